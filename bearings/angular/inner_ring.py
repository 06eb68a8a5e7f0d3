"""The inner ring of a ball bearing in space: six coordinates, on rows of balls between groove centres.

To the ring's place in the plane and its spin (`bearings.rolling.ring`) come its way along the shaft and two
small tilts. Each ball is the spring on the line between the groove centres of `angular_row`; of its
length l at the ball's angle,

    F = K max(l - A, 0)^1.5 + c (l - A) l'

acts on the ring across and along the shaft and, at the levers Z_i and R_i, tilts it. The ball itself,
carried along its path by the turning ring, resists with the slope of the spring's energy over the ball's
angle. With the transverse inertia I_t, the polar one I_p and the spin Omega of the ring

    I_t rx'' + I_p Omega ry' = M_x        I_t ry'' - I_p Omega rx' = M_y

The journal, which tilts too, meets the bore at both edges of its land, l/2 to either side of the ring's
middle, with half the contact's stiffness at each: without tilt that is the contact in the plane. Its
friction acts around the shaft, as there; along the shaft it slides freely. Its shoulders land on the ring's
faces.

Along the shaft balls roll at half the ring's rate, which makes it heavier (`row.ROLLED_MASS`). A ball's
centrifugal force, which opens the contact angle at the inner race, is that of `thrown_ball`. The housing
does not tilt, and takes no moments.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

from ...modelkit.gravity import gravity_along
from ...modelkit.kernel import inlined, kernel
from ...modelkit.numerics import squared
from ...modelkit.ports import Motion, MountReaction, SeatReaction
from ...modelkit.variables import group, groups, integer, real
from .. import seat
from ..contact.face import (
    ShoulderMemory,
    ShoulderReport,
    Slip,
    Tilt,
    land_tilted,
    note_landing,
    report_faces,
)
from ..contact.journal import Touch, note_touch, time_to_touch
from ..contact.laws import elastic_energy
from ..contact.line import BoreContact
from ..contact.materials import elastic_of
from ..rolling import ring
from ..rolling.ball_set import BallSet
from ..rolling.declarations import RollingMemory, RollingOutputs
from ..seat import space
from ..seat.space import SpatialSeatMemory
from .angular_row import (
    ROLLED_MASS,
    ROLLED_WEIGHT,
    SINGLES,
    Pose,
    RowConstants,
    ball_rows,
    keep_row,
    pressed,
)
from .thrown_ball import alone_on_outer, rolled_orbit, thrown_ball

Z, VZ, RX, RY, WX, WY = range(ring.NEXT, ring.NEXT + 6)  # along the shaft; tilts and their rates
NEXT = ring.NEXT + 6
FACE_LOSS = space.OWN  # heat of the faces
LEAST_THROWN = 1e-6  # N, of a ball's centrifugal force that has a part in its balance


@dataclass(frozen=True)
class ContactAngle:
    """Balls and races that may touch at an angle."""

    contact_angle: float = real(0.0, "rad", "contact angle; 0: deep grooves", minimum=0.0, maximum=1.2)


@dataclass(frozen=True)
class AngularBallSet(ContactAngle, BallSet):
    """Balls and races, which may touch at an angle."""


@dataclass(frozen=True)
class SpatialRing(ring.Ring):
    """Inner ring, which tilts."""

    transverse_inertia: float = real(
        0.0, "kg.m2", "its moment of inertia about a diameter; 0: half of inertia", minimum=0.0
    )


@dataclass(frozen=True)
class SpatialOutputs(RollingOutputs):
    """Outputs of all rolling bearings in space."""

    journal: SeatReaction = group(SeatReaction)
    housing: MountReaction = group(MountReaction)
    shoulder: ShoulderReport = group(ShoulderReport)


@dataclass(frozen=True)
class SpatialMemory(RollingMemory):
    """Memory of all rolling bearings in space."""

    seat: SpatialSeatMemory = group(SpatialSeatMemory)
    shoulder: ShoulderMemory = group(ShoulderMemory)
    pushed_off: float = real(0.0, "N", "of the rotor on the ring, to the open side of its rows, of late")


@dataclass(frozen=True)
class AlongReport:
    """The ring along the shaft, and its tilt."""

    z: float = real(0.0, "m", "position of the ring", local=True)
    vz: float = real(0.0, "m/s", "velocity of the ring", local=True)
    force: float = real(0.0, "N", "of the balls on the ring", local=True)
    contact_angle: float = real(0.0, "rad", "of the most loaded ball; 0: none is loaded", local=True)
    centrifugal: float = real(
        0.0,
        "1",
        "centrifugal force of a ball over the force on the most loaded one, means since the rotor landed",
        local=True,
    )
    rx: float = real(0.0, "rad", "tilt of the ring about x", local=True)
    ry: float = real(0.0, "rad", "tilt of the ring about y", local=True)
    moment_x: float = real(0.0, "N.m", "of the balls on the ring, about x", local=True)
    moment_y: float = real(0.0, "N.m", "of the balls on the ring, about y", local=True)


@dataclass(frozen=True)
class SpaceConstants:
    """Constants of a ring in space that follow from the parameters."""

    rows: int = integer(0, "rows of balls")
    row: tuple = groups(RowConstants, 2)
    damping: float = real(0.0, "N.s/m2", "of a ball of such a row")
    abreast: float = real(1.0, "1", "balls side by side that are one, and share its force")
    transverse_inertia: float = real(0.0, "kg.m2", "of the ring about a diameter")
    mass_along: float = real(0.0, "kg", "of the ring, and of the balls, which roll along with it")
    weight_along: float = real(0.0, "N", "of ring and balls along the shaft, towards +z")
    outer_share: float = real(0.0, "1", "of the outer ring in how far the race opens all around")
    edge: BoreContact = group(BoreContact)


@dataclass(frozen=True)
class SpaceRingMemory:
    """The ring at the last evaluation."""

    fz: float = real(0.0, "N", "of the balls on the ring")
    mx: float = real(0.0, "N.m", "of the balls on the ring")
    my: float = real(0.0, "N.m", "of the balls on the ring")
    across: float = real(0.0, "N", "sum of what the springs press the balls outwards with")
    sine: float = real(0.0, "1", "of the contact angle of the most loaded ball")
    centrifugal: float = real(0.0, "N", "of a ball over the macro step; 0: it is left out")
    outer_alone: float = real(0.0, "m", "indentation of the outer race by that alone")
    lifted: float = real(0.0, "m", "sum over pressed balls of how far that has moved them outwards")
    stretch: float = real(0.0, "N.m", "work of the balls along the shaft over a strain of the inner ring")
    orbit_load: float = real(0.0, "N", "largest force of the inner race on a ball")
    orbit_ratio: float = real(0.0, "1", "orbit of that ball over the ring's spin")
    edge_mx: float = real(0.0, "N.m", "of the bore's edges on the journal")
    edge_my: float = real(0.0, "N.m", "of the bore's edges on the journal")
    edge_stored: float = real(0.0, "J", "in the contacts at both edges")
    time: float = real(0.0, "s", "time of the last micro-step")
    pressed: float = real(0.0, "N.s", "impulse of the force on the most loaded ball since the landing")
    thrown: float = real(0.0, "N.s", "of a ball's centrifugal force meanwhile, while one was pressed")


@kernel
def derive(m, hoop):
    """Set m.d.space, of a bearing whose m.d.race and m.d.contact are set; hoop: of its rings (m/N)."""
    p, d, c, b = m.p, m.d, m.d.space, m.p.balls
    transverse = p.ring.transverse_inertia
    c.transverse_inertia = transverse if transverse > 0.0 else 0.5 * p.ring.inertia
    c.mass_along = p.ring.mass + ROLLED_MASS * b.count * d.mass
    weight = p.ring.mass + ROLLED_WEIGHT * b.count * d.mass
    c.weight_along = weight * gravity_along(p.gravity, p.inclination)
    c.edge = d.contact
    edge = c.edge
    edge.stiffness, edge.damping, edge.viscous = (
        0.5 * edge.stiffness,
        0.5 * edge.damping,
        0.5 * edge.viscous,
    )
    if b.contact_angle > 0.0:  # no play lets the ring sink, and a pair's preload holds it
        d.rest_x = d.rest_y = 0.0
        d.inner_radius = 0.5 * (b.pitch_diameter - b.diameter * math.cos(b.contact_angle))
    clamped = p.preload, p.interference, hoop
    rings = elastic_of(p.ring)
    first, second = ball_rows(b, rings, b.contact_angle, p.arrangement, p.row_distance, clamped)
    if p.arrangement in SINGLES:  # rows side by side are one
        c.rows, c.abreast, c.damping = 1, b.rows, d.race.damping
    else:
        c.rows, c.abreast, c.damping = 2, 1.0, d.race.damping / b.rows
    keep_row(c.row[0], first, c.abreast)
    keep_row(c.row[1], second, c.abreast)


@kernel
def set_weights(w):
    """Set the error weights of what the ring has beside that of a ring in the plane, in w (n,)."""
    w[Z], w[VZ] = 1.0 / seat.POSITION_SCALE, 1.0 / seat.VELOCITY_SCALE
    w[RX] = w[RY] = 1.0 / space.TILT_SCALE
    w[WX] = w[WY] = 1.0 / space.TILT_RATE_SCALE


@kernel
def place_in_space(q):
    """Put the ring at rest where its housing is, straight."""
    q[Z], q[VZ], q[RX], q[RY], q[WX], q[WY] = q[space.HZ], q[space.HVZ], 0.0, 0.0, 0.0, 0.0


@kernel
def ring_pose(q):
    """`Pose` (m, rad) of the ring in the housing."""
    return Pose(q[ring.RX] - q[seat.HX], q[ring.RY] - q[seat.HY], q[Z] - q[space.HZ], q[RX], q[RY])


@kernel
def pose_rates(q):
    """Its rates, as a `Pose` (m/s, rad/s)."""
    return Pose(q[ring.RVX] - q[seat.HVX], q[ring.RVY] - q[seat.HVY], q[VZ] - q[space.HVZ], q[WX], q[WY])


class HeldBall(NamedTuple):
    """A ball between the rings in space."""

    force: float  # N, of the inner race on it
    elastic: float  # N, what of it is not damping
    outer: float  # N, of the outer race on it
    indentation: float  # m
    rate: float  # m/s
    across: float  # N, of `force` outwards
    along: float  # N, likewise along the shaft
    turning: float  # N m, slope of the spring's energy over the ball's angle
    cosine: float  # of the contact angle at the inner race
    sine: float


@inlined
def _held(row, pose, moving, direction, damping, contact):
    """`HeldBall` at a `direction` (cosine, sine), whose `contact` with the inner race is

    (elastic force (N), indentation (m), cosine and sine of the contact angle, centrifugal force (N)).
    """
    (c, s), (elastic, indentation, cosine, sine, thrown) = direction, contact
    tilting = moving.ry * c - moving.rx * s
    outwards = moving.x * c + moving.y * s + row.inner_at * tilting
    rate = cosine * outwards + sine * (moving.z - row.lever * tilting)
    force = max(elastic + damping * max(indentation, 0.0) * rate, 0.0)
    turned = -pose.ry * s - pose.rx * c  # of the tilt along the path
    turning = elastic * cosine * (pose.y * c - pose.x * s + row.inner_at * turned)
    turning -= elastic * sine * row.lever * turned
    across, along = force * cosine, force * sine
    outer = force
    if thrown > 0.0:
        outer = math.sqrt(squared(across + thrown) + squared(along))
    return HeldBall(force, elastic, outer, indentation, rate, across, along, turning, cosine, sine)


@kernel
def held_ball(row, pose, moving, c, s, m):
    """A ball of a `row` (a record of `RowConstants`) at an angle of cosine c and sine s, as `HeldBall`.

    pose, moving: the ring's `Pose` and its rates.
    """
    grown = m.s.gaps.ball_growth
    ball = pressed(row, pose, c, s, grown)
    contact = ball.force, ball.length - row.free + grown, ball.cosine, ball.sine, 0.0
    return _held(row, pose, moving, (c, s), m.d.space.damping, contact)


@kernel
def orbiting_ball(row, pose, moving, c, s, at, m):
    """The same of a ball that its orbit throws outwards, after `step_balls`; at: its number in all rows."""
    space, balls = m.s.space, m.s.balls
    ball = thrown_ball(row, space.centrifugal, space.outer_alone, m.s.gaps.ball_growth, at, m.s.orbit)
    if ball.inner > 0.0:
        space.lifted += ball.lifted
        balls.energy += ball.stored - 0.4 * ball.inner * ball.indentation  # what `note_ball` adds
        if ball.inner > space.orbit_load:
            space.orbit_load = ball.inner
            space.orbit_ratio = rolled_orbit(ball, m.p.balls.diameter / m.p.balls.pitch_diameter)
    contact = ball.inner, ball.indentation, ball.cosine, ball.sine, space.centrifugal
    return _held(row, pose, moving, (c, s), m.d.space.damping, contact)


@kernel
def throw_balls(m):
    """Set the centrifugal force of a ball for a macro step that begins; returns the work (J) of its change.

    Balls orbit as they roll without spin on the outer race, at the contact angles of the most loaded one.
    """
    s, b = m.s.space, m.p.balls
    orbit = s.orbit_ratio * m.q[ring.RW]
    thrown = m.d.mass / b.rows * m.d.space.abreast * 0.5 * b.pitch_diameter * orbit * orbit
    work = (thrown - s.centrifugal) * s.lifted
    s.outer_alone = alone_on_outer(m.d.space.row[0], thrown)
    s.centrifugal = thrown if thrown > LEAST_THROWN else 0.0
    return work


@kernel
def add_ball(space, row, ball, c, s):
    """Add a `HeldBall`'s force along the shaft and moments on the ring to a record of `SpaceRingMemory`."""
    tilting = row.inner_at * ball.across - row.lever * ball.along
    space.fz -= ball.along
    space.across += ball.elastic * ball.cosine
    space.mx += tilting * s
    space.my -= tilting * c


