"""Data of a machine's scene, derived from its rotor and its bearings by stated rules.

The rules are those of the scenes that come with the project, which are of real machines; each stands as a
comment beside its value in the scene that is written (`machine.scene_text`).
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from ...bearings.catalogue import Bearing
from ...bearings.catalogue.landing import landing
from ...bearings.contact.line import FROM_GEOMETRY
from ...master.common.errors import TouchdownError, one_of
from ...master.common.text import RPM
from ...master.scene.plausible import MAX_BORE_SPEED, SPEED_RATIO_LIMIT
from ...rotor.beams.shaft import Shaft
from ...rotor.modal.modes import RIGID_MODES, basis
from ...rotor.static_deflection import at_rest
from ..rotor.mode_error import ImpactSeat, ModeError, fewest_modes, impact_seat
from ..rotor.rotor_report import pulling

if TYPE_CHECKING:
    from ..loop.design import Tuned  # the loops, which most machines do without

GRAVITY = 9.81  # m/s2
LEVITATION_FREQUENCY = 2.0 * math.pi * 60.0  # rad/s, of the rotor's half on its magnetic bearing
LEVITATION_DAMPING = 0.3  # ratio
FORCE_LIMIT_RATIO = 6.0  # limit of a magnetic bearing's force over the static load
MU0 = 4e-7 * math.pi  # V s/(A m)
FLUX = 1.2  # T, where the iron of magnets saturates
POLE_ANGLE = math.pi / 8  # rad
CURRENT = 6.0  # A, limit of an amplifier
RESISTANCE = 0.5  # Ohm, of a coil
SWUNG = 2.0 * math.pi * 1000.0  # rad/s, at which an amplifier's voltage swings its current by the bias
MAX_SPEED_RATIO = 0.7  # speed over the first bending frequency
HOUSING_SHARE = 0.15  # housing over what it carries
MIN_HOUSING_MASS = 2.0  # kg
HOUSING_FREQUENCY = 2.0 * math.pi * 500.0  # rad/s
HOUSING_DAMPING = 0.2  # ratio
RING_DAMPING = 300.0  # N s/m, between the rings, as of a 6014
STEEL_LOSS = 0.12  # s/m


@dataclass(frozen=True)
class Support:
    """A magnetic or a touchdown bearing: its name, its place on the rotor, what it carries at rest."""

    component: str
    station: str
    load: float  # N, upwards on the rotor; negative: it would have to pull


@dataclass(frozen=True)
class MountFile:
    """Settings of a mount, from a file."""

    name: str  # of the file
    settings: Mapping[str, object]  # by variable


@dataclass(frozen=True)
class Magnets:
    """Of a magnetic bearing, and its amplifiers; SI.

    At the current limit the iron carries `FLUX`, and an axis pulls `reserve` times the load.
    """

    load: float  # on the one that carries most
    gap: float
    speed: float
    reserve: float

    @property
    def area(self) -> float:
        """Of a pole."""
        most = self.reserve * self.load
        return rounded(1.05 * MU0 * most / (FLUX**2 * math.cos(POLE_ANGLE)))  # rounding takes 5 % at most

    @property
    def turns(self) -> int:
        """Which make that flux in both gaps."""
        return math.floor(2.0 * FLUX * self.gap / (MU0 * CURRENT))

    @property
    def voltage(self) -> float:
        """Of the DC link, by `swung`."""
        linked = 0.5 * FLUX * self.turns * self.area
        return rounded(1.05 * (self.swung * linked + RESISTANCE * CURRENT))

    @property
    def swung(self) -> float:
        """Angular frequency (rad/s) at which it swings a coil's current by the bias."""
        return max(SWUNG, 2.0 * self.speed)


@dataclass(frozen=True)
class Levitation:
    """Magnets and the controller of all magnetic bearings."""

    magnets: Magnets
    period: float  # s, from sample to sample
    controller: Tuned | None  # None: still to be found
    sensors: tuple[str, ...]  # of the rotor, one for each bearing; none: they look at the journal
    about: tuple[str, ...] = ()  # how its loops are, a line each


