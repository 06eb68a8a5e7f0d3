"""Warnings and stops where the energy says that the answer is in doubt.

`ResidualMonitor` watches the ledger: it warns, then ends the run, where a force at the worst connection
would have to be off by more than the scene allows to explain the residual.

`EnergyBalanceMonitor` does the same for energy that a bearing's inside, or the system as a whole, made or
lost. The energy that a bearing stores, the heat it made, and the work of its loads on journal and housing
must keep the sum that they had at the start; so must all energies of the system, less what was supplied.
What they gained or lost since is compared with what the connections turned over plus m g c, or with the
largest kinetic energy of the system plus m g c where that is less. Thresholds are those of a connection,
where half of an energy's share counts, as a force goes with the root of the energy. Bearings and systems
that do not state all of it are not judged.

A bearing that knows only coarsely where its journal is sees work that was not done: where the coupling of
that bearing is in doubt itself, the macro step is to blame, not the bearing.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

from ....modelkit.ports import ACCELERATION, VELOCITY
from ...common.errors import Ended
from ...common.text import percent
from ...components.component import JUMP, STIFFNESS, WORK
from ...scene.run_spec import RunSpec, round_down_125, shorter_step
from ..bonds.bond import hold_of
from ..loop.kernels.port_accounts import FORCE_PER_ENERGY
from ..observer import Observer, RunState
from ..snapshot import Kept, Saved
from ..system import RATE, System
from .account import BondAccount, SeatAccount, WorkAccount
from .accounts import Ledger

MICRO_STEP, TOLERANCE = "micro_step", "interface.tolerance"
MACRO_STEP_BLAME = 3.0  # times what a scheme can take; there the macro step alone is to blame


class ResidualMonitor(Observer):
    """Holds the ledger's largest share of residual in turnover against the run's thresholds."""

    KEPT = ("warned_at", "warning", "limit")

    def __init__(self, ledger: Ledger, run: RunSpec) -> None:
        self.warned_at: float | None = None  # s from zero, where the ledger passed the warning threshold
        self.warning = ""  # the connection, by how much, and what to do
        self._ledger, self._run = ledger, run
        self.limit = run.warn_residual  # share of residual in turnover

    def stepped(self, state: RunState) -> None:
        share = self._ledger.worst_share
        if share <= self.limit:
            if state.last and self.warned_at is not None:  # what it came to says what to do
                self.warning = self._message(state, share, self.warned_at)
            return
        state.keep()  # what is not a number is over every limit
        if share <= self._run.stop_residual:
            self.warned_at = state.since_zero
            self.warning = self._message(state, share, self.warned_at)
            self.limit = self._run.stop_residual
        else:
            state.stop(self._message(state, share, state.since_zero), Ended.STOPPED)

    def due(self, state: RunState) -> int:
        """Where the ledger passes the limit, which compiled code sees."""
        return state.steps

    def _message(self, state: RunState, share: float, since: float) -> str:
        worst = self._ledger.worst()
        if worst is None:
            return "the system has no connection that is audited"
        bond = isinstance(worst, BondAccount)
        wrong = percent(share, 2)
        size = f"{wrong} of the energy exchanged" if bond else f"that of a force wrong by {wrong}"
        limit = f"limit {percent(self._run.warn_residual)}, exceeded since t = {since:.6g} s"
        return (
            f"the energy error of the coupling at {worst.title} is {size} ({limit}); "
            f"{_remedy(self._run, state.system, worst, share)}"
        )


def _remedy(run: RunSpec, system: System, account: WorkAccount, share: float) -> str:
    """A remedy where the residual of `account` is too large beside the energy exchanged.

    The coupling is to blame where the contact swings farther in a macro step than the scheme can take; the
    steps inside the bearing, where it does not.
    """
    if run.scheme.error_order == 0:
        smaller = 0.1 * run.tolerance
        return f"the tolerance of {run.tolerance:g} m is too large, try --set run.tolerance={smaller:g}"
    if not isinstance(account, SeatAccount):
        return _shorter_for_bond(run, share)
    bearing = account.attachment.bearing
    swing = _swing(run, system, bearing)
    inside = (
        _suggest_inner_step(system, bearing) if swing < MACRO_STEP_BLAME * run.scheme.angle_limit else ""
    )
    if inside and swing <= run.scheme.angle_limit:
        return (
            f"the macro step of {run.macro_step:g} s is short enough, the steps inside the bearing are "
            f"not, try {inside}"
        )
    return _step_warning(
        run, share, f"or the steps inside the bearing are, try {inside} or" if inside else "try"
    )


def _option(step: float) -> str:
    """The option that sets a macro step (s)."""
    return f'--set "run.macro_step={1e6 * step:g} us"'


def _step_warning(run: RunSpec, share: float, either: str = "try") -> str:
    """A remark that the macro step is to blame for a share of residual, and which one to try."""
    return (
        f"the macro step of {run.macro_step:g} s is too long for scheme {run.scheme.name}, "
        f"{either} {_option(shorter_step(run, share, max(run.scheme.error_order, 1)))}"
    )


def _shorter_for_bond(run: RunSpec, share: float) -> str:
    way = hold_of(run)
    other = "try --set run.bonds=smooth, or" if way.held else "try"
    return (
        f"the macro step of {run.macro_step:g} s is too long for a bond that crosses by {way.name}, "
        f"{other} {_option(shorter_step(run, share, way.error_order))}"
    )


def _swing(run: RunSpec, system: System, bearing: str) -> float:
    """How far the journal swings on its contact in a macro step (rad); inf where that is not stated."""
    name = f"{bearing}.{RATE}"
    if name not in system or system.value(name) <= 0.0:
        return float("inf")
    return system.every[bearing] * run.macro_step * system.value(name)


def _suggest_inner_step(system: System, bearing: str) -> str:
    """The setting that makes a bearing's own steps finer; empty where it has none."""
    for setting, factor in ((MICRO_STEP, 0.5), (TOLERANCE, 0.1)):
        name = f"{bearing}.{setting}"
        if name in system and system.value(name) > 0.0:
            return f"--set {name}={factor * system.value(name):g}"
    return ""


