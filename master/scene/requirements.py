"""Requirements of a scene: limits of quantities of its summary."""

from __future__ import annotations

import math
from typing import NamedTuple

from ...modelkit.reader import Table, number
from ..quantities import Quantity, named


class RequirementKind(NamedTuple):
    """A requirement by the quantity that it limits."""

    quantity: Quantity
    size: tuple[float, float] = (0.0, math.inf)  # SI, of a limit that can be meant
    example: str = ""


def _kind(key: str, size: tuple[float, float] = (0.0, math.inf), example: str = "") -> RequirementKind:
    return RequirementKind(named(key)[0], size, example)


KINDS = {
    "least_gap": _kind("least_gap", (0.0, 0.02), "20 um"),
    "contact_force": _kind("peak_contact_force"),
    "ball_force": _kind("peak_ball_force"),
    "ball_pressure": _kind("largest_ball_pressure", (1e6, 1e11), "4 GPa"),
    "static_safety": _kind("lowest_static_safety"),
    "drops": _kind("drops_until_fatigue"),
    "settling_time": _kind("settling_time"),  # of all bearings
    "stroke": _kind("housing_stroke", (0.0, 0.02), "100 um"),
    "heat": _kind("bearing_heat"),
    "temperature": _kind("largest_temperature_rise"),
    "contact_temperature": _kind("contact_temperature"),
    "whirl_turns": _kind("whirl_revolutions"),
}


class Requirement(NamedTuple):
    """A limit; `kind` is its name in `KINDS`."""

    kind: str
    limit: float  # SI


def read_requirements(table: Table) -> tuple[Requirement, ...]:
    """The [requirements] of a scene. Raises TouchdownError."""
    table.only((*KINDS,))
    limits = {
        name: number(kind.quantity.unit, minimum=0.0, size=kind.size, example=kind.example)
        for name, kind in KINDS.items()
    }
    return tuple(Requirement(name, table.get(name, limits[name])) for name in table.values)
