"""The inner ring, in which the journal lands, and the layout of the balls behind it in the state.

Behind the copies of journal and housing (`bearings.seat`) a rolling bearing's state has the ring's six
components; balls and cage follow, component by component. Its own quadratures are the heat lost, and that
of each part.

Loops over the balls hold no branches and no calls of the mathematical library, so that the compiler turns
them into vector code. That takes `LANES` balls at a time and is slow on what is left over, so the loops
may run past the last ball (`rounded_lanes`): the array has room there, with any content.
"""

from __future__ import annotations

from dataclasses import dataclass

from ...modelkit.kernel import inlined, kernel
from ...modelkit.numerics import squared
from ...modelkit.ports import Motion
from ...modelkit.variables import SWITCH, choice, integer, real
from .. import seat
from ..contact.friction import coefficient, curve
from ..contact.journal import note_touch, place_in_bore, time_to_touch, touch_at, touch_of, watch_contact
from ..contact.laws import elastic_energy, elastic_force
from ..contact.line import half_width
from ..contact.materials import MATERIALS, STEEL
from ..contact.pair import INSIDE, ContactPlace, contact_heat, friction_line, kick_of, rubbed, squeeze
from ..contact.passivity import Beat, middle_of, settled_account
from ..heat import shares, warm_parts
from ..heat.flash import Surface, contact_temperature
from ..heat.shares import Sources
from . import bending
from .ball_set import MAX_BALLS
from .bending import AUTOMATIC, MAX_HARMONICS
from .friction import Around, Bore, Push, RingChange, over_ring, rub, rubbed_of
from .pitch_circle import RingMotion

RX, RY, RVX, RVY, RANGLE, RW = range(seat.INSIDE, seat.INSIDE + 6)
NEXT = seat.INSIDE + 6
LOSS, HEAT = shares.LOSS, shares.HEAT

TIGHT = 1e-9  # m; a smaller clearance makes no strip of contact
SYNCHRONOUS = 0.99  # of the journal's surface speed: the ring has caught up


@dataclass(frozen=True)
class Ring:
    """Inner ring, which may bend (`bending`). Defaults: 6004 (filled in; not in Halminen (2016))."""

    mass: float = real(0.015, "kg", "mass of the inner ring", above=0.0)
    inertia: float = real(1.9e-6, "kg.m2", "moment of inertia of the inner ring", above=0.0)
    harmonics: int = integer(
        0,
        "highest harmonic in which the ring bends in its plane; 0: it is rigid; -1: 0.41 times the balls "
        "in a row, rounded up",
        minimum=AUTOMATIC,
        maximum=MAX_HARMONICS,
    )
    width: float = real(
        0.0, "m", "width, of a ring that bends; 0: contact.length", minimum=0.0, needs="harmonics"
    )
    material: int = choice(STEEL, MATERIALS, "material of both rings; their mass is set apart")
    modulus: float = real(
        0.0, "Pa", "modulus of elasticity of both rings; 0: the material's", minimum=0.0, shown="GPa"
    )
    poisson: float = real(
        0.0, "1", "Poisson's ratio of both rings; 0: the material's", minimum=0.0, maximum=0.5
    )
    damping_ratio: float = real(
        0.0, "1", "damping ratio of each of its modes", minimum=0.0, maximum=1.0, needs="harmonics"
    )
    growth: int = choice(0, SWITCH, "ring and journal grow by their spin, which changes play and clearance")


@dataclass(frozen=True)
class RingReport:
    """Motion of the inner ring, and how fast its bore and the journal's surface move."""

    x: float = real(0.0, "m", "horizontal position", local=True)
    y: float = real(0.0, "m", "vertical position", local=True)
    vx: float = real(0.0, "m/s", "horizontal velocity", local=True)
    vy: float = real(0.0, "m/s", "vertical velocity", local=True)
    omega: float = real(0.0, "rad/s", "spin speed", local=True)
    surface_speed: float = real(0.0, "m/s", "circumferential speed of the bore", local=True)
    journal_speed: float = real(0.0, "m/s", "circumferential speed of the journal", local=True)
    sync_time: float = real(
        -1.0, "s", "time when the bore first reached 99 % of the journal's speed; -1: not yet", local=True
    )
    ovality: float = real(
        0.0,
        "m",
        "amplitude of the second harmonic: half of what the ring's diameters differ by",
        local=True,
    )


@dataclass(frozen=True)
class RaceSpeeds:
    """Half the circumferential speed of the inner race, actual and without slip in the bore."""

    rotor: float = real(0.0, "m/s", "half the race's speed if the bore rolled on the journal", local=True)
    ring: float = real(0.0, "m/s", "half the circumferential speed of the inner race", local=True)


