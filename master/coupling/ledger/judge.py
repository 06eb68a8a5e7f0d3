"""Warns, then ends the run, where the residual says that the answer is in doubt."""

from __future__ import annotations

from touchdown.master.common.ended import Ended
from touchdown.master.coupling.bonds.ways import way_of
from touchdown.master.coupling.ledger.account import Account, SeatAccount
from touchdown.master.coupling.ledger.accounts import Ledger
from touchdown.master.coupling.observer import Moment, Observer
from touchdown.master.coupling.system import RATE, System
from touchdown.master.scene.run_spec import RunSpec
from touchdown.master.scene.step_sizes import shorter_step

MICRO_STEP, TOLERANCE = "micro_step", "interface.tolerance"
BEYOND = 3.0  # times what a scheme bears; there the macro step alone is to blame


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
    inside = finer(system, bearing) if swing < BEYOND * run.scheme.bears else ""
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
