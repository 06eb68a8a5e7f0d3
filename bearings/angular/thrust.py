"""The inner ring of a detailed bearing along the shaft: faces for a shoulder, and balls that carry thrust.

Balls that are bodies move in the plane. Along the shaft the ring has a coordinate of its own, on the closed
form of one row or a pair (`bearings.angular`): each ball is the spring between the centres of its grooves,

    F(z) = sum over the rows of Z K d^1.5 sin a        d, a by z alone, as if no load pressed across

so thrust and radial load do not meet in a ball: where both are large, its force is larger than either says.
The rotor's shoulder lands on the ring's faces (`bearings.contact.face`), whose friction spins the ring up.

In a kick of h seconds damping is taken in its middle, by solving for the ring's acceleration along the
shaft, and friction at its end. With s the sliding of a place b of the face, expected to end at s*, friction
there is c_b s, c_b = N/places mu(|s*|)/|s*|. That joins the ring's three equations for the bore and the
balls as a mass h sum c_b and an inertia h R^2 sum c_b; the rest of it, where the places slide unlike, stays
as it is expected.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

from ...modelkit.kernel import kernel
from ...modelkit.numerics import squared
from ...modelkit.variables import array, group, groups, integer, real
from .. import seat
from ..contact.face import (
    PLACES,
    ShoulderMemory,
    ShoulderReport,
    Slip,
    has_faces,
    land,
    note_landing,
    report_faces,
    watch_faces,
)
from ..contact.friction import coefficient
from ..contact.laws import ContactLaw, elastic_and_damping
from ..contact.materials import elastic_of
from ..heat import parts
from ..heat.parts import Sources
from ..rolling import ring
from ..rolling.ball_set import BallSet, FreeBallSet, series_dissipation, set_race_law
from ..rolling.micro_step import step_in_hit
from .row import (
    ROLLED_MASS,
    ROLLED_WEIGHT,
    SINGLES,
    Pose,
    RowConstants,
    keep_row,
    pressed,
    rows_of,
)

Z, VZ, FACE_LOSS = range(3)  # of the ring along the shaft, from m.d.thrust.at: m, m/s; J, heat of the faces
SLOWEST = 1e-6  # m/s, sliding below which the curve of friction is a straight line


@dataclass(frozen=True)
class ThrustAngle:
    """A contact angle of balls that move in the plane."""

    contact_angle: float = real(
        0.0,
        "rad",
        "contact angle under thrust; in the plane balls are as at 0",
        minimum=0.0,
        maximum=1.2,
    )


@dataclass(frozen=True)
class AngularBallSet(ThrustAngle, BallSet):
    """Balls that carry thrust at a contact angle."""


@dataclass(frozen=True)
class AngularFreeBallSet(ThrustAngle, FreeBallSet):
    """The same without a cage."""


@dataclass(frozen=True)
class Along:
    """The ring along the shaft; all 0 where it stays in the plane."""

    z: float = real(0.0, "m", "position of the ring", local=True)
    vz: float = real(0.0, "m/s", "velocity of the ring", local=True)
    force: float = real(0.0, "N", "of the balls on the ring", local=True)
    contact_angle: float = real(0.0, "rad", "of the most loaded row; 0: none is loaded", local=True)
    ball_force: float = real(0.0, "N", "of thrust on a ball of the most loaded row", local=True)
    peak_ball_force: float = real(0.0, "N", "the largest of thrust on a ball so far", local=True)


@dataclass(frozen=True)
class ThrustOutputs:
    """Outputs about a ring that moves along the shaft."""

    along: Along = group(Along)
    shoulder: ShoulderReport = group(ShoulderReport)


@dataclass(frozen=True)
class ThrustRows:
    """Rows of balls that carry thrust, in a model's constants."""

    at: int = integer(0, "first component of the ring along the shaft in the state")
    rows: int = integer(0, "of balls along the shaft; 0: the ring stays in the plane")
    mass: float = real(0.0, "kg", "of the ring, and of the balls, which roll along with it")
    weight: float = real(0.0, "kg", "what of ring and balls gravity pulls at it by")
    balls: float = real(0.0, "1", "in a row that are one spring")
    abreast: float = real(1.0, "1", "balls side by side that share its force")
    damping: float = real(0.0, "N.s/m2", "of a ball")
    race: ContactLaw = group(ContactLaw)  # of both races in series
    row: tuple = groups(RowConstants, 2)


