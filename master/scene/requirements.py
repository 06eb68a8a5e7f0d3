"""Requirements of a scene: limits of figures of its summary."""

from __future__ import annotations

import math
from typing import NamedTuple

from ...modelkit.reader import Table, number


class Kind(NamedTuple):
    """A requirement by its figure: all figures of the summary whose names begin with `figure` count."""

    figure: str
    unit: str  # SI, of the limit
    factor: float  # limit over figure
    at_least: bool  # else at most
    meaning: str
    size: tuple[float, float] = (0.0, math.inf)  # SI, of a limit that can be meant
    example: str = ""


KINDS = {
    "least_gap": Kind("least_gap_um", "m", 1e-6, True, "least gap left", (0.0, 0.02), "20 um"),
    "contact_force": Kind("peak_contact_force_N", "N", 1.0, False, "largest contact force"),
    "ball_force": Kind("peak_ball_force_N", "N", 1.0, False, "largest ball force"),
    "ball_pressure": Kind(
        "largest_ball_pressure_GPa", "Pa", 1e9, False, "largest pressure on a race", (1e6, 1e11), "4 GPa"
    ),
    "static_safety": Kind("lowest_static_safety", "1", 1.0, True, "lowest static safety"),
    "drops": Kind("drops_until_fatigue", "1", 1.0, True, "drops until fatigue"),
    "settling_time": Kind("settling_time_s", "s", 1.0, False, "settling time"),
    "stroke": Kind(
        "housing_stroke_um", "m", 1e-6, False, "largest stroke of a housing", (0.0, 0.02), "100 um"
    ),
    "heat": Kind("bearing_heat_J", "J", 1.0, False, "heat in a bearing"),
    "temperature": Kind(
        "largest_temperature_rise_K", "K", 1.0, False, "largest temperature rise in a bearing"
    ),
    "whirl_turns": Kind("whirl_", "1", 1.0, False, "turns of the longest whirl"),
}


class Requirement(NamedTuple):
    """A limit; `kind` is its name in `KINDS`."""

    kind: str
    limit: float  # SI


def requirements(given: Table) -> tuple[Requirement, ...]:
    """The [requirements] of a scene. Raises TouchdownError."""
    given.only((*KINDS,))
    limits = {
        name: number(kind.unit, minimum=0.0, size=kind.size, example=kind.example)
        for name, kind in KINDS.items()
    }
    return tuple(Requirement(name, given.get(name, limits[name])) for name in given.values)
