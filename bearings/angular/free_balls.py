"""A row, or a pair of rows, of free balls between the rings in space, as a cageless bearing has them.

Balls of both rows at one angle are one, with one orbit and one spin about an axis across their contact
lines. Both rows press on it, each along its own line (`inner_ring.held`); friction at the races acts along
the orbit, with the forces of both rows together:

    r_m m gamma'' = mu(s_i) F + mu(s_o) F_o + H_b - H_(b+1) - g m cos(gamma) - (dU/dgamma + drag)/r_m

U is the energy of the rows' springs. The inner contact lies where the free contact angle has it,
d_m/2 - D/2 cos a0 from the middle. Laws act as they stand: this is for adaptive steps.
"""

from __future__ import annotations

from ...modelkit.kernel import kernel
from ...modelkit.numerics import cosine_and_sine
from ..contact.friction import coefficient
from ..rolling import ring
from ..rolling.balls import Total
from ..rolling.pitch_circle import Pressed, clear, note, rolling_drag
from ..rolling.ring import part
from ..rolling.row import ANGLE, ORBIT, SPIN
from . import inner_ring
from .row import Pose


@kernel
def press(q, m):
    """Both races press all balls in the state q; sets what accelerates them but friction and neighbours."""
    p, d, s, at = m.p, m.d, m.s, m.s.balls
    angle, orbit = part(q, ANGLE, m), part(q, ORBIT, m)
    pose, moving = inner_ring.pose(q, m), inner_ring.rates(q, m)
    closed = p.balls.play - s.gaps.play  # since the start: the race is wider by that
    inner_ring.clear(s.space)
    clear(s.held)
    for b in range(p.balls.count):
        at.cosine[b], at.sine[b] = cosine_and_sine(angle[b])
        c, sine = at.cosine[b], at.sine[b]
        there = Pose(pose.x + closed * c, pose.y + closed * sine, pose.z, pose.rx, pose.ry)
        elastic, force, across, turning, at.rolled[b] = 0.0, 0.0, 0.0, 0.0, 0.0
        for k in range(d.space.rows):
            ball = inner_ring.held(d.space.row[k], there, moving, c, sine, d.space.damping)
            if ball.indentation <= 0.0:
                continue
            inner_ring.add(s.space, d.space.row[k], ball, c, sine)
            if ball.force > s.held.force:
                s.space.sine = ball.sine
            note(
                s.held, b, Pressed(ball.force, ball.elastic, ball.indentation, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
            )
            elastic, force = elastic + ball.elastic, force + ball.force
            across, turning = across + ball.across, turning + ball.turning
            at.rolled[b] += (ball.force - ball.elastic) * ball.rate
        v = d.pitch_radius * orbit[b]
        s.inner.normal[b], at.elastic[b], at.along[b] = force, elastic, across
        s.outer.normal[b] = force + d.pitch_radius * d.mass * orbit[b] * orbit[b]
        drag = p.rolling.resistance * (s.inner.normal[b] + s.outer.normal[b]) * rolling_drag(v)
        at.rolled[b] += drag * v
        at.radius[b] = d.pitch_radius
        at.lever[b] = d.inner_radius - pose.x * c - pose.y * sine
        held = turning / d.pitch_radius + drag
        at.faster[b] = (-held / d.mass - d.gravity * c) / d.pitch_radius
        at.turning[b] = 0.0


@kernel
def rub(q, dq, m):
    """Friction of all balls that are pressed (`press`) at both races; sets their derivatives in dq.

    Returns the `Total` (N, N m, W) of all balls on the ring across the shaft.
    """
    d, s, at, n = m.d, m.s, m.s.balls, m.p.balls.count
    orbit, spin, gap = part(q, ORBIT, m), part(q, SPIN, m), ring.gap(q)
    fx, fy, moment, heat, outside = 0.0, 0.0, 0.0, 0.0, 0.0
    for b in range(n):
        c, sine = at.cosine[b], at.sine[b]
        v, around = d.pitch_radius * orbit[b], d.ball_radius * spin[b]
        inside = gap.spin * at.lever[b] + gap.uy * c - gap.ux * sine - v + around
        outwards = -(v + around)
        f_i = coefficient(inside, d.race_friction) * s.inner.normal[b]
        f_o = coefficient(outwards, d.race_friction) * s.outer.normal[b]
        at.faster[b] += (f_i + f_o) / (d.pitch_radius * d.mass)
        at.turning[b] += d.ball_radius / d.inertia * (f_o - f_i)
        fx -= at.along[b] * c - f_i * sine
        fy -= at.along[b] * sine + f_i * c
        moment -= f_i * at.lever[b]
        heat += f_i * inside + f_o * outwards + at.rolled[b]
        outside += f_o * outwards + 0.5 * at.rolled[b]
    at.outside = outside
    ring.copy(orbit, part(dq, ANGLE, m))
    ring.copy(at.faster[:n], part(dq, ORBIT, m))
    ring.copy(at.turning[:n], part(dq, SPIN, m))
    return Total(fx, fy, moment, heat)
