"""The contract as a check of a component: its ports, their variables and units, and the roles it can take.

docs/contract.md has the tables.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from enum import StrEnum

from ...modelkit.ports import MODES
from ...modelkit.variables import Causality
from ..common.errors import TouchdownError
from ..components.component import (
    FORCE,
    JUMP,
    LOAD,
    MODE_LOAD,
    MODE_MOTION,
    MOTION,
    MOUNT,
    NEEDED,
    POSITION,
    SEAT,
    SLOPE,
    SPATIAL,
    STATIC,
    UNITS,
    WORK,
    Component,
    FmiType,
    ScalarVariable,
)
from ..coupling.connections import AXIS, TOLD
from ..coupling.controller_alone import control_axes, set_points
from ..coupling.ledger.auditor import CLEARANCE, REPORT

TAKING = (Causality.INPUT,)
GIVING = (Causality.OUTPUT, Causality.CALCULATED_PARAMETER)


class PortSide(StrEnum):
    """The side of a port."""

    BEARING = "bearing"  # takes motion and gives load
    BODY = "body"  # the other way round
    SENSOR = "sensor"  # takes motion only


# by which an elastic mode is counted
_MODE = {PortSide.BEARING: MODE_LOAD[0], PortSide.BODY: MODE_MOTION[0]}


@dataclass
class CheckReport:
    """The findings about an FMU."""

    name: str
    problems: list[str] = field(default_factory=list)
    lines: list[str] = field(default_factory=list)
    unitless: list[str] = field(default_factory=list)  # variables without a unit, and the assumed one

    @property
    def text(self) -> str:
        """For people."""
        verdict = "passed" if not self.problems else f"{len(self.problems)} problem(s)"
        body = [f"  {line}" for line in self.lines]
        if self.unitless:
            body.append(f"  no unit stated, taken to be: {', '.join(dict.fromkeys(self.unitless))}")
        body += [f"  problem: {p}" for p in self.problems]
        return "\n".join([f"{self.name}: {verdict}", *body])


def port_sides(component: Component) -> dict[str, PortSide]:
    """Sides of a component's ports, by the ports' names."""
    sides: dict[str, PortSide] = {}
    for variable in component.variables.values():
        port, _, suffix = variable.name.rpartition(".")
        if not port or port.endswith("]"):  # modes belong to their seat
            continue
        if variable.causality is Causality.INPUT and suffix in POSITION:
            loaded = any(f"{port}.{load}" in component.variables for load in FORCE)
            sides[port] = PortSide.BEARING if loaded else PortSide.SENSOR
        elif variable.causality is Causality.INPUT and suffix in FORCE:
            sides[port] = PortSide.BODY
    return sides


@dataclass(frozen=True)
class _Role:
    """A role of a component in a scene."""

    title: str
    side: PortSide  # of its ports
    ports: tuple[str, ...] = ()  # by the names that the project's scenes attach; none: any
    optional: tuple[str, ...] = ()  # ports it may have
    parameters: Mapping[str, str] = field(default_factory=dict)  # names and units


BEARING, AMB, CONTROLLER = "bearing", "amb", "controller"
ROLES = {
    BEARING: _Role("a bearing", PortSide.BEARING, ("journal",), ("housing",)),
    AMB: _Role("a magnetic bearing", PortSide.BEARING, ("journal",), ("housing",), {"shutdown_time": "s"}),
    "rotor": _Role("a rotor", PortSide.BODY),  # its seats may have any names
    "housing": _Role("a housing", PortSide.BODY, ("seat",)),
    CONTROLLER: _Role("a controller", PortSide.SENSOR),  # it takes signals alone
}


def check_ports(component: Component, report: CheckReport) -> None:
    """Check every port that a component has."""
    sides = port_sides(component)
    if not sides:
        report.lines.append("no port of a bearing or a body: it can only be connected variable by variable")
    for port, side in sides.items():
        if side is PortSide.SENSOR:
            report.lines.append(f"port {port}: of a sensor")
        else:
            _check_port(component, port, side, report)


def check_role(component: Component, role: str, report: CheckReport) -> None:
    """Check what a component lacks for a role (a key of ROLES)."""
    if role == CONTROLLER:
        _check_controller(component, report)
        return
    expected = ROLES[role]
    sides = port_sides(component)
    for port in (*expected.ports, *(p for p in expected.optional if p in sides)):
        if port not in sides:
            _check_port(component, port, expected.side, report)
        elif sides[port] is not expected.side:
            report.problems.append(f"port {port} is of a {sides[port]}, not of a {expected.side}")
    seats = [p for p, side in sides.items() if side is expected.side and _spins(component, p)]
    if not expected.ports and not seats:
        report.problems.append(
            f"no port of a {expected.side} that spins; {expected.title} needs for each seat, called "
            "A for one, A.x, A.y (output in m), A.omega (output in rad/s) and A.fx, A.fy (input in N)"
        )
    if role == BEARING:
        report.lines += _would_bring_more(component)
    asked = {} if role == AMB and control_axes(component) else expected.parameters  # actuators switch off
    for name, unit in asked.items():
        variable = component.variables.get(name)
        if variable is None or variable.causality is not Causality.PARAMETER:
            report.lines.append(
                f"it has no {name} (parameter in {unit}), from which most scenes count; give them a time "
                'instead, such as zero = "20 ms"'
            )
        else:
            _check_variable(variable, (Causality.PARAMETER,), unit, report)


def _check_controller(component: Component, report: CheckReport) -> None:
    """Check the variables by which an actuator is controlled, axis by axis."""
    axes = control_axes(component)
    if not axes:
        name = AXIS.format(1, TOLD[0])
        report.problems.append(f"{name} is missing (input in m); no controller works without it")
    for axis in axes:
        _check_variable(component.variables[AXIS.format(axis, TOLD[0])], TAKING, "m", report)
        try:
            outputs = set_points(component, axis)
        except TouchdownError as error:
            report.problems.append(str(error))
            continue
        for name, unit in outputs.items():
            _check_variable(component.variables[name], GIVING, unit, report)


def _would_bring_more(component: Component) -> list[str]:
    """A line for each variable whose lack the master makes up for."""
    port = ROLES[BEARING].ports[0]
    states = all(f"{port}.{account}" in component.variables for account in (WORK, JUMP))
    gains = (
        (REPORT in component.variables, "it reports no contact: first contact, peak force and verdict are "
         f"estimated from means over steps; {REPORT} and contact.peak_force as outputs would give them"),
        (CLEARANCE in component.variables, "it states no clearance: that is taken to be where the journal "
         f"first meets a force; {CLEARANCE} as a parameter would give it"),
        (states, f"it states no work: the ledger listens to a second instance; {port}.{WORK} and "
         f"{port}.{JUMP} as outputs would spare that"),
    )  # fmt: skip
    return [line for there, line in gains if not there]


def _spins(component: Component, port: str) -> bool:
    return any(f"{port}.{suffix}" in component.variables for suffix in SEAT)


def _check_port(component: Component, port: str, side: PortSide, report: CheckReport) -> None:
    takes, gives = (MOTION, LOAD + SLOPE) if side is PortSide.BEARING else (LOAD + SLOPE, MOTION)
    missing: list[str] = []
    for suffixes, causes in ((takes, TAKING), (gives, GIVING)):
        for suffix in suffixes:
            variable = component.variables.get(f"{port}.{suffix}")
            if variable is not None:
                _check_variable(variable, causes, UNITS[suffix], report)
                continue
            missing.append(suffix)
            if suffix in NEEDED:
                report.problems.append(
                    f"{port}.{suffix} is missing ({causes[0]} in {UNITS[suffix]}); "
                    f"no {side} works without it"
                )
    if any(f"{port}.{suffix}" in component.variables for suffix in (*takes, *gives)):
        report.lines.append(_port_summary(component, port, side, missing))


def _check_variable(
    variable: ScalarVariable, causes: Sequence[Causality], unit: str, report: CheckReport
) -> None:
    if variable.causality not in causes:
        report.problems.append(f"{variable.name} has the causality {variable.causality}, not {causes[0]}")
    elif variable.kind is not FmiType.REAL:
        report.problems.append(f"{variable.name} is of the type {variable.kind}, not Real")
    elif variable.unit is None:
        report.unitless.append(f"{variable.name} in {unit}")
    elif variable.unit != unit:
        report.problems.append(f"{variable.name} is in {variable.unit}, not in {unit}")


def _port_summary(component: Component, port: str, side: PortSide, missing: Sequence[str]) -> str:
    """A summary of a port, and of the variables that it lacks."""
    spins = _spins(component, port)
    text = f"port {port}: of a {side}, {'seat of a journal' if spins else 'mount of a housing'}"
    modes = sum(f"{port}.mode[{k}].{_MODE[side]}" in component.variables for k in range(1, MODES + 1))
    text += f", with up to {modes} elastic modes" if modes else ""
    rare = [*NEEDED, *STATIC, *(MOUNT if spins else SEAT)]
    for suffixes in SPATIAL:
        rare += suffixes if set(suffixes) <= set(missing) else ()
    optional = [suffix for suffix in missing if suffix not in rare]
    return text + (f"; without {', '.join(optional)}" if optional else "")