# Parts of a bearing that may make energy by themselves, with any step
SUSPECTS = (
    *("land", "shoulder.gap_minus", "shoulder.gap_plus", "balls.contact_angle", "ring.harmonics"),
    *("thermal", "ring.growth", "slip", "damping", "rolling.resistance"),
)


def _otherwise(system: System, bearing: str) -> str:
    """What to do where finer steps do not help."""
    names = (f"{bearing}.{name}" for name in SUSPECTS)
    acting = [name for name in names if name in system and system.value(name) != 0.0]
    parts = (
        f"set {', '.join(acting)} to 0 in turn, to find the part that does it" if acting else "report it"
    )
    return f"; if that leaves as much, the steps are not to blame, but the model: {parts}"


SWING_LIMITS = {
    VELOCITY: 1.0,
    ACCELERATION: 3.0,
}  # rad; how far a body swings that goes straight, or in a parabola


class MountSwing(Observer):
    """Warns where a body on springs, a housing, swings farther in a macro step than the scheme carries it.

    Its bearing then sees it where it never is, and may agree with it about the energy all the same.
    Bearings that carry it by its own equations do not need to be told.
    """

    at_beats_only: ClassVar[bool] = True
    KEPT = ("warned_at", "warning")

    def __init__(self, system: System, run: RunSpec) -> None:
        self.warned_at: float | None = None  # s from zero
        self.warning = ""  # which body, and what to do
        self._run, self._limit = run, SWING_LIMITS.get(run.scheme.order, math.inf)
        stiffness = ((a, a.bearing_end.full(STIFFNESS)) for a in system.attachments)
        self._mounts = [(a, name) for a, name in stiffness if name in system]

    def stepped(self, state: RunState) -> None:
        if self.warned_at is not None:
            return
        for attachment, name in self._mounts:
            step = state.system.every[attachment.bearing] * self._run.macro_step
            frequency = math.sqrt(max(state.system.value(name), 0.0))
            if frequency * step <= self._limit:
                continue
            shorter = round_down_125(self._run.macro_step * self._limit / (frequency * step))
            self.warned_at = state.since_zero
            self.warning = (
                f"{attachment.body_end.title} swings {frequency * step:.2g} rad on its springs in a macro "
                f"step of {step:g} s, which scheme {self._run.scheme.name} does not follow; take scheme "
                f"interface, or try {_option(shorter)}"
            )
            return


KINETIC, SUPPLIED = "energy.kinetic", "supplied"
STORED = (KINETIC, "energy.potential", "energy.dissipated")
SAMPLING_NOISE = 1e-5  # of the energy that bodies and contacts hold; steps let the sum swing by as much
ROUNDING = 1e-6  # of the kinetic energy, spin with it; what is less is not judged


@dataclass
class _Sum(Kept):
    """Energies, COMPONENT.VARIABLE, whose sum stays, but for those in `less`; title: for people."""

    KEPT: ClassVar[tuple[str, ...]] = ("start", "share", "made")

    title: str
    bearing: str  # whose inside it is; empty: the system
    names: Sequence[str]
    less: Sequence[str] = ()
    start: float = 0.0  # J
    share: float = 0.0  # of what was turned over, the largest so far
    made: float = 0.0  # J, there; below 0: lost

    def value(self, system: System) -> float:
        """The sum (J)."""
        return sum(map(system.value, self.names)) - sum(map(system.value, self.less))

    def held(self, system: System) -> float:
        """Kinetic and potential energy, of any sign (J)."""
        return sum(abs(system.value(name)) for name in self.names if name.endswith(STORED[:2]))