@kernel
def _at_edge(motion, z, rx, ry, wx, wy):
    """`Motion` of a body's axis `z` (m) from where `motion` is, by its tilt (rad, rad/s)."""
    return Motion(
        motion.x + z * ry,
        motion.y - z * rx,
        motion.vx + z * wy,
        motion.vy - z * wx,
        motion.spin,
    )


@kernel
def _journal_at(q, z):
    """`Motion` of the journal's axis, `z` (m) from the ring's middle."""
    return _at_edge(seat.journal_motion(q), z, q[space.JRX], q[space.JRY], q[space.JWX], q[space.JWY])


@kernel
def _ring_at(q, z):
    """`Motion` of the ring's axis likewise."""
    return _at_edge(ring.ring_motion(q), z, q[RX], q[RY], q[WX], q[WY])


@kernel
def journal_on_edges(q, shape, m):
    """`Touch` of the journal with the bore: at both edges of its land together, where it has one.

    The moments that tilt the journal are kept in m.s.space; shape: as for `ring.journal_on_ring`.
    """
    space, half = m.s.space, 0.5 * m.p.land
    space.edge_mx = space.edge_my = 0.0
    if half == 0.0:
        t = ring.journal_on_ring(q, shape, m)
        space.edge_stored = elastic_energy(t.indentation, m.d.contact)
        return t
    law = m.d.space.edge
    a = ring.touch_in_bore(q, _journal_at(q, -half), _ring_at(q, -half), law, shape, m)
    b = ring.touch_in_bore(q, _journal_at(q, half), _ring_at(q, half), law, shape, m)
    space.edge_mx, space.edge_my = half * (a.fy - b.fy), half * (b.fx - a.fx)
    space.edge_stored = elastic_energy(a.indentation, law) + elastic_energy(b.indentation, law)
    deeper = a.indentation > b.indentation
    t = Touch(
        a.fx + b.fx,
        a.fy + b.fy,
        a.journal_moment + b.journal_moment,
        a.ring_moment + b.ring_moment,
        a.normal + b.normal,
        a.elastic + b.elastic,
        a.indentation if deeper else b.indentation,
        a.rate if deeper else b.rate,
        a.loss + b.loss,
        a.sliding + b.sliding,
    )
    note_touch(m.s.ring, t)
    return t