@kernel
def ring_motion(q):
    """`Motion` of the inner ring (m, m/s, rad/s) in the state q."""
    return Motion(q[RX], q[RY], q[RVX], q[RVY], q[RW])


@inlined
def _bent_bore(place, body, before, bent, outwards):
    """A `ContactPlace` of the journal in a bore of a `BentShape`, and the bore's `Motion` and acceleration.

    place: in the round bore; body, before: motion of the ring, and its acceleration in the kick before;
    outwards: that of its bending there (m/s2).
    """
    distance = place.second - place.first
    turned = bent.slope / distance if distance > 0.0 else 0.0
    nx, ny = place.nx + turned * place.ny, place.ny - turned * place.nx
    by = 1.0 / (1.0 + turned * turned)
    vx, vy, ax, ay = bent.rate * by * nx, bent.rate * by * ny, outwards * by * nx, outwards * by * ny
    moving = Motion(body.x, body.y, body.vx + vx, body.vy + vy, body.spin)
    faster = Motion(before.x, before.y, before.vx + ax, before.vy + ay, before.spin)
    bent_place = ContactPlace(nx, ny, place.indentation - bent.opening, place.first, place.second, 0.0)
    return bent_place, moving, faster


@kernel
def journal_on_ring(q, shape, m):
    """The journal's `Touch` with the ring (N, N m, m), laws as they stand, remembered for `watch_bore`.

    shape: the ring's (BendingMemory), whose modes it presses.
    """
    t = touch_in_bore(q, seat.journal_motion(q), ring_motion(q), m.d.contact, shape, m)
    note_touch(m.s.ring, t)
    return t


@kernel
def touch_in_bore(q, journal, body, law, shape, m):
    """`Touch` (N, N m, m) of a journal by a `law`, a record, in the bore of a ring; both `Motion`.

    It presses the modes of a ring that bends, in `shape` (BendingMemory).
    """
    round_bore = place = place_in_bore(journal, body, m.p.journal_radius, m.s.gaps.clearance)
    if m.d.bending.waves > 0:
        bent = bending.bore_at(q, place.nx, place.ny, m.d.bending)
        place, body, _ = _bent_bore(place, body, body, bent, 0.0)
    t = touch_at(place, journal, body, law, m.d.friction)
    bending.press_bore(t.normal, round_bore.nx, round_bore.ny, m.d.bending, shape)
    return t


@inlined
def moved_before(m):
    """`RingChange` (m/s, rad/s) by a kick as long as this one at the ring's last acceleration."""
    h, a = m.s.kick, m.s.before
    return RingChange(h * a[RVX], h * a[RVY], h * a[RW])


@inlined
def meet_journal(q, m):
    """(`ContactPlace` of the journal in the bore (m), its `Kick`, the ring answering alone, its `Squeeze`).

    The journal keeps its velocity, that of the middle of the kick.
    """
    p, s, journal, body = m.p, m.s, seat.journal_motion(q), ring_motion(q)
    place, before = place_in_bore(journal, body, p.journal_radius, s.gaps.clearance), ring_motion(s.before)
    along = 1.0 / p.ring.mass
    across = along + place.second * place.second / p.ring.inertia
    if m.d.bending.waves > 0:
        shape = s.inner.shape
        shape.bore_x, shape.bore_y = place.nx, place.ny
        bent = bending.shape_at(q, place.nx, place.ny, m.d.bending)
        place, body, before = _bent_bore(place, body, before, bent, shape.bore_faster)
        along += m.d.bending.answer
    kept, last = Motion(0.0, 0.0, 0.0, 0.0, 0.0), (s.rubbed, s.ring.normal)
    kick = kick_of(Beat(s.kick, s.drift), (across, along), kept, before, place, INSIDE, last)
    return place, kick, squeeze(journal, body, place, INSIDE, m.d.contact, kick, s.ring.stored)


