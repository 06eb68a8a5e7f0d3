"""Declarations that bearings with balls as bodies in space share: parameters, outputs, memory."""

from __future__ import annotations

import math
from dataclasses import dataclass

from ....modelkit.gravity import gravity_along
from ....modelkit.kernel import kernel
from ....modelkit.variables import array, group, groups, integer, real
from ...contact import friction
from ...contact.face import has_face
from ...contact.friction import FrictionLaw
from ...contact.laws import ContactLaw, broadcast_law, damp, in_series
from ...contact.line import BoreContact
from ...contact.materials import elastic_of
from ...contact.peaks import PeakMemory
from ...rolling import declarations, ring
from ...rolling.ball_set import (
    BallContacts,
    FreeBallSet,
    ball_mass,
    inner_radius,
    set_race_law,
    solid_ball_inertia,
    start_angle,
)
from ...rolling.balls import place_balls
from ...rolling.bodies import HardestHit
from ...rolling.declarations import RollingDerived, RollingParameters
from ...rolling.micro_step import MICRO_STEP, RESOLUTION, refined, step_in_hit
from .. import arrangement
from ..angular_row import SINGLES, ball_rows, race_stiffness
from ..inner_ring import AngularBallSet, ContactAngle, SpatialMemory, SpatialOutputs, SpatialRing
from .half_step import SpaceKickMemory
from .memory_layout import ROOM
from .races import NOT_TOUCHING, BallGrooves, RaceContacts
from .rubbing import BallFriction
from .space_balls import SpaceBalls
from .space_ring import Six, Touches


@dataclass(frozen=True)
class FreeAngularBallSet(ContactAngle, FreeBallSet):
    """Balls without a cage, whose races they touch at an angle."""


@dataclass(frozen=True)
class SpaceParameters(arrangement.RowsParameters, RollingParameters):
    """Defaults: Koyo 6904 under the disk of section 4.3, as `detailed_cageless`."""

    contact: BoreContact = group(BoreContact, damping=1e7)
    balls: AngularBallSet = group(AngularBallSet)
    ring: SpatialRing = group(SpatialRing, mass=0.0095, inertia=1.08e-6)
    micro_step: float = real(
        MICRO_STEP,
        "s",
        "longest step inside, of the velocity Verlet method; shorter ones follow below the default; "
        "0: adaptive Dormand-Prince steps of the error interface.tolerance",
        minimum=0.0,
        maximum=1e-4,
    )
    race_friction: FrictionLaw = group(FrictionLaw)


@dataclass(frozen=True)
class SpaceBall:
    """One ball; rows one behind the other."""

    x: float = real(0.0, "m", "horizontal position", local=True)
    y: float = real(0.0, "m", "vertical position", local=True)
    z: float = real(0.0, "m", "position along the shaft", local=True)
    spin: float = real(0.0, "rad/s", "spin speed about the shaft's direction", local=True)
    inner: float = real(0.0, "N", "normal force of the inner race", local=True)
    outer: float = real(0.0, "N", "normal force of the outer race", local=True)
    side: float = real(0.0, "N", "normal force of the next ball, or of the cage", local=True)
    inner_angle: float = real(
        0.0,
        "rad",
        "contact angle at the inner race; positive where it carries a shaft pushed in +z",
        local=True,
    )
    outer_angle: float = real(0.0, "rad", "the same at the outer race", local=True)


@dataclass(frozen=True)
class SpaceAlongReport:
    """The ring along the shaft and its tilt, and contact angles."""

    z: float = real(0.0, "m", "position of the ring", local=True)
    vz: float = real(0.0, "m/s", "velocity of the ring", local=True)
    force: float = real(0.0, "N", "of the balls on the ring", local=True)
    rx: float = real(0.0, "rad", "tilt of the ring about x", local=True)
    ry: float = real(0.0, "rad", "tilt of the ring about y", local=True)
    contact_angle: float = real(0.0, "rad", "of the most loaded ball, at the inner race", local=True)
    outer_angle: float = real(0.0, "rad", "of that ball, at the outer race", local=True)


@dataclass(frozen=True)
class SpaceOutputs(SpatialOutputs):
    """Loads, and what to know of the inside."""

    ring: ring.RingReport = group(ring.RingReport)
    inner: BallContacts = group(BallContacts)
    outer: BallContacts = group(BallContacts)
    hardest: HardestHit = group(HardestHit)
    ball: tuple = groups(SpaceBall, ROOM)
    along: SpaceAlongReport = group(SpaceAlongReport)


