"""Outputs of a bearing in space, with a cage or without: peaks after micro-steps, others after macro steps.

At the sides of the balls are neighbours or pockets; `sides` is what is told of them (`BallContacts`).
"""

from __future__ import annotations

import math

from ....modelkit.kernel import kernel
from ....modelkit.numerics import squared
from ... import seat
from ...contact.face import report_faces, watch_faces
from ...contact.peaks import Largest, watch_peaks
from ...heat import shares
from ...rolling import gaps, ring
from ...rolling.ball_contacts import highest, stored_energy
from ...rolling.balls import largest_contact, watch_balls
from . import races
from . import space_ring as space_ring
from .memory_layout import FACE_LOSS as FACE_HEAT
from .memory_layout import RTX, RTY, RVZ, RWX, RWY, RZ


@kernel
def watch_contacts(time, sides, m):
    """Peaks (N, m) of the balls' contacts, after the micro-step to `time` (s)."""
    s, o, n, abreast = m.s, m.o, m.d.balls, m.d.abreast
    inner = largest_contact(s.inner.normal, s.inner.indentation, n, abreast)
    outer = largest_contact(s.outer.normal, s.outer.indentation, n, abreast)
    watch_peaks(time, inner, o.inner, s.inner_peaks)
    watch_peaks(time, outer, o.outer, s.outer_peaks)
    side = highest(s.side[0], m.p.balls.count, abreast)
    if m.d.rows > 1:
        other = highest(s.side[1], m.p.balls.count, abreast)
        side = Largest(max(side.force, other.force), max(side.indentation, other.indentation), 0, 0)
    watch_peaks(time, side, sides, s.side_peaks)
    force, contact = inner.force, inner.loaded
    if outer.force > force:
        force, contact = outer.force, outer.loaded
    depth, deepest = _approach(m)
    before = o.balls.peak_force
    watch_balls(time, Largest(force, depth, contact, deepest), m)
    if o.balls.peak_force > before:
        o.hardest.ball = contact + 1


@kernel
def _approach(m):
    """Largest approach of the grooves at a ball that both press (m), and which ball that is."""
    most, ball = 0.0, 0
    for b in range(m.d.balls):
        inner, outer = m.s.inner.indentation[b], m.s.outer.indentation[b]
        if inner > 0.0 and outer > 0.0 and inner + outer > most:
            most, ball = inner + outer, b
    return most, ball


@kernel
def watch_bodies(t, q, sides, m):
    """Peaks and events, after each accepted micro-step, t (s) into the macro step."""
    ring.watch_bore(t, q, m)
    watch_contacts(m.time + t, sides, m)
    watch_faces(m.time + t, m.p.shoulder, m.o.shoulder, m.s.shoulder)


@kernel
def _angles(b, m):
    """Contact angles (rad) of ball `b` at the inner and at the outer race."""
    i, o = m.s.inner, m.s.outer
    return math.atan2(i.axial[b], i.outwards[b]), math.atan2(-o.axial[b], -o.outwards[b])


@kernel
def _report_balls(q, m):
    """Outputs of the balls at the end of the macro step; returns their kinetic energy (J)."""
    d, o, s, n = m.d, m.o, m.s, m.d.balls
    kinetic, speed, spin, loaded, most, best = 0.0, 0.0, 0.0, 0, 0.0, -1
    for b in range(n):
        x = s.balls
        distance = math.sqrt(squared(x.x[b] - q[seat.HX]) + squared(x.y[b] - q[seat.HY]))
        square = squared(x.wx[b]) + squared(x.wy[b]) + squared(x.wz[b])
        kinetic += (
            0.5 * d.mass * (squared(x.vx[b]) + squared(x.vy[b]) + squared(x.vz[b]))
            + 0.5 * d.inertia * square
        )
        speed, spin = speed + x.orbit[b] * distance, spin + math.sqrt(square)
        inner, outer = s.inner.normal[b], s.outer.normal[b]
        loaded += 1 if inner > 0.0 and outer > 0.0 else 0
        if max(inner, outer) > most:
            most, best = max(inner, outer), b
        ball, row, slot = o.ball[b], b // m.p.balls.count, b % m.p.balls.count
        ball.x, ball.y, ball.z, ball.spin = x.x[b], x.y[b], x.z[b], x.wz[b]
        ball.inner, ball.outer = inner / d.abreast, outer / d.abreast
        ball.side = s.side[row].normal[slot] / d.abreast
        ball.inner_angle, ball.outer_angle = _angles(b, m)
    o.balls.loaded, o.speed.orbit, o.speed.ball = loaded, speed / n, spin / n * d.ball_radius
    o.along.contact_angle, o.along.outer_angle = _angles(best, m) if best >= 0 else (0.0, 0.0)
    return kinetic


