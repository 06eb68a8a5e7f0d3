"""Check an FMU: is it valid, what can it stand in for, does it run, and as its model."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np
from fmpy.validation import validate_fmu

from ...modelkit.model import Model
from ...modelkit.variables import Causality
from ..common.errors import TouchdownError
from ..components.component import NUMBERS, Component
from ..components.description import by_pythonfmu
from ..components.fmu import ArchivedFmu
from ..components.loading import Stepping, foreign, load_component
from ..scene.run_spec import CALL_TIMEOUT
from . import controller_response, twin
from .bearing_response import press
from .contract import BEARING, CONTROLLER, ROLES, Report, check_ports, check_role, ports
from .host import advice

DRY_RUN_STEPS, DRY_RUN_STEP = 10, 1e-5
DRY_RUN_SPEED = 1e-3  # m/s, of what a bearing holds
DRY_RUN_FORCE = 1e-2  # N, on a body
UNLISTED = "ModelStructure/InitialUnknowns does not contain"  # fmpy's words


def check_fmu(
    name: str,
    role: str | None = None,
    names: Mapping[str, str] | None = None,
    call_timeout: float = CALL_TIMEOUT,
    sample_time: float = 0.0,
) -> Report:
    """Check the FMU at a path, or one of the project's own by name.

    With a role ("bearing", "rotor", "amb", "housing", "controller"), whether it can stand in for one;
    `names` gives what it calls the variables of the contract. One that is none of the project's is stepped
    in a process of its own; each call may take `call_timeout` (s). A controller is told a position every
    `sample_time` (s; 0: by the step that it states, or `controller_response.PERIOD`). Raises TouchdownError
    where there is nothing to check (missing, damaged, no co-simulation here).
    """
    stepping = Stepping(call_timeout=call_timeout)
    component = load_component("checked", name, stepping=stepping)
    assert isinstance(component, ArchivedFmu)
    report = Report(name)
    try:
        component.rename(names or {})
        _check_validity(component, role, report)
        check_ports(component, report)
        if role is not None:
            check_role(component, role, report)
        _dry_run(component, report)
    finally:
        period = sample_time or component.inner_step or controller_response.PERIOD
        problem = component.close()
    if problem:
        report.problems.append(f"at its end: {problem}")
    if role == BEARING and not report.problems:
        _press(name, names or {}, stepping, report)
    if role == CONTROLLER and not report.problems:
        controller_response.press(lambda: _renamed(name, names or {}, stepping), period, report)
    model = twin.model_of(component)
    if model is not None and not report.problems:
        _compare(name, model, stepping, report)
    if foreign(name) and by_pythonfmu(component.description):
        report.lines.append(f"made by pythonfmu, so its host is a Python program, or {advice()}")
    if role is not None:
        can = "cannot" if report.problems else "can"
        report.lines.append(f"it {can} stand in for {ROLES[role].title}")
    return report


def _renamed(name: str, names: Mapping[str, str], stepping: Stepping) -> Component:
    """An instance that calls its variables as the contract does."""
    component = load_component("checked", name, stepping=stepping)
    try:
        component.rename(names)
    except BaseException:
        component.close()
        raise
    return component


def _press(name: str, names: Mapping[str, str], stepping: Stepping, report: Report) -> None:
    """Press the journal of a bearing, in an instance of its own."""
    component = _renamed(name, names, stepping)
    try:
        press(component, report)
    finally:
        component.close()


def _check_validity(component: ArchivedFmu, role: str | None, report: Report) -> None:
    """The findings of fmpy: problems, or lines where this master does without it."""
    version = f"FMI {component.description.fmiVersion}"
    problems = validate_fmu(str(component.path))
    optional = [c for c in problems if c.startswith(UNLISTED) and not component.description.initialUnknowns]
    complaints = [complaint for complaint in problems if complaint not in optional]
    if not complaints:
        but = " but for its InitialUnknowns" if optional else ""
        report.lines.append(f"valid {version} for co-simulation{but}")
    elif role is None:
        report.problems += complaints
    else:  # what this master does not need
        report.lines += [f"not valid {version}: {complaint}" for complaint in complaints]
    if optional:
        report.lines.append(
            "it lists no InitialUnknowns, so tools cannot tell what its first outputs follow from"
        )


def _compare(name: str, model: Model, stepping: Stepping, report: Report) -> None:
    """Run an FMU of the project beside its model, in an instance of its own."""
    component = load_component("checked", name, stepping=stepping)
    try:
        assert isinstance(component, ArchivedFmu)
        twin.compare(component, model, report)
    finally:
        component.close()


def _dry_run(component: Component, report: Report) -> None:
    """A few steps from the defaults, set as such, under small motions and loads: outputs are finite."""
    outputs = [
        v.name
        for v in component.variables.values()
        if v.causality is Causality.OUTPUT and v.kind in NUMBERS
    ]
    settable = [v for v in component.variables.values() if v.settable and v.start is not None]
    fed = [f"{port}.{suffix}" for port in ports(component) for suffix in ("y", "vy", "fy")]
    fed = [
        n for n in fed if n in component.variables and component.variable(n).causality is Causality.INPUT
    ]
    try:
        component.set({v.name: v.start for v in settable if v.start is not None})
        component.bind(fed, np.zeros(0), [])
        component.enter(0.0)
        component.exit()
        wrong = _not_finite(component, outputs)
        for k in range(DRY_RUN_STEPS):
            time = k * DRY_RUN_STEP
            small = {"y": -DRY_RUN_SPEED * time, "vy": -DRY_RUN_SPEED, "fy": DRY_RUN_FORCE}
            component.inputs[:] = [small[name.rpartition(".")[2]] for name in fed]
            component.push()
            component.step(time, DRY_RUN_STEP)
            wrong |= _not_finite(component, outputs)
    except TouchdownError as error:
        report.problems.append(f"dry run: {error}")
        return
    if wrong:
        report.problems.append(f"dry run: {', '.join(wrong)} not finite")
    else:
        report.lines.append(f"dry run: {DRY_RUN_STEPS} steps of {DRY_RUN_STEP:g} s, outputs finite")


def _not_finite(component: Component, names: Sequence[str]) -> dict[str, None]:
    """Which of `names` are no finite numbers now; a dictionary keeps their order."""
    values = zip(names, component.read(names), strict=True)
    return {name: None for name, value in values if not math.isfinite(value)}