@dataclass(frozen=True)
class SpaceDerived(RollingDerived):
    """Constants that follow from the parameters."""

    inner: ContactLaw = group(ContactLaw)
    outer: ContactLaw = group(ContactLaw)
    race_friction: FrictionLaw = group(FrictionLaw)
    side_contact: ContactLaw = group(ContactLaw)  # at the balls' sides: neighbours, or pockets
    side_friction: FrictionLaw = group(FrictionLaw)
    inner_groove: BallGrooves = group(BallGrooves)
    outer_groove: BallGrooves = group(BallGrooves)
    rows: int = integer(0, "rows of balls in the state")
    balls: int = integer(0, "balls in the state")
    abreast: float = real(1.0, "1", "balls side by side that are one, and share its force")
    mass: float = real(0.0, "kg", "of a ball, or of those side by side")
    inertia: float = real(0.0, "kg.m2", "of a ball, or of those side by side")
    ball_radius: float = real(0.0, "m", "of a ball")
    gravity_z: float = real(0.0, "m/s2", "gravity along the shaft, towards +z")
    transverse_inertia: float = real(0.0, "kg.m2", "of the ring about a diameter")
    micro_step: float = real(0.0, "s", "longest step inside")
    resolution: float = real(0.0, "rad", "of the fastest contact, longest step inside")
    x: tuple = array(ROOM)  # where the balls start, from the middle
    y: tuple = array(ROOM)
    z: tuple = array(ROOM)


@dataclass(frozen=True)
class SpaceMemory(SpatialMemory, SpaceKickMemory):
    """Memory between evaluations and steps."""

    balls: SpaceBalls = group(SpaceBalls)
    inner_groove: BallGrooves = group(BallGrooves)  # at present temperatures and spin
    inner: RaceContacts = group(RaceContacts)
    outer: RaceContacts = group(RaceContacts)
    friction: BallFriction = group(BallFriction)
    touches: Touches = group(Touches)
    six: Six = group(Six)
    along: float = real(0.0, "N", "of the balls on the ring, along the shaft")
    inner_peaks: PeakMemory = group(PeakMemory)
    outer_peaks: PeakMemory = group(PeakMemory)
    side_peaks: PeakMemory = group(PeakMemory)


STATIC = SpaceParameters().race_friction.static
ALIKE = len(
    declarations.rolling_problems("race_friction", "side")
)  # problems that bearings in the plane have, too
OWN = ALIKE + len(arrangement.PROBLEMS)


def space_problems(side: str) -> tuple[str, ...]:
    """Faults that `space_problem` may find; side: name of the friction law at the balls' sides."""
    return (
        *declarations.rolling_problems("race_friction", side),
        *arrangement.PROBLEMS,
        "ring.harmonics = {0:g} has the ring bend, which goes with balls in the plane; set it to 0",
    )


@kernel
def space_problem(p, crowded, side, usual, numbers):
    """The number in `space_problems` of a fault in the parameters p, or 0.

    crowded: 1 where more balls are admitted than fit; side: friction law at the balls' sides, a record, and
    `usual`, its static coefficient by default; numbers: of the message.
    """
    found = declarations.rolling_problem(p, crowded, numbers)
    found = declarations.law_problem(found, p.race_friction, STATIC, declarations.OWN, numbers)
    found = declarations.law_problem(found, side, usual, declarations.OWN + 2, numbers)
    if found != 0:
        return found
    found = arrangement.rows_problem(p, numbers)
    if found != 0:
        return ALIKE + found
    numbers[0] = p.ring.harmonics
    return OWN + 1 if p.ring.harmonics != 0 else 0


@kernel
def rows_as_one(p):
    """How many of the rows in p.balls.rows stand side by side as one in the state; p: parameters."""
    return p.balls.rows if p.arrangement in SINGLES else 1


@kernel
def row_ball_mass(p):
    """Mass (kg) of a ball of the state: of those side by side that are one; p: parameters."""
    return ball_mass(p.balls) * rows_as_one(p) / p.balls.rows


@kernel
def _derive_laws(side, rubbing, damped, m):
    """Set in m.d masses, and the laws of all contacts of the balls; as `derive`."""
    p, d, b = m.p, m.d, m.p.balls
    modelled = rows_as_one(p)
    d.abreast = modelled
    d.mass, d.ball_radius = row_ball_mass(p), 0.5 * b.diameter
    d.inertia = solid_ball_inertia(d.mass, b.diameter)
    for law, stiffness in ((d.inner, d.stiffness.inner), (d.outer, d.stiffness.outer)):
        set_race_law(law, b, stiffness, ball_mass(b), 1.0)
        broadcast_law(law, modelled / b.rows)
    d.race_friction, d.side_contact, d.side_friction = p.race_friction, side, rubbing
    broadcast_law(d.side_contact, modelled)
    damp(d.side_contact, damped)
    friction.derive(d.race_friction)
    friction.derive(d.side_friction)


