"""Events of a scene: what is to happen in a component at an instant.

    [[event]]
    time = "5 ms"
    what = "amb: coil_off 2"       # COMPONENT: WORD, and which one, where there are several

A component that knows events has parameters event[1].time, event[1].kind, a choice, and so on. The scene's
events fill them in its order, so that they are settings as others are, and go into packages as those do.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import NamedTuple

from ..common.errors import TouchdownError
from ..common.units import to_si
from .tables import items, refuse_unknown, table

EXAMPLE = '[[event]] with time = "5 ms" and what = "amb: link_off"'
KEYS = ("time", "what")
GROUP = "event"  # a component's parameters: event[1].time, event[1].kind, ...
KIND = "kind"
WHICH = "coil"  # what a number behind the word means
_WHAT = re.compile(r"\s*([\w -]+?)\s*:\s*(\w+)(?:\s+(\d+))?\s*")


class Event(NamedTuple):
    """An event, and its time and place."""

    component: str
    time: float  # s, on the simulation's clock
    kind: str  # one of the component's words
    which: int | None = None


def events(value: object, where: str) -> tuple[Event, ...]:
    """The [[event]] tables of a scene. Raises TouchdownError."""
    listed = items(value)
    if listed is None:
        raise TouchdownError(f"{where} must be tables, such as {EXAMPLE}")
    return tuple(_event(table(entry, f"{where} {n}"), f"{where} {n}") for n, entry in enumerate(listed, 1))


def _event(given: Mapping[str, object], here: str) -> Event:
    refuse_unknown(given, KEYS, here)
    lacking = [key for key in KEYS if key not in given]
    if lacking:
        raise TouchdownError(f"{here} lacks {lacking[0]}; write such as {EXAMPLE}")
    time = to_si(given["time"], "s", f"{here}: time")
    if time < 0.0:
        raise TouchdownError(f"{here}: time = {given['time']} must be at least 0 s")
    match = _WHAT.fullmatch(str(given["what"]))
    if match is None:
        raise TouchdownError(f"{here}: what = {given['what']!r}; write such as {EXAMPLE}")
    return Event(match[1], time, match[2], None if match[3] is None else int(match[3]))


def settings_of(found: tuple[Event, ...], component: str) -> dict[str, object]:
    """The events of a component as settings of its parameters."""
    settings: dict[str, object] = {}
    theirs = [event for event in found if event.component == component]
    for number, event in enumerate(theirs, start=1):
        settings[f"{GROUP}[{number}].time"] = event.time
        settings[f"{GROUP}[{number}].{KIND}"] = event.kind
        if event.which is not None:
            settings[f"{GROUP}[{number}].{WHICH}"] = event.which
    return settings
