"""Detailed touchdown bearing without a cage, every ball a body in space.

Balls have three coordinates and three spins each, the inner ring six coordinates; the outer ring is the
housing's and does not tilt. In one row or a pair of them balls run in grooves at a contact angle, which
load, speed and tilt change: centrifugal force and the gyroscopic moment of balls follow from their motion.
The rotor touches the ring at both edges of the bore's land, and with its shoulders on the faces. Each ball
meets the next one of its row.

At contact angle 0, in the plane, this is `detailed_cageless`. Not in it: friction of balls that spin about
their contact's normal, rings that bend, races that are no circles, an outer ring that tilts.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from ..modelkit.integrators import dopri
from ..modelkit.kernel import inlined, kernel
from ..modelkit.model import Model, constants
from ..modelkit.numerics import blank, missing
from ..modelkit.ports import Load
from ..modelkit.variables import group, real
from . import seat
from .angular.bodies import balls, declarations, neighbours, races, rubbing
from .angular.bodies import ring as space_ring
from .angular.bodies.declarations import PROBLEMS as OWN_PROBLEMS
from .angular.bodies.declarations import SpaceDerived, SpaceMemory, SpaceOutputs, SpaceParameters
from .angular.bodies.kick import book, leapfrog, missed
from .angular.bodies.layout import FACE_LOSS as FACE_HEAT
from .angular.bodies.layout import MAX_STATES, RTX, RTY, RVZ, RWX, RWY, RZ
from .angular.bodies.ring import axes_of
from .contact.face import report_faces, watch_faces
from .contact.friction import curve
from .contact.peaks import Largest, watch_peaks
from .heat import parts
from .heat.parts import Sources
from .rolling import ring
from .rolling.ball_set import BallContacts
from .rolling.balls import largest, watch_balls
from .rolling.declarations import starts_from, state_constants
from .rolling.micro_step import beat_of, withhold
from .rolling.sides import fill_sides, highest, settle_sides, stored


@dataclass(frozen=True)
class Parameters(SpaceParameters):
    """Defaults: Koyo 6904 under the disk of section 4.3, pitch diameter corrected to 28.5 mm."""


@dataclass(frozen=True)
class Speeds(ring.RaceSpeeds):
    """Circumferential speeds that agree where nothing slips."""

    orbit: float = real(0.0, "m/s", "mean speed of the balls around the shaft", local=True)
    ball: float = real(0.0, "m/s", "mean circumferential speed of the balls by their spin", local=True)


@dataclass(frozen=True)
class Outputs(SpaceOutputs):
    """Loads, and what to know of the inside."""

    neighbours: BallContacts = group(BallContacts)
    speed: Speeds = group(Speeds)


MEMORY = seat.bearing_memory(Parameters, Outputs, MAX_STATES, derived=SpaceDerived, hidden=SpaceMemory)
SCRATCH = dopri.scratch_layout(MAX_STATES + seat.MODES_SIZE)
CONSTANTS, PROBLEMS = constants(MEMORY, OWN_PROBLEMS)


@inlined
def _press(q, axes, moved, m):
    """Both races press all balls in the state q; sets their accelerations, with gravity.

    axes: of the ring; moved: what the kick before did to it (`Moved`).
    """
    d, s, n, beat = m.d, m.s, balls.lanes(m), beat_of(m)
    answer, still = s.kick / d.mass, races.Moved(0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    housing, body = space_ring.housing_frame(q), space_ring.ring_frame(q, axes)
    races.find(s.balls, housing, d.outer_groove, d.ball_radius, n, s.outer)
    races.find(s.balls, body, d.inner_groove, d.ball_radius, n, s.inner)
    races.follow(n, s.outer, still)
    races.follow(n, s.inner, moved)
    races.slide(s.balls, housing, d.ball_radius, n, s.outer)
    races.slide(s.balls, body, d.ball_radius, n, s.inner)
    races.press(s.balls, d.outer, beat, answer, n, s.outer)
    races.press(s.balls, d.inner, beat, answer, n, s.inner)
    races.accelerate(s.balls, s.outer, s.inner, 1.0 / d.mass, -d.gravity, d.gravity_z, n)


@inlined
def _rub(q, dq, axes, moved, m):
    """Friction at both races and of the rotor, and the ring's acceleration; returns `OnShaft`.

    axes: of the ring; moved: what the kick before did to it (`Moved`).
    """
    d, s, n, h, f = m.d, m.s, balls.lanes(m), m.s.kick, m.s.friction
    law, by_mass = curve(d.race_friction), h / d.mass
    by_spin = h * d.ball_radius * d.ball_radius / d.inertia
    answer = by_mass + by_spin
    at = q[seat.HX], q[seat.HY], q[seat.HVX], q[seat.HVY]
    rubbing.drive(s.balls, s.outer, beat_of(m), d.ball_radius, at[0], at[1], at[2], at[3], n)
    rubbing.drive(s.balls, s.inner, beat_of(m), d.ball_radius, at[0], at[1], at[2], at[3], n)
    rubbing.cross(s.outer, s.inner, f, by_mass, by_spin, n)
    rubbing.expect(s.outer, s.inner, f, n)
    rubbing.draw(s.outer, answer, law, n)
    rubbing.draw(s.inner, answer, law, n)
    rubbing.join(s.outer, s.inner, f, n)
    space_ring.begin_six(q, h, m)
    shaft = space_ring.shaft_of(q, axes)
    space_ring.meet_rotor(shaft, moved, beat_of(m), m)
    rubbing.load_ring(s.inner, f, h, d.balls, n, s.six)
    space_ring.solve_six(s.six)
    space_ring.accelerate(q, dq, axes, m)
    now = space_ring.moved_by(dq, axes, h)
    races.follow(n, s.inner, now)
    rubbing.settle(s.outer, s.inner, f, answer, n)
    rubbing.brake(s.balls, s.outer, s.inner, 1.0 / d.mass, d.ball_radius / d.inertia, n)
    rubbing.find_middle(s.balls, s.outer, h, n)
    rubbing.find_middle(s.balls, s.inner, h, n)
    return space_ring.leave_rotor(shaft, axes, now, q, m)


@kernel
def react(t, q, dq, m):
    """Derivative dq of ring and balls in q, and the `Load` (N, N m) on journal and housing."""
    s, h = m.s, m.s.kick
    balls.gather(q, m)
    axes = axes_of(q[RTX], q[RTY])
    moved = space_ring.moved_by(s.before, axes, h)
    _press(q, axes, moved, m)
    neighbours.meet_neighbours(m)
    shaft = _rub(q, dq, axes, moved, m)
    balls.hand_over(dq, m)
    outer, inner = rubbing.total_on(s.outer, m.d.balls), rubbing.total_on(s.inner, m.d.balls)
    s.brake.hx, s.brake.hy, s.brake.hz, s.along = outer.hx, outer.hy, outer.hz, inner.fz
    among = neighbours.rubbing(h, m)
    at_rotor = shaft.bore + shaft.faces
    dq[ring.LOSS] = at_rotor + inner.loss + outer.loss + among
    dq[FACE_HEAT] = shaft.faces
    parts.set_rates(Sources(at_rotor, 0.0, inner.loss, outer.loss, among), shaft.sliding, dq, ring.HEAT)
    return Load(shaft.fx, shaft.fy, shaft.spin, outer.fx, outer.fy, shaft.fz, outer.fz, shaft.mx, shaft.my)


@kernel
def rhs(t, q, dq, m):
    """Derivative dq (m.n,) of everything the bearing integrates, t (s) into the macro step."""
    load = react(t, q, dq, m)
    seat.copy_rates(t, q, dq, m, m.half, load)
    book(dq, load, m)


@inlined
def drift(trial, q, mid, h, m):
    """Places in the state `trial`: those in q and h (s) times the velocities in `mid` (`verlet`)."""
    seat.drift(trial, q, mid, h, m)
    space_ring.drift(trial, q, mid, h)
    balls.drift(trial, q, mid, h, m)


@kernel
def fastest(m):
    """Largest angular frequency of a body on its contacts, at the last evaluation (rad/s)."""
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
    return max(math.sqrt(max((stiffest + 2.0 * side) / d.mass, of_ring)), s.seat.fastest)


@kernel
def kicked(q, dq, kick, m):
    """Settle all contacts' accounts after a `kick` (s) under dq; what they withheld is in q as heat."""
    s, n, off, sides = m.s, m.d.balls, missed(dq, kick, m), 0.0
    axes = axes_of(q[RTX], q[RTY])
    inner = races.settle_race(s.inner, n, kick, off.part, 0.0, 0.0, 0.0)
    outer = races.settle_race(s.outer, n, kick, off.part, off.hx, off.hy, off.hz)
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
        fill_sides(s.side[row], d.ball_contact, m.p.balls.count)
    space_ring.fill_touches(m)