@dataclass(frozen=True)
class ThrustMemory:
    """Along the shaft, at the last evaluation."""

    accelerates: float = real(0.0, "m/s2", "the ring")
    force: float = real(0.0, "N", "of the balls on the ring")
    elastic: float = real(0.0, "N", "what of it is no damping")
    loss: float = real(0.0, "W", "of the balls")
    energy: float = real(0.0, "J", "in the balls")
    sine: float = real(0.0, "1", "of the contact angle of the most loaded row")
    ball: float = real(0.0, "N", "on a ball of it")
    normal: float = real(0.0, "N", "of the face")
    face_elastic: float = real(0.0, "N", "what of it is no damping")
    side: float = real(0.0, "1", "towards which the face pushes the journal; 0: none")
    face_loss: float = real(0.0, "W", "by damping of the face")
    sum: float = real(0.0, "N.s/m", "of c_b")
    slip: object = array(3)  # before the kick: m/s, m/s, rad/s
    held: object = array(3)  # friction on the ring if the kick does not move it: N, N, N m


@dataclass(frozen=True)
class ThrustDerived:
    """Constants that follow from the parameters."""

    thrust: ThrustRows = group(ThrustRows)


@dataclass(frozen=True)
class ThrustHidden:
    """Memory between evaluations and steps."""

    thrust: ThrustMemory = group(ThrustMemory)
    shoulder: ShoulderMemory = group(ShoulderMemory)


class Drag(NamedTuple):
    """Friction of a face that moves with the ring over a kick, on the ring."""

    fx: float  # N, as the ring keeps its velocity
    fy: float
    moment: float  # N m
    mass: float  # kg, by which the ring resists more
    inertia: float  # kg m2


NO_DRAG = Drag(0.0, 0.0, 0.0, 0.0, 0.0)


@kernel
def derive(m):
    """Set the rows that carry thrust in m.d.thrust, once m.d has stiffness, mass and steps of the balls."""
    p, d, b = m.p, m.d.thrust, m.p.balls
    d.rows = 0
    if b.contact_angle == 0.0 and not has_faces(p.shoulder):
        return
    m.d.micro_step = min(m.d.micro_step, step_in_hit(p.micro_step, p.shoulder, p.ring.mass))
    d.mass = p.ring.mass + ROLLED_MASS * b.count * m.d.mass
    d.weight = p.ring.mass + ROLLED_WEIGHT * b.count * m.d.mass
    rings = elastic_of(p.ring)
    whole = m.d.stiffness
    set_race_law(d.race, b, whole.series, m.d.mass, series_dissipation(whole))
    d.balls, d.abreast, d.damping = b.count, b.rows, d.race.damping
    clamped = p.preload, p.interference
    first, second = rows_of(b, rings, b.contact_angle, p.arrangement, p.row_distance, clamped)
    keep_row(d.row[0], first)
    keep_row(d.row[1], second)
    if p.arrangement in SINGLES:  # rows side by side are one
        d.rows = 1
        d.row[0].stiffness *= b.rows
    else:
        d.rows, d.abreast, d.damping = 2, 1.0, d.damping / b.rows


@kernel
def append(m):
    """Put the ring along the shaft behind the m.n components in use, with its error weights."""
    if m.d.thrust.rows > 0:
        at = m.d.thrust.at = m.n
        m.weight[at + Z], m.weight[at + VZ] = 1.0 / seat.POSITION_SCALE, 1.0 / seat.VELOCITY_SCALE
        m.weight[at + FACE_LOSS] = 0.0
        m.n += 3


@kernel
def place(m):
    """Put the ring at rest in its housing along the shaft."""
    if m.d.thrust.rows > 0:
        at = m.d.thrust.at
        m.q[at + Z], m.q[at + VZ], m.q[at + FACE_LOSS] = m.q[seat.HZ], m.q[seat.HVZ], 0.0
        m.s.thrust.ball = 0.0