@kernel
def accelerate_in_space(q, dq, held, m):
    """Derivatives dq of the ring in space, which is `held` (N) along the shaft by balls and damping.

    Returns the `Landing` of the journal's shoulders on its faces. The balls' and the bore's moments are
    those of the last evaluation, in m.s.space.
    """
    p, d, s = m.p, m.d.space, m.s.space
    journal, body = seat.journal_motion(q), ring.ring_motion(q)
    slip = Slip(
        q[space.JZ] - q[Z],
        q[space.JVZ] - q[VZ],
        journal.vx - body.vx,
        journal.vy - body.vy,
        journal.spin - body.spin,
    )
    tilt = Tilt(q[space.JRX] - q[RX], q[space.JRY] - q[RY], q[space.JWX] - q[WX], q[space.JWY] - q[WY])
    faces = land_tilted(slip, tilt, p.shoulder, m.d.friction)
    note_landing(m.s.shoulder, faces)
    dq[Z] = q[VZ]
    dq[VZ] = (held - faces.fz + d.weight_along) / d.mass_along
    dq[RX], dq[RY] = q[WX], q[WY]
    spinning = p.ring.inertia * q[ring.RW]
    about_x, about_y = s.mx - s.edge_mx - faces.mx, s.my - s.edge_my - faces.my
    dq[WX] = (about_x - spinning * q[WY]) / d.transverse_inertia
    dq[WY] = (about_y + spinning * q[WX]) / d.transverse_inertia
    dq[FACE_LOSS] = faces.loss
    return faces