@kernel
def _watch_balls(time, m):
    """Peaks (N, m) of the balls' contacts, after the micro-step to `time` (s)."""
    s, o, n, abreast = m.s, m.o, m.d.balls, m.d.abreast
    inner = largest(s.inner.normal, s.inner.indentation, n, abreast)
    outer = largest(s.outer.normal, s.outer.indentation, n, abreast)
    watch_peaks(time, inner, o.inner, s.inner_peaks)
    watch_peaks(time, outer, o.outer, s.outer_peaks)
    side = highest(s.side[0], m.p.balls.count, abreast)
    if m.d.rows > 1:
        other = highest(s.side[1], m.p.balls.count, abreast)
        side = Largest(max(side.force, other.force), max(side.indentation, other.indentation), 0, 0)
    watch_peaks(time, side, o.neighbours, s.side_peaks)
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
def observe(t, q, m):
    """Peaks and events, after each accepted micro-step, t (s) into the macro step."""
    ring.watch(t, q, m)
    _watch_balls(m.time + t, m)
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
        rate, distance = balls.orbit(x, b, q)
        square = x.wx[b] ** 2 + x.wy[b] ** 2 + x.wz[b] ** 2
        kinetic += 0.5 * d.mass * (x.vx[b] ** 2 + x.vy[b] ** 2 + x.vz[b] ** 2) + 0.5 * d.inertia * square
        speed, spin = speed + rate * distance, spin + math.sqrt(square)
        inner, outer = s.inner.normal[b], s.outer.normal[b]
        loaded += 1 if inner > 0.0 and outer > 0.0 else 0
        if max(inner, outer) > most:
            most, best = max(inner, outer), b
        ball, row, at = o.ball[b], b // m.p.balls.count, b % m.p.balls.count
        ball.x, ball.y, ball.z, ball.spin = x.x[b], x.y[b], x.z[b], x.wz[b]
        ball.inner, ball.outer = inner / d.abreast, outer / d.abreast
        ball.side = s.side[row].normal[at] / d.abreast
        ball.inner_angle, ball.outer_angle = _angles(b, m)
    o.balls.loaded, o.speed.orbit, o.speed.ball = loaded, speed / n, spin / n * d.ball_radius
    o.along.contact_angle, o.along.outer_angle = _angles(best, m) if best >= 0 else (0.0, 0.0)
    return kinetic


