"""The cage, and the pockets in which it holds the balls.

Every pocket is a circle around a point that turns with the cage on the pitch circle (2.42), wider than
the ball by the clearance on radius; the balls are all that guides the cage.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from ...modelkit.kernel import kernel
from ...modelkit.numerics import squared
from ...modelkit.ports import Motion
from ...modelkit.variables import real
from .. import seat
from ..contact.journal import length_problem, out_of_proportion
from ..contact.pair import INSIDE, ContactPlace, kick_of, squeeze
from .ball_bodies import ANGLE, SIZE, SPIN, VX, VY, X, Y, ball_motion, push_ball
from .ball_contacts import ball_heat, lay, note_apart, press_of, rub_sides
from .ball_set import EVEN_SPREAD, start_angle
from .micro_step import beat_of
from .ring import BALLS


@dataclass(frozen=True)
class CageBody:
    """Cage that moves freely between the balls."""

    mass: float = real(2.15e-3, "kg", "mass of the cage; as heavy as two balls", above=0.0)
    inertia: float = real(
        0.0, "kg.m2", "moment of inertia of the cage; 0: a ring on the pitch circle", minimum=0.0
    )
    clearance: float = real(5e-6, "m", "radial clearance of a ball in its pocket")


PROBLEMS = (
    "cage.clearance = {0:g} m makes a pocket of {1:g} m, smaller than its ball of {2:g} m; "
    "it must be at least 0 m",
    length_problem("cage.clearance", "half of balls.diameter"),
)


@kernel
def pocket_problem(p, numbers):
    """The number in `PROBLEMS` of a fault in the pockets of p, or 0; numbers: for texts."""
    clearance, diameter = p.cage.clearance, p.balls.diameter
    if clearance < 0.0:
        numbers[0], numbers[1], numbers[2] = clearance, diameter + 2.0 * clearance, diameter
        return 1
    return 2 if out_of_proportion(clearance, 0.5 * diameter, numbers) else 0


@kernel
def inertia_of(p, mass):
    """Moment of inertia (kg m2) of a cage of `mass` (kg), that part of the one in the parameters p."""
    radius = 0.5 * p.balls.pitch_diameter
    return p.cage.inertia * (mass / p.cage.mass) if p.cage.inertia != 0.0 else mass * squared(radius)


@kernel
def set_pockets(d, b, radius):
    """Set d.pocket_x and d.pocket_y (m) on a `radius` (m) where the balls b, a record, start."""
    for i in range(b.count):
        angle = start_angle(b.first_angle, b.count, EVEN_SPREAD, i)
        d.pocket_x[i], d.pocket_y[i] = radius * math.cos(angle), radius * math.sin(angle)


@dataclass(frozen=True)
class CageReport:
    """Motion of the cage."""

    x: float = real(0.0, "m", "horizontal position", local=True)
    y: float = real(0.0, "m", "vertical position", local=True)
    vx: float = real(0.0, "m/s", "horizontal velocity", local=True)
    vy: float = real(0.0, "m/s", "vertical velocity", local=True)
    omega: float = real(0.0, "rad/s", "spin speed", local=True)


@kernel
def first_component(m):
    """Index at which the cage's state starts."""
    return BALLS + SIZE * m.p.balls.count


@kernel
def place_cage(q, m):
    """Put the cage in the state q at rest in the housing's middle."""
    i = first_component(m)
    q[i + X], q[i + Y] = q[seat.HX], q[seat.HY]
    q[i + VX], q[i + VY] = q[seat.HVX], q[seat.HVY]
    q[i + ANGLE], q[i + SPIN] = 0.0, 0.0


@kernel
def _pocket(q, i, rx, ry):
    """Motion of a pocket at (rx, ry) (m) from the middle of the cage, whose components in q start at i."""
    spin = q[i + SPIN]
    return Motion(q[i + X] + rx, q[i + Y] + ry, q[i + VX] - spin * ry, q[i + VY] + spin * rx, spin)


@kernel
def _kick(b, place, rx, ry, m):
    """The `Kick` of ball `b` and its pocket, at (rx, ry) (m) from the middle of the cage."""
    d, before, side = m.d, m.s.before, m.s.side
    lever, off = place.second + rx * place.nx + ry * place.ny, rx * place.ny - ry * place.nx
    both = 1.0 / d.mass + 1.0 / m.p.cage.mass
    across = both + d.ball_radius * d.ball_radius / d.inertia + lever * lever / d.cage_inertia
    answers = across, both + off * off / d.cage_inertia
    first, second = ball_motion(before, b, m), _pocket(before, first_component(m), rx, ry)
    last = side.tangential[b], side.normal[b]
    return kick_of(beat_of(m), answers, first, second, place, INSIDE, last)


