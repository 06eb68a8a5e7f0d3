"""Detailed touchdown bearing without a cage, every ball a body in space.

Balls have three coordinates and three spins each, the inner ring six coordinates; the outer ring is the
housing's and does not tilt. In one row or a pair of them balls run in grooves at a contact angle, which
load, speed and tilt change: centrifugal force and the gyroscopic moment of balls follow from their motion.
The rotor touches the ring at both edges of the bore's land, and with its shoulders on the faces. Each ball
meets the next one of its row.

At contact angle 0, in the plane, this is `detailed_cageless`. Not in it: friction of balls that spin about
their contact's normal, rings that bend, races that are not circles, and an outer ring that tilts.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from ..modelkit.integrators import dopri
from ..modelkit.kernel import kernel
from ..modelkit.model import Model, constants
from ..modelkit.numerics import blank, missing
from ..modelkit.variables import group, groups, real
from . import seat
from .angular import arrangement
from .angular.bodies import interior, neighbours, space_balls, space_outputs, space_parts
from .angular.bodies.half_step import leapfrog_in_space, record_spatial_work
from .angular.bodies.interior import drift, fill_accounts, kicked
from .angular.bodies.memory_layout import MAX_STATES, ROWS, RTX, RTY
from .angular.bodies.neighbours import NeighbourSides
from .angular.bodies.space_parts import (
    FreeAngularBallSet,
    SpaceDerived,
    SpaceMemory,
    SpaceOutputs,
    SpaceParameters,
)
from .angular.bodies.space_ring import moved_by, tilted_axes
from .contact.friction import FrictionLaw
from .contact.laws import ContactLaw
from .rolling import gaps, ring
from .rolling.ball_contacts import Chain
from .rolling.ball_set import BallContacts, spread_of
from .rolling.declarations import state_constants
from .seat import space


@dataclass(frozen=True)
class Parameters(SpaceParameters):
    """Defaults: Koyo 6904 under the disk of section 4.3, pitch diameter corrected to 28.5 mm."""

    balls: FreeAngularBallSet = group(FreeAngularBallSet)
    ball_contact: ContactLaw = group(ContactLaw, stiffness=1e8)
    ball_friction: FrictionLaw = group(FrictionLaw, static=0.03, dynamic=0.02)


@dataclass(frozen=True)
class _Speeds(ring.RaceSpeeds):
    """Circumferential speeds that agree where nothing slips."""

    orbit: float = real(0.0, "m/s", "mean speed of the balls around the shaft", local=True)
    ball: float = real(0.0, "m/s", "mean circumferential speed of the balls by their spin", local=True)


@dataclass(frozen=True)
class Outputs(SpaceOutputs):
    """Loads, and what to know of the interior."""

    neighbours: BallContacts = group(BallContacts)
    speed: _Speeds = group(_Speeds)


@dataclass(frozen=True)
class Hidden(SpaceMemory):
    """Memory between evaluations and steps."""

    side: tuple = groups(NeighbourSides, ROWS)
    chain: Chain = group(Chain)


MEMORY = seat.bearing_memory(
    Parameters, Outputs, MAX_STATES, derived=SpaceDerived, hidden=Hidden, inputs=space.SpatialInputs
)
SCRATCH = dopri.scratch_layout(MAX_STATES + seat.MODES_SIZE)
STATIC = Parameters().ball_friction.static
CONSTANTS, PROBLEMS = constants(MEMORY, space_parts.space_problems("ball_friction"))


@kernel
def react(t, q, dq, m):
    """Derivative dq of ring and balls in q, and the `SpatialLoad` (N, N m) on journal and housing."""
    space_balls.gather_balls(q, m)
    axes = tilted_axes(q[RTX], q[RTY])
    moved = moved_by(m.s.before, axes, m.s.kick)
    interior.press_on_races(q, axes, moved, m)
    neighbours.meet_neighbours(m)
    shaft = interior.rub_bodies(q, dq, axes, moved, m)
    space_balls.hand_over_balls(dq, m)
    return interior.conclude(dq, shaft, neighbours.neighbours_heat(m.s.kick, m), m)


@kernel
def rhs(t, q, dq, m):
    """Derivative dq (m.n,) of everything the bearing integrates, t (s) into the macro step."""
    load = react(t, q, dq, m)
    space.spatial_copy_rates(t, q, dq, m, m.half, load)
    record_spatial_work(dq, load, m)


@kernel
def _fastest(m):
    """Largest angular frequency of a body on its contacts, at the last evaluation (rad/s)."""
    return interior.fastest_body(0.0, m)


@kernel
def observe(t, q, m):
    """Peaks and events, after each accepted micro-step, t (s) into the macro step."""
    space_outputs.watch_bodies(t, q, m.o.neighbours, m)


@kernel
def report(q, m):
    """Outputs wanted once per macro step, from the state q (m.n,)."""
    space_outputs.report(q, m.o.neighbours, True, (0.0, 0.0), m)


@kernel
def derive(words):
    """Stiffness and masses from geometry, where all starts, error weights; returns a problem, or 0."""
    m = words.view(MEMORY)[0]
    p, size = m.p, m.d.size
    blank(words, CONSTANTS)
    problem = space_parts.space_problem(p, p.balls.crowded, p.ball_friction, STATIC, m.message_numbers)
    if problem != 0:
        return problem
    mass = space_parts.row_ball_mass(p)
    space_parts.derive(m, spread_of(p.balls), math.inf, p.ball_contact, p.ball_friction, mass, 0.5 * mass)
    size.coordinates, size.ball_ball = 8 + 6 * m.d.balls, m.d.balls
    interior.set_weights(m)
    ring.append_bending(math.inf, m)
    return missing(words, CONSTANTS)


@kernel
def start(words):
    """Ring and balls at rest, the first ball at its angle; words: the memory, in 8-byte words."""
    m = words.view(MEMORY)[0]
    space.take_spatial_inputs(m.q, m)
    gaps.start_gaps(m)
    interior.place_bodies(m.q, m)
    state_constants(m)
    m.s.kick = m.s.drift = m.s.lately = 0.0
    seat.begin(space.SPATIAL, react, report, m)
    fill_accounts(m)
    space_outputs.watch_contacts(m.time, m.o.neighbours, m)
    m.s.kick = m.s.drift = 0.5 * m.d.micro_step


@kernel
def integrate(m, work, span):
    """Advance m.q by `span` (s); work: (8, m.n) or wider. As `seat.integrate`."""
    if m.d.micro_step > 0.0:
        return leapfrog_in_space(rhs, drift, _fastest, kicked, observe, m, work, span)
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
    name="angular_cageless",
    title="Detailed cageless touchdown bearing in space",
    about="Full-complement angular contact bearing, single or in pairs, with every ball a body in space",
    parameters=Parameters,
    inputs=space.SpatialInputs,
    outputs=Outputs,
    derived=SpaceDerived,
    hidden=Hidden,
    memory=MEMORY,
    derive=derive,
    start=start,
    advance=advance,
    effects=gaps.EFFECTS,
    advance_without=_advance_as_built,
    problems=PROBLEMS,
    instant=instant,
    starts_from=space_parts.space_starts_from("ball_ball"),
)