@kernel
def _report_hardest(m):
    """Forces (N) and speed (m/s) of the ball that has borne the largest force."""
    h, s, b, abreast, count = m.o.hardest, m.s, m.o.hardest.ball - 1, m.d.abreast, m.p.balls.count
    i, o, side, at = s.inner, s.outer, s.side[b // count], b % count
    h.inner_normal, h.outer_normal = i.normal[b] / abreast, o.normal[b] / abreast
    h.inner_tangential, h.outer_tangential = i.friction_t[b] / abreast, o.friction_t[b] / abreast
    before = at - 1 if at > 0 else count - 1
    if side.normal[before] > side.normal[at]:
        at = before
    h.side_normal, h.side_tangential = side.normal[at] / abreast, side.tangential[at] / abreast
    x = s.balls
    h.speed = math.sqrt(x.wx[b] ** 2 + x.wy[b] ** 2 + x.wz[b] ** 2) * m.d.ball_radius


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
        elastic += stored(s.side[row], d.ball_contact, p.balls.count)
    return weight + elastic + space_ring.stored_in_touches(m)


@kernel
def report(q, m):
    """Outputs wanted once per macro step, from the state q (m.n,)."""
    p, d, o, s = m.p, m.d, m.o, m.s
    ring.report(q, m, d.inner_radius)
    o.along.z, o.along.vz, o.along.force = q[RZ], q[RVZ], s.along
    o.along.rx, o.along.ry = q[RTX], q[RTY]
    kinetic = _report_balls(q, m)
    kinetic += 0.5 * p.ring.mass * (q[ring.RVX] ** 2 + q[ring.RVY] ** 2 + q[RVZ] ** 2)
    kinetic += 0.5 * p.ring.inertia * q[ring.RW] ** 2 + 0.5 * d.transverse_inertia * (
        q[RWX] ** 2 + q[RWY] ** 2
    )
    e = o.energy
    e.kinetic, e.potential, e.dissipated = kinetic, _potential(q, m), q[ring.LOSS]
    report_faces(q[FACE_HEAT], p.shoulder, o.shoulder, s.shoulder)
    parts.report(q, ring.HEAT, m)
    inner = largest(s.inner.normal, s.inner.indentation, d.balls, d.abreast)
    outer = largest(s.outer.normal, s.outer.indentation, d.balls, d.abreast)
    o.inner.force, o.inner.indentation = inner.force, inner.indentation
    o.outer.force, o.outer.indentation = outer.force, outer.indentation
    o.balls.force = max(inner.force, outer.force)
    o.balls.indentation, _ = _approach(m)
    o.neighbours.force = o.neighbours.indentation = 0.0
    for row in range(d.rows):
        side = largest(s.side[row].normal, s.side[row].indentation, p.balls.count, d.abreast)
        o.neighbours.force = max(o.neighbours.force, side.force)
        o.neighbours.indentation = max(o.neighbours.indentation, side.indentation)
    if o.hardest.ball > 0:
        _report_hardest(m)


@kernel
def settle(words):
    """Stiffness and masses from geometry, where all starts, error weights; returns a problem, or 0."""
    m = words.view(MEMORY)[0]
    blank(words, CONSTANTS)
    problem = declarations.problem(m.p, m.told)
    if problem != 0:
        return problem
    declarations.settle(m)
    seat.set_weights(m.weight)
    seat.weigh_tilt(m.weight)
    ring.set_weights(m.weight)
    space_ring.set_weights(m.weight)
    balls.set_weights(m)
    ring.append_bending(math.inf, m)
    return missing(words, CONSTANTS)


@kernel
def start(words):
    """Ring and balls at rest, the first ball at its angle; words: the memory, in 8-byte words."""
    m = words.view(MEMORY)[0]
    q = m.q
    seat.take_inputs(q, m)
    ring.place(q, m.d.rest_x, m.d.rest_y)
    q[RZ], q[RVZ], q[RTX], q[RTY], q[RWX], q[RWY] = q[seat.HZ], q[seat.HVZ], 0.0, 0.0, 0.0, 0.0
    balls.lay_out(q, m)
    state_constants(m)
    m.s.kick = m.s.drift = m.s.lately = 0.0
    seat.begin(react, report, m)
    fill_accounts(m)
    _watch_balls(m.time, m)
    m.s.kick = m.s.drift = 0.5 * m.d.micro_step


@kernel
def integrate(m, work, span):
    """Advance m.q by `span` (s); work: (8, m.n) or wider. As `seat.integrate`."""
    if m.d.micro_step > 0.0:
        return leapfrog(rhs, drift, fastest, kicked, observe, m, work, span)
    return seat.integrate(rhs, observe, m, work, span)


@kernel
def instant(t, q, dq, m):
    """Derivative dq (m.n,) and load in m.o (N, N m) under the motion m.u, friction as it stands."""
    m.s.kick = m.s.drift = 0.0
    seat.instant(react, t, q, dq, m)


@kernel
def advance(words, work, time, step):
    """One macro step of `step` (s) from `time` (s); returns a status."""
    rows = work.ravel().view(SCRATCH)[0].rows
    m = words.view(MEMORY)[0]
    return seat.advance(react, integrate, report, words, m, rows, time, step)


_KNOWN = starts_from("coordinates", "ball_ball", "ball_outer", "ball_inner")
_ALSO = {"stiffness": ("balls.contact_angle",)}
MODEL = Model(
    name="angular_cageless",
    title="Detailed cageless touchdown bearing in space",
    about="Full-complement angular contact bearing, single or in pairs, with every ball a body in space",
    parameters=Parameters,
    inputs=seat.BearingInputs,
    outputs=Outputs,
    derived=SpaceDerived,
    hidden=SpaceMemory,
    memory=MEMORY,
    settle=settle,
    start=start,
    advance=advance,
    problems=PROBLEMS,
    instant=instant,
    starts_from={name: (*known, *_ALSO.get(name.split(".")[0], ())) for name, known in _KNOWN.items()},
)