@kernel
def _report_hardest(m, neighbours):
    """Forces (N) and speed (m/s) of the ball that has borne the largest force."""
    h, s, b, abreast, count = m.o.hardest, m.s, m.o.hardest.ball - 1, m.d.abreast, m.p.balls.count
    i, o, side, slot = s.inner, s.outer, s.side[b // count], b % count
    h.inner_normal, h.outer_normal = i.normal[b] / abreast, o.normal[b] / abreast
    h.inner_tangential, h.outer_tangential = i.friction_t[b] / abreast, o.friction_t[b] / abreast
    before = slot - 1 if slot > 0 else count - 1
    if neighbours and side.normal[before] > side.normal[slot]:
        slot = before
    h.side_normal = side.normal[slot] / abreast
    # its parts depend on the axes t and m
    whole = math.hypot(side.tangential[slot], side.tangential_m[slot])
    h.side_tangential = math.copysign(whole, side.tangential[slot]) / abreast
    x = s.balls
    h.speed = math.sqrt(squared(x.wx[b]) + squared(x.wy[b]) + squared(x.wz[b])) * m.d.ball_radius


@kernel
def _potential(q, m):
    """Energy of all contacts, and of the weight of ring and balls (J)."""
    p, d, s = m.p, m.d, m.s
    y, z = 0.0, 0.0
    for b in range(d.balls):
        y, z = y + s.balls.y[b], z + s.balls.z[b]
    weight = d.mass * (d.gravity * y - d.gravity_z * z)
    weight += p.ring.mass * (d.gravity * q[ring.RY] - d.gravity_z * q[RZ])
    elastic = races.stored_in(s.inner, d.inner, d.balls) + races.stored_in(s.outer, d.outer, d.balls)
    for row in range(d.rows):
        elastic += stored_energy(s.side[row], d.side_contact, p.balls.count)
    return weight + elastic + space_ring.stored_in_touches(m)


@kernel
def report(q, sides, neighbours, of_cages, m):
    """Outputs wanted once per macro step, from the state q (m.n,).

    sides: what is told of the sides; neighbours: balls meet there, which share a contact; of_cages: kinetic
    and potential energy (J) of the cages.
    """
    p, d, o, s = m.p, m.d, m.o, m.s
    ring.report(q, m, d.inner_radius)
    gaps.report(m)
    o.along.z, o.along.vz, o.along.force = q[RZ], q[RVZ], s.along
    o.along.rx, o.along.ry = q[RTX], q[RTY]
    kinetic = _report_balls(q, m)
    kinetic += 0.5 * p.ring.mass * (squared(q[ring.RVX]) + squared(q[ring.RVY]) + squared(q[RVZ]))
    kinetic += 0.5 * p.ring.inertia * squared(q[ring.RW]) + 0.5 * d.transverse_inertia * (
        squared(q[RWX]) + squared(q[RWY])
    )
    e = o.energy
    e.kinetic, e.potential = kinetic + of_cages[0], _potential(q, m) + of_cages[1]
    e.dissipated = q[ring.LOSS]
    report_faces(q[FACE_HEAT], p.shoulder, o.shoulder, s.shoulder)
    shares.report(q, ring.HEAT, m)
    inner = largest_contact(s.inner.normal, s.inner.indentation, d.balls, d.abreast)
    outer = largest_contact(s.outer.normal, s.outer.indentation, d.balls, d.abreast)
    o.inner.force, o.inner.indentation = inner.force, inner.indentation
    o.outer.force, o.outer.indentation = outer.force, outer.indentation
    o.balls.force = max(inner.force, outer.force)
    o.balls.indentation, _ = _approach(m)
    sides.force = sides.indentation = 0.0
    for row in range(d.rows):
        side = largest_contact(s.side[row].normal, s.side[row].indentation, p.balls.count, d.abreast)
        sides.force = max(sides.force, side.force)
        sides.indentation = max(sides.indentation, side.indentation)
    if o.hardest.ball > 0:
        _report_hardest(m, neighbours)
