"""Requirements of a scene: limits of figures of its summary."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import NamedTuple

from ..common.errors import TouchdownError
from ..common.units import to_si
from .tables import refuse_unknown, table, without_unit


class Kind(NamedTuple):
    """A requirement by its figure: all figures of the summary whose names begin with `figure` count."""

    figure: str
    unit: str  # SI, of the limit
    factor: float  # limit over figure
    at_least: bool  # else at most
    meaning: str


KINDS = {
    "least_gap": Kind("least_gap_um", "m", 1e-6, True, "least gap left"),
    "contact_force": Kind("peak_contact_force_N", "N", 1.0, False, "largest contact force"),
    "ball_force": Kind("peak_ball_force_N", "N", 1.0, False, "largest ball force"),
    "ball_pressure": Kind("largest_ball_pressure_GPa", "Pa", 1e9, False, "largest pressure on a race"),
    "static_safety": Kind("lowest_static_safety", "1", 1.0, True, "lowest static safety"),
    "drops": Kind("drops_until_fatigue", "1", 1.0, True, "drops until fatigue"),
    "settling_time": Kind("settling_time_s", "s", 1.0, False, "settling time"),
    "stroke": Kind("housing_stroke_um", "m", 1e-6, False, "largest stroke of a housing"),
    "heat": Kind("bearing_heat_J", "J", 1.0, False, "heat in a bearing"),
    "temperature": Kind(
        "largest_temperature_rise_K", "K", 1.0, False, "largest temperature rise in a bearing"
    ),
    "whirl_turns": Kind("whirl_", "1", 1.0, False, "turns of the longest whirl"),
}


# limits in SI that can be meant, and one as it is written
PLAUSIBLE = {
    "least_gap": (0.0, 0.02, "20 um"),
    "stroke": (0.0, 0.02, "100 um"),
    "ball_pressure": (1e6, 1e11, "4 GPa"),
}


class Requirement(NamedTuple):
    """A limit; `kind` is its name in `KINDS`."""

    kind: str
    limit: float  # SI


def requirements(value: object, where: str) -> tuple[Requirement, ...]:
    """The [requirements] of a scene. Raises TouchdownError."""
    given: Mapping[str, object] = table(value, where)
    refuse_unknown(given, tuple(KINDS), where)
    return tuple(_requirement(name, limit, where) for name, limit in given.items())


def _requirement(name: str, value: object, where: str) -> Requirement:
    limit = to_si(value, KINDS[name].unit, f"{where} {name}")
    if limit < 0.0:
        raise TouchdownError(f"{where} {name} = {value} must not be below 0")
    least, most, example = PLAUSIBLE.get(name, (0.0, math.inf, ""))
    if limit != 0.0 and not least <= limit <= most:
        raise without_unit(f"{where} {name}", value, limit, KINDS[name].unit, example)
    return Requirement(name, limit)
