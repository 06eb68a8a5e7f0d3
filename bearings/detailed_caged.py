"""Detailed touchdown bearing with a cage: balls and cage as bodies (sections 2.2, 2.3, 4.3 of the source).

Inner ring, balls and cage have three coordinates each, the outer ring has the housing's two, its rotation
is fixed: with nine balls 36 coordinates and one constraint. Contacts: journal and ring, ball and inner
race, ball and outer race, ball and cage. The rotation of the outer ring is eliminated; see
`bearings.rolling.bodies.augmented` for the form with a Lagrange multiplier.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from touchdown.bearings import seat
from touchdown.bearings.contact.friction import FrictionLaw, prepared
from touchdown.bearings.contact.laws import ContactLaw, abreast, damped
from touchdown.bearings.contact.proportion import out_of_proportion
from touchdown.bearings.rolling import ring
from touchdown.bearings.rolling.ball_state import MOST_STATES
from touchdown.bearings.rolling.balls import MOST_BALLS, BallContacts, Coordinates
from touchdown.bearings.rolling.bodies import cage, outputs
from touchdown.bearings.rolling.bodies.declarations import (
    BallBodiesDerived,
    BallBodiesMemory,
    BallBodiesOutputs,
    BallBodiesParameters,
    derived,
    problem,
)
from touchdown.bearings.rolling.bodies.races import press_races, rub_races
from touchdown.bearings.rolling.bodies.state import (
    ball_weights,
    drift,
    fastest,
    place,
    ring_weights,
)
from touchdown.bearings.rolling.declarations import starts_from, state_constants
from touchdown.bearings.rolling.micro_step import book, leapfrog
from touchdown.bearings.rolling.side import stored
from touchdown.modelkit.integrators import dopri
from touchdown.modelkit.kernel import kernel
from touchdown.modelkit.model import Model
from touchdown.modelkit.ports import Load
from touchdown.modelkit.variables import array, group, real


@dataclass(frozen=True)
class Parameters(BallBodiesParameters):
    """Defaults: SKF 6004 under the disk of section 4.3."""

    cage: cage.CageBody = group(cage.CageBody)
    cage_contact: ContactLaw = group(ContactLaw, stiffness=1e8)
    cage_friction: FrictionLaw = group(FrictionLaw, static=0.03, dynamic=0.02)


@dataclass(frozen=True)
class Speeds(ring.RaceSpeeds):
    """Circumferential speeds that agree where nothing slips (4.2; the source's Fig 26)."""

    cage: float = real(0.0, "m/s", "circumferential speed of the cage on the pitch circle", local=True)
    orbit: float = real(0.0, "m/s", "mean speed of the balls along the pitch circle", local=True)
    ball: float = real(0.0, "m/s", "mean circumferential speed of the balls by their spin", local=True)


@dataclass(frozen=True)
class Outputs(BallBodiesOutputs):
    """Loads, and what to know of the inside."""

    cage: cage.CageReport = group(cage.CageReport)
    pockets: BallContacts = group(BallContacts)
    speed: Speeds = group(Speeds)


@dataclass(frozen=True)
class Derived(BallBodiesDerived):
    """What parameters fix."""

    cage_contact: ContactLaw = group(ContactLaw)
    cage_friction: FrictionLaw = group(FrictionLaw)
    cage_inertia: float = real(0.0, "kg.m2", "of the cage")
    pocket_x: tuple = array(MOST_BALLS)  # from the cage's centre, at the start
    pocket_y: tuple = array(MOST_BALLS)


MEMORY = seat.bearing_memory(Parameters, Outputs, MOST_STATES, derived=Derived, hidden=BallBodiesMemory)
SCRATCH = dopri.scratch_layout(MOST_STATES + seat.ROOM)


@kernel
def react(t, q, dq, m):
    """Derivative dq of ring, balls and cage in q, and the `Load` (N, N m) on journal and housing."""
    press_races(q, dq, m)
    cage.pocket_contacts(q, dq, m)
    j, inner, outer = rub_races(q, dq, m)
    ring.accelerate(q, dq, m, j, inner)
    dq[ring.LOSS] = j.loss + inner.loss + outer.loss + cage.rubbing(q, dq, m)
    return Load(j.fx, j.fy, j.journal_moment, outer.fx, outer.fy)


@kernel
def rhs(t, q, dq, m):
    """Derivative dq (m.n,) of everything the bearing integrates, t (s) into the macro step."""
    load = react(t, q, dq, m)
    seat.copy_rates(t, q, dq, m, m.half, load)
    book(dq, load, m)


@kernel
def observe(t, q, m):
    """Peaks and events, after each accepted micro-step, t (s) into the macro step."""
    ring.watch(t, q, m)
    outputs.watch(m.time + t, m, m.o.pockets)


@kernel
def report(q, m):
    """Outputs wanted once per macro step, from the state q (m.n,)."""
    p, o, count = m.p, m.o, m.p.balls.count
    ring.report(q, m, m.d.inner_radius)
    kinetic, potential = outputs.report(q, m, neighbours=False)
    outputs.state_contacts(o.pockets, m.s.side, m)
    of_cage, weight = cage.report(q, m)
    in_sides = stored(m.s.side, m.d.cage_contact, count)
    ring.report_energy(q, m, kinetic + of_cage, potential + weight + in_sides, p.ring.inertia)


@kernel
def start(words):
    """Ring, balls and cage at rest, the first ball at its angle; words: the memory, in 8-byte words."""
    m = words.view(MEMORY)[0]
    seat.take_inputs(m.q, m)
    ring.place(m.q, m.d.rest_x, m.d.rest_y)
    place(m.q, m)
    cage.place(m.q, m)
    m.s.kick = 0.5 * m.d.micro_step
    state_constants(m)
    seat.begin(react, report, m)


@kernel
def integrate(m, work, span):
    """Advance m.q by `span` (s); work: (8, m.n) or wider. As `seat.integrate`."""
    if m.d.micro_step > 0.0:
        return leapfrog(rhs, drift, fastest, observe, m, work, span)
    return seat.integrate(rhs, observe, m, work, span)


@kernel
def instant(t, q, dq, m):
    """Derivative dq (m.n,) and load in m.o (N, N m) under the motion m.u, friction as it stands."""
    m.s.kick = 0.0
    seat.instant(react, t, q, dq, m)


@kernel
def advance(words, work, time, step):
    """One macro step of `step` (s) from `time` (s); returns a status."""
    rows = work.ravel().view(SCRATCH)[0].rows
    m = words.view(MEMORY)[0]
    return seat.advance(react, integrate, report, words, m, rows, time, step)


def derive(p: Parameters) -> Derived:
    """Stiffness and masses from geometry, and where everything starts."""
    b = p.balls
    unused = [0.0] * (MOST_BALLS - b.count)
    inertia = p.cage.inertia or p.cage.mass * b.pitch_radius**2
    of_cage = 1.0 / p.cage.mass + b.pitch_radius**2 / inertia
    side = abreast(p.cage_contact, b.rows)
    fields = derived(p, side, min(b.ball_mass, p.cage.mass))
    return Derived(
        **fields,  # type: ignore[arg-type]
        cage_contact=damped(side, min(b.ball_mass, p.cage.mass)),
        cage_friction=prepared(p.cage_friction),
        cage_inertia=inertia,
        cage_answer=of_cage,
        size=Coordinates(
            coordinates=9 + 3 * b.count,
            constraints=1,
            ball_cage=b.count,
            ball_outer=b.count,
            ball_inner=b.count,
        ),
        pocket_x=tuple([b.pitch_radius * math.cos(a) for a in b.angles()] + unused),
        pocket_y=tuple([b.pitch_radius * math.sin(a) for a in b.angles()] + unused),
    )


def check(p: Parameters) -> str | None:
    """What is wrong between the parameters."""
    if p.cage.clearance < 0.0:
        pocket = p.balls.diameter + 2.0 * p.cage.clearance
        return (
            f"cage.clearance = {p.cage.clearance:g} m makes a pocket of {pocket:g} m, smaller than its "
            f"ball of {p.balls.diameter:g} m; it must be at least 0 m"
        )
    pocket = out_of_proportion(
        "cage.clearance", p.cage.clearance, "half of balls.diameter", p.balls.ball_radius
    )
    return pocket or problem(p, "cage_friction")


def weights(p: Parameters) -> np.ndarray:
    """Error weights of the state."""
    return seat.weights(ring_weights(p) + ball_weights(p.balls.count) + cage.cage_weights(p.balls))


MODEL = Model(
    name="detailed_caged",
    title="Detailed caged touchdown bearing",
    about="Ball bearing with every ball and the cage a body of its own",
    parameters=Parameters,
    inputs=seat.BearingInputs,
    outputs=Outputs,
    derived=Derived,
    hidden=BallBodiesMemory,
    memory=MEMORY,
    start=start,
    advance=advance,
    weights=weights,
    derive=derive,
    check=check,
    instant=instant,
    starts_from=starts_from("coordinates", "ball_cage", "ball_outer", "ball_inner"),
)
