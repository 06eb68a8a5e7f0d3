"""Simplified touchdown bearing without a cage (Halminen (2016), section 2.1, harmonised as in 4.3).

The inner ring has three coordinates; each ball has its angular position and its spin (2.4). Where a ball
is pressed between the rings, one spring in series stands for both of its contacts (2.5, 2.6); friction
at both drives the ball along the race (2.10) and spins it (2.11); neighbours push and rub (2.8).

All angles and spins are counter-clockwise here (Halminen (2016) counts a ball's spin clockwise). With n the
outward and t = (-n_y, n_x) the tangential direction at a ball, s_i and s_o the sliding speeds at the
inner and outer race:

    r_m m gamma'' = mu(s_i) F + mu(s_o) F_o + H_b - H_(b+1) - g m cos(gamma) - F (e . t)/r_m     (2.10)
    I theta''     = r_b (mu(s_o) F_o - mu(s_i) F) - r_b mu_bb (H_b + H_(b+1))                      (2.11)

with F and F_o as in `bearings.rolling.pitch_circle`.

Deviations from Halminen (2016), each named where it acts:
- (2.10) as printed has a further term mu r_b/r_m (F + F_o), which counts the contact moment twice;
  `as_printed` adds it (a passive bearing then loses angular momentum to nowhere).
- A ball driven into the narrowing gap resists with -F (e . t)/r_m.
- (5.1), the pitch radius corrected for indentation, is an option (`corrected_pitch`); as printed its signs
  take a loaded ball inwards, where the ring presses it outwards, into the outer race.
- Friction on a ball reacts on the rings as a force, too, so that action equals reaction.
- Neighbours push along the chord between their centres.
- Balls have no inertia or weight across the race: what (2.9) adds at the outer race loads friction, not
  the housing.

The balls' angles, orbits and spins lie in the state vector one after another, so that loops over the
balls become vector code. Friction on a ball of half a gram is stiff (1e7 per second under load),
everything else is not. The default are leapfrog steps that take friction implicitly
(`bearings.rolling.friction`); the reference, with `micro_step = 0`, is a linearly implicit method
whose matrix holds the slopes of friction.
"""

from __future__ import annotations

from dataclasses import dataclass

from ..modelkit.integrators import dopri, rosenbrock
from ..modelkit.kernel import kernel
from ..modelkit.model import Model, constants
from ..modelkit.numerics import blank, missing, squared
from ..modelkit.ports import Interface, Load
from ..modelkit.variables import SWITCH, Choices, array, choice, group, real
from . import seat
from .contact import friction
from .contact.friction import FrictionLaw
from .contact.laws import ContactLaw, broadcast_law, damp
from .contact.line import BoreContact
from .contact.peaks import PeakMemory, watch_peaks
from .rolling import bending, declarations, gaps, ring
from .rolling.ball_contacts import Chain, SideContacts, highest, stored_energy
from .rolling.ball_set import (
    MAX_BALLS,
    BallContacts,
    FreeBallSet,
    ball_mass,
    outer_share,
    series_dissipation,
    set_race_law,
    solid_ball_inertia,
    spread_of,
    start_angle,
    touch_angle,
)
from .rolling.balls import largest_contact, watch_balls
from .rolling.declarations import (
    RollingDerived,
    RollingMemory,
    RollingOutputs,
    RollingParameters,
    starts_from,
    state_constants,
)
from .rolling.friction import FrictionLines, RubbedRace
from .rolling.micro_step import (
    MICRO_STEP,
    RESOLUTION,
    STATIC_BENDING,
    KickMemory,
    fastest_bending,
    leapfrog,
    record_work,
    refined,
    step_in_hit,
)
from .rolling.pitch_circle import RollingResistance
from .rolling.ring import BALLS, part
from .rolling.row import (
    ANGLE,
    MAX_STATES,
    ORBIT,
    SPIN,
    RaceBalls,
    drift,
    fastest_in_row,
    fill_row_accounts,
    linearise,
    neighbour_forces,
    press_balls,
    press_by,
    row_heat,
    row_kicked,
    rub_balls,
    solve_linearised,
)

BALL_SPIN_SCALE = 1e3  # rad/s
ORBIT_SCALE = 100.0  # rad/s; a ball's speed along the race over its radius

NOMINAL, CORRECTED, AS_PRINTED = range(3)
RADII = Choices(
    "PitchRadius",
    ("nominal", "corrected", "printed"),
    (
        "the pitch circle's",
        "corrected for indentation and play",
        "corrected with the signs of (5.1) as printed",
    ),
)