@inlined
def _bend(q, squeezed, n, m):
    """(Change of the bore's rate at the journal (m/s), heat (W)) as the ring bends over the kick.

    The journal is `squeezed`, and `n` balls press the race with m.s.inner.normal.
    """
    h, d, shape, normal = m.s.kick, m.d.bending, m.s.inner.shape, m.s.inner.normal
    for i in range(d.waves):
        shape.acceleration[i] = 0.0
    if squeezed.normal > 0.0:
        bending.press_modes(squeezed.normal, shape.bore_x, shape.bore_y, d, shape)
    for b in range(n):
        if normal[b] > 0.0:
            bending.press_modes(-normal[b], shape.nx[b], shape.ny[b], d, shape)
    loss = bending.accelerate_modes(q, h, d, shape)
    for b in range(n):
        pressed = normal[b] > 0.0
        shape.faster[b] = bending.faster_at(shape.nx[b], shape.ny[b], d, shape) if pressed else 0.0
    pressed = squeezed.normal > 0.0
    shape.bore_faster = bending.faster_at(shape.bore_x, shape.bore_y, d, shape) if pressed else 0.0
    return h * shape.bore_faster, loss


@inlined
def bore_line(place, kick, squeezed, m):
    """`Bore`: the journal's friction at a `place` of the bore over a `kick`, if `squeezed`."""
    if squeezed.normal <= 0.0:
        return Bore(place.nx, place.ny, place.second, 0.0, 0.0)
    expected = squeezed.sliding + kick.sliding
    line = friction_line(squeezed.sliding, expected, kick.across, squeezed.normal, curve(m.d.friction))
    return Bore(place.nx, place.ny, place.second, line.start / line.base, line.slope / line.base)


@inlined
def push_on(place, squeezed, balls, m):
    """`Push` on the ring: journal `squeezed` at its place, `balls` (Total: N, N m), weight."""
    p, n = m.p, squeezed.normal
    fx, fy = balls.fx + n * place.nx, balls.fy + n * place.ny - p.ring.mass * m.d.gravity
    return Push(fx, fy, balls.moment, p.ring.mass, p.ring.inertia)


@inlined
def rub_journal(place, squeezed, friction, moved, bent, m):
    """The journal's `Touch` (N, N m, m, W) that is `squeezed` and rubs, remembered for `watch_bore`.

    friction: N, along t; moved: `RingChange` of the kick; bent: by how much it has the bore
    bend away faster (m/s), and the heat of bending (W).
    """
    s, pressed = m.s, rubbed(place, INSIDE, squeezed, friction)
    ahead = over_ring(place.nx, place.ny, place.second, moved)
    opening = moved.x * place.nx + moved.y * place.ny + bent[0]
    loss, sliding = contact_heat(pressed, -ahead, -opening), pressed.sliding - 0.5 * ahead
    t = touch_of(pressed, place.indentation, loss + bent[1], sliding)
    note_touch(s.ring, t)
    s.ring.bent = bent[1]
    s.ring.middle, s.ring.nx, s.ring.ny = squeezed.rate - 0.5 * opening, place.nx, place.ny
    s.rubbed = friction
    s.brake.jx, s.brake.jy, s.brake.jm = (
        t.fx + t.elastic * place.nx,
        t.fy + t.elastic * place.ny,
        t.journal_moment,
    )
    return t


@inlined
def rub_races(q, pressed, answers, inner, m):
    """Friction of all balls at both races and of the journal in the bore, over the kick m.s.kick.

    pressed: `Total` (N, N m) of the balls on the ring but for friction; answers: `Answers` of a ball;
    inner: `Inner` (n,). The races' friction and heat are set in m.s.outer and m.s.inner. Returns the
    journal's `Touch` (N, N m, m, W) and `RingChange`: what the kick does to the ring.
    """
    s, n = m.s, len(inner.nx)
    place, kick, squeezed = meet_journal(q, m)
    bent = 0.0, 0.0
    if m.d.bending.waves > 0:
        bent = _bend(q, squeezed, m.p.balls.count, m)
    push = push_on(place, squeezed, pressed, m)
    around = Around(moved_before(m), push, bore_line(place, kick, squeezed, m))
    races = rubbed_of(s.outer, n), rubbed_of(s.inner, n)
    law = curve(m.d.race_friction)
    friction, moved = rub(s.kick, m.p.balls.count, law, answers, around, inner, races[0], races[1], s.lines)
    return rub_journal(place, squeezed, friction, moved, bent, m), moved


@kernel
def bore_stiffness(m):
    """Stiffness (N/m) of the journal's contact at its indentation of the last evaluation."""
    depth = m.s.ring.indentation
    return m.d.contact.exponent * elastic_force(depth, m.d.contact) / depth if depth > 0.0 else 0.0


@kernel
def ring_frequency_squared(below, m):
    """Largest squared frequency (rad2/s2) of the ring and its modes on contacts of `below` (N/m) together.

    Of one that bends: an upper bound, some per cent above. Its modes alone are not faster than micro-steps
    resolve.
    """
    b = m.d.bending
    rigid = below / m.p.ring.mass
    return rigid + (below * b.answer + b.fastest * b.fastest) if below > 0.0 else rigid


