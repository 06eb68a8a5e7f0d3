"""Stresses of a flexible rotor as figures of a run: the largest ones, and those at the kept instant.

The largest are resultants of both planes. The kept instant's are apart for the horizontal (x) and the
vertical plane (y), largest absolute values over all nodes: the columns of Table 4 of the source.
"""

from __future__ import annotations

import re

from ..coupling.simulation import Outcome
from .final_state import ReadableComponent, ReadableSystem

MPA = 1e-6
KINDS = ("bending", "shear")
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


def stress_figures(system: ReadableSystem, outcome: Outcome) -> dict[str, object]:
    """Figures of all components that report stresses; None where there was no stress."""
    names = stressed(system)
    figures: dict[str, object] = {}
    for name in names:
        tail = f"_{name}" if len(names) > 1 else ""
        component = system.components[name]
        own = _peaks(component, outcome.zero) | _kept_stresses(component, outcome.zero)
        figures |= {f"{key}{tail}": value for key, value in own.items()}
    return figures


def _peaks(component: ReadableComponent, zero: float) -> dict[str, object]:
    figures: dict[str, object] = {}
    for kind in KINDS:
        names = [f"stress.peak_{kind}{tail}" for tail in ("", "_node", "_time")]
        keys = [f"peak_{kind}_stress{tail}" for tail in ("_MPa", "_node", "_time_s")]
        if not all(name in component.variables for name in names):
            continue
        value, node, time = component.read(names)
        there = value > 0.0
        values = (MPA * value, node, time - zero) if there else (None, None, None)
        figures |= dict(zip(keys, values, strict=True))
    return figures


def _kept_stresses(component: ReadableComponent, zero: float) -> dict[str, object]:
    time = kept_instant(component)
    figures: dict[str, object] = {"kept_stress_time_s": None if time is None else time - zero}
    for kind in KINDS:
        for axis in "xy":
            key = f"kept_{kind}_{axis}"
            nodes, values = along(component, f"{kind}_{axis}")
            if time is None or not nodes:
                figures |= {f"{key}_MPa": None, f"{key}_node": None}
                continue
            value, node = max(zip(map(abs, values), nodes, strict=True), key=lambda pair: pair[0])
            figures |= {f"{key}_MPa": MPA * value, f"{key}_node": node}
    return figures
