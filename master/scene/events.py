"""Events of a scene: what is to happen in a component at an instant, such as "amb: coil_off 2".

A component that knows events has parameters event[1].time, event[1].kind, a choice, and so on. The scene's
events fill them in its order, so that they are settings as others are, and go into packages as those do.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from typing import NamedTuple

from ...modelkit.reader import Kind, Table, key, number

GROUP = "event"  # a component's parameters: event[1].time, event[1].kind, ...
KIND = "kind"
WHICH = "coil"  # what a number behind the word means
_WHAT = re.compile(r"\s*([\w -]+?)\s*:\s*(\w+)(?:\s+(\d+|all|both))?\s*")


class _Event(NamedTuple):
    """An event, and its time and place."""

    component: str
    time: float  # s, on the simulation's clock
    kind: str  # one of the component's words
    which: int | None = None  # None: all


@dataclass(frozen=True)
class EventTable:
    """A table [[event]]."""

    time: float = key(number("s", minimum=0.0), says="on the simulation's clock")
    what: tuple[str, ...] = key(
        Kind(
            lambda value, name: _WHAT.fullmatch(value).groups(),  # type: ignore
            'such as "amb: coil_off 2", "amb: coil_short all" or "amb: sensor_lost both"',
        ),
        says="COMPONENT: WORD, and which one, all or both where there are several",
    )


def settings_at_times(tables: Iterable[Table]) -> tuple[_Event, ...]:
    """The [[event]] tables of a scene. Raises TouchdownError."""
    found = [(one.time, *one.what) for one in (table.read(EventTable) for table in tables)]
    return tuple(
        _Event(name, time, kind, int(which) if which and which.isdecimal() else None)
        for time, name, kind, which in found
    )


def settings_of(found: tuple[_Event, ...], component: str) -> dict[str, object]:
    """The events of a component as settings of its parameters."""
    settings: dict[str, object] = {}
    theirs = [event for event in found if event.component == component]
    for i, event in enumerate(theirs, start=1):
        settings[f"{GROUP}[{i}].time"] = event.time
        settings[f"{GROUP}[{i}].{KIND}"] = event.kind
        if event.which is not None:
            settings[f"{GROUP}[{i}].{WHICH}"] = event.which
    return settings