@dataclass(frozen=True)
class Parameters(RollingParameters):
    """Defaults: Koyo 6904 under the disk of section 4.3, pitch diameter corrected to 28.5 mm."""

    interface: Interface = group(Interface, tolerance=2e-5)
    micro_step: float = real(
        MICRO_STEP,
        "s",
        "longest step inside, of the velocity Verlet method; shorter ones follow below the default; "
        "0: adaptive linearly implicit steps of the "
        "error interface.tolerance",
        minimum=0.0,
        maximum=1e-4,
    )
    contact: BoreContact = group(BoreContact, damping=1e7)
    balls: FreeBallSet = group(FreeBallSet)
    ring: ring.Ring = group(ring.Ring, mass=0.0095, inertia=1.08e-6)
    as_printed: int = choice(
        0, SWITCH, "(2.10) with its last friction term as printed, which breaks momentum"
    )
    corrected_pitch: int = choice(NOMINAL, RADII, "radius on which balls run")
    rolling: RollingResistance = group(RollingResistance)
    race_friction: FrictionLaw = group(FrictionLaw)
    ball_contact: ContactLaw = group(ContactLaw, stiffness=1e8)
    ball_friction: FrictionLaw = group(FrictionLaw, static=0.03, dynamic=0.02)


@dataclass(frozen=True)
class _Speeds(ring.RaceSpeeds):
    """Circumferential speeds that agree where nothing slips (Halminen (2016), 4.2, Figs 25 and 26)."""

    orbit: float = real(0.0, "m/s", "mean speed of the balls along the pitch circle", local=True)
    ball: float = real(0.0, "m/s", "mean circumferential speed of the balls by their spin", local=True)


@dataclass(frozen=True)
class Outputs(RollingOutputs):
    """Loads, and what to know of the inside."""

    neighbours: BallContacts = group(BallContacts)
    speed: _Speeds = group(_Speeds)


@dataclass(frozen=True)
class Derived(RollingDerived):
    """Constants that follow from the parameters."""

    race: ContactLaw = group(ContactLaw)
    race_friction: FrictionLaw = group(FrictionLaw)
    ball_contact: ContactLaw = group(ContactLaw)
    ball_friction: FrictionLaw = group(FrictionLaw)
    mass: float = real(0.0, "kg", "of a ball, or of those side by side")
    inertia: float = real(0.0, "kg.m2", "of a ball, or of those side by side")
    ball_radius: float = real(0.0, "m", "of a ball")
    pitch_radius: float = real(0.0, "m", "where ball centres run")
    touch_angle: float = real(0.0, "rad", "between neighbours that just touch")
    run_radius: float = real(0.0, "m", "where ball centres run, unloaded: as (5.1) corrects it")
    run_share: float = real(0.0, "1", "of the rings' approach by which that radius grows")
    micro_step: float = real(0.0, "s", "longest step inside")
    resolution: float = real(0.0, "rad", "of the fastest contact, longest step inside")
    angles: tuple = array(MAX_BALLS)


@dataclass(frozen=True)
class Hidden(RollingMemory, KickMemory):
    """Memory between evaluations and steps."""

    balls: RaceBalls = group(RaceBalls)
    lines: FrictionLines = group(FrictionLines)
    inner: RubbedRace = group(RubbedRace)
    outer: RubbedRace = group(RubbedRace)
    side: SideContacts = group(SideContacts)
    chain: Chain = group(Chain)
    side_peaks: PeakMemory = group(PeakMemory)
    lever: tuple = array(MAX_BALLS)  # m, of the chord between neighbours that touch, about the middle


MEMORY = seat.bearing_memory(Parameters, Outputs, MAX_STATES, derived=Derived, hidden=Hidden)
SCRATCH = dopri.scratch_layout(MAX_STATES + seat.MODES_SIZE)
STATIC, STATIC_OF_BALLS = Parameters().race_friction.static, Parameters().ball_friction.static
CONSTANTS, PROBLEMS = constants(MEMORY, declarations.rolling_problems("race_friction", "ball_friction"))


@kernel
def react(t, q, dq, m):
    """Derivative dq of ring and balls in q, and the `Load` (N, N m) on journal and housing."""
    press_balls(q, m)
    neighbour_forces(q, m)
    j, balls = rub_balls(q, dq, m)
    ring.accelerate(q, dq, m, j, balls)
    among, outside = row_heat(dq, m), m.s.balls.outside
    dq[ring.LOSS] = j.loss + balls.loss + among
    ring.share_heat(dq, j, balls.loss - outside, outside, among, m)
    return Load(j.fx, j.fy, j.journal_moment, -balls.fx, -balls.fy)