@kernel
def settle_bore(kick, part, vx, vy, m):
    """Settle the account of the journal's contact after a `kick` (s); returns what it withheld (J).

    part: of the kick in which its force was found; vx, vy: by how much the journal was faster in its middle
    than it was taken to be (m/s).
    """
    c = m.s.ring
    closing = middle_of(c.rate, c.middle, part) + vx * c.nx + vy * c.ny
    c.stored, withheld = settled_account(c.stored, c.indentation, kick * c.elastic * closing)
    return withheld


@kernel
def gap(q):
    """`RingMotion` (m, m/s, rad/s) from the housing's middle, as balls on the pitch circle meet it."""
    return RingMotion(
        q[RX] - q[seat.HX],
        q[RY] - q[seat.HY],
        q[RVX] - q[seat.HVX],
        q[RVY] - q[seat.HVY],
        q[RW],
    )


@kernel
def translate(q, dq, m, journal, fx, fy):
    """Derivatives dq of the ring but for its spin, under the journal's `Touch` and the balls' force (N)."""
    p = m.p
    dq[RX] = q[RVX]
    dq[RY] = q[RVY]
    dq[RVX] = (fx - journal.fx) / p.ring.mass
    dq[RVY] = (fy - journal.fy) / p.ring.mass - m.d.gravity
    dq[RANGLE] = q[RW]


@kernel
def accelerate(q, dq, m, journal, balls):
    """Derivatives dq of the ring under the journal's `Touch` and the balls' `Total` (N, N m)."""
    translate(q, dq, m, journal, balls.fx, balls.fy)
    dq[RW] = (journal.ring_moment + balls.moment) / m.p.ring.inertia


@inlined
def share_heat(dq, journal, inner, outer, among, m):
    """Set in dq the heat of each part: of the journal's `Touch`, at both races, among the balls (W)."""
    bent = m.s.ring.bent
    sources = Sources(journal.loss - bent, bent, inner, outer, among)
    shares.set_rates(sources, journal.sliding, dq, HEAT)


@inlined
def drift(trial, q, mid, h):
    """The ring's position in the state `trial`: that in q and h (s) times its velocity in `mid`."""
    trial[RX] = q[RX] + h * mid[RVX]
    trial[RY] = q[RY] + h * mid[RVY]
    trial[RANGLE] = q[RANGLE] + h * mid[RW]


@kernel
def report_energy(q, m, kinetic, potential, inertia):
    """Energy of the bearing (J), in m.o; `kinetic` and `potential` (J) are those of balls and cage,
    `inertia` (kg m2) is what turns with the ring.
    """
    p, o = m.p, m.o.energy
    speed2 = squared(q[RVX]) + squared(q[RVY])
    o.kinetic = kinetic + 0.5 * p.ring.mass * speed2 + 0.5 * inertia * squared(q[RW])
    o.potential = potential + elastic_energy(m.s.ring.indentation, m.d.contact)
    o.potential += p.ring.mass * m.d.gravity * q[RY]
    o.dissipated = q[LOSS]
    shares.report(q, HEAT, m)


@kernel
def place_ring(q, dx, dy):
    """Put the ring at rest in its housing, (dx, dy) from the middle (m)."""
    q[RX], q[RY] = q[seat.HX] + dx, q[seat.HY] + dy
    q[RVX], q[RVY] = q[seat.HVX], q[seat.HVY]


@kernel
def bore_temperature(q, m):
    """The highest between journal and bore now (K above the start): `heat.flash` in the state q."""
    p, warmth, clearance = m.p, m.s.gaps.warmth, max(m.s.gaps.clearance, TIGHT)
    j, body = seat.journal_motion(q), ring_motion(q)
    x, y = j.x - body.x, j.y - body.y
    # at which the strip goes round in the bore, and, but for the indentation, on the journal
    turning = (x * (j.vy - body.vy) - y * (j.vx - body.vx)) / max(x * x + y * y, TIGHT * TIGHT)
    over, under = (
        (j.spin - turning) * p.journal_radius,
        (body.spin - turning) * (p.journal_radius + clearance),
    )
    press, sliding = m.s.ring.normal / p.contact.length, over - under
    made = coefficient(sliding, m.d.friction) * press * sliding
    width = half_width(press, p.contact, p.journal_radius, clearance)
    journal = Surface(over, warmth[warm_parts.JOURNAL], STEEL)
    return contact_temperature(
        made, width, journal, Surface(under, warmth[warm_parts.INNER], p.ring.material)
    )


