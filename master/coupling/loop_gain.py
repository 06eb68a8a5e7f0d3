"""Ends a run in which values that feed each other grow by the same factor with every macro step.

Two components whose outputs follow from their inputs at once, joined both ways, make an algebraic loop. The
master goes round it once in a macro step, so it settles where the loop's gain is below one, and runs away
where it is not: by a factor that no physical motion has from step to step.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from graphlib import CycleError, TopologicalSorter

from ..common.errors import Ended
from .observer import LOOK_INTERVAL_STEPS, Observer, RunState
from .system import System

OBSERVED_STEPS = 12  # successive macro steps that are looked at, at the begin and at every beat
MIN_GAIN = 1.05  # what grows more slowly may be a motion
FACTOR_TOLERANCE = 0.01  # by how much the factors of successive steps may differ


class LoopGain(Observer):
    """Looks at what crosses in a loop of single connections, in the first macro steps after every beat."""

    KEPT = ("_seen",)

    def __init__(self, system: System) -> None:
        self._system = system
        self._loop = _loop(system)
        self._names = _outputs(system, self._loop)
        self._seen: list[list[float]] = []

    def due(self, state: RunState) -> int:
        """Some steps one by one at every beat; never where there is no loop."""
        if not self._names:
            return state.steps
        return state.done + 1 if state.done % LOOK_INTERVAL_STEPS <= OBSERVED_STEPS else state.next_beat

    def stepped(self, state: RunState) -> None:
        if not self._names or state.done % LOOK_INTERVAL_STEPS > OBSERVED_STEPS:
            self._seen.clear()
            return
        self._seen.append([self._system.signal(name) for name in self._names])
        if len(self._seen) < OBSERVED_STEPS:
            return
        for name, values in zip(self._names, zip(*self._seen, strict=True), strict=True):
            gain = _factor(values)
            if gain is not None:
                way = " -> ".join([*self._loop, self._loop[0]])
                state.stop(
                    f"the loop {way} runs away: {name} changes by {gain:.3g} times as much with every "
                    f"macro step, up to t = {state.since_zero:.6g} s; its components answer at once, so "
                    "its gain must be below 1: put a delay or a filter into it, or solve it inside one FMU",
                    Ended.STOPPED,
                )
        self._seen.clear()


def _factor(values: Sequence[float]) -> float | None:
    """By what successive changes grow, with its sign; None where they do not, or not by one factor."""
    changes = [after - before for before, after in itertools.pairwise(values)]
    if not all(change != 0.0 and math.isfinite(change) for change in changes):
        return None
    factors = [after / before for before, after in itertools.pairwise(changes)]
    last = factors[-1]
    alike = all(
        abs(factor - last) <= FACTOR_TOLERANCE * abs(last) for factor in factors[len(factors) // 2 :]
    )
    return last if alike and abs(last) >= MIN_GAIN else None


def _single(system: System) -> list[tuple[str, str, str]]:
    """(source, output, target) of connections that belong to no bearing's port and no bond."""
    ports = {frozenset((a.bearing, a.body)) for a in system.attachments}
    ports |= {frozenset((bond.force_side, bond.motion_side)) for bond in system.bonds}
    return [
        (c.source, c.output, c.target)
        for c in system.connections
        if frozenset((c.source, c.target)) not in ports and not system.constant(c)
    ]


def _loop(system: System) -> list[str]:
    """Components of a loop of single connections, each feeding the next; empty: there is none."""
    graph: dict[str, set[str]] = {}
    for source, _, target in _single(system):
        graph.setdefault(target, set()).add(source)
    try:
        TopologicalSorter(graph).prepare()
    except CycleError as error:
        return list(error.args[1])[:-1]
    return []


def _outputs(system: System, loop: Sequence[str]) -> list[str]:
    """COMPONENT.VARIABLE of what is exchanged within the loop."""
    names = [f"{s}.{output}" for s, output, target in _single(system) if s in loop and target in loop]
    return [name for name in dict.fromkeys(names) if name in system.position]
