"""Warnings and stops where the energy says that the answer is in doubt.

Warns, then ends the run, where a bearing's inside, or the system as a whole, made or lost energy.

What a bearing stores and what it turned into heat, and what its loads did on journal and housing, must stay
what they were at the start together; so must all energies of the system, less what was supplied. What they
gained or lost since is judged over what the connections turned over and m g c, or over the largest kinetic
energy of the system and m g c where that is less. Bearings and systems that do not state all of it are not
judged.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

from ...common.errors import Ended
from ...components.component import JUMP, WORK
from ...scene.run_spec import RunSpec, shorter_step, tidy
from ..bonds.bond import way_of
from ..observer import Moment, Observer
from ..system import RATE, System
from .account import Account, SeatAccount
from .accounts import Ledger

MICRO_STEP, TOLERANCE = "micro_step", "interface.tolerance"
MACRO_STEP_BLAME = 3.0  # times what a scheme bears; there the macro step alone is to blame


class Judge(Observer):
    """Holds the ledger's largest share of residual in turnover against the run's thresholds."""

    def __init__(self, ledger: Ledger, run: RunSpec) -> None:
        self.warned_at: float | None = None  # s from zero, where the ledger passed the warning threshold
        self.warning = ""  # the connection, by how much, and what to do
        self._ledger, self._run = ledger, run
        self.limit = run.warn_residual  # share of residual in turnover

    def stepped(self, now: Moment) -> None:
        share = self._ledger.worst_share
        if share <= self.limit:
            return
        now.keep()  # what is not a number is over every limit
        said = self._said(now, share)
        if share <= self._run.stop_residual:
            self.warned_at, self.warning = now.since_zero, said
            self.limit = self._run.stop_residual
        else:
            now.stop(said, Ended.STOPPED)

    def due(self, now: Moment) -> int:
        """Where the ledger passes the limit, which compiled code sees."""
        return now.steps

    def _said(self, now: Moment, share: float) -> str:
        worst = self._ledger.worst()
        if worst is None:
            return "the system has no connection that is audited"
        return (
            f"the energy ledger of {worst.title} is off by {100.0 * share:.2g} % of what it "
            f"turned over at t = {now.since_zero:.6g} s; {remedy(self._run, now.system, worst, share)}"
        )


def remedy(run: RunSpec, system: System, account: Account, share: float) -> str:
    """What to change where the residual of `account` is too large a share of the turnover.

    The coupling is to blame where the contact swings farther in a macro step than the scheme bears; the
    steps inside the bearing, where it does not.
    """
    if run.scheme.error_order == 0:
        smaller = 0.1 * run.tolerance
        return f"the tolerance of {run.tolerance:g} m is too large, try --set run.tolerance={smaller:g}"
    if not isinstance(account, SeatAccount):
        return _shorter_for_bond(run, share)
    bearing = account.attachment.bearing
    swing = _swing(run, system, bearing)
    inside = finer(system, bearing) if swing < MACRO_STEP_BLAME * run.scheme.bears else ""
    if inside and swing <= run.scheme.bears:
        return (
            f"the macro step of {run.macro_step:g} s is short enough, the steps inside the bearing are "
            f"not, try {inside}"
        )
    either = f"or the steps inside the bearing are, try {inside} or" if inside else "try"
    return (
        f"the macro step of {run.macro_step:g} s is too long for scheme {run.scheme.name}, "
        f"{either} --macro-step {shorter_step(run, share, run.scheme.error_order):g}"
    )


def _shorter_for_bond(run: RunSpec, share: float) -> str:
    way = way_of(run)
    other = "try --set run.bonds=smooth, or" if way.held else "try"
    return (
        f"the macro step of {run.macro_step:g} s is too long for a bond that crosses by {way.name}, "
        f"{other} --macro-step {shorter_step(run, share, way.error_order):g}"
    )


def _swing(run: RunSpec, system: System, bearing: str) -> float:
    """How far the journal swings on its contact in a macro step (rad); inf where that is not stated."""
    name = f"{bearing}.{RATE}"
    if name not in system or system.value(name) <= 0.0:
        return float("inf")
    return system.every[bearing] * run.macro_step * system.value(name)


def finer(system: System, bearing: str) -> str:
    """The setting that makes a bearing's own steps finer; empty where it has none."""
    for setting, factor in ((MICRO_STEP, 0.5), (TOLERANCE, 0.1)):
        name = f"{bearing}.{setting}"
        if name in system and system.value(name) > 0.0:
            return f"--set {name}={factor * system.value(name):g}"
    return ""


