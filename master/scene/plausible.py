"""Whether what a scene says can be a machine: what cannot is refused, what hardly can is said.

Each number may lie within its own bounds and make no machine beside the others, or be of another unit
than was meant. Each run looks at it once its components are set, before the first step.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from ..common.errors import TouchdownError
from ..common.text import MM, RPM, percent

MAX_BORE_SPEED = 1e3  # m rpm, bore times speed: what grease-lubricated ball bearings run
SPEED_RATIO_LIMIT = 1.5  # times the speed of a rule; above, it is said
WIDE_CLEARANCE = 0.1  # clearance over the journal's radius; usual is 0.01 to 0.03
MIN_BORE_FILL = 0.7  # of the bore that journal and clearance fill at least, where no sleeve is between
HIGH_FRICTION = 1.0  # coefficient of friction; steel on steel has 0.1 to 0.6
MAX_FRICTION = 5.0  # above which nothing rubs
BALLS = "balls."  # begins the names of what a ball bearing says of its balls
CONTACT_ANGLE = "balls.contact_angle"
FACES = ("shoulder.gap_minus", "shoulder.gap_plus")
# rows with a contact angle that carry a shaft pushed one way only: which way, and the same turned round
ONE_SIDED = {
    "single": (1.0, "single reversed"),
    "tandem": (1.0, "tandem reversed"),
    "single reversed": (-1.0, "single"),
    "tandem reversed": (-1.0, "tandem"),
}
WEIGHT_ALONG = 0.1  # m/s2; what a shaft out of level by half a degree feels
COEFFICIENTS = ("friction.dynamic", "friction.static")


@dataclass(frozen=True)
class PlausibleSeat:
    """A touchdown bearing and the journal that it is around; lengths in m."""

    bearing: str  # component
    values: Mapping[str, float]  # its parameters in SI, by name
    designation: str | None  # in the catalogue
    bore: float | None  # of that bearing
    body: str  # component that the journal is of
    speed: float | None  # rad/s, at the start
    bare_speed: bool = False  # whether it was given as a number without a unit
    gravity: float | None = None  # m/s2, of that body
    inclination: float | None = None  # rad, of that body's shaft
    axial: bool | None = None  # whether that body moves along its shaft; None: it cannot
    mass: float | None = None  # kg, of that body, where it says it
    thrusts: Sequence[float] = (0.0,)  # N, on that body towards +z, at each time that a thrust is given at
    arrangement: str = ""  # of the bearing's rows
    is_angled: bool = False  # whether that bearing of the catalogue is a pair with a contact angle

    @property
    def has_faces(self) -> bool:
        """Whether a shoulder of the body lands on it along the shaft."""
        return any(self.values.get(name, 0.0) > 0.0 for name in FACES)

    @property
    def pull(self) -> float:
        """Of gravity on the body along its shaft (m/s2), towards +z."""
        pull = -(self.gravity or 0.0) * math.sin(self.inclination or 0.0)
        return pull if abs(pull) > WEIGHT_ALONG else 0.0

    @property
    def width(self) -> float | None:
        """Diameter (m) that the rule of speed counts: the bore, or what the journal leaves to guess."""
        radius = self.values.get("journal_radius")
        return self.bore or (None if radius is None else 2.0 * radius)


def plausibility_warnings(seats: Iterable[PlausibleSeat]) -> list[str]:
    """Warnings about a machine before it runs, a line each.

    Raises TouchdownError for what cannot be.
    """
    every = list(seats)
    looks = (_family, _fit, _clearance, _friction, _speed, _weight)
    lines = [line for seat in every for look in looks for line in look(seat)]
    return list(dict.fromkeys((*lines, *_along(every))))


def _family(seat: PlausibleSeat) -> Iterable[str]:
    """Refuse a pair with a contact angle as the preset of a planar bearing."""
    if seat.is_angled and "balls.count" in seat.values and CONTACT_ANGLE not in seat.values:
        raise TouchdownError(
            f"{seat.bearing}.preset = {seat.designation} is a pair with a contact angle, and the bearing "
            f"is planar; set fmu = angular_simplified, or --swap {seat.bearing}=angular_simplified"
        )
    return ()


def _fit(seat: PlausibleSeat) -> Iterator[str]:
    """Of the journal in the bore."""
    radius, bore = seat.values.get("journal_radius"), seat.bore
    if radius is None or bore is None:
        return
    what = f"{seat.bearing}.journal_radius = {_mm(radius)}"
    if 2.0 * radius > bore:
        raise TouchdownError(
            f"{what}, a journal of {_mm(2.0 * radius)}, does not go into {seat.designation}, whose bore is "
            f"{_mm(bore)}; take a bearing with a wider bore (`touchdown catalogue` lists them), or set the "
            "radius of the journal that belongs to it"
        )
    filled = 2.0 * (radius + seat.values.get("clearance", 0.0))
    if filled < MIN_BORE_FILL * bore:
        yield (
            f"{what} and its clearance fill {_mm(filled)} of the bore of {seat.designation}, {_mm(bore)}; "
            "a sleeve is taken to fill the rest"
        )


def _clearance(seat: PlausibleSeat) -> Iterator[str]:
    radius, clearance = seat.values.get("journal_radius"), seat.values.get("clearance")
    if radius and clearance and clearance > WIDE_CLEARANCE * radius:
        yield (
            f"{seat.bearing}.clearance = {_mm(clearance)} is {percent(clearance / radius, 2)} of the "
            f"journal's radius of {_mm(radius)}, and most are 1 to 3 %; it is radial, and a number without "
            "a unit is in m"
        )


def _friction(seat: PlausibleSeat) -> Iterator[str]:
    for name in COEFFICIENTS:
        value = seat.values.get(name, 0.0)
        what = f"{seat.bearing}.{name} = {value:g}"
        if value > MAX_FRICTION:
            raise TouchdownError(
                f"{what} is not a coefficient of friction: steel on steel has 0.1 to 0.6; write "
                f'"{value:g} %" where per cent are meant'
            )
        if value > HIGH_FRICTION:
            yield f"{what} is implausibly high; steel on steel has 0.1 to 0.6"


def _speed(seat: PlausibleSeat) -> Iterator[str]:
    rolls = seat.bore is not None or any(name.startswith(BALLS) for name in seat.values)
    if not rolls or seat.speed is None or seat.width is None:
        return
    usual = MAX_BORE_SPEED / seat.width / RPM
    if abs(seat.speed) > SPEED_RATIO_LIMIT * usual:
        yield (
            f"{seat.body}.speed = {RPM * seat.speed:.0f} rpm is more than a bearing of {_mm(seat.width)} "
            f"bore runs ({RPM * usual:.0f} rpm by the rule of {MM * MAX_BORE_SPEED:,.0f} mm rpm)"
            f"{'; a number without a unit is in rad/s' if seat.bare_speed else ''}"
        )


def _weight(seat: PlausibleSeat) -> Iterator[str]:
    inclined = seat.inclination or 0.0
    if inclined != 0.0 and seat.axial is False:
        yield (
            f"the shaft of {seat.body} is inclined by {math.degrees(inclined):.4g} deg, and {seat.body} "
            "does not move along it, as if something held its weight along the shaft; set "
            f"{seat.body}.axial = 1"
        )
    elif seat.gravity == 0.0 and not seat.axial:
        remedy = f"; {seat.body}.axial = 1 lets it move along its shaft, too" if seat.axial is False else ""
        yield (
            f"{seat.body}.gravity = 0 m/s2: nothing presses {seat.body} into its bearings, and it does not "
            f"fall in the plane across its shaft{remedy}"
        )


def _along(seats: Sequence[PlausibleSeat]) -> Iterator[str]:
    """Lines on bodies that nothing carries along the shaft."""
    for body in dict.fromkeys(seat.body for seat in seats if seat.axial):
        mine = [seat for seat in seats if seat.body == body]
        if not any(seat.has_faces for seat in mine):
            able = [seat.bearing for seat in mine if FACES[0] in seat.values]
            remedy = (
                f"set {able[0]}.{FACES[0]} or {FACES[1]}"
                if able
                else "take a bearing with faces, such as landing_sleeve"
            )
            yield f"{body}.axial = 1: no bearing holds {body} along its shaft; {remedy}"
        else:
            yield from _weight_along(body, mine)
        yield from filter(None, map(_open_side, mine))
    for seat in seats:
        if seat.has_faces and not seat.axial:
            remedy = f"; set {seat.body}.axial = 1" if seat.axial is False else ""
            yield (
                f"{seat.bearing} has faces for a shoulder to land on, and {seat.body} does not move along "
                f"its shaft{remedy}"
            )


def _weight_along(body: str, mine: Sequence[PlausibleSeat]) -> Iterator[str]:
    """A warning that the weight of a `body` pulls it where none of its bearings, `mine`, has a face."""
    pull = mine[0].pull
    side = FACES[1] if pull > 0.0 else FACES[0]
    if pull != 0.0 and not any(seat.values.get(side, 0.0) > 0.0 for seat in mine):
        yield (
            f"the weight pulls {body} towards {'+z' if pull > 0.0 else '-z'}, where no bearing has a face; "
            f"set {next(seat.bearing for seat in mine if side in seat.values)}.{side}"
        )


def _open_side(seat: PlausibleSeat) -> str | None:
    """A warning that weight or thrust presses a shoulder to the side where the bearing's rows are open.

    Without the body's mass its weight counts alone, beside the thrusts.
    """
    if seat.arrangement not in ONE_SIDED or not seat.values.get(CONTACT_ANGLE):
        return None
    side, turned = ONE_SIDED[seat.arrangement]
    face, carried, to = (FACES[0], "+z", "-z") if side > 0.0 else (FACES[1], "-z", "+z")
    pushes = [thrust + (seat.mass or 0.0) * seat.pull for thrust in seat.thrusts]
    pushes += [] if seat.mass else [seat.pull]
    if min(side * push for push in pushes) >= 0.0 or not seat.values.get(face):
        return None
    return (
        f'{seat.bearing}.arrangement = "{seat.arrangement}" carries a shaft pushed in {carried} only, and '
        f"weight or thrust presses {seat.body} on to its face towards {to}, where the row has no shoulder; "
        f'set {seat.bearing}.arrangement = "{turned}", or take a pair back to back'
    )


class Heavy(NamedTuple):
    """A component that has weight."""

    name: str
    gravity: float  # m/s2
    inclination: float | None  # rad; None: it takes none


def weight_warnings(components: Iterable[Heavy]) -> Iterator[str]:
    """Where the components of one machine do not agree on which way is down, a line each."""
    every = [one for one in components if one.gravity != 0.0]
    inclined = [one for one in every if one.inclination]
    if not inclined:
        return
    first = inclined[0]
    angle = f"{math.degrees(first.inclination or 0.0):.4g} deg"
    for one in every:
        if one.inclination is None:
            yield (
                f"{one.name} takes no inclination, and its gravity of {one.gravity:.4g} m/s2 acts as if "
                f"the shaft lay; that of {first.name} is inclined by {angle}. Set {one.name}.gravity = 0 "
                "where its weight does not count"
            )
        elif one.inclination != first.inclination:
            inclination = f"{math.degrees(one.inclination):.4g} deg"
            yield (
                f"{one.name}.inclination is {inclination} and {first.name}.inclination is {angle}; one "
                f'machine has one: write inclination = "{angle}" in the scene, outside its tables'
            )
        elif one.gravity != first.gravity:
            yield (
                f"{one.name}.gravity = {one.gravity:.4g} m/s2 and {first.name}.gravity = "
                f"{first.gravity:.4g} m/s2 differ; they are sizes, which the inclination of {angle} turns"
            )


def _mm(length: float) -> str:
    return f"{MM * length:.4g} mm"
