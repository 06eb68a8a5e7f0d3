"""Forces inside a bearing in space, with a cage or without: one evaluation, and the steps between.

Races press all balls (`press_on_races`). Neighbours or the cage's pockets push and rub what they meet. Then
races and rotor rub, with the ring's acceleration (`rub_bodies`).
"""

from __future__ import annotations

import math

from ....modelkit.kernel import inlined, kernel
from ....modelkit.ports import SpatialLoad
from ... import seat
from ...contact.friction import curve
from ...heat import shares
from ...heat.shares import Sources
from ...rolling import gaps, ring
from ...rolling.ball_contacts import fill_sides, settle_sides
from ...rolling.micro_step import beat_of, withhold
from ...seat import space
from .. import inner_ring
from . import races, rubbing, space_balls
from . import space_ring as space_ring
from .half_step import missed_in_space
from .memory_layout import FACE_LOSS as FACE_HEAT
from .memory_layout import ROOM, RTX, RTY
from .space_ring import tilted_axes


@inlined
def press_on_races(q, axes, moved, m):
    """Both races press all balls in the state q; sets their accelerations, with gravity.

    axes: of the ring; moved: what the kick before did to it (`Moved`).
    """
    d, s, n, beat = m.d, m.s, space_balls.ball_lanes(m), beat_of(m)
    answer, still = s.kick / d.mass, races.BodyChange(0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    housing, body = space_ring.housing_frame(q), space_ring.ring_frame(q, axes)
    hvx, hvy = q[seat.HVX], q[seat.HVY]
    space_balls.find_orbits(s.balls, q[seat.HX], q[seat.HY], hvx, hvy, n)
    races.find_contacts(s.balls, housing, d.outer_groove, d.ball_radius, n, s.outer)
    races.find_contacts(s.balls, body, s.inner_groove, d.ball_radius, n, s.inner)
    races.follow(n, s.outer, still)
    races.follow(n, s.inner, moved)
    races.set_sliding(s.balls, housing, d.ball_radius, n, s.outer)
    races.set_sliding(s.balls, body, d.ball_radius, n, s.inner)
    races.press_on_race(s.balls, d.outer, beat, answer, hvx, hvy, n, s.outer)
    races.press_on_race(s.balls, d.inner, beat, answer, hvx, hvy, n, s.inner)
    races.accelerate_balls(s.balls, s.outer, s.inner, 1.0 / d.mass, -d.gravity, d.gravity_z, n)


@inlined
def rub_bodies(q, dq, axes, moved, m):
    """Friction at both races and of the rotor, and the ring's acceleration; returns `OnShaft`.

    axes: of the ring; moved: what the kick before did to it (`Moved`).
    """
    d, s, n, h, f = m.d, m.s, space_balls.ball_lanes(m), m.s.kick, m.s.friction
    law, by_mass = curve(d.race_friction), h / d.mass
    by_spin = h * d.ball_radius * d.ball_radius / d.inertia
    answer = by_mass + by_spin
    hvx, hvy = q[seat.HVX], q[seat.HVY]
    rubbing.driven_sliding(s.balls, s.outer, beat_of(m), d.ball_radius, hvx, hvy, n)
    rubbing.driven_sliding(s.balls, s.inner, beat_of(m), d.ball_radius, hvx, hvy, n)
    rubbing.cross(s.outer, s.inner, f, by_mass, by_spin, n)
    rubbing.expect(s.outer, s.inner, f, n)
    rubbing.draw_friction(s.outer, answer, law, n)
    rubbing.draw_friction(s.inner, answer, law, n)
    rubbing.join(s.outer, s.inner, f, n)
    space_ring.begin_six(q, h, m)
    shaft = space_ring.shaft_of(q, axes)
    space_ring.meet_rotor(shaft, moved, beat_of(m), m)
    rubbing.load_ring(s.inner, f, h, d.balls, n, s.six)
    space_ring.solve_six(s.six)
    space_ring.accelerate_ring(q, dq, axes, m)
    moves = space_ring.moved_by(dq, axes, h)
    races.follow(n, s.inner, moves)
    rubbing.set_friction(s.outer, s.inner, f, answer, n)
    rubbing.brake(s.balls, s.outer, s.inner, 1.0 / d.mass, d.ball_radius / d.inertia, n)
    rubbing.find_middle(s.balls, s.outer, h, n)
    rubbing.find_middle(s.balls, s.inner, h, n)
    return space_ring.leave_rotor(shaft, axes, moves, q, m)


@inlined
def conclude(dq, shaft, among, m):
    """Set the heats in dq, and what the load's work is booked by; returns the `SpatialLoad` (N, N m).

    shaft: what the rotor gets (`OnShaft`); among: heat at the sides of the balls (W).
    """
    s = m.s
    outer, inner = rubbing.total_on(s.outer, m.d.balls), rubbing.total_on(s.inner, m.d.balls)
    s.brake.hx, s.brake.hy, s.brake.hz, s.along = outer.hx, outer.hy, outer.hz, inner.fz
    at_rotor = shaft.bore + shaft.faces
    dq[ring.LOSS] = at_rotor + inner.loss + outer.loss + among
    dq[FACE_HEAT] = shaft.faces
    shares.set_rates(Sources(at_rotor, 0.0, inner.loss, outer.loss, among), shaft.sliding, dq, ring.HEAT)
    across = shaft.fx, shaft.fy, shaft.spin, outer.fx, outer.fy
    return SpatialLoad(*across, shaft.fz, outer.fz, shaft.mx, shaft.my)


@inlined
def drift(trial, q, mid, h, m):
    """Places in the state `trial`: those in q and h (s) times the velocities in `mid` (`verlet`)."""
    space.drift(trial, q, mid, h, m)
    space_ring.drift(trial, q, mid, h)
    space_balls.drift(trial, q, mid, h, m)


@kernel
def fastest_body(of_cages, m):
    """Largest angular frequency of a body on its contacts, at the last evaluation (rad/s).

    of_cages: its square, of the cages (rad2/s2); 0 without.
    """
    d, s, count = m.d, m.s, m.p.balls.count
    stiffest, side = 0.0, 0.0
    below, turning = space_ring.stiffness_below(m)
    for b in range(d.balls):
        k = s.inner.stiffness[b]
        lever = s.inner.zeta[b] * s.inner.outwards[b] - s.inner.rho[b] * s.inner.axial[b]
        below += k
        turning += k * lever * lever
        stiffest = max(stiffest, k + s.outer.stiffness[b])
    for row in range(d.rows):
        for b in range(count):
            side = max(side, s.side[row].stiffness[b])
    of_ring = max(below / m.p.ring.mass, turning / d.transverse_inertia)
    of_ball = (stiffest + 2.0 * side) / d.mass
    return max(math.sqrt(max(of_ball, of_ring, of_cages)), s.seat.fastest)


@kernel
def kicked(q, dq, kick, m):
    """Settle all contacts' accounts after a `kick` (s) under dq; what they withheld is in q as heat."""
    s, n, off, sides = m.s, m.d.balls, missed_in_space(dq, kick, m), 0.0
    axes = tilted_axes(q[RTX], q[RTY])
    inner = races.settle_grooves(s.inner, n, kick, off.part, 0.0, 0.0, 0.0)
    outer = races.settle_grooves(s.outer, n, kick, off.part, off.hx, off.hy, off.hz)
    for row in range(m.d.rows):
        sides += settle_sides(s.side[row], m.p.balls.count, kick, off.part)
    rotor = space_ring.settle_touches(q, kick, off, axes, m)
    withhold(q, (inner, outer), sides, rotor, m)


@kernel
def fill_accounts(m):
    """Have the contacts that press at the last evaluation hold what their laws have stored."""
    s, d = m.s, m.d
    races.fill_race(s.inner, d.inner, d.balls)
    races.fill_race(s.outer, d.outer, d.balls)
    for row in range(d.rows):
        fill_sides(s.side[row], d.side_contact, m.p.balls.count)
    space_ring.fill_touches(m)


@kernel
def follow_gaps(m, since):
    """Have inner grooves and bore follow temperatures and spins as a macro step begins; since: s after it.

    A ball that grows is pressed along its contact's normal at any angle: the inner arc is as if smaller.
    """
    if not gaps.due(m, since):
        return
    s, made, closed, work = m.s, m.d.inner_groove, gaps.change_gaps(m), 0.0
    now, c, t, g = s.inner_groove, s.inner, s.touches, s.gaps
    wider, longer = m.p.balls.play - g.play - g.ball_growth, 1.0 + g.strain_along
    for b in range(m.d.balls):
        circle, along, arc = made.circle[b] + wider, made.along[b] * longer, made.arc[b] - g.ball_growth
        way = c.outwards[b] * (circle - now.circle[b]) + c.axial[b] * (along - now.along[b])
        pressed = gaps.pressed_in(way - (arc - now.arc[b]), c.indentation[b], c.stored[b], m.d.inner)
        c.stored[b], work = c.stored[b] + pressed, work + pressed
        now.circle[b], now.along[b], now.arc[b] = circle, along, arc
    s.ring.elastic = 0.0
    for k in range(space_ring.EDGES):
        elastic = t.normal[k] - t.damped[k]
        t.stored[k], s.ring.elastic = t.stored[k] + closed.clearance * elastic, s.ring.elastic + elastic
    gaps.book_closing(closed, 0.5 * work, 0.5 * work, m)


@kernel
def place_bodies(q, m):
    """Put ring and balls in the state q at rest, where they start."""
    made, now = m.d.inner_groove, m.s.inner_groove
    for k in range(ROOM):
        now.circle[k], now.along[k], now.arc[k] = made.circle[k], made.along[k], made.arc[k]
    ring.place_ring(q, m.d.rest_x, m.d.rest_y)
    inner_ring.place_in_space(q)
    space_balls.lay_out_rows(q, m)


@kernel
def set_weights(m):
    """Set the error weights of seat, ring and balls, and m.n to what these have in the state."""
    space.set_weights(m.weight)
    space.weigh_tilt(m.weight)
    ring.set_weights(m.weight)
    inner_ring.set_weights(m.weight)
    space_balls.set_weights(m)
