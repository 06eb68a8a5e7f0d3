"""What balls as bodies show: peaks after each micro-step, forces and motion after each macro step.

Forces are stated for one ball of those side by side.
"""

from __future__ import annotations

import math

from touchdown.bearings import seat
from touchdown.bearings.rolling.balls import watch_balls, watch_contacts
from touchdown.bearings.rolling.bodies.state import ball_motion
from touchdown.bearings.rolling.side import largest, stored
from touchdown.modelkit.kernel import kernel


@kernel
def watch(m, sides):
    """Peaks (N, m), after a micro-step; `sides` is the report of the cage's or neighbours' contacts."""
    s, o, count, rows = m.s, m.o, m.p.balls.count, m.p.balls.rows
    inner, sunk_in, first = largest(s.inner, count, rows)
    outer, sunk_out, second = largest(s.outer, count, rows)
    side, overlap, _ = largest(s.side, count, rows)
    watch_contacts(inner, sunk_in, o.inner)
    watch_contacts(outer, sunk_out, o.outer)
    watch_contacts(side, overlap, sides)
    if max(inner, outer) > o.balls.peak_force:
        o.hardest.ball = (first if inner >= outer else second) + 1
    watch_balls(max(inner, outer), approach(m), m)


@kernel
def approach(m):
    """Largest approach of the rings at a ball that both press (m)."""
    largest_sum = 0.0
    for b in range(m.p.balls.count):
        inner, outer = m.s.inner.indentation[b], m.s.outer.indentation[b]
        if inner > 0.0 and outer > 0.0:
            largest_sum = max(largest_sum, inner + outer)
    return largest_sum


@kernel
def state_contacts(report, contacts, count, rows):
    """Largest force (N) and indentation (m) of `count` balls now, in `report` (BallContacts)."""
    report.force, report.indentation, _ = largest(contacts, count, rows)


@kernel
def report(q, m, neighbours):
    """Outputs of the balls at the end of the macro step, from the state q.

    `neighbours`: side contacts lie between a ball and the next one, not between a ball and the cage.
    Returns (kinetic energy, energy of the race contacts and of the balls' weight) in J.
    """
    p, d, o, s = m.p, m.d, m.o, m.s
    count = p.balls.count
    state_contacts(o.inner, s.inner, count, p.balls.rows)
    state_contacts(o.outer, s.outer, count, p.balls.rows)
    o.balls.force = max(o.inner.force, o.outer.force)
    o.balls.indentation = approach(m)
    kinetic, height, orbit, spin, loaded = 0.0, 0.0, 0.0, 0.0, 0
    for b in range(count):
        now = ball_motion(q, b, m)
        dx, dy = now.x - q[seat.HX], now.y - q[seat.HY]
        kinetic += 0.5 * d.mass * (now.vx**2 + now.vy**2) + 0.5 * d.inertia * now.spin**2
        height += now.y
        across = dx * (now.vy - q[seat.HVY]) - dy * (now.vx - q[seat.HVX])
        orbit += across / math.sqrt(dx * dx + dy * dy)
        spin += abs(now.spin)
        if s.inner.normal[b] > 0.0 and s.outer.normal[b] > 0.0:
            loaded += 1
        ball = o.ball[b]
        ball.x, ball.y, ball.spin = now.x, now.y, now.spin
        ball.inner, ball.outer = s.inner.normal[b] / p.balls.rows, s.outer.normal[b] / p.balls.rows
        ball.side = s.side.normal[b] / p.balls.rows
    o.balls.loaded = loaded
    o.speed.orbit = orbit / count
    o.speed.ball = spin / count * d.ball_radius
    if o.hardest.ball > 0:
        _report_hardest(o.hardest.ball - 1, q, m, neighbours)
    potential = (
        p.gravity * d.mass * height + stored(s.inner, d.inner, count) + stored(s.outer, d.outer, count)
    )
    return kinetic, potential


@kernel
def _report_hardest(b, q, m, neighbours):
    """Forces (N) and speed (m/s) of ball `b`, which has borne the largest force."""
    h, s, rows = m.o.hardest, m.s, m.p.balls.rows
    h.inner_normal, h.inner_tangential = s.inner.normal[b] / rows, s.inner.tangential[b] / rows
    h.outer_normal, h.outer_tangential = s.outer.normal[b] / rows, s.outer.tangential[b] / rows
    side = b
    before = b - 1 if b > 0 else m.p.balls.count - 1
    if neighbours and s.side.normal[before] > s.side.normal[b]:
        side = before
    h.side_normal, h.side_tangential = s.side.normal[side] / rows, s.side.tangential[side] / rows
    h.speed = abs(ball_motion(q, b, m).spin) * m.d.ball_radius