@kernel
def rhs(t, q, dq, m):
    """Derivative dq (m.n,) of everything the bearing integrates, t (s) into the macro step."""
    load = react(t, q, dq, m)
    seat.copy_rates(t, q, dq, m, m.half, load)
    record_work(dq, load, m)


@kernel
def observe(t, q, m):
    """Peaks and events, after each accepted micro-step, t (s) into the macro step."""
    ring.watch_bore(t, q, m)
    time, s, count, rows = m.time + t, m.s, m.p.balls.count, m.p.balls.rows
    watch_balls(time, largest_contact(s.inner.normal, s.balls.indentation, count, rows), m)
    watch_peaks(time, highest(s.side, count, rows), m.o.neighbours, s.side_peaks)


@kernel
def report(q, m):
    """Outputs wanted once per macro step, from the state q (m.n,)."""
    p, d, o, s = m.p, m.d, m.o, m.s.balls
    count = p.balls.count
    ring.report(q, m, d.inner_radius)
    gaps.report(m)
    largest = largest_contact(m.s.inner.normal, s.indentation, count, p.balls.rows)
    o.balls.force, o.balls.indentation = largest.force, largest.indentation
    largest = largest_contact(m.s.side.normal, m.s.side.indentation, count, p.balls.rows)
    o.neighbours.force, o.neighbours.indentation = largest.force, largest.indentation
    moving = d.mass * squared(d.pitch_radius)
    angular, turning = part(q, ORBIT, m), part(q, SPIN, m)
    kinetic, pressed = bending.bending_energy(q, d.bending)
    o.ring.ovality = bending.ovality(q, d.bending)
    height, orbit, spin, loaded = 0.0, 0.0, 0.0, 0
    for b in range(count):
        kinetic += 0.5 * moving * squared(angular[b]) + 0.5 * d.inertia * squared(turning[b])
        height += d.pitch_radius * s.sine[b]
        orbit += angular[b]
        spin += abs(turning[b])
        if s.indentation[b] > 0.0:
            loaded += 1
            pressed += 0.4 * s.elastic[b] * s.indentation[b]
    o.balls.loaded = loaded
    o.speed.orbit = orbit / count * d.pitch_radius
    o.speed.ball = spin / count * d.ball_radius
    potential = pressed + stored_energy(m.s.side, d.ball_contact, count) + d.gravity * d.mass * height
    ring.report_energy(q, m, kinetic, potential, p.ring.inertia)


@kernel
def _problem(p, numbers):
    """Number of what is wrong between the parameters p, or 0."""
    found = declarations.rolling_problem(p, p.balls.crowded, numbers)
    found = declarations.law_problem(found, p.race_friction, STATIC, declarations.OWN, numbers)
    return declarations.law_problem(found, p.ball_friction, STATIC_OF_BALLS, declarations.OWN + 2, numbers)


@kernel
def _derive_laws(m):
    """Set in m.d the laws at the balls, and the steps that resolve them."""
    p, d, b = m.p, m.d, m.p.balls
    set_race_law(d.race, b, d.stiffness.series, d.mass, series_dissipation(d.stiffness))
    d.race_friction, d.ball_friction = p.race_friction, p.ball_friction
    friction.derive(d.race_friction)
    friction.derive(d.ball_friction)
    d.ball_contact = p.ball_contact
    broadcast_law(d.ball_contact, b.rows)
    damp(d.ball_contact, d.mass)
    d.micro_step = min(
        p.micro_step,
        step_in_hit(p.micro_step, d.contact, p.ring.mass),
        step_in_hit(p.micro_step, d.race, p.ring.mass),
        step_in_hit(p.micro_step, d.ball_contact, 0.5 * d.mass),
    )
    d.resolution = refined(p.micro_step) * RESOLUTION


@kernel
def _derive_balls(m, spread):
    """Set in m.d what the balls are, where they run and where they start."""
    d, b = m.d, m.p.balls
    d.mass, d.touch_angle = ball_mass(b), touch_angle(b)
    d.inertia = solid_ball_inertia(d.mass, b.diameter)
    d.ball_radius, d.pitch_radius = 0.5 * b.diameter, 0.5 * b.pitch_diameter
    d.run_radius, d.run_share = d.pitch_radius, 0.0
    if m.p.corrected_pitch == CORRECTED:
        d.run_radius, d.run_share = d.pitch_radius + 0.5 * b.play, outer_share(d.stiffness)
    elif m.p.corrected_pitch == AS_PRINTED:
        d.run_share = -0.5
    for i in range(b.count):
        d.angles[i] = start_angle(b.first_angle, b.count, spread, i)