@kernel
def _carry(way, rate, m):
    """Have m.s.thrust be what the balls do to a ring moved by `way` (m) at a `rate` (m/s).

    Returns how they damp it (N s/m).
    """
    s, d, damped = m.s.thrust, m.d.thrust, 0.0
    s.force = s.elastic = s.loss = s.energy = s.ball = s.sine = m.s.along = 0.0
    for k in range(d.rows):
        row = d.row[k]
        ball = pressed(row, Pose(0.0, 0.0, way, 0.0, 0.0), 1.0, 0.0)
        depth = ball.length - row.free
        if depth <= 0.0:
            continue
        law = d.damping * depth
        force = max(ball.force + law * ball.sine * rate, 0.0)
        s.force -= d.balls * force * ball.sine
        s.elastic -= d.balls * ball.force * ball.sine
        s.loss += d.balls * (force - ball.force) * ball.sine * rate
        s.energy += 0.4 * d.balls * ball.force * depth
        m.s.along += d.balls * (
            ball.slope * squared(ball.sine) + ball.force * squared(ball.cosine) / ball.length
        )
        damped += d.balls * law * squared(ball.sine)
        if force >= s.ball:
            s.ball, s.sine = force, ball.sine
    return damped


@kernel
def _meet(q, rate, m):
    """`Landing` of the journal on the faces of a ring at a `rate` (m/s), without friction."""
    at = m.d.thrust.at
    slip = Slip(q[seat.JZ] - q[at + Z], q[seat.JVZ] - rate, 0.0, 0.0, 0.0)
    return land(slip, m.p.shoulder, m.d.friction)


@kernel
def press(q, m):
    """Find the forces along the shaft in the state q, over the kick m.s.kick, and the face's `Drag`."""
    if m.d.thrust.rows == 0:
        return NO_DRAG
    p, s, at, half = m.p, m.s.thrust, m.d.thrust.at, 0.5 * m.s.kick
    way, rate, mass = q[at + Z] - q[seat.HZ], q[at + VZ], m.d.thrust.mass
    weight = m.d.thrust.weight * m.d.gravity_z
    damped = _carry(way, rate - q[seat.HVZ], m)
    face = _meet(q, rate, m)
    closing = face.rate
    damped += elastic_and_damping(face.indentation, p.shoulder)[1]
    middle = rate + half * ((s.force - face.fz + weight) / mass) / (1.0 + half * damped / mass)
    _carry(way, middle - q[seat.HVZ], m)
    face = _meet(q, middle, m)
    note_landing(m.s.shoulder, face)
    m.s.shoulder.rate = closing
    s.accelerates = (s.force - face.fz + weight) / mass
    s.normal, s.face_loss, s.side = face.normal, face.loss, math.copysign(1.0, face.fz)
    s.face_elastic = elastic_and_damping(face.indentation, p.shoulder)[0]
    if face.indentation > 0.0:
        m.s.along += p.shoulder.exponent * s.face_elastic / face.indentation
    m.s.along /= mass
    return _drag(q, m)


@kernel
def _drag(q, m):
    """The face's `Drag` on the ring in the state q; what it depends on is kept in m.s.thrust."""
    s, radius, h, a = m.s.thrust, m.p.shoulder.radius, m.s.kick, m.s.before
    s.sum = s.held[0] = s.held[1] = s.held[2] = 0.0
    s.slip[0], s.slip[1] = q[seat.JVX] - q[ring.RVX], q[seat.JVY] - q[ring.RVY]
    s.slip[2] = q[seat.JW] - q[ring.RW]
    if s.normal <= 0.0:
        return NO_DRAG
    ux, uy = s.slip[0] - h * a[ring.RVX], s.slip[1] - h * a[ring.RVY]  # as the kick is expected to end
    spin = s.slip[2] - h * a[ring.RW]
    each, across_x, across_y = 0.0, 0.0, 0.0
    for k in range(PLACES):
        angle = 2.0 * math.pi * k / PLACES
        ex, ey = -math.sin(angle), math.cos(angle)
        sx, sy = ux + radius * spin * ex, uy + radius * spin * ey
        speed = max(math.sqrt(sx * sx + sy * sy), SLOWEST)
        c = s.normal / PLACES * coefficient(speed, m.d.friction) / speed
        each += c
        across_x += c * radius * ex
        across_y += c * radius * ey
    s.sum = each
    s.held[0] = each * s.slip[0] + across_x * spin
    s.held[1] = each * s.slip[1] + across_y * spin
    s.held[2] = each * radius * radius * s.slip[2] + across_x * ux + across_y * uy
    return Drag(s.held[0], s.held[1], s.held[2], h * each, h * each * radius * radius)


