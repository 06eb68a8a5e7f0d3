"""Detailed touchdown bearing with a cage, every ball a body in space.

All of `angular_cageless`, with pockets of a cage in place of neighbours: each row has a cage of its own,
a rigid body with six coordinates that only its balls guide.

At contact angle 0, in the plane, this is `detailed_caged`. Not in it, beside what is not in the other:
a land on a ring that guides the cage, and a cage that bends.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from ..modelkit.integrators import dopri
from ..modelkit.kernel import inlined, kernel
from ..modelkit.model import Model, constants
from ..modelkit.numerics import blank, missing
from ..modelkit.variables import group, groups, real
from . import seat
from .angular import arrangement
from .angular.bodies import interior, space_balls, space_cage, space_outputs, space_parts
from .angular.bodies.half_step import leapfrog_in_space, record_spatial_work
from .angular.bodies.interior import fill_accounts, kicked
from .angular.bodies.memory_layout import MAX_STATES, ROWS, RTX, RTY
from .angular.bodies.space_cage import CageConstants, PocketSides, SpaceCageBody, SpaceCageReport
from .angular.bodies.space_parts import SpaceDerived, SpaceMemory, SpaceOutputs, SpaceParameters
from .angular.bodies.space_ring import moved_by, tilted_axes
from .angular.inner_ring import SpatialRing
from .contact.friction import FrictionLaw
from .contact.laws import ContactLaw
from .contact.line import BoreContact
from .rolling import cage as planar_cage
from .rolling import gaps, ring
from .rolling.ball_set import EVEN_SPREAD, BallContacts
from .rolling.declarations import state_constants
from .seat import space


@dataclass(frozen=True)
class Parameters(SpaceParameters):
    """Defaults: SKF 6004 under the disk of section 4.3, as `detailed_caged`."""

    contact: BoreContact = group(BoreContact, damping=1e7, length=12e-3, depth=1.635e-3)
    ring: SpatialRing = group(SpatialRing)
    cage: SpaceCageBody = group(SpaceCageBody)
    cage_contact: ContactLaw = group(ContactLaw, stiffness=1e8)
    cage_friction: FrictionLaw = group(FrictionLaw, static=0.03, dynamic=0.02)


@dataclass(frozen=True)
class _Speeds(ring.RaceSpeeds):
    """Circumferential speeds that agree where nothing slips."""

    cage: float = real(0.0, "m/s", "speed of the first row's cage on the pitch circle", local=True)
    orbit: float = real(0.0, "m/s", "mean speed of the balls around the shaft", local=True)
    ball: float = real(0.0, "m/s", "mean circumferential speed of the balls by their spin", local=True)


@dataclass(frozen=True)
class Outputs(SpaceOutputs):
    """Loads, and what to know of the interior."""

    cage: SpaceCageReport = group(SpaceCageReport)
    second_cage: SpaceCageReport = group(SpaceCageReport)
    pockets: BallContacts = group(BallContacts)
    speed: _Speeds = group(_Speeds)


@dataclass(frozen=True)
class Derived(SpaceDerived):
    """Constants that follow from the parameters."""

    cage: CageConstants = group(CageConstants)


@dataclass(frozen=True)
class Hidden(SpaceMemory):
    """Memory between evaluations and steps."""

    side: tuple = groups(PocketSides, ROWS)


MEMORY = seat.bearing_memory(
    Parameters, Outputs, MAX_STATES, derived=Derived, hidden=Hidden, inputs=space.SpatialInputs
)
SCRATCH = dopri.scratch_layout(MAX_STATES + seat.MODES_SIZE)
STATIC = Parameters().cage_friction.static
_SHARED = space_parts.space_problems("cage_friction")
SHARED = len(_SHARED)
SLENDER = SHARED + len(planar_cage.PROBLEMS) + 1  # number of the problem
CONSTANTS, PROBLEMS = constants(MEMORY, (*_SHARED, *planar_cage.PROBLEMS, space_cage.SLENDER))


@kernel
def react(t, q, dq, m):
    """Derivative dq of ring, balls and cages in q, and the `SpatialLoad` on journal and housing."""
    space_balls.gather_balls(q, m)
    axes = tilted_axes(q[RTX], q[RTY])
    moved = moved_by(m.s.before, axes, m.s.kick)
    interior.press_on_races(q, axes, moved, m)
    space_cage.meet_pockets(q, dq, m)
    shaft = interior.rub_bodies(q, dq, axes, moved, m)
    space_balls.hand_over_balls(dq, m)
    return interior.conclude(dq, shaft, space_cage.cages_heat(q, dq, m), m)


@kernel
def rhs(t, q, dq, m):
    """Derivative dq (m.n,) of everything the bearing integrates, t (s) into the macro step."""
    load = react(t, q, dq, m)
    space.spatial_copy_rates(t, q, dq, m, m.half, load)
    record_spatial_work(dq, load, m)


@kernel
def _fastest(m):
    """Largest angular frequency of a body on its contacts, at the last evaluation (rad/s)."""
    return interior.fastest_body(space_cage.cage_frequency_squared(m), m)


@kernel
def observe(t, q, m):
    """Peaks and events, after each accepted micro-step, t (s) into the macro step."""
    space_outputs.watch_bodies(t, q, m.o.pockets, m)


@kernel
def report(q, m):
    """Outputs wanted once per macro step, from the state q (m.n,)."""
    space_outputs.report(q, m.o.pockets, False, space_cage.report(q, m), m)


@kernel
def _problem(p, numbers):
    """Number of what is wrong between the parameters p, or 0."""
    found = planar_cage.pocket_problem(p, numbers)
    if found != 0:
        return SHARED + found
    found = space_parts.space_problem(p, 0, p.cage_friction, STATIC, numbers)
    if found != 0:
        return found
    numbers[0], numbers[1] = p.cage.transverse_inertia, 0.5 * planar_cage.inertia_of(p, p.cage.mass)
    return SLENDER if 0.0 < numbers[0] < numbers[1] else 0


@kernel
def derive(words):
    """Stiffness and masses from geometry, where all starts, error weights; returns a problem, or 0."""
    m = words.view(MEMORY)[0]
    p, d = m.p, m.d
    blank(words, CONSTANTS)
    problem = _problem(p, m.message_numbers)
    if problem != 0:
        return problem
    lighter = space_cage.derive(m)
    space_parts.derive(m, EVEN_SPREAD, p.cage.clearance, p.cage_contact, p.cage_friction, lighter, lighter)
    space_cage.derive_pockets(m)
    d.size.coordinates, d.size.ball_cage = 8 + 6 * (d.balls + d.rows), d.balls
    interior.set_weights(m)
    space_cage.set_weights(m)
    ring.append_bending(math.inf, m)
    return missing(words, CONSTANTS)


@kernel
def start(words):
    """Ring, balls and cages at rest, the first ball at its angle; words: the memory, in 8-byte words."""
    m = words.view(MEMORY)[0]
    space.take_spatial_inputs(m.q, m)
    gaps.start_gaps(m)
    interior.place_bodies(m.q, m)
    space_cage.place_cages(m.q, m)
    state_constants(m)
    m.s.kick = m.s.drift = m.s.lately = 0.0
    seat.begin(space.SPATIAL, react, report, m)
    fill_accounts(m)
    space_outputs.watch_contacts(m.time, m.o.pockets, m)
    m.s.kick = m.s.drift = 0.5 * m.d.micro_step


@inlined
def _drift(trial, q, mid, h, m):
    """Places in the state `trial`, those of the cages included (`verlet`)."""
    interior.drift(trial, q, mid, h, m)
    space_cage.drift(trial, q, mid, h, m)


@kernel
def integrate(m, work, span):
    """Advance m.q by `span` (s); work: (8, m.n) or wider. As `seat.integrate`."""
    if m.d.micro_step > 0.0:
        return leapfrog_in_space(rhs, _drift, _fastest, kicked, observe, m, work, span)
    return seat.integrate(space.SPATIAL, rhs, observe, m, work, span)


@kernel
def instant(t, q, dq, words):
    """Derivative dq (m.n,) and load in m.o (N, N m) under the motion m.u, friction as it stands."""
    m = words.view(MEMORY)[0]
    m.s.kick = m.s.drift = 0.0
    seat.instant(space.SPATIAL, react, t, q, dq, m)


@kernel
def advance(words, work, time, step):
    """One macro step of `step` (s) from `time` (s); returns a status."""
    rows = work.ravel().view(SCRATCH)[0].rows
    m = words.view(MEMORY)[0]
    status = seat.advance(
        space.SPATIAL, interior.follow_gaps, react, integrate, report, words, m, rows, time, step
    )
    return arrangement.status_on_row(gaps.status_when_warm(status, m), m, step)


@kernel
def _advance_as_built(words, work, time, step):
    """The same where play and clearance stay as they are (`gaps.EFFECTS`)."""
    rows = work.ravel().view(SCRATCH)[0].rows
    m = words.view(MEMORY)[0]
    status = seat.advance(
        space.SPATIAL, seat.any_time, react, integrate, report, words, m, rows, time, step
    )
    return arrangement.status_on_row(status, m, step)


MODEL = Model(
    name="angular_caged",
    title="Detailed caged touchdown bearing in space",
    about="Angular contact bearing, single or in pairs, with every ball and the cages bodies in space",
    parameters=Parameters,
    inputs=space.SpatialInputs,
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
    starts_from=space_parts.space_starts_from("ball_cage"),
)