KINETIC, SUPPLIED = "energy.kinetic", "supplied"
STORED = (KINETIC, "energy.potential", "energy.dissipated")
SAMPLING_NOISE = 1e-5  # of the energy that bodies and contacts hold; steps let the sum swing by as much
ROUNDING = 1e-6  # of the kinetic energy, spin with it; what is less is not judged


@dataclass
class Sum:
    """Energies, COMPONENT.VARIABLE, whose sum stays, but for those in `less`; title: for people."""

    title: str
    bearing: str  # whose inside it is; empty: the system
    names: Sequence[str]
    less: Sequence[str] = ()
    start: float = 0.0  # J
    share: float = 0.0  # the largest so far

    def value(self, system: System) -> float:
        """The sum (J)."""
        return sum(map(system.value, self.names)) - sum(map(system.value, self.less))

    def held(self, system: System) -> float:
        """Kinetic and potential energy, whatever their signs (J)."""
        return sum(abs(system.value(name)) for name in self.names if name.endswith(STORED[:2]))


class Balance(Observer):
    """Holds what was made inside bearings and in the whole against the run's thresholds."""

    at_beats_only: ClassVar[bool] = True

    def __init__(self, ledger: Ledger, run: RunSpec, system: System) -> None:
        self.warned_at: float | None = None  # s from zero, where a sum passed the warning threshold
        self.warning = ""  # which, by how much, and what to do
        self._ledger, self._run = ledger, run
        self._limit = run.warn_residual
        self.sums = [*_insides(system), *_whole(system)]
        for one in self.sums:
            one.start = one.value(system)
        self._moving = [
            f"{name}.{KINETIC}" for name, c in system.components.items() if KINETIC in c.variables
        ]
        self._fastest = 0.0  # J, largest kinetic energy of all

    def stepped(self, now: Moment) -> None:
        self._fastest = max(self._fastest, sum(map(now.system.value, self._moving)))
        over = min(self._ledger.turnover, self._fastest) + self._ledger.fall + ROUNDING * self._fastest
        for one in self.sums:
            made = one.value(now.system) - one.start
            judged = max(abs(made) - SAMPLING_NOISE * one.held(now.system), 0.0)
            share = judged / over if over > 0.0 else 0.0
            one.share = share if not share <= one.share else one.share  # no number is the largest
            if not share <= self._limit:
                self._speak(now, one, made, share)

    def _speak(self, now: Moment, one: Sum, made: float, share: float) -> None:
        now.keep()
        verb = "lost" if made < 0.0 else "made"
        said = (
            f"{one.title} {verb} {abs(made):.3g} J by t = {now.since_zero:.6g} s, {100.0 * share:.2g} % of "
            f"what was turned over; {self._remedy(now.system, one)}"
        )
        if share <= self._run.stop_residual:
            self.warned_at, self.warning = now.since_zero, said
            self._limit = self._run.stop_residual
        else:
            now.stop(said, Ended.STOPPED)

    def _remedy(self, system: System, one: Sum) -> str:
        if one.bearing:
            ratio = f"{one.bearing}.balls.damping_ratio"
            damping = [f"--set {ratio}=0.02"] if ratio in system and system.value(ratio) < 0.02 else []
            settings = [setting for setting in (finer(system, one.bearing), *damping) if setting]
            if settings:
                return f"try {' or '.join(settings)}"
        return f"try --macro-step {tidy(0.5 * self._run.macro_step):g}"

    @property
    def worst(self) -> Sum | None:
        """The bearing whose inside is off most, over what was turned over; None where none is judged."""
        insides = [one for one in self.sums if one.bearing]
        return max(insides, key=lambda one: (math.isnan(one.share), one.share), default=None)


def _insides(system: System) -> list[Sum]:
    """A sum for each bearing that states all of its energies, and its work at every port."""
    found: list[Sum] = []
    for bearing in dict.fromkeys(a.bearing for a in system.attachments):
        ends = [a.bearing_end for a in system.attachments if a.bearing == bearing]
        crossed = [end.full(account) for end in ends for account in (WORK, JUMP)]
        names = [*(f"{bearing}.{energy}" for energy in STORED), *crossed]
        if all(name in system for name in names):
            found.append(Sum(f"the inside of {bearing}", bearing, names))
    return found


def _whole(system: System) -> list[Sum]:
    """The system's sum; none where a component states nothing, or steps of their own part them in time."""
    states = [{KINETIC, SUPPLIED} & set(c.variables) for c in system.components.values()]
    if not all(states) or system.bonds or max(system.every.values()) > 1:
        return []
    names = [f"{name}.{energy}" for name in system.components for energy in STORED]
    less = [f"{name}.{SUPPLIED}" for name in system.components]
    return [Sum("the system", "", [n for n in names if n in system], [n for n in less if n in system])]
