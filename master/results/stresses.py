"""Stresses of a flexible rotor in a summary: the largest ones, and those at the kept instant.

The largest are resultants of both planes. The kept instant's are apart for the horizontal (x) and the
vertical plane (y), largest absolute values over all nodes: the columns of Halminen (2016), Table 4.
"""

from __future__ import annotations

import re

from ..coupling.simulation import Outcome
from ..quantities import PLANES, STRESSES, Owner, Summary, enter
from .final_state import ReadableComponent, ReadableSystem
from .first_impact import value_at
from .recording import Recording

STRESS_VARIABLE = "stress.peak_bending"  # a component with this variable reports stresses


def stressed(system: ReadableSystem) -> list[str]:
    """Names of the components that report stresses."""
    return [name for name, component in system.components.items() if STRESS_VARIABLE in component.variables]


def kept_instant(component: ReadableComponent) -> float | None:
    """When the stresses along the rotor were kept (s from the run's start); None where they never were."""
    if "stress.kept_time" not in component.variables:
        return None
    time = component.read(["stress.kept_time"])[0]
    return time if time > 0.0 else None


def along(component: ReadableComponent, variable: str) -> tuple[list[int], list[float]]:
    """Nodes, and the values there of one of their variables (SI)."""
    pattern = re.compile(rf"node\[(\d+)\]\.{re.escape(variable)}")
    names = {int(m[1]): m[0] for m in map(pattern.fullmatch, component.variables) if m}
    nodes = sorted(names)
    return nodes, component.read([names[node] for node in nodes]) if nodes else []


def add_stresses(
    summary: Summary, system: ReadableSystem, outcome: Outcome, first: int | None, recording: Recording
) -> None:
    """Add the stresses of all rotors that report them; None where there was no stress.

    first: the row of the recording at which the first impact is over; None: that cannot be told.
    """
    for name in stressed(system):
        component = system.components[name]
        values = _peaks(component, outcome.zero) | _kept_stresses(component, outcome.zero)
        for kind in STRESSES:
            peak = value_at(first, f"{name}.stress.peak_{kind}", recording)
            values[f"first_impact_{kind}_stress"] = peak
        enter(summary, values, Owner.COMPONENT, name)


def _peaks(component: ReadableComponent, zero: float) -> dict[str, object]:
    values: dict[str, object] = {}
    for kind in STRESSES:
        names = [f"stress.peak_{kind}{tail}" for tail in ("", "_node", "_time")]
        if not all(name in component.variables for name in names):
            continue
        value, node, time = component.read(names)
        found = (value, node, time - zero) if value > 0.0 else (None, None, None)
        keys = [f"peak_{kind}_stress{tail}" for tail in ("", "_node", "_time")]
        values |= dict(zip(keys, found, strict=True))
    return values


def _kept_stresses(component: ReadableComponent, zero: float) -> dict[str, object]:
    time = kept_instant(component)
    values: dict[str, object] = {"kept_stress_time": None if time is None else time - zero}
    for kind in STRESSES:
        for axis in PLANES:
            key = f"kept_{kind}_{axis}"
            nodes, found = along(component, f"{kind}_{axis}")
            if time is None or not nodes:
                values |= {key: None, f"{key}_node": None}
                continue
            value, node = max(zip(map(abs, found), nodes, strict=True), key=lambda pair: pair[0])
            values |= {key: value, f"{key}_node": node}
    return values
