"""Every setting in force, with its unit and where it comes from."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import asdict

from touchdown.master.common.units import spoken
from touchdown.master.components.component import Variable
from touchdown.master.report.facts.numbers import digits, quantity
from touchdown.master.report.facts.origins import Origin, origin_of, run_origin
from touchdown.master.report.facts.subject import Subject
from touchdown.master.report.page.blocks import Block, Folded, Table, Text
from touchdown.master.scene.run_spec import UNITS
from touchdown.modelkit.variables import Causality

HEAD = ["Setting", "Value", "Origin", "Meaning"]


def settings(subject: Subject) -> list[Block]:
    """Tables by part: what is not the default first, the defaults folded."""
    blocks: list[Block] = [
        Text(
            "Values as they were in force. The origin is the last that had a say: the default of the "
            "model, the catalogue of bearings, the scene, or what was set for this run "
            "(--set, --swap, or from Python)."
        ),
        _run(subject),
    ]
    for name, component in subject.run.system.components.items():
        blocks += _component(subject, name, component.variables)
    return blocks


def _run(subject: Subject) -> Table:
    scene = subject.result.scene
    rows = [
        [f"run.{key}", _run_value(key, value), run_origin(scene, key).value]
        for key, value in asdict(scene.run).items()
    ]
    return Table("How it was run", HEAD[:3], rows)


def _run_value(key: str, value: object) -> str:
    if isinstance(value, dict):  # the scheme
        return str(value["name"])
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, (int, float)):
        return quantity(float(value), UNITS.get(key, "1"), 6)
    if isinstance(value, (tuple, list)):
        return ", ".join(str(part) for part in value) or "–"
    return str(value)


def _component(subject: Subject, name: str, variables: Mapping[str, Variable]) -> Iterator[Block]:
    rows: dict[bool, list[list[str]]] = {True: [], False: []}
    for variable in variables.values():
        if variable.causality is Causality.PARAMETER:
            origin = origin_of(subject.result.scene.components[name], variable.name)
            value = subject.run.system.value(f"{name}.{variable.name}")
            row = [f"{name}.{variable.name}", shown(variable, value), origin.value, variable.description]
            rows[origin is Origin.DEFAULT].append(row)
    spec = subject.result.scene.components[name]
    made = f"{name}: {spec.fmu}" + (f", catalogue {spec.preset}" if spec.preset else "")
    if rows[False]:
        yield Table(made, HEAD, rows[False])
    if rows[True]:
        table = Table(f"{made}, defaults", HEAD, rows[True])
        title = f"{made}: {len(rows[True])} settings at their defaults"
        yield Folded(title, [table])


def shown(variable: Variable, value: float) -> str:
    """A setting's value with its unit."""
    text = quantity(float(value), variable.unit or "1", 6)
    turns, per = spoken(variable.name, value)
    return f"{text} ({digits(turns, 6)} {per})" if variable.unit == "rad/s" and value else text