@kernel
def note_orbit(time, force, orbit, m):
    """Keep the mean centrifugal force of a ball over that of the `force` (N) on the most loaded one.

    Both are means over the time since the rotor landed in which a ball was pressed, up to an accepted
    micro-step that ends at `time` (s). At the largest force, in the first impact, the ring has hardly begun
    to turn; where the ring turns with the rotor, balls carry its weight and the preload, and it is there
    that contact angles go wrong. orbit: rad/s.
    """
    s = m.s.space
    step, s.time = time - s.time, time
    landed = m.o.contact.first_time >= 0.0 or m.o.shoulder.first_time >= 0.0
    if force <= 0.0 or not landed:
        return
    radius, mass = 0.5 * m.p.balls.pitch_diameter, m.d.mass / m.p.balls.rows
    s.pressed += force * step
    s.thrown += mass * radius * orbit * orbit * step
    m.o.along.centrifugal = s.thrown / s.pressed


@kernel
def report(q, m):
    """Outputs of the ring in space, and its part in the bearing's energy (J), once that is in m.o."""
    o, s, d, e = m.o.along, m.s.space, m.d.space, m.o.energy
    o.z, o.vz, o.rx, o.ry = q[Z], q[VZ], q[RX], q[RY]
    o.force, o.moment_x, o.moment_y = s.fz, s.mx, s.my
    o.contact_angle = math.asin(s.sine) if m.o.balls.force > 0.0 else 0.0
    e.kinetic += 0.5 * d.mass_along * squared(q[VZ])
    e.kinetic += 0.5 * d.transverse_inertia * (squared(q[WX]) + squared(q[WY]))
    e.potential -= d.weight_along * q[Z]
    e.potential += report_faces(q[FACE_LOSS], m.p.shoulder, m.o.shoulder, m.s.shoulder)
    e.potential += s.edge_stored - elastic_energy(m.s.ring.indentation, m.d.contact)
    e.dissipated += q[FACE_LOSS]
    half = 0.5 * m.p.land
    if half > 0.0:
        for side in (-half, half):
            reach = time_to_touch(_journal_at(q, side), _ring_at(q, side), m.s.gaps.clearance)
            m.o.contact.reach = min(m.o.contact.reach, reach)
