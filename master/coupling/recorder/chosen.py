"""Which variables of a system are recorded over time, and which are kept of the end only."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from typing import NamedTuple

from touchdown.master.common.errors import TouchdownError, one_of
from touchdown.master.components.component import READABLE, REPORTED, Variable
from touchdown.master.components.contract import reported
from touchdown.master.coupling.connections import full
from touchdown.master.coupling.recorder.table import END, TIME
from touchdown.master.coupling.system import System
from touchdown.master.scene.run_spec import RunSpec
from touchdown.modelkit.variables import Causality


class Chosen(NamedTuple):
    """Variables of a component."""

    recorded: list[str]
    at_end: list[str]  # kept of the end only


def choose(run: RunSpec, system: System) -> dict[str, Chosen]:
    """By component. Raises TouchdownError for what `run` names and nothing is called."""
    components = system.components
    _refuse_taken(components)
    every = [full(name, v) for name, component in components.items() for v in component.variables]
    for key, beginnings in (("record", run.record), ("record_also", run.record_also)):
        _refuse_unused(f"run.{key}", beginnings, every)
    connected = {c.source_name for c in system.connections}
    found: dict[str, Chosen] = {}
    for name, component in components.items():
        given = [v for v in component.variables.values() if v.causality in REPORTED and v.kind in READABLE]
        chosen = [v.name for v in given if _chosen(full(name, v.name), v, run, connected)]
        known = set(chosen)
        found[name] = Chosen(chosen, [v.name for v in given if v.name not in known])
    return found


def _chosen(name: str, variable: Variable, run: RunSpec, connected: Collection[str]) -> bool:
    """Whether COMPONENT.VARIABLE is recorded."""
    if _begins(name, run.record_also):
        return True
    if "[" in name and not run.record_arrays:
        return False
    if run.record:
        return _begins(name, run.record)
    return variable.causality is Causality.OUTPUT or name in connected or reported(variable.name)


def _begins(name: str, beginnings: Sequence[str]) -> bool:
    """Whether COMPONENT.VARIABLE is one of those, or in the component or group of one."""
    return any(f"{name}.".startswith(f"{b}.") for b in beginnings)


def _refuse_unused(key: str, beginnings: Sequence[str], every: Sequence[str]) -> None:
    for b in beginnings:
        if not any(_begins(name, [b]) for name in every):
            raise TouchdownError(f"{key}: there is nothing called {b}; {one_of(b, every)}")


def _refuse_taken(components: Iterable[str]) -> None:
    """Raise TouchdownError where a component's group would have a name that the file has already."""
    for name in components:
        if name in (TIME, END):
            raise TouchdownError(f"a component cannot be called {name} and be recorded; rename it")
