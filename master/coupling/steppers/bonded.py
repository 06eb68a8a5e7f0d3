"""Components one after another, those that give the force of a bond before those that take it.

Both are stepped in parts within a macro step (`coupling.bonds`). The first macro step is divided, its parts
growing from a thousandth of it: motion can be told ahead only from what has been seen.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import NamedTuple

import numpy as np

from touchdown.master.common.errors import TouchdownError
from touchdown.master.coupling.bonds.crossing import Crossing, Past
from touchdown.master.coupling.bonds.turn import BondedTurn, Loads
from touchdown.master.coupling.bonds.ways import way_of
from touchdown.master.coupling.steppers.gauss_seidel import GaussSeidel, Turn
from touchdown.master.coupling.steppers.rates import parts_of
from touchdown.master.coupling.system import System
from touchdown.master.scene.run_spec import RunSpec

RAMP = 10  # doublings of the first part of the first macro step until the whole of it is over


class Memory(NamedTuple):
    """What it knows of the past."""

    ramped: bool
    pasts: Sequence[Past]


class Bonded(GaussSeidel):
    """Steps a system with bonds."""

    any_step = any_moment = False  # FMUs of others may take steps of one length only

    def __init__(self, system: System, run: RunSpec) -> None:
        self.way = way_of(run)
        _require_single_steps(system)
        place = {name: k for k, name in enumerate(system.order)}
        self._crossings = [Crossing(b, self.way, place[b.taker] < place[b.giver]) for b in system.bonds]
        self.ramped = self.way.held or not system.divisible
        for crossing in self._crossings:
            crossing.trusted = self.ramped
        super().__init__(system, run)

    def follow(self) -> None:
        super().follow()
        system = self.system
        live = [c for c in self._crossings if not system.retired & {c.bond.giver, c.bond.taker}]
        for crossing in live:
            crossing.find(system)
        self.live = live
        bonded = {name for c in live for name in (c.bond.giver, c.bond.taker)}
        plain = {turn.component.name: turn for turn in self.turns}
        self._takes: list[Callable[[float, float], None]] = [
            BondedTurn(system, name, live, _loads(system, name)).take
            if name in bonded
            else _take(plain[name], system.signals)
            for name in system.order
        ]

    def step(self, number: int, time: float, step: float) -> None:
        if self.ramped:
            self.sweep(time, step)
            return
        self.ramped = True
        part, done = step / 2**RAMP, 0.0
        for _ in range(RAMP + 1):
            self.sweep(time + done, part)
            done += part
            part = done

    def told_ends(self, time: float, step: float) -> list[tuple[float, ...]]:
        """Where the motion of each bond leads by itself in a step."""
        for crossing in self.live:
            crossing.begin(time, step)
        return [crossing.told_end for crossing in self.live]

    def sweep(self, time: float, step: float, ends: Iterable[float] | None = None) -> None:
        """One step of all components; `ends`: where the motion of all bonds is told to end."""
        told = None if ends is None else iter(ends)
        for crossing in self.live:
            crossing.begin(time, step)
            if told is not None:
                crossing.prescribe([next(told) for _ in crossing.bond.motion])
        for take in self._takes:
            take(time, step)
        for crossing in self.live:
            crossing.end()

    @property
    def crossings(self) -> Sequence[Crossing]:
        return self._crossings

    def memory(self) -> Memory:
        return Memory(self.ramped, [crossing.past for crossing in self._crossings])

    def recall(self, memory: object) -> None:
        assert isinstance(memory, Memory)
        self.ramped, pasts = memory
        for crossing, past in zip(self._crossings, pasts, strict=True):
            crossing.past = past


def _take(turn: Turn, signals: np.ndarray) -> Callable[[float, float], None]:
    return lambda time, step: turn.take(signals, 0, time, step)


def _loads(system: System, name: str) -> list[Loads]:
    return [Loads(part.means, part.slopes, part.last) for part in parts_of(system, name)]


def _require_single_steps(system: System) -> None:
    for name, every in system.every.items():
        if every != 1:
            raise TouchdownError(
                f"{system.bonds[0].title} is a bond, with which all components take the same steps; remove "
                f"{name}.every = {every}"
            )