@kernel
def _set_weights(m):
    """Set the error weights, and m.n to what is in use."""
    w, n = m.weight, m.p.balls.count
    seat.set_weights(w)
    ring.set_weights(w)
    for i in range(BALLS, BALLS + n):
        w[i + ANGLE * n] = m.d.pitch_radius / seat.POSITION_SCALE
        w[i + ORBIT * n], w[i + SPIN * n] = 1.0 / ORBIT_SCALE, 1.0 / BALL_SPIN_SCALE
    m.n = BALLS + 3 * n


@kernel
def derive(words):
    """Stiffness and masses from geometry, where all starts, error weights; returns a problem, or 0."""
    m = words.view(MEMORY)[0]
    d, count = m.d, m.p.balls.count
    blank(words, CONSTANTS)
    problem = _problem(m.p, m.message_numbers)
    if problem != 0:
        return problem
    spread = spread_of(m.p.balls)
    declarations.derive(m, spread)
    _derive_balls(m, spread)
    _derive_laws(m)
    d.size.coordinates, d.size.ball_ball, d.size.rings = 5 + 2 * count, count, count
    _set_weights(m)
    ring.append_bending(fastest_bending(m.p.micro_step, STATIC_BENDING), m)
    return missing(words, CONSTANTS)


@kernel
def start(words):
    """Ring and balls at rest, the first ball at its angle; words: the memory, in 8-byte words."""
    m = words.view(MEMORY)[0]
    count = m.p.balls.count
    seat.take_inputs(m.q, m)
    gaps.start_gaps(m)
    ring.place_ring(m.q, m.d.rest_x, m.d.rest_y)
    for b in range(count):
        m.q[BALLS + b] = m.d.angles[b]
        m.q[BALLS + b + count], m.q[BALLS + b + 2 * count] = 0.0, 0.0
    m.s.balls.cross[:] = 1.0
    state_constants(m)
    m.s.kick = m.s.drift = m.s.lately = 0.0
    seat.begin(seat.PLANAR, react, report, m)
    fill_row_accounts(m)
    m.s.kick = m.s.drift = 0.5 * m.d.micro_step


@kernel
def _follow_gaps(m, since):
    """Have the gaps follow temperatures and spins as a macro step begins; since: s after that."""
    if gaps.due(m, since):
        closed = gaps.change_gaps(m)
        work = press_by(closed.play, m)
        gaps.book_closing(closed, 0.5 * work, 0.5 * work, m)


@kernel
def integrate(m, work, span):
    """Advance m.q by `span` (s); work: (8, m.n) or wider. As `seat.integrate`."""
    if m.d.micro_step > 0.0:
        return leapfrog(rhs, drift, fastest_in_row, row_kicked, observe, m, work, span)
    tolerance = m.p.interface.tolerance
    return rosenbrock.integrate(
        rhs,
        linearise,
        solve_linearised,
        observe,
        m,
        m.q,
        seat.PARTS,
        m.n,
        m.weight,
        work,
        span,
        m.h,
        tolerance,
    )


@kernel
def instant(t, q, dq, words):
    """Derivative dq (m.n,) and load in m.o (N, N m) under the motion m.u, friction as it stands."""
    m = words.view(MEMORY)[0]
    m.s.kick = m.s.drift = 0.0
    seat.instant(seat.PLANAR, react, t, q, dq, m)


@kernel
def advance(words, work, time, step):
    """One macro step of `step` (s) from `time` (s); returns a status."""
    rows = work.ravel().view(SCRATCH)[0].rows
    m = words.view(MEMORY)[0]
    status = seat.advance(seat.PLANAR, _follow_gaps, react, integrate, report, words, m, rows, time, step)
    return gaps.status_when_warm(status, m)


@kernel
def _advance_as_built(words, work, time, step):
    """The same where play and clearance stay as they are (`gaps.EFFECTS`)."""
    rows = work.ravel().view(SCRATCH)[0].rows
    m = words.view(MEMORY)[0]
    return seat.advance(seat.PLANAR, seat.any_time, react, integrate, report, words, m, rows, time, step)


MODEL = Model(
    name="simplified_cageless",
    title="Simplified cageless touchdown bearing",
    about="Full-complement ball bearing: one ring on springs at the balls, each of them with its "
    "angle and spin",
    parameters=Parameters,
    inputs=seat.BearingInputs,
    outputs=Outputs,
    derived=Derived,
    hidden=Hidden,
    memory=MEMORY,
    derive=derive,
    start=start,
    advance=advance,
    effects=gaps.EFFECTS,
    advance_without=_advance_as_built,
    problems=PROBLEMS,
    instant=instant,
    starts_from=starts_from("coordinates", "ball_ball", "rings"),
)
