"""Accounts of all connections: residual, energy made, and what the motion turned over."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from ....modelkit.ports import MODEL
from ...components.component import FORCE, JUMP, MOMENTS, POSITION, THRUST, TILT, WORK
from ..assembly import ORDER
from ..loop.kernels.port_accounts import BOOK, book, shares, worst_of
from ..snapshot import Kept
from ..steppers.stepper import Stepper
from ..system import System
from .account import BondAccount, SeatAccount, WorkAccount
from .auditor import witnesses

VELOCITY = tuple(f"v{axis}" for axis in POSITION)
_ALONG = ("z", THRUST, "vz")  # of the shaft


class Ledger(Kept):
    """Accounts of all attachments and bonds of a system that is initialised.

    scale: what residuals are related to (J), 0: nothing; fall: energy lost by falling (J), 0: unknown.
    """

    KEPT = ("books",)

    def __init__(self, stepper: Stepper, scale: float, fall: float) -> None:
        self.scale, self.fall = scale, fall
        self._system = system = stepper.system
        self.books = np.zeros(len(system.attachments) + len(system.bonds), BOOK)
        rows = iter(self.books)
        self._seats = [SeatAccount(a, next(rows)) for a in system.attachments]
        self._bonds = [BondAccount(c, next(rows)) for c in stepper.crossings]
        crossing = {account.title for account in self._bonds}
        held = [title for bond in system.bonds if (title := bond.title) not in crossing]
        self.accounts: list[WorkAccount] = [*self._seats, *self._bonds]
        self.accounts += [WorkAccount(b, next(rows)) for b in held]
        for account in self.accounts[len(self._seats) + len(self._bonds) :]:
            account.unaudited = f"scheme {stepper.run.scheme.name} holds its values"
        bearings = list(dict.fromkeys(a.bearing for a in system.attachments))
        for number, account in enumerate(self.accounts):
            account.record["group"] = -1 - number  # alone
        for account in self._seats:
            account.record["group"] = bearings.index(account.attachment.bearing)
        in_turn = stepper.run.scheme.sequence == "gauss-seidel"
        self._flows = [_begun(system, account, in_turn) for account in self._seats]
        self._find()
        silent = [account for account in self._seats if not account.record["stating"]]
        self._witnesses = witnesses(stepper, silent)

    def close(self) -> None:
        """Free the instances that listened."""
        for witness in self._witnesses:
            witness.close()

    def retired(self, names: Sequence[str]) -> None:
        """Find the accounts where they now stand in the system's signals; those of the retired rest."""
        for witness in self._witnesses:
            witness.retired(names)
        self._find()

    def _find(self) -> None:
        self._signals, position = self._system.signals, self._system.position
        for account, flow in zip(self._seats, self._flows, strict=True):
            a = account.attachment
            statements = [a.bearing_end.full(WORK), a.bearing_end.full(JUMP), a.body_end.full(WORK)]
            account.record["stating"] = all(name in position for name in statements)
            if account.record["stating"]:
                account.record["statements"] = [position[name] for name in statements]
            across, along, tilting = flow
            account.record["flowing"] = all(name in position for name in across)
            if account.record["flowing"]:
                places = [position[name] for name in across]
                for names in (along, tilting):
                    there = all(name in position for name in names)
                    places += [position[name] if there else -1 for name in names]
                account.record["flow"] = places

    @property
    def listens(self) -> bool:
        """Whether it steps instances of its own to hear what bearings do not state."""
        return bool(self._witnesses)

    def book(self, done: int, step: float) -> None:
        """Book a step of `step` (s) that was just taken, the number `done` (from 1)."""
        book(self.books, self._signals, done)
        for account in self._bonds:
            account.fetch()
        for witness in self._witnesses:
            witness.book(step)

    @property
    def total(self) -> float:
        """Sum of |r_n| over all connections and steps (J)."""
        return sum(account.total for account in self.accounts)

    @property
    def made(self) -> float:
        """Energy that the coupling made, less what it lost (J)."""
        return sum(account.made for account in self.accounts)

    @property
    def turned(self) -> float:
        """Sum of |mean force times displacement| at all ports (J)."""
        return sum(account.turned for account in self.accounts)

    @property
    def turnover(self) -> float:
        """Energy that the motion turned over at all ports, its kinetic energy with it (J)."""
        return sum(account.turnover for account in self.accounts)

    @property
    def residual(self) -> float:
        """Sum of |r_n| over all connections and steps, over the energy scale (or in J without one)."""
        return self.total / self.scale if self.scale > 0.0 else self.total

    def worst(self) -> WorkAccount | None:
        """The account with the largest share of residual; NaN is the worst."""
        worst, _ = worst_of(self.books, self.fall)
        return self.accounts[worst] if worst >= 0 else None

    @property
    def worst_share(self) -> float:
        """The largest share of residual in turnover, of any connection."""
        return worst_of(self.books, self.fall)[1]

    def share_at(self, bearing: str) -> float:
        """The largest share at a bearing's connections; 0 where none is."""
        found = shares(self.books, self.fall)
        at_bearing = [a.attachment.bearing == bearing for a in self._seats]
        return float(np.max(found[: len(at_bearing)][at_bearing], initial=0.0))

    @property
    def unaudited(self) -> tuple[str, ...]:
        """Connections that are not audited, each with why."""
        return tuple(f"{a.title}, {a.unaudited}" for a in self.accounts if a.unaudited)


def _begun(system: System, account: SeatAccount, in_turn: bool) -> tuple[list[str], list[str], list[str]]:
    """Begin an account; returns the names of motion and load from which follows what it turns over.

    They are those across the shaft, along it and of its tilt.

    in_turn: whether bodies take each step after the bearings, under the load of that step.
    """
    a, record = account.attachment, account.record
    # 1/kg; 0: unknown, or prescribed
    gain, gain_z = (system.value(n) if n in system else 0.0 for n in map(a.motion, ("inv_m", "inv_m_z")))
    moves = all(a.motion(v) in system.position for v in VELOCITY) and gain > 0.0
    record["every"] = math.lcm(system.every[a.bearing], system.every[a.body])
    record["mass"] = 1.0 / gain if moves else 0.0
    record["mass_z"] = 1.0 / gain_z if gain_z > 0.0 else 0.0
    record["x"] = math.nan
    record["carried"] = in_turn and not a.on_journal and system.settings.get((a.bearing, ORDER)) == MODEL
    across = [*map(a.motion, POSITION), *map(a.load, FORCE)]
    along = [a.motion("z"), a.load(THRUST), a.motion("vz")]
    tilting = [*map(a.motion, TILT), *map(a.load, MOMENTS)]
    return [*across, *map(a.motion, VELOCITY if moves else POSITION)], along, tilting