@kernel
def pocket_contacts(q, dq, m):
    """All balls against their pockets; adds to the balls' accelerations, sets the cage's part of dq.

    Returns (cosine, sine) of the cage's angle.
    """
    p, d, side, i = m.p, m.d, m.s.side, first_component(m)
    turned = math.cos(q[i + ANGLE]), math.sin(q[i + ANGLE])
    _find_pockets(q, turned, m)
    rub_sides(side, p.balls.count, d.cage_friction, m.s.lines)
    fx, fy, moment = 0.0, 0.0, 0.0
    for b in range(p.balls.count):
        if side.indentation[b] > 0.0:
            rx, ry = _arm(b, turned, d)
            out = press_of(side, b, INSIDE, d.cage_contact)
            push_ball(b, out.fx, out.fy, out.first_moment, m)
            fx -= out.fx
            fy -= out.fy
            moment += out.second_moment - rx * out.fy + ry * out.fx
    dq[i + X], dq[i + Y], dq[i + ANGLE] = q[i + VX], q[i + VY], q[i + SPIN]
    dq[i + VX] = fx / p.cage.mass
    dq[i + VY] = fy / p.cage.mass - m.d.gravity
    dq[i + SPIN] = moment / d.cage_inertia
    return turned


@kernel
def _arm(b, turned, d):
    """Where the pocket of ball `b` lies (m) from the middle of the cage, `turned` (cosine, sine)."""
    c, s = turned
    return c * d.pocket_x[b] - s * d.pocket_y[b], s * d.pocket_x[b] + c * d.pocket_y[b]


@kernel
def _find_pockets(q, turned, m):
    """Balls in the state q that press their pockets, how hard, and what their friction depends on."""
    d, side, clearance, i = m.d, m.s.side, m.p.cage.clearance, first_component(m)
    side.touching = 0
    for b in range(m.p.balls.count):
        rx, ry = _arm(b, turned, d)
        ball, pocket = ball_motion(q, b, m), _pocket(q, i, rx, ry)
        ex, ey = ball.x - pocket.x, ball.y - pocket.y
        distance = math.sqrt(ex * ex + ey * ey)
        if distance <= clearance:
            note_apart(side, b)
            continue
        reach = distance + d.ball_radius
        place = ContactPlace(ex / distance, ey / distance, distance - clearance, d.ball_radius, reach, 0.0)
        kick = _kick(b, place, rx, ry, m)
        squeezed = squeeze(ball, pocket, place, INSIDE, d.cage_contact, kick, side.stored[b])
        lay(side, b, place, squeezed.sliding, squeezed.rate, kick, d.cage_contact)
        side.normal[b], side.damped[b] = squeezed.normal, squeezed.damped


@kernel
def pockets_heat(dq, turned, m):
    """Heat (W) of all pockets over the kick whose accelerations are in dq; turned: of `pocket_contacts`."""
    i, side, loss = first_component(m), m.s.side, 0.0
    for b in range(m.p.balls.count):
        if side.indentation[b] > 0.0:
            rx, ry = _arm(b, turned, m.d)
            loss += ball_heat(side, b, m.s.kick, ball_motion(dq, b, m), _pocket(dq, i, rx, ry), INSIDE)
    return loss


@kernel
def report(q, m):
    """Outputs of the cage from the state q; returns its kinetic and its potential energy (J)."""
    i, o, p = first_component(m), m.o.cage, m.p
    o.x, o.y, o.vx, o.vy, o.omega = q[i + X], q[i + Y], q[i + VX], q[i + VY], q[i + SPIN]
    m.o.speed.cage = q[i + SPIN] * 0.5 * p.balls.pitch_diameter
    kinetic = 0.5 * p.cage.mass * (squared(o.vx) + squared(o.vy)) + 0.5 * m.d.cage_inertia * squared(
        o.omega
    )
    return kinetic, m.d.gravity * p.cage.mass * o.y


@kernel
def set_weights(m):
    """Set the error weights of the cage's components, behind the m.n others, and count them.

    Its angle matters where the pockets are.
    """
    i, w = m.n, m.weight
    w[i + X] = w[i + Y] = 1.0 / seat.POSITION_SCALE
    w[i + VX] = w[i + VY] = 1.0 / seat.VELOCITY_SCALE
    w[i + ANGLE] = 1.0 / seat.POSITION_SCALE * (0.5 * m.p.balls.pitch_diameter)
    w[i + SPIN] = 1.0 / seat.SPIN_SCALE
    m.n = i + SIZE
