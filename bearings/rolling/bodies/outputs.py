"""What balls as bodies show: peaks after each micro-step, forces and motion after each macro step.

Forces are stated for one ball of those side by side.
"""

from __future__ import annotations

import math

from touchdown.bearings import seat
from touchdown.bearings.contact.peaks import Largest, watch_peaks
from touchdown.bearings.rolling.balls import largest, watch_balls
from touchdown.bearings.rolling.bodies.state import ball_motion
from touchdown.bearings.rolling.sides.contact import highest, stored
from touchdown.modelkit.kernel import kernel


@kernel
def watch(time, m, sides):
    """Peaks (N, m), after the micro-step to `time` (s).

    sides: report of the balls' contacts with the cage or with each other.
    """
    s, o, count, rows = m.s, m.o, m.p.balls.count, m.p.balls.rows
    inner = largest(s.inner.normal, s.inner.indentation, count, rows)
    outer = largest(s.outer.normal, s.outer.indentation, count, rows)
    watch_peaks(time, inner, o.inner, s.inner_peaks)
    watch_peaks(time, outer, o.outer, s.outer_peaks)
    watch_peaks(time, highest(s.side, count, rows), sides, s.side_peaks)
    force, contact = inner.force, inner.loaded
    if outer.force > force:
        force, contact = outer.force, outer.loaded + count
    depth, deepest = approach(m)
    before = o.balls.peak_force
    watch_balls(time, Largest(force, depth, contact, deepest), m)
    if o.balls.peak_force > before:
        o.hardest.ball = contact % count + 1


@kernel
def approach(m):
    """Largest approach of the rings at a ball that both press (m), and which ball that is."""
    most, ball = 0.0, 0
    for b in range(m.p.balls.count):
        inner, outer = m.s.inner.indentation[b], m.s.outer.indentation[b]
        if inner > 0.0 and outer > 0.0 and inner + outer > most:
            most, ball = inner + outer, b
    return most, ball


@kernel
def state_contacts(report, contacts, m):
    """Largest force (N) and indentation (m) of all balls' `contacts` now, in `report` (BallContacts)."""
    now = largest(contacts.normal, contacts.indentation, m.p.balls.count, m.p.balls.rows)
    report.force, report.indentation = now.force, now.indentation


@kernel
def report(q, m, neighbours):
    """Outputs of the balls at the end of the macro step, from the state q.

    `neighbours`: side contacts lie between a ball and the next one, not between a ball and the cage.
    Returns (kinetic energy, energy of the race contacts and of the balls' weight) in J.
    """
    p, d, o, s = m.p, m.d, m.o, m.s
    count = p.balls.count
    state_contacts(o.inner, s.inner, m)
    state_contacts(o.outer, s.outer, m)
    o.balls.force = max(o.inner.force, o.outer.force)
    o.balls.indentation, _ = approach(m)
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
