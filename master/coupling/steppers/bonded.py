"""Sequences for systems with bonds: one pass over the components, or passes repeated until they agree.

`Bonded` steps the components one after another, those that give the force of a bond before those that take
it. Both are stepped in parts within a macro step (`coupling.bonds`). The first macro step is divided, its
parts growing from a thousandth of it: motion can be predicted only from what has been seen.

`IteratedBonds` repeats the step until the motion predicted over each bond is the motion that comes out. The
unknown is where the motion of all bonds ends, u; one sweep of all components gives where it comes to, g(u).
From r = g(u) - u the next is u + K r, where K is about (I - dg/du)^-1: found by sweeps from ends that are
moved a little, one after the other, and improved by every repetition (Broyden's good update).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import NamedTuple

import numpy as np

from ...common.errors import TouchdownError
from ...scene.run_spec import RunSpec
from ..bonds.bond import hold_of
from ..bonds.exchange import BondExchange, History
from ..bonds.substeps import BondedTurn, SubstepLoads
from ..snapshot import Saved
from ..system import System
from .gauss_seidel import GaussSeidel, StepTurn
from .iterated import MAX_REPETITIONS, TINY, Iterated
from .rates import parts_of
from .stepper import Checkpoint, require_any_step

RAMP_DOUBLINGS = 10  # doublings of the first part of the first macro step until the whole of it is over


class _Memory(NamedTuple):
    """The stepper's memory of the past."""

    ramped: bool
    pasts: Sequence[History]


class Bonded(GaussSeidel):
    """Steps a system with bonds."""

    any_step = any_moment = False  # FMUs of others may take steps of one length only
    KEPT = ("ramped",)

    def __init__(self, system: System, run: RunSpec) -> None:
        self.way = hold_of(run)
        _require_single_steps(system)
        place = {name: k for k, name in enumerate(system.order)}
        self._crossings = [
            BondExchange(b, self.way, place[b.motion_side] < place[b.force_side]) for b in system.bonds
        ]
        self.ramped = self.way.held or not system.divisible
        for crossing in self._crossings:
            crossing.trusted = self.ramped
        super().__init__(system, run)

    def follow(self) -> None:
        super().follow()
        system = self.system
        live = [c for c in self._crossings if not system.retired & {c.bond.force_side, c.bond.motion_side}]
        for crossing in live:
            crossing.find(system)
        self.live = live
        bonded = {name for c in live for name in (c.bond.force_side, c.bond.motion_side)}
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
        part, done = step / 2**RAMP_DOUBLINGS, 0.0
        for _ in range(RAMP_DOUBLINGS + 1):
            self.sweep(time + done, part)
            done += part
            part = done

    def estimated_ends(self, time: float, step: float) -> list[tuple[float, ...]]:
        """Where the motion of each bond leads by itself in a step."""
        for crossing in self.live:
            crossing.begin(time, step)
        return [crossing.estimated_end for crossing in self.live]

    def sweep(self, time: float, step: float, ends: Iterable[float] | None = None) -> None:
        """One step of all components; `ends`: where the motion of all bonds is told to end."""
        values = None if ends is None else iter(ends)
        for crossing in self.live:
            crossing.begin(time, step)
            if values is not None:
                crossing.prescribe([next(values) for _ in crossing.bond.motion])
        for take in self._takes:
            take(time, step)
        for crossing in self.live:
            crossing.end()

    @property
    def crossings(self) -> Sequence[BondExchange]:
        return self._crossings

    def save(self) -> Saved:
        return super().save() | {"crossings": [crossing.save() for crossing in self._crossings]}

    def load(self, saved: Saved) -> None:
        super().load(saved)
        for crossing, of_one in zip(self._crossings, saved["crossings"], strict=True):
            crossing.load(of_one)

    def memory(self) -> _Memory:
        return _Memory(self.ramped, [crossing.past for crossing in self._crossings])

    def recall(self, memory: object) -> None:
        assert isinstance(memory, _Memory)
        self.ramped, pasts = memory
        for crossing, past in zip(self._crossings, pasts, strict=True):
            crossing.past = past


def _take(turn: StepTurn, signals: np.ndarray) -> Callable[[float, float], None]:
    return lambda time, step: turn.take(signals, 0, time, step)


def _loads(system: System, name: str) -> list[SubstepLoads]:
    return [SubstepLoads(part.means, part.slopes, part.last) for part in parts_of(system, name)]


