"""A rotor's file as a machine needs it: with a place for each bearing, and who holds it at the start."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace

from touchdown.master.common.errors import TouchdownError
from touchdown.modelkit.model import ModelError
from touchdown.rotor.beams.shaft import Shaft, Station
from touchdown.rotor.file import parse, written

LEVITATED = re.compile(r"^levitated_at\s*=\s*\[[^\]]*\]", re.MULTILINE)
TABLE = re.compile(r"^\[", re.MULTILINE)
STATIONS = re.compile(r"^\[stations\][^\n]*\n", re.MULTILINE)


def with_places(shaft: Shaft, seats: Sequence[str], magnets: Sequence[str]) -> tuple[Shaft, list[str]]:
    """A rotor that its magnetic bearings hold at the start, and their stations.

    A magnetic bearing at a touchdown bearing's station gets one of its own at the same node. Raises
    TouchdownError where the name of that is taken.
    """
    stations, held = list(shaft.stations), list[str]()
    for name in magnets:
        if name not in seats:
            held.append(name)
            continue
        there = next((s.node for s in stations if s.name == name), None)
        own = f"amb_{name}"
        taken = next((s.node for s in stations if s.name == own), there)
        if taken != there:
            raise TouchdownError(f"--amb {name}: {shaft.title} has a station {own} elsewhere; name that")
        if there is not None and all(s.name != own for s in stations):
            stations.append(Station(own, there))
        held.append(own)
    return replace(shaft, stations=tuple(stations), levitated_at=tuple(held)), held


def rewritten(text: str, shaft: Shaft, wanted: Shaft) -> str:
    """The text of `shaft`'s file, changed to that of `wanted`: its stations and who levitates it.

    Comments and layout stay where that is possible. Raises TouchdownError where it cannot be written.
    """
    if wanted == shaft:
        return text
    names = ", ".join(f'"{name}"' for name in wanted.levitated_at)
    line = f"levitated_at = [{names}]"
    changed, found = LEVITATED.subn(line, text, count=1)
    if not found:
        first = TABLE.search(text)
        at = first.start() if first else len(text)
        changed = f"{text[:at]}{line}  # who holds the rotor at the start\n\n{text[at:]}"
    added = [s for s in wanted.stations if s not in shaft.stations]
    lines = "".join(f"{s.name} = {s.node}\n" for s in added)
    if added:
        changed = STATIONS.sub(lambda match: match[0] + lines, changed, count=1)
    try:
        if _same(parse(changed, "the rotor"), wanted):
            return changed
    except ModelError:
        pass
    try:
        return written(wanted)
    except ModelError as error:
        raise TouchdownError(f"the places of the magnetic bearings cannot be added: {error}") from None


def _same(shaft: Shaft, wanted: Shaft) -> bool:
    """Whether two rotors differ at most in the order of their stations."""
    return (
        set(shaft.stations) == set(wanted.stations) and replace(shaft, stations=wanted.stations) == wanted
    )
