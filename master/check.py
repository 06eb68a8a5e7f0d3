"""Check an FMU: is it valid, what can it stand in for, and does it run."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from pathlib import Path

from fmpy.validation import validate_fmu

from fmus.build import cached
from master.component import Component
from master.connections import LOAD, MOTION, NEEDED, SLOPE
from master.errors import TouchdownError
from master.fmi import FmuComponent
from master.library import locate
from modelkit.kernel import user_cache
from modelkit.ports import MODES

UNITS = {
    "x": "m", "y": "m", "vx": "m/s", "vy": "m/s", "ax_free": "m/s2", "ay_free": "m/s2", "inv_m": "1/kg",
    "omega": "rad/s", "alpha_free": "rad/s2", "inv_I": "1/(kg.m2)", "k_over_m": "1/s2", "c_over_m": "1/s",
    "fx": "N", "fy": "N", "mz": "N.m", "dfx": "N/s", "dfy": "N/s", "dmz": "N.m/s",
    "static_fx": "N", "static_fy": "N",
}  # fmt: skip
SPIN = ("omega", "alpha_free", "inv_I", "mz", "dmz")
STATIC = ("static_fx", "static_fy")
_MODE = {"bearing": "qx", "body": "x"}
MOUNT = ("k_over_m", "c_over_m")
DRY_RUN_STEPS, DRY_RUN_STEP = 10, 1e-5


@dataclass
class Report:
    """What was found out about an FMU."""

    name: str
    problems: list[str] = field(default_factory=list)
    lines: list[str] = field(default_factory=list)

    @property
    def text(self) -> str:
        """For people."""
        verdict = "passed" if not self.problems else f"{len(self.problems)} problem(s)"
        body = [f"  {line}" for line in self.lines] + [f"  problem: {p}" for p in self.problems]
        return "\n".join([f"{self.name}: {verdict}", *body])


def check_fmu(name: str) -> Report:
    """Check the FMU at a path, or one of the project's own by name.

    Raises TouchdownError where there is nothing to check (missing, damaged, no co-simulation here).
    """
    found = locate(name)
    path = found if isinstance(found, Path) else cached(found)
    component = FmuComponent("checked", path, user_cache())
    report = Report(name)
    try:
        found = validate_fmu(str(path))
        report.problems += found
        if not found:
            report.lines.append("valid FMI 2.0 for co-simulation")
        _check_ports(component, report)
        _dry_run(component, report)
    finally:
        component.close()
    return report


def ports(component: Component) -> dict[str, str]:
    """Ports by name and kind: a "bearing" takes motion and gives load, a "body" the other way round, a
    "sensor" takes motion only.
    """
    found: dict[str, str] = {}
    for variable in component.variables.values():
        port, _, suffix = variable.name.rpartition(".")
        if not port or port.endswith("]"):  # modes belong to their seat
            continue
        if variable.causality == "input" and suffix in NEEDED["motion"]:
            loaded = any(f"{port}.{load}" in component.variables for load in NEEDED["load"])
            found[port] = "bearing" if loaded else "sensor"
        elif variable.causality == "input" and suffix in NEEDED["load"]:
            found[port] = "body"
    return found


def _check_ports(component: Component, report: Report) -> None:
    found = ports(component)
    if not found:
        report.lines.append("no port of a bearing or a body: it can only be connected variable by variable")
    for port, side in found.items():
        if side == "sensor":
            report.lines.append(f"port {port}: of a sensor")
            continue
        takes, gives = (MOTION, LOAD + SLOPE) if side == "bearing" else (LOAD + SLOPE, MOTION)
        missing: list[str] = []
        for suffixes, causes in ((takes, ("input",)), (gives, ("output", "calculatedParameter"))):
            for suffix in suffixes:
                name = f"{port}.{suffix}"
                variable = component.variables.get(name)
                if variable is None:
                    missing.append(suffix)
                elif variable.causality not in causes:
                    text = f"{name} has the causality {variable.causality}, not {causes[0]}"
                    report.problems.append(text)
                elif variable.unit is not None and variable.unit != UNITS[suffix]:
                    report.problems.append(f"{name} is in {variable.unit}, not in {UNITS[suffix]}")
        needed = [s for s in (*NEEDED["motion"], *NEEDED["load"]) if s in missing]
        report.problems += [f"{port}.{suffix} is missing; no {side} works without it" for suffix in needed]
        spins = any(f"{port}.{suffix}" in component.variables for suffix in SPIN)
        rare = (*STATIC, *(MOUNT if spins else SPIN))
        optional = [s for s in missing if s not in needed and s not in rare]
        text = f"port {port}: of a {side}, {'seat of a journal' if spins else 'mount of a housing'}"
        modes = sum(f"{port}.mode[{k}].{_MODE[side]}" in component.variables for k in range(1, MODES + 1))
        text += f", with up to {modes} elastic modes" if modes else ""
        report.lines.append(text + (f"; without {', '.join(optional)}" if optional else ""))


def _dry_run(component: Component, report: Report) -> None:
    """A few steps from the defaults, set as such: outputs must be finite numbers."""
    outputs = [
        v.name
        for v in component.variables.values()
        if v.causality == "output" and v.kind in ("Real", "Integer")
    ]
    settable = [v for v in component.variables.values() if v.settable and v.start is not None]
    try:
        component.set({v.name: v.start for v in settable if v.start is not None})
        component.enter(0.0)
        component.exit()
        values = component.read(outputs)
        for k in range(DRY_RUN_STEPS):
            component.step(k * DRY_RUN_STEP, DRY_RUN_STEP)
            values = component.read(outputs)
    except TouchdownError as error:
        report.problems.append(f"dry run: {error}")
        return
    wrong = [n for n, value in zip(outputs, values, strict=True) if not math.isfinite(value)]
    if wrong:
        report.problems.append(f"dry run: {', '.join(wrong)} not finite")
    else:
        report.lines.append(f"dry run: {DRY_RUN_STEPS} steps of {DRY_RUN_STEP:g} s, outputs finite")