@dataclass(frozen=True)
class Design:
    """A machine: all numbers in SI."""

    rotor: str  # the FMU's name, or the rotor's file
    title: str
    mass: float
    inertia: float | None  # of a rigid rotor
    modes: ModeError | None  # of a flexible one, per plane, and what they cost
    bending: float | None  # its first bending frequency, Hz
    speed: float
    clearance: float
    magnetic: tuple[Support, ...]
    touchdown: tuple[Support, ...]
    bearings: tuple[Bearing, ...]  # at each of `touchdown`
    presets: tuple[str, ...]  # what the scene calls them
    mount: str | MountFile | None = None  # what they sit in: a rule's name or a file; None: housings
    axial: str = (
        ""  # of `touchdown`, the component with faces for a shoulder; "": it keeps its place along z
    )
    inclination: float = 0.0  # of the +z end over the horizontal
    levitation: Levitation | None = None  # None: magnetic bearings are springs and dampers

    @property
    def carries(self) -> str:
        """A verb for what a bearing has of the weight."""
        return "would carry, lying," if self.inclination else "carries"

    @property
    def levitated_mass(self) -> float:
        """On the magnetic bearing that carries most (kg)."""
        return max(abs(support.load) for support in self.magnetic) / GRAVITY

    @property
    def landed_mass(self) -> float:
        """On the touchdown bearing that carries most (kg)."""
        return max(abs(support.load) for support in self.touchdown) / GRAVITY

    def notes(self) -> list[str]:
        """Notes for the user, one line each."""
        lines = pulling({f"at rest {s.component}": s.load for s in self.touchdown})
        for s, bearing in zip(self.touchdown, self.bearings, strict=True):
            if abs(s.load) > (limit := bearing.capacity().static):
                lines.append(
                    f"{s.component} carries {1e-3 * abs(s.load):.3g} kN at rest, more than the static "
                    f"rating of {bearing.designation}, C0 = {1e-3 * limit:.3g} kN"
                )
        usual = sensible_speed(self.bending, self.bearings)
        if self.speed > SPEED_RATIO_LIMIT * usual:
            lines.append(
                f"speed = {RPM * self.speed:.0f} rpm is more than such a machine runs "
                f"({RPM * usual:.0f} rpm by the rule)"
            )
        return lines


def supports(shaft: Shaft, prefix: str, stations: Sequence[str], option: str) -> tuple[Support, ...]:
    """Bearings at these stations of a rotor, and what each carries. Raises TouchdownError."""
    known = [station.name for station in shaft.stations]
    for name in stations:
        if name not in known:
            raise TouchdownError(
                f"{option} {name}: {shaft.title} has no such station; {one_of(name, known)}"
            )
    if not stations:
        raise TouchdownError(
            f"{shaft.title}: its file does not tell which stations are meant (levitated_at does); give "
            f"{option} and two of {', '.join(known) or 'its stations, of which there are none'}"
        )
    if len(stations) < 2 or len(set(stations)) != len(stations):
        raise TouchdownError(
            f"{option} {','.join(stations)}: name two stations of the rotor or more, each once; "
            f"there are: {', '.join(known) or 'none'}"
        )
    names = [f"{prefix}_{name.removeprefix(f'{prefix}_')}" for name in stations]
    if len(set(names)) != len(names):
        raise TouchdownError(
            f"{option} {','.join(stations)}: two bearings would be called {max(names, key=names.count)}; "
            "rename a station"
        )
    try:
        rest = at_rest(shaft, [(shaft.node(name), math.inf) for name in stations], GRAVITY)
    except TouchdownError as error:
        raise TouchdownError(f"{option} {','.join(stations)}: {error}") from None
    return tuple(
        Support(name, station, float(load))
        for name, station, load in zip(names, stations, rest.reactions, strict=True)
    )


def first_bending(shaft: Shaft) -> float:
    """The lowest bending frequency of the free rotor (Hz)."""
    return float(basis(shaft, 0).omega[RIGID_MODES]) / (2.0 * math.pi)


def kept_modes(
    shaft: Shaft, touchdown: Sequence[Support], bearings: Sequence[Bearing], clearance: float
) -> ModeError:
    """How many modes a machine's rotor keeps, by the first impact in its bearings, in housings by rule."""
    seats, carried = list[ImpactSeat](), max(abs(support.load) for support in touchdown)
    mass = max(HOUSING_SHARE * carried / GRAVITY, MIN_HOUSING_MASS)
    damping = 2.0 * HOUSING_DAMPING * mass * HOUSING_FREQUENCY
    for support, bearing in zip(touchdown, bearings, strict=True):
        hit = landing(bearing, clearance, abs(support.load) * clearance)
        values = {
            **bearing.settings(),
            "clearance": clearance,
            "journal_radius": 0.5 * bearing.bore - clearance,
            "contact.law": FROM_GEOMETRY,
            "contact.load": hit.load,
            "contact.dissipation": STEEL_LOSS,
            "balls.dissipation": STEEL_LOSS,
            "balls.expected_indentation": hit.indentation,
            "damping": bearing.damping or RING_DAMPING,
        }
        mount = (mass + bearing.outer_ring, mass * HOUSING_FREQUENCY**2, damping)
        seats.append(impact_seat(shaft.node(support.station), values, mount))
    return fewest_modes(shaft, seats)


def sensible_speed(bending: float | None, bearings: Sequence[Bearing]) -> float:
    """A speed (rad/s) below the first bending frequency (Hz) that ball bearings run, two digits of rpm."""
    fastest = MAX_BORE_SPEED / max(bearing.bore for bearing in bearings)
    below = math.inf if bending is None else MAX_SPEED_RATIO * bending * 60.0
    return rounded(min(below, fastest), down=True) / RPM


def rounded(value: float, down: bool = False) -> float:
    """To two digits; `down`: never above `value`."""
    if value == 0.0:
        return 0.0
    unit = 10.0 ** (math.floor(math.log10(abs(value))) - 1)
    digits = math.floor(value / unit + 1e-9) if down else round(value / unit)
    return float(f"{digits * unit:.12g}")
