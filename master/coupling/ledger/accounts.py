"""Accounts of all connections: residual, energy made, and what the motion turned over."""

from __future__ import annotations

import math
from collections.abc import Container, Sequence
from itertools import islice

import numpy as np

from touchdown.master.components.contract import FORCE, JUMP, POSITION, WORK
from touchdown.master.coupling.ledger.account import Account
from touchdown.master.coupling.ledger.witness import witnesses
from touchdown.master.coupling.steppers.stepper import Stepper
from touchdown.master.coupling.system import System

TRIFLE = 1e-4  # of the energy lost by falling; what turns over less is not judged by its own measure
MINOR = 0.1  # of what all connections turn over; likewise
VELOCITY = tuple(f"v{axis}" for axis in POSITION)


class _Statements:
    """What both sides of a connection state of their work."""

    def __init__(self, account: Account) -> None:
        a = account.attachment
        self.account = account
        self.names = (a.bearing_end.full(WORK), a.bearing_end.full(JUMP), a.body_end.full(WORK))
        self._by_bearing = self._jumps = self._by_body = 0.0  # J, as last stated
        self._pending = 0.0  # J, work difference of the last step, its jump not yet known

    def book(self, by_bearing: float, jumps: float, by_body: float) -> None:
        """Compare what both have stated (J) up to the end of a step."""
        self.account.book(self._pending + (jumps - self._jumps))
        self._pending = (by_bearing - self._by_bearing) - (by_body - self._by_body)
        self._by_bearing, self._jumps, self._by_body = by_bearing, jumps, by_body


class _Flow:
    """What turns over at a connection: force times displacement, and kinetic energy along the force.

    A journal that slides past a contact brings nothing of its motion along into it.
    """

    def __init__(self, account: Account, gain: float, known: Container[str]) -> None:
        a = account.attachment
        moves = all(a.motion(v) in known for v in VELOCITY) and gain > 0.0
        self.account = account
        self.names = (
            *map(a.motion, POSITION), *map(a.load, FORCE), *map(a.motion, VELOCITY if moves else POSITION)
        )  # fmt: skip
        self._mass = 1.0 / gain if moves else 0.0  # kg, that moves with the port
        self._x = self._y = self._vx = self._vy = math.nan

    def book(self, x: float, y: float, fx: float, fy: float, vx: float, vy: float) -> None:
        """Add a step to (x, y) (m) under the mean load (fx, fy) (N), with the velocity at its end (m/s)."""
        account, squared = self.account, fx * fx + fy * fy
        if squared > 0.0 and self._x == self._x:  # from the second step on
            account.turned += abs(fx * (x - self._x) + fy * (y - self._y))
            along = max(abs(fx * vx + fy * vy), abs(fx * self._vx + fy * self._vy))
            account.kinetic = max(account.kinetic, 0.5 * self._mass * along * along / squared)
        self._x, self._y, self._vx, self._vy = x, y, vx, vy


class Ledger:
    """Accounts of all attachments of a system that is initialised.

    scale: what residuals are related to (J), 0: nothing; fall: energy lost by falling (J), 0: unknown.
    """

    def __init__(self, stepper: Stepper, scale: float, fall: float) -> None:
        self.scale, self.fall = scale, fall
        self._system = system = stepper.system
        self.accounts = [
            Account(a, math.lcm(system.every[a.bearing], system.every[a.body])) for a in system.attachments
        ]
        position = system.position
        stated = [_Statements(account) for account in self.accounts]
        self._stated = [s for s in stated if all(name in position for name in s.names)]
        self._flows = [_Flow(account, _gain(system, account), position) for account in self.accounts]
        heard = {s.account.attachment for s in self._stated}
        self._witnesses = witnesses(stepper, [a for a in self.accounts if a.attachment not in heard])
        self._find()

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
        self._stated = [s for s in self._stated if all(name in position for name in s.names)]
        self._flows = [f for f in self._flows if all(name in position for name in f.names)]
        self._places = np.array(
            [position[name] for kept in (*self._stated, *self._flows) for name in kept.names], dtype=np.intp
        )

    def book(self, done: int, step: float) -> None:
        """Book a step of `step` (s) that was just taken, the number `done` (from 1)."""
        values = iter(self._signals[self._places].tolist())
        for stated, *work in zip(self._stated, values, values, values, strict=False):
            if done % stated.account.every == 0:
                stated.book(*work)
        for flow in self._flows:
            flow.book(*islice(values, 6))
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

    def share(self, account: Account) -> float:
        """The residual of an account over what it turned over; 0 where nothing was."""
        over = max(account.turnover, MINOR * self.turnover) + TRIFLE * self.fall
        return account.total / over if over != 0.0 else 0.0

    def worst(self) -> Account | None:
        """The account with the largest share of residual; one that is no number is the worst."""
        return max(self.accounts, key=lambda a: _ordered(self.share(a)), default=None)

    @property
    def worst_title(self) -> str:
        """The connection with the largest share, for people; empty where there is none."""
        worst = self.worst()
        return worst.attachment.title if worst else ""

    @property
    def worst_share(self) -> float:
        """The largest share of residual in turnover, of any connection."""
        worst = self.worst()
        return self.share(worst) if worst else 0.0

    @property
    def unaudited(self) -> tuple[str, ...]:
        """Connections that are not audited, each with why."""
        return tuple(f"{a.attachment.title}, {a.unaudited}" for a in self.accounts if a.unaudited)


def _ordered(share: float) -> float:
    return math.inf if math.isnan(share) else share


def _gain(system: System, account: Account) -> float:
    """Acceleration per force at an account's port (1/kg); 0: unknown, or prescribed."""
    name = account.attachment.motion("inv_m")
    return system.value(name) if name in system else 0.0
