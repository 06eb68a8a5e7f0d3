"""Levitated again: what became of the rotor, and what controllers, amplifiers and magnets went through."""

from __future__ import annotations

from collections.abc import Iterator

from ...master.common.text import joined
from ...master.quantities import LINK_ENERGIES, named
from ...master.results.capture import COILS, COMMANDED, GAP, LIMITED, captures
from ...master.results.hold_up import links
from ..charts import series
from ..layout import Absent, Data
from ..numbers import digits, heads, quantity
from ..series import Line
from ..subject import COLOURS, Subject

STATE, CAPTURED, MISSED = "state", "captured_time", "missed"  # of a controller
CHARGE = "capacitor"  # V, of a DC link
ENERGY = "link_energy"  # J, of an actuator
AXES = (1, 2)  # of an actuator
OF_AXES = (("current", "A", "Currents"), ("voltage", "V", "Voltages"))  # of coils: variable, unit, title
COIL_SIDES = (("plus", "+"), ("minus", "−"))
HOLD_UP = ("hold_up_time", "lock_out_time", *(f"link_{key}" for key in LINK_ENERGIES))
VERDICTS = "capture", "capture_time", "capture_last_contact", "capture_peak_force"


def levitation(subject: Subject) -> Data:
    """Verdicts, states, currents, voltages, limits. Raises Absent without actuator and controller."""
    controllers, actuators = _telling(subject, COMMANDED), _telling(subject, COILS["largest_coil_current"])
    if not controllers and not actuators:
        raise Absent("no magnetic bearing of this scene has a controller of its own.")
    states, components = list(_lines(subject, controllers, STATE)), subject.run.system.components
    charges = list(_lines(subject, links(subject.run.system), CHARGE))
    chart = subject.chart("controllers", "States of the controllers", "state", states) if states else None
    voltages = subject.chart("links", "Voltages of DC links", "voltage [V]", charges) if charges else None
    return {
        "fate_heads": heads(VERDICTS),
        "fates": _fates(subject),
        "command": quantity(subject.summary.get("capture_command_time"), "s"),
        "states": series(chart) if chart else None,
        "meaning": components[controllers[0]].variables[STATE].description if states else "",
        "controllers": _by_sensors(subject, controllers),
        "coils": [one for name in actuators for one in _coils(subject, name)],
        "limit_heads": heads(COILS),
        "limits": [_limits(subject, name) for name in actuators],
        "voltages": series(voltages) if voltages else None,
        "hold_up_heads": heads(HOLD_UP),
        "hold_ups": [_hold_up(subject, name) for name in links(subject.run.system)],
        "closed": joined([n for n in actuators if subject.run.system.value(f"{n}.{GAP}") <= 0.0]),
    }


def _telling(subject: Subject, variable: str) -> list[str]:
    """The components that have a variable of that name."""
    return [name for name in subject.run.system.components if f"{name}.{variable}" in subject.run.system]


def _fates(subject: Subject) -> list[list[str]]:
    return [
        [
            seat,
            one.words,
            quantity(one.after, "s", 3),
            "no contact" if one.last_contact is None else quantity(one.last_contact, "s", 3),
            quantity(one.peak_force or None, "N", 3),
        ]
        for seat, one in captures(subject.summary).items()
    ]


def _lines(subject: Subject, names: list[str], variable: str) -> Iterator[Line]:
    for k, name in enumerate(names):
        if f"{name}.{variable}" in subject.run.recording:
            yield Line(name, COLOURS[k % len(COLOURS)], subject.run.recording[f"{name}.{variable}"])


def _by_sensors(subject: Subject, controllers: list[str]) -> list[list[str]]:
    def when(name: str, variable: str) -> str:
        value = subject.run.system.value(f"{name}.{variable}")
        return quantity(value - subject.zero, "s") if value >= 0.0 else "never"

    return [
        [
            name,
            when(name, COMMANDED),
            when(name, CAPTURED),
            digits(subject.run.system.value(f"{name}.{MISSED}")),
            quantity(subject.run.system.value(f"{name}.{LIMITED}"), "s", 3),
        ]
        for name in controllers
    ]


def _coils(subject: Subject, name: str) -> Iterator[Data]:
    """Currents and voltages of an actuator's coils over time, where they were recorded."""
    for variable, unit, title in OF_AXES:
        coils = [
            (f"{name}.axis[{k}].{variable}_{side}", f"axis {k} {sign}")
            for k in AXES
            for side, sign in COIL_SIDES
        ]
        lines = [
            Line(words, COLOURS[k], subject.run.recording[full])
            for k, (full, words) in enumerate(coils)
            if full in subject.run.recording
        ]
        if lines:
            axis = f"{variable} [{unit}]"
            chart = subject.chart(f"{variable}-{name}", f"{title} of {name}", axis, lines)
            yield {"what": title, "of": name, "curves": series(chart)}


def _hold_up(subject: Subject, name: str) -> list[str]:
    values = subject.summary["components"][name]
    return [name, values["hold_up"], *(quantity(values[key], named(key)[0].unit, 3) for key in HOLD_UP)]


def _limits(subject: Subject, name: str) -> list[str]:
    shown = [(variable, named(key)[0].unit) for key, variable in COILS.items()]
    shown += [(GAP, "m"), (ENERGY, "J")]
    value = subject.run.system.value
    return [name, *(quantity(value(f"{name}.{variable}"), unit, 3) for variable, unit in shown)]
