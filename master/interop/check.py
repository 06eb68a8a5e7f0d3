"""Check an FMU: whether it is valid, which role it can take, whether it runs, and runs like its model."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np
from fmpy.validation import validate_fmu

from ...modelkit.model import Model
from ...modelkit.variables import Causality
from ..common.errors import TouchdownError
from ..common.interrupts import interrupts_noted
from ..components.attributes import ignored, mend
from ..components.component import NUMBERS, Component
from ..components.description import DESCRIPTION, made_by_pythonfmu, read_xml
from ..components.fmu import ArchivedFmu
from ..components.loading import Stepping, foreign, load_component
from ..scene.run_spec import CALL_TIMEOUT
from . import controller_response, twin
from .bearing_response import press_journal
from .contract import BEARING, CONTROLLER, ROLES, CheckReport, check_ports, check_role, port_sides
from .host_needs import advice

DRY_RUN_STEPS, DRY_RUN_STEP = 10, 1e-5  # s, of FMUs that propose none
DRY_RUN_SPEED = 1e-3  # m/s, of what a bearing holds
DRY_RUN_FORCE = 1e-2  # N, on a body
UNLISTED = "ModelStructure/InitialUnknowns does not contain"  # fmpy's words


def check_fmu(
    name: str,
    role: str | None = None,
    names: Mapping[str, str] | None = None,
    call_timeout: float = CALL_TIMEOUT,
    sample_time: float = 0.0,
) -> CheckReport:
    """Check the FMU at a path, or one of the project's own by name.

    With a role ("bearing", "rotor", "amb", "housing", "controller"), whether it can stand in for one;
    `names` gives its names of the contract's variables. A third-party FMU is stepped in a separate
    process; each call may take `call_timeout` (s). A controller receives a position every
    `sample_time` (s; 0: by the step that it states, or `controller_response.PERIOD`). Raises TouchdownError
    where the FMU is missing, damaged, or cannot be co-simulated here.
    """
    with interrupts_noted() as interrupted:  # raised in an FMU, Ctrl-C would be a failure of it
        try:
            return _checked(name, role, names or {}, Stepping(call_timeout=call_timeout), sample_time)
        finally:
            if interrupted.is_set():
                raise KeyboardInterrupt


def _checked(
    name: str, role: str | None, names: Mapping[str, str], stepping: Stepping, sample_time: float
) -> CheckReport:
    component = load_component("checked", name, stepping=stepping)
    assert isinstance(component, ArchivedFmu)
    report = CheckReport(name)
    try:
        component.rename(names)
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
        _press(name, names, stepping, report)
    if role == CONTROLLER and not report.problems:
        controller_response.move_axes(lambda: _renamed(name, names, stepping), period, report)
    model = twin.model_of(component)
    if model is not None and not report.problems:
        _compare(name, model, stepping, report)
    if foreign(name) and made_by_pythonfmu(component.description):
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


def _press(name: str, names: Mapping[str, str], stepping: Stepping, report: CheckReport) -> None:
    """Press the journal of a new instance of a bearing."""
    component = _renamed(name, names, stepping)
    try:
        press_journal(component, report)
    finally:
        component.close()


def _check_validity(component: ArchivedFmu, role: str | None, report: CheckReport) -> None:
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
    if component.tool:
        report.lines.append(f"it needs {component.tool} on the machine (needsExecutionTool)")
    root = read_xml(component.folder / DESCRIPTION)
    report.lines += [f"read all the same: {line}" for line in mend(root)]
    report.lines += ignored(root)
    if optional:
        report.lines.append(
            "it lists no InitialUnknowns, so tools cannot tell what its first outputs follow from"
        )


def _compare(name: str, model: Model, stepping: Stepping, report: CheckReport) -> None:
    """Run a new instance of a project's FMU beside its model."""
    component = load_component("checked", name, stepping=stepping)
    try:
        assert isinstance(component, ArchivedFmu)
        twin.compare_with_model(component, model, report)
    finally:
        component.close()


def _dry_run(component: ArchivedFmu, report: CheckReport) -> None:
    """A few steps from the defaults, set as such, under small motions and loads: outputs are finite."""
    outputs = [
        v.name
        for v in component.variables.values()
        if v.causality is Causality.OUTPUT and v.kind in NUMBERS
    ]
    step = component.inner_step or component.made_for_step or DRY_RUN_STEP
    constant = component.declared_constant
    settable = [
        v
        for v in component.variables.values()
        if v.settable and v.start is not None and v.causality in (Causality.PARAMETER, Causality.INPUT)
    ]
    fed = [f"{port}.{suffix}" for port in port_sides(component) for suffix in ("y", "vy", "fy")]
    fed = [
        n for n in fed if n in component.variables and component.variable(n).causality is Causality.INPUT
    ]
    try:
        component.set({v.name: v.start for v in settable if v.start is not None})
        component.bind(fed, np.zeros(0), [])
        stop = component.stop_time or DRY_RUN_STEPS * step
        step = min(step, stop)
        steps = min(DRY_RUN_STEPS, int(stop / step + 1e-9))
        component.enter(0.0, stop)
        component.exit()
        wrong = _not_finite(component, outputs)
        before = component.read(constant)
        for k in range(steps):
            time = k * step
            small = {"y": -DRY_RUN_SPEED * time, "vy": -DRY_RUN_SPEED, "fy": DRY_RUN_FORCE}
            component.inputs[:] = [small[name.rpartition(".")[2]] for name in fed]
            component.push()
            component.step(time, step)
            wrong |= _not_finite(component, outputs)
    except TouchdownError as error:
        report.problems.append(f"dry run: {error}")
        return
    if wrong:
        report.problems.append(f"dry run: {', '.join(wrong)} not finite")
    else:
        report.lines.append(f"dry run: {steps} steps of {step:g} s, outputs finite")
    report.lines += [
        f"{name} is declared constant and changes: it is exchanged at every step"
        for name, first, last in zip(constant, before, component.read(constant), strict=True)
        if first != last
    ]


def _not_finite(component: Component, names: Sequence[str]) -> dict[str, None]:
    """Those of `names` whose values are not finite; a dictionary keeps their order."""
    values = zip(names, component.read(names), strict=True)
    return {name: None for name, value in values if not math.isfinite(value)}
