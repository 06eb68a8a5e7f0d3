"""How a scene is to be run: [run] of its file."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from touchdown.master.common.errors import TouchdownError
from touchdown.master.common.units import to_si
from touchdown.master.scene.schemes import DEFAULT, SCHEMES, Scheme, scheme
from touchdown.master.scene.tables import beginnings, refuse_unknown, switch, whole

RUN_UNITS = {
    "duration": "s",
    "macro_step": "s",
    "tolerance": "m",
    "record_every": "1",
    "warn_residual": "1",
    "stop_residual": "1",
}


@dataclass(frozen=True)
class RunSpec:
    """How to run."""

    duration: float = 1.0  # s, from the scene's zero
    macro_step: float = 2e-5  # s
    scheme: Scheme = SCHEMES[DEFAULT]
    tolerance: float = 1e-10  # m, of the interface per macro step, for schemes that repeat or divide it
    record_every: int = 5  # macro steps
    record: tuple[str, ...] = ()  # beginnings of COMPONENT.VARIABLE that are recorded; none: all
    record_arrays: bool = False  # also elements of arrays, such as single balls; else only at the end
    warn_residual: float = 1e-3  # ledger over energy scale: say so
    stop_residual: float = 0.1  # ledger over energy scale: stop


def with_changes(run: RunSpec, changes: Mapping[str, object]) -> RunSpec:
    """A copy with the keys of [run] in `changes` set; raises TouchdownError for what cannot be."""
    refuse_unknown(changes, ("scheme", "record", "record_arrays", *RUN_UNITS), "[run]")
    values: dict[str, Any] = {}
    for key, value in changes.items():
        if key == "scheme":
            values[key] = value if isinstance(value, Scheme) else scheme(str(value))
            continue
        if key == "record_arrays":
            values[key] = switch(value, f"run.{key}")
            continue
        if key == "record":
            values[key] = beginnings(value)
            continue
        number = to_si(value, RUN_UNITS[key], f"run.{key}")
        if number <= 0.0 or not math.isfinite(number):
            raise TouchdownError(f"run.{key} = {value} must be above 0")
        if key == "record_every":
            number = whole(value, f"run.{key}")
        values[key] = number
    return replace(run, **values)