class Shove(NamedTuple):
    """Loads along the shaft and of the faces' friction, on the journal and on the housing."""

    fx: float  # N, on the journal
    fy: float
    fz: float
    moment: float  # N m
    housing: float  # N, along the shaft


NO_SHOVE = Shove(0.0, 0.0, 0.0, 0.0, 0.0)


@kernel
def accelerate(q, dq, moved, m):
    """Derivatives dq of the ring by faces and thrust, in a kick that does `moved` (Moved) to it.

    Returns the `Shove`. Heat goes to dq, too; what of the forces makes heat to m.s.brake.
    """
    if m.d.thrust.rows == 0:
        return NO_SHOVE
    s, at, p, b = m.s.thrust, m.d.thrust.at, m.p, m.s.brake
    dq[at + Z], dq[at + VZ] = q[at + VZ], s.accelerates
    turn = s.sum * p.shoulder.radius * p.shoulder.radius
    fx, fy = s.held[0] - s.sum * moved.x, s.held[1] - s.sum * moved.y
    moment = s.held[2] - turn * moved.spin
    dq[ring.RVX] += fx / p.ring.mass
    dq[ring.RVY] += fy / p.ring.mass
    dq[ring.RW] += moment / p.ring.inertia
    heat = s.face_loss + fx * (s.slip[0] - 0.5 * moved.x) + fy * (s.slip[1] - 0.5 * moved.y)
    heat += moment * (s.slip[2] - 0.5 * moved.spin)
    dq[at + FACE_LOSS] = heat
    dq[ring.LOSS] += heat + s.loss
    parts.add_heat(Sources(heat, 0.0, 0.5 * s.loss, 0.5 * s.loss, 0.0), dq, ring.HEAT)
    b.jx, b.jy, b.jm = b.jx - fx, b.jy - fy, b.jm - moment
    b.jz, b.hz = s.side * (s.normal - s.face_elastic), s.elastic - s.force
    return Shove(-fx, -fy, s.side * s.normal, -moment, -s.force)


@kernel
def drift(trial, q, mid, h, m):
    """The ring's place along the shaft in the state `trial`; the others as `ring.drift`."""
    if m.d.thrust.rows > 0:
        at = m.d.thrust.at
        trial[at + Z] = q[at + Z] + h * mid[at + VZ]


@kernel
def watch(time, m):
    """Peaks and landings, after the micro-step to `time` (s)."""
    if m.d.thrust.rows > 0:
        watch_faces(time, m.p.shoulder, m.o.shoulder, m.s.shoulder)
        own = m.s.thrust.ball / m.d.thrust.abreast
        m.o.along.peak_ball_force = max(m.o.along.peak_ball_force, own)


@kernel
def report(q, m):
    """Outputs along the shaft and energy of it, from the state q; after `ring.report_energy`."""
    if m.d.thrust.rows == 0:
        return
    o, s, at, mass = m.o.along, m.s.thrust, m.d.thrust.at, m.d.thrust.mass
    o.z, o.vz, o.force = q[at + Z], q[at + VZ], s.force
    o.ball_force = s.ball / m.d.thrust.abreast
    o.contact_angle = math.asin(s.sine) if s.ball > 0.0 else 0.0
    in_faces = report_faces(q[at + FACE_LOSS], m.p.shoulder, m.o.shoulder, m.s.shoulder)
    m.o.energy.kinetic += 0.5 * mass * squared(q[at + VZ])
    m.o.energy.potential += s.energy + in_faces - m.d.thrust.weight * m.d.gravity_z * q[at + Z]
