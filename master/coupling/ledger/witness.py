"""Who listens to a bearing that keeps no account of its work.

The loads that such a bearing hands over do not tell what the coupling made: a mean force over a step in
which the contact opens and closes is consistent with any loss. So a second instance of its FMU is told, in
parts of each step that is over, the motion that the bodies really made, prescribed as the contract has it
(`inv_m` = 0). With its loads F along that motion, and the loads G that the bodies were given,

    r = sum (F_j - G_j) . (x_j+1 - x_j)

is the residual, over the parts j. The bodies' motion between the ends of a step is the cubic through their
positions and velocities. Moments are left out: what spin loses to friction does not come back as motion.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from touchdown.master.common.errors import TouchdownError
from touchdown.master.common.units import scaled
from touchdown.master.components.contract import FORCE, GAINS, POSITION
from touchdown.master.coupling.assembly import LEAD, ORDER
from touchdown.master.coupling.connections import Connection
from touchdown.master.coupling.ledger.account import SeatAccount
from touchdown.master.coupling.ledger.followed import Axis, Spin
from touchdown.master.coupling.steppers.stepper import Stepper
from touchdown.master.coupling.system import System
from touchdown.modelkit.ports import MODEL

PARTS = 4  # of a step in which there is a load
AS_TOLD = {ORDER: MODEL, LEAD: 0}  # it follows what is prescribed, and hands over what acted meanwhile


def witnesses(stepper: Stepper, accounts: Iterable[SeatAccount]) -> list[Witness]:
    """One for each bearing of `accounts`, whose sides do not both state their work.

    Where there can be none, the accounts say why.
    """
    by_bearing: dict[str, list[SeatAccount]] = {}
    for account in accounts:
        by_bearing.setdefault(account.attachment.bearing, []).append(account)
    found: list[Witness] = []
    for theirs in by_bearing.values():
        try:
            _check(stepper, theirs)
            found.append(Witness(stepper.system, theirs))
        except TouchdownError as error:
            _leave(theirs, str(error))
    return found


def _check(stepper: Stepper, accounts: Iterable[SeatAccount]) -> None:
    """Raise TouchdownError where steps or loads do not let themselves be followed."""
    system = stepper.system
    if not stepper.in_one:
        raise TouchdownError(f"scheme {stepper.run.scheme.name} repeats or divides its steps")
    for a in (account.attachment for account in accounts):
        if max(system.every[a.bearing], system.every[a.body]) > 1:
            raise TouchdownError(f"{a.bearing} or {a.body} takes macro steps of its own")
        if any(c.scale for c in system.connections if {c.source, c.target} == {a.bearing, a.body}):
            raise TouchdownError("what crosses is scaled")


def _leave(accounts: Iterable[SeatAccount], why: str) -> None:
    for account in accounts:
        account.unaudited = why


class Witness:
    """A second instance of a bearing, told the motion that the bodies really made.

    Raises TouchdownError where there can be no second one.
    """

    def __init__(self, system: System, accounts: Sequence[SeatAccount]) -> None:
        self._system = system
        self._accounts: Sequence[SeatAccount] = accounts  # none once it hears no more
        self._bearing = accounts[0].attachment.bearing
        self._component = system.components[self._bearing].second()
        self._time = system.start  # s
        try:
            self._begin()
        except TouchdownError:
            self._component.close()
            raise
        self._find()

    def _begin(self) -> None:
        """Initialise it as the bearing was, without what it would carry the bodies by."""
        system, component = self._system, self._component
        settings = {key: value for (name, key), value in system.settings.items() if name == self._bearing}
        component.set(settings | {key: value for key, value in AS_TOLD.items() if key in settings})
        fed = [c for c in system.connections if c.target == self._bearing and not _carries(c)]
        component.set({c.input: _value(system, c) for c in fed if system.constant(c)})
        told = [c for c in fed if not system.constant(c)]
        self._inputs = [c.input for c in told]
        forces = [a.attachment.bearing_end.own(force) for a in self._accounts for force in FORCE]
        self._forces = np.zeros(len(forces))
        component.bind(self._inputs, self._forces, forces)
        component.enter(system.start)
        component.inputs[:] = [_value(system, c) for c in told]
        component.push()
        component.exit()
        component.pull()

    def _place(self, name: str) -> int | None:
        return self._inputs.index(name) if name in self._inputs else None

    def _find(self) -> None:
        """Find motion and loads where they now stand in the system."""
        system = self._system
        self._axes = [Axis(system, a, axis, self._place) for a in self._accounts for axis in POSITION]
        self._spins = [Spin(system, a, self._place) for a in self._accounts]
        self._intake = system.intakes[self._bearing]
        taken = list(self._intake.inputs)
        held = [(self._inputs.index(name), taken.index(name)) for name in self._inputs if name in taken]
        self._here, self._there = np.array(held, dtype=np.intp).reshape(-1, 2).T

    def retired(self, names: Sequence[str]) -> None:
        """These components are stepped no more, and what is exchanged stands elsewhere."""
        gone = set(names)
        if any({a.attachment.bearing, a.attachment.body} & gone for a in self._accounts):
            self._accounts = ()
        else:
            self._find()

    def book(self, step: float) -> None:
        """Follow a step of `step` (s) that was just taken, and book what it made."""
        if not self._accounts:
            return
        for axis in self._axes:
            axis.follow(step)
        for spin in self._spins:
            spin.follow()
        loaded = self._forces.any() or any(axis.given() for axis in self._axes)
        try:
            residuals = self._walk(step, PARTS if loaded else 1)
        except TouchdownError as error:
            _leave(self._accounts, f"the second instance that listens failed: {error}")
            self._accounts = ()
            return
        for account, x, y in zip(self._accounts, residuals[::2], residuals[1::2], strict=True):
            account.book(float(x + y))

    def _walk(self, step: float, parts: int) -> np.ndarray:
        """Take the step in parts; returns the residuals (J) of all axes."""
        component, span = self._component, step / parts
        residuals = np.zeros(len(self._axes))
        component.inputs[self._here] = self._intake.of(self._system.signals)[self._there]
        for part in range(parts):
            begin, end = part / parts, (part + 1) / parts
            for one in (*self._axes, *self._spins):
                one.tell(component.inputs, begin, end, span)
            component.push()
            component.step(self._time + part * span, span)
            component.pull()
            residuals += [
                axis.work(force, begin, end, step)
                for axis, force in zip(self._axes, self._forces.tolist(), strict=True)
            ]
        self._time += step
        return residuals

    def close(self) -> None:
        """Free the instance."""
        self._component.close()


def _carries(c: Connection) -> bool:
    """Whether what crosses is there for the bearing to carry the body by."""
    return c.input.rpartition(".")[2] in GAINS or "mode[" in c.input


def _value(system: System, c: Connection) -> float:
    """What a connection's input gets now."""
    return scaled(system.value(c.source_name), c.scale)