@kernel
def _derive_grooves(m):
    """Set in m.d the grooves of all balls; behind the last one stands what touches nothing."""
    p, d, b = m.p, m.d, m.p.balls
    inner, outer = d.inner_groove, d.outer_groove
    conformity = b.outer_conformity if b.outer_conformity != 0.0 else b.conformity
    inner_arc, outer_arc = 0.5 * (b.conformity - 1.0) * b.diameter, 0.5 * (conformity - 1.0) * b.diameter
    clamped = p.preload, p.interference, 0.0
    first, second = ball_rows(
        b, elastic_of(p.ring), b.contact_angle, p.arrangement, p.row_distance, clamped
    )
    half = 0.5 * b.play if b.contact_angle == 0.0 else 0.0  # `row_of` has all of it at the inner race
    for k in range(ROOM):
        row = first if k < b.count else second
        inner.circle[k], outer.circle[k] = row.inner + half, row.outer + half
        inner.along[k], outer.along[k] = row.inner_at, row.outer_at
        inner.arc[k] = inner_arc if k < d.balls else NOT_TOUCHING
        outer.arc[k] = outer_arc if k < d.balls else NOT_TOUCHING


@kernel
def _place_balls(m, spread, reach):
    """Set where the balls start: on the lines between their grooves, where both contacts balance.

    spread, reach: as for `place_balls`, which places those without a contact angle.
    """
    d, b = m.d, m.p.balls
    for k in range(ROOM):
        d.x[k], d.y[k], d.z[k] = 0.5 * b.pitch_diameter, 0.0, 0.0
    if b.contact_angle == 0.0:
        place_balls(d, b, spread, reach)
        return
    inner, outer, s = d.inner_groove, d.outer_groove, d.stiffness
    share = (s.series / s.outer) ** (2.0 / 3.0)
    for k in range(d.balls):
        across, along = inner.circle[k] - outer.circle[k], inner.along[k] - outer.along[k]
        length = math.sqrt(across * across + along * along)
        depth = max(length - inner.arc[k] - outer.arc[k], 0.0)
        part = (outer.arc[k] + share * depth) / length
        angle = start_angle(b.first_angle, b.count, spread, k % b.count)
        radius = outer.circle[k] + part * across
        d.x[k], d.y[k], d.z[k] = (
            radius * math.cos(angle),
            radius * math.sin(angle),
            outer.along[k] + part * along,
        )


@kernel
def derive(m, spread, reach, side, rubbing, damped, lighter):
    """Set in m.d what parameters fix, but for a cage; spread, reach: as for `place_balls`.

    side, rubbing: laws of the contacts at the balls' sides, records; damped, lighter: masses (kg) that
    their damping ratio and the length of a hit are of.
    """
    p, d, b = m.p, m.d, m.p.balls
    declarations.derive(m, spread)
    d.gravity_z = gravity_along(p.gravity, p.inclination)
    rings = elastic_of(p.ring)
    d.stiffness.inner, d.stiffness.outer = race_stiffness(b, rings, b.contact_angle)
    d.stiffness.series = in_series(d.stiffness.inner, d.stiffness.outer)
    d.rows = 1 if p.arrangement in SINGLES else 2
    d.balls = d.rows * b.count
    d.inner_radius = inner_radius(b) - 0.5 * b.play
    transverse = p.ring.transverse_inertia
    d.transverse_inertia = transverse if transverse > 0.0 else 0.5 * p.ring.inertia
    if b.contact_angle > 0.0:  # no play lets the ring sink
        d.rest_x = d.rest_y = 0.0
    _derive_laws(side, rubbing, damped, m)
    _derive_grooves(m)
    _place_balls(m, spread, reach)
    d.micro_step = min(
        p.micro_step,
        step_in_hit(p.micro_step, d.contact, p.ring.mass),
        step_in_hit(p.micro_step, d.inner, d.mass),
        step_in_hit(p.micro_step, d.outer, d.mass),
        step_in_hit(p.micro_step, d.side_contact, lighter),
    )
    if has_face(p.shoulder):
        d.micro_step = min(d.micro_step, step_in_hit(p.micro_step, p.shoulder, p.ring.mass))
    d.resolution = refined(p.micro_step) * RESOLUTION
    size, count = d.size, d.balls
    size.constraints = 0
    size.ball_outer, size.ball_inner = count, count


def space_starts_from(side: str) -> dict[str, tuple[str, ...]]:
    """Initial dependencies of the outputs; side: what of `Coordinates` is counted at the balls' sides."""
    also = {"stiffness": ("balls.contact_angle",), "size": ("arrangement",)}
    known = declarations.starts_from("coordinates", side, "ball_outer", "ball_inner")
    return {name: (*parameters, *also.get(name.split(".")[0], ())) for name, parameters in known.items()}