@kernel
def _watch_temperature(time, q, m):
    """Keep the highest temperature between journal and bore, and its time (s)."""
    found, o = bore_temperature(q, m), m.o.temperature
    if found > o.contact:
        o.contact, o.contact_time = found, time


@kernel
def watch_bore(t, q, m):
    """First contact, peaks and the time of synchronism, after a micro-step, t (s) into the macro step."""
    time = m.time + t
    watch_contact(time, seat.journal_motion(q), m.s.ring, m.o.contact, m.s.contact)
    if m.p.thermal == 1 and m.s.ring.normal > 0.0:
        _watch_temperature(time, q, m)
    o = m.o.ring
    if o.sync_time < 0.0 and m.o.contact.first_time >= 0.0:
        bore = m.p.journal_radius + m.p.clearance
        journal = q[seat.JW] * m.p.journal_radius
        if abs(q[RW] * bore) >= SYNCHRONOUS * abs(journal) and q[RW] * journal > 0.0:
            o.sync_time = time


@kernel
def report(q, m, race_radius):
    """Outputs of ring and contact at the end of the macro step; race_radius: of the inner race (m)."""
    o, p = m.o.ring, m.p
    o.x, o.y, o.vx, o.vy, o.omega = q[RX], q[RY], q[RVX], q[RVY], q[RW]
    o.surface_speed = q[RW] * (p.journal_radius + p.clearance)
    o.journal_speed = q[seat.JW] * p.journal_radius
    m.o.speed.ring = 0.5 * q[RW] * race_radius
    m.o.speed.rotor = 0.5 * o.journal_speed * race_radius / (p.journal_radius + p.clearance)
    c = m.o.contact
    c.force, c.indentation = m.s.ring.normal, m.s.ring.indentation
    c.sliding = o.journal_speed - o.surface_speed
    c.reach = time_to_touch(seat.journal_motion(q), ring_motion(q), m.s.gaps.clearance)


@kernel
def append_bending(limit, m):
    """Put the modes of the ring behind the m.n components in use, with their error weights.

    limit: as for `bending.derive` (rad/s).
    """
    bending.derive(m.d.bending, m.p, m.n, limit)
    weigh_bending(m)


@kernel
def weigh_bending(m):
    """Count the modes of the ring behind the m.n components in use, and set their error weights."""
    length, speed = 1.0 / seat.POSITION_SCALE, 1.0 / seat.VELOCITY_SCALE
    m.n = bending.set_weights(m.d.bending, m.weight, length, speed)


@kernel
def set_weights(weight):
    """Set the error weights of the ring's components in `weight` (n,); the heat lost is a quadrature."""
    weight[RX] = weight[RY] = 1.0 / seat.POSITION_SCALE
    weight[RVX] = weight[RVY] = 1.0 / seat.VELOCITY_SCALE
    weight[RANGLE] = weight[RW] = 1.0 / seat.SPIN_SCALE


BALLS = NEXT  # from here each component of all balls in turn
LANES = 16  # as compiled for 512 bit; half of it is in use at 256
MAX_LEFTOVER_BALLS = 2  # balls left over that are quicker alone than with company
# with a cage, a ring that bends, and room to run past the last ball
MAX_STATES = BALLS + 6 * (MAX_BALLS + 1) + bending.MAX_STATES + LANES


@kernel
def part(q, component, m):
    """(count,) view of one component of all balls in the state q, or in its derivative."""
    count = m.p.balls.count
    return q[BALLS + component * count : BALLS + (component + 1) * count]


@kernel
def lanes(q, component, m):
    """(rounded(count),) view of one component in the state q, to read, past the last ball, too."""
    first = BALLS + component * m.p.balls.count
    return q[first : first + rounded_lanes(m.p.balls.count)]


@kernel
def rounded_lanes(count):
    """How many balls the loops run over for `count`; all arrays have room for `MAX_BALLS`."""
    left = count % LANES
    return count if left <= MAX_LEFTOVER_BALLS else count - left + LANES


@inlined
def drift_balls(trial, q, mid, h, place, rate, n):
    """Set n places in the state `trial`: those in q and h (s) times their rates in `mid`.

    place, rate: numbers of the first ones in the state.
    """
    to, start, by = trial[place : place + n], q[place : place + n], mid[rate : rate + n]
    for b in range(len(to)):
        to[b] = start[b] + h * by[b]


@inlined
def copy(values, to):
    """Set `to` (n,) to `values` (n,)."""
    for b in range(len(to)):
        to[b] = values[b]
