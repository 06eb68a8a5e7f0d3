"""How the cases of the source's Table 4, rotor II, are read: what is assumed, and what else it could be.

Like is to be compared with like: a reading is how stresses are recovered, the friction law, the offsets and
the instant. What the source does not state is an assumption.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from touchdown.master.studies.dissertation.ensemble import SEATS
from touchdown.master.studies.dissertation.first_peak import BENDING, WAIT

Settings = Mapping[str, object]

SOURCE = {  # MPa, and whether it whirls
    "1": (8.76, 2.28, 0.59, 0.16, "no whirl"),
    "2": (7.68, 1.85, 0.55, 0.13, "no whirl"),
    "3a": (15.37, 9.83, 1.11, 0.84, "whirl"),
    "3b": (103.82, 24.42, 7.34, 1.68, "whirl"),
}
OTHER_ROTOR = Path(__file__).with_name("rotor_II_other.toml")


def both(variable: str, value: object) -> dict[str, object]:
    """A setting of both touchdown bearings."""
    return {f"bearing_{seat}.{variable}": value for seat in SEATS}


def offsets(a: float) -> dict[str, object]:
    """Bearing A off to one side by `a` (um), bearing B to the other."""
    return {"housing_A.x0": f"{a:g} um", "housing_B.x0": f"{-a:g} um"}


MODES_ALONE = {"rotor.modes": 10, "rotor.residual": 0, "rotor.stress.mode_acceleration": 0}
COULOMB = both("friction.kind", 0) | both("friction.static", 0.27) | both("friction.dynamic", 0.27)
AS_SOURCE = {**MODES_ALONE, **COULOMB}
ALL_FLEXIBILITY = {"rotor.residual": 1, "rotor.stress.mode_acceleration": 1}
WIDE = offsets(200.0)
DRAG = both("rolling.resistance", 0.12)
AS_PRINTED = both("friction.kind", 1) | both("friction.dynamic", 0.18)


@dataclass(frozen=True)
class Assumption:
    """Something the source does not state."""

    about: str
    settings: Settings
    because: str


ASSUMPTIONS = (
    Assumption(
        "stresses from ten modes per plane, without what loads do to the modes left out",
        MODES_ALONE,
        "sigma/tau of 14 to 15 in the source; all modes give another ratio (below)",
    ),
    Assumption(
        "friction of 0.27 at every sliding speed (printed: 0.27 static, 0.18 sliding)",
        COULOMB,
        "X over Y of 0.24 to 0.27 in the source's cases 1 and 2",
    ),
    Assumption(
        f"cases 1 and 2 at the first distinct peak: nothing exceeds it for {1e3 * WAIT:.2f} ms,\n"
        f"    half a period of the third bending mode; case 3 at the largest peak",
        {},
        '"right after the initial contact" and "at the end, when the rotor is whirling"',
    ),
    Assumption(
        "case 3: each bearing off by the total misalignment; case 2 as printed, half at each",
        WIDE,
        "as printed, nothing whirls in case 3 (below)",
    ),
    Assumption(
        "case 3b: a drag on the inner rings, 0.05 of the balls' loads times the pitch diameter",
        DRAG,
        "fitted to case 3b: without it the whirl does not grow (below)",
    ),
)


@dataclass(frozen=True)
class Reading:
    """One way to run and read a case."""

    label: str
    settings: Settings = field(default_factory=dict[str, object])
    first: bool = False  # stresses at the first distinct peak; else at the largest


READINGS: Mapping[str, Sequence[Reading]] = {  # the first is the source's
    "1": (Reading("as the source reads", AS_SOURCE, first=True), Reading("true")),
    "2": (Reading("as the source reads", AS_SOURCE, first=True), Reading("true")),
    "3a": (
        Reading("as the source reads", {**AS_SOURCE, **WIDE}),
        Reading("true, offsets as the source's reading", WIDE),
        Reading("true, offsets as printed"),
    ),
    "3b": (
        Reading("as the source reads", {**AS_SOURCE, **WIDE, **DRAG}),
        Reading("true, offsets and drag as the source's reading", {**WIDE, **DRAG}),
        Reading("true, offsets as printed, no drag"),
    ),
}


@dataclass(frozen=True)
class Change:
    """One thing changed in the source's reading of a case."""

    about: str
    settings: Settings = field(default_factory=dict[str, object])
    rotor: Path | None = None
    wait: float = WAIT  # s


AT_FIRST_PEAK: Mapping[str, Sequence[Change]] = {  # by case, in its source's reading
    "1": (
        Change("what loads do to the modes left out", ALL_FLEXIBILITY),
        Change("all modes", {"rotor.modes": 0}),
        Change("five modes", {"rotor.modes": 5}),
        Change("friction as printed, 0.27 and 0.18", AS_PRINTED),
        Change(
            f"a peak for {0.25e3 / BENDING[0]:.2f} ms, a quarter of the first mode's",
            wait=0.25 / BENDING[0],
        ),
        Change("ten times the contact's stiffness", both("contact.stiffness", 1.2e10)),
        Change("another geometry of equal mass and modes", rotor=OTHER_ROTOR),
        Change("bearing B preloaded by 5 um", {"bearing_B.balls.play": "-5 um"}),
        Change(
            "twice the support's stiffness", {"housing_A.stiffness": 134e6, "housing_B.stiffness": 74e6}
        ),
        Change("half of it", {"housing_A.stiffness": 33.5e6, "housing_B.stiffness": 18.5e6}),
    ),
    "2": (
        Change("each bearing off by the total", offsets(100.0)),
        Change("the same to the other sides", offsets(-100.0)),
    ),
}
AT_LARGEST: Mapping[str, Sequence[Change]] = {
    "3a": (
        Change("offsets as printed", offsets(-100.0)),
        Change("offsets to the other sides", offsets(-200.0)),
        Change("friction as printed, 0.27 and 0.18", AS_PRINTED),
        Change("the drag of case 3b", DRAG),
    ),
    "3b": [
        Change(f"rolling.resistance = {drag:g}", both("rolling.resistance", drag))
        for drag in (0.0, 0.06, 0.11, 0.13)
    ],
}