class EnergyBalanceMonitor(Observer):
    """Holds what was made inside bearings and in the whole against the run's thresholds."""

    at_beats_only: ClassVar[bool] = True
    KEPT = ("warned_at", "warning", "_warned", "_limit", "_fastest")

    def __init__(self, ledger: Ledger, run: RunSpec, system: System) -> None:
        self.warned_at: float | None = None  # s from zero, where a sum passed the warning threshold
        self.warning = ""  # which, by how much, and what to do
        self._ledger, self._run = ledger, run
        self._warned: int | None = None  # of the sums
        self._limit = run.warn_residual
        self.sums = [*_insides(system), *_system_sums(system)]
        for one in self.sums:
            one.start = one.value(system)
        self._moving = [
            f"{name}.{KINETIC}" for name, c in system.components.items() if KINETIC in c.variables
        ]
        self._fastest = 0.0  # J, largest kinetic energy of all

    def stepped(self, state: RunState) -> None:
        self._fastest = max(self._fastest, sum(map(state.system.value, self._moving)))
        over = min(self._ledger.turnover, self._fastest) + self._ledger.fall + ROUNDING * self._fastest
        for number, one in enumerate(self.sums):
            gained = one.value(state.system) - one.start
            judged = max(abs(gained) - SAMPLING_NOISE * one.held(state.system), 0.0)
            share = judged / over if over > 0.0 else 0.0
            if not share <= one.share:  # no number is the largest
                one.share, one.made = share, gained
            if not share <= energy_share(self._limit):
                self._warn(state, number)
        if state.last and self._warned is not None:  # what it came to says what to do
            self.warning = self._message(state, self.sums[self._warned])

    def save(self) -> Saved:
        return super().save() | {"sums": [one.save() for one in self.sums]}

    def load(self, saved: Saved) -> None:
        super().load(saved)
        for one, of_one in zip(self.sums, saved["sums"], strict=True):
            one.load(of_one)

    def _warn(self, state: RunState, number: int) -> None:
        one = self.sums[number]
        state.keep()
        if one.share <= energy_share(self._run.stop_residual):
            self.warned_at, self._warned = state.since_zero, number
            self.warning = self._message(state, one)
            self._limit = self._run.stop_residual
        else:
            state.stop(self._message(state, one), Ended.STOPPED)

    def _message(self, state: RunState, one: _Sum) -> str:
        return (
            f"{one.title} {'lost' if one.made < 0.0 else 'made'} {abs(one.made):.3g} J by "
            f"t = {state.since_zero:.6g} s, {percent(one.share, 2)} of the turnover; "
            f"{self._remedy(state.system, one, FORCE_PER_ENERGY * one.share)}"
        )

    def _remedy(self, system: System, one: _Sum, share: float) -> str:
        coupling = self._ledger.share_at(one.bearing) if one.bearing else self._ledger.worst_share
        swing = _swing(self._run, system, one.bearing)
        too_far = self._run.scheme.angle_limit < swing < math.inf  # for the scheme, in a macro step
        doubted = too_far or not coupling <= self._run.warn_residual
        if doubted and self._run.scheme.error_order > 0:
            return _step_warning(self._run, max(share, coupling))
        if one.bearing:
            ratio = f"{one.bearing}.balls.damping_ratio"
            damping = [f"--set {ratio}=0.02"] if ratio in system and system.value(ratio) < 0.02 else []
            settings = [
                setting for setting in (_suggest_inner_step(system, one.bearing), *damping) if setting
            ]
            if settings:
                return f"try {' or '.join(settings)}{_otherwise(system, one.bearing)}"
        return f"try {_option(round_down_125(0.5 * self._run.macro_step))}"

    @property
    def worst(self) -> _Sum | None:
        """The bearing whose inside is off most, over what was turned over; None where none is judged."""
        insides = [one for one in self.sums if one.bearing]
        return max(insides, key=lambda one: (math.isnan(one.share), one.share), default=None)

    @property
    def system_sum(self) -> _Sum | None:
        """The system's sum; None where it is not judged."""
        return next((one for one in self.sums if not one.bearing), None)


def energy_share(force_share: float) -> float:
    """The share of energy made that is as grave as a force off by a share of `force_share`."""
    return force_share / FORCE_PER_ENERGY


def _insides(system: System) -> list[_Sum]:
    """A sum for each bearing that states all of its energies, and its work at every port."""
    found: list[_Sum] = []
    for bearing in dict.fromkeys(a.bearing for a in system.attachments):
        ends = [a.bearing_end for a in system.attachments if a.bearing == bearing]
        crossed = [end.full(account) for end in ends for account in (WORK, JUMP)]
        names = [*(f"{bearing}.{energy}" for energy in STORED), *crossed]
        if all(name in system for name in names):
            found.append(_Sum(f"the inside of {bearing}", bearing, names))
    return found


def _system_sums(system: System) -> list[_Sum]:
    """The system's sum; none where a component states nothing, or steps of their own part them in time."""
    states = [{KINETIC, SUPPLIED} & set(c.variables) for c in system.components.values()]
    if not all(states) or system.bonds or max(system.every.values()) > 1:
        return []
    names = [f"{name}.{energy}" for name in system.components for energy in STORED]
    less = [f"{name}.{SUPPLIED}" for name in system.components]
    return [_Sum("the system", "", [n for n in names if n in system], [n for n in less if n in system])]