def _require_single_steps(system: System) -> None:
    for name, every in system.every.items():
        if every != 1:
            raise TouchdownError(
                f"{system.bonds[0].title} is a bond, with which all components take the same steps; remove "
                f"{name}.every = {every}"
            )


MIN_OFFSET = 1e-9  # m; ends are moved by what they are off, and at least by so much
JACOBIAN_INTERVAL = MAX_REPETITIONS // 2  # repetitions after which K is found anew


class IteratedBonds(Iterated):
    """Repeats each step until the ends of all bonds stay; a velocity counts by what it moves in it."""

    KEPT = ("_steps", "_repeated", "_deepest")

    def __init__(self, system: System, run: RunSpec) -> None:
        if system.attachments:
            raise TouchdownError(
                f"scheme {run.scheme.name} repeats for bearings or for bonds, not for both: with "
                f"{system.attachments[0].title} and {system.bonds[0].title} choose interface or halving"
            )
        self._bonded = Bonded(system, run)
        self._gains: np.ndarray | None = None  # K
        if self._bonded.way.held:
            raise TouchdownError(
                f"scheme {run.scheme.name} repeats steps until the extrapolated motion is right, and "
                f"{system.bonds[0].title} crosses by {self._bonded.way.name}, which tells none; choose "
                "run.bonds = contact or smooth, or scheme hold"
            )
        super().__init__(system, run)
        require_any_step(system, run.scheme.name)

    def follow(self) -> None:
        self._bonded.follow()

    def save(self) -> Saved:
        gains = {} if self._gains is None else {"gains": self._gains}
        return super().save() | gains | {"bonded": self._bonded.save()}

    def load(self, saved: Saved) -> None:
        super().load(saved)
        self._gains = saved.get("gains")
        self._bonded.load(saved["bonded"])

    @property
    def crossings(self) -> Sequence[BondExchange]:
        return self._bonded.crossings

    def step(self, number: int, time: float, step: float) -> None:
        if self._bonded.ramped:
            super().step(number, time, step)
        else:  # there is no past to tell anything from
            self._bonded.step(number, time, step)

    def _checkpoint(self) -> Checkpoint:
        return Checkpoint(self.system, self._bonded)

    def _converge(self, before: Checkpoint, time: float, step: float) -> float:
        """Repeat the step from where the motion leads by itself; returns how far its end is off (m)."""
        self._steps += 1
        bonded = self._bonded
        sizes = np.array([size for c in bonded.live for size in c.sizes(step)])
        end = np.concatenate(bonded.estimated_ends(time, step)) * sizes

        def off_from(end: np.ndarray) -> np.ndarray:
            before.restore()
            return self._sweep(time, step, end / sizes) * sizes - end

        off = off_from(end)
        for repetition in range(1, MAX_REPETITIONS):
            change = float(np.max(np.abs(off)))
            if change <= self.run.tolerance or not np.isfinite(change):
                return change
            if self._gains is None or repetition == JACOBIAN_INTERVAL:
                self._gains = _gains(off_from, end, off)
            moved = self._gains @ off
            end = end + moved
            came = off_from(end)
            self._gains, off = _improved(self._gains, moved, came - off), came
        return float(np.max(np.abs(off)))

    def _sweep(self, time: float, step: float, end: np.ndarray) -> np.ndarray:
        """The step with the motion told to end there; returns where it ended."""
        self._repeated += 1
        self._bonded.sweep(time, step, end)
        return np.concatenate([c.last_motion for c in self._bonded.live])


def _gains(off_from: Callable[[np.ndarray], np.ndarray], end: np.ndarray, off: np.ndarray) -> np.ndarray:
    """K at `end`, where the sweep is `off` (m)."""
    size = max(float(np.max(np.abs(off))), MIN_OFFSET)
    turned = np.array([(off_from(end + size * unit) - off) / size for unit in np.eye(len(end))]).T
    if not np.isfinite(turned).all():  # the step will not converge, and be divided
        return np.eye(len(end))
    return -np.linalg.pinv(turned)


def _improved(gains: np.ndarray, moved: np.ndarray, turned: np.ndarray) -> np.ndarray:
    """K such that it says what came of the last repetition: off `turned` as the ends were `moved`."""
    along = moved @ gains
    share = float(along @ turned)
    if abs(share) <= TINY:
        return gains
    return gains - np.outer(moved + gains @ turned, along) / share
