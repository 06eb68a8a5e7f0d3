"""Bearings that keep no account: contact estimated by the master, and work measured by a second instance.

The loads that such a bearing hands over do not tell what the coupling made: a mean force over a step in
which the contact opens and closes is consistent with any loss. So a second instance of its FMU
(`_ShadowInstance`) is given, in parts of each step that is over, the motion that the bodies really made,
prescribed as the contract has it (`inv_m` = 0). With its loads F along that motion, and the loads G that
the bodies were given,

    r = sum (F_j - G_j) . (x_j+1 - x_j)

is the residual, over the parts j. The bodies' motion between the ends of a step is the cubic through their
positions and velocities. Moments are left out: what spin loses to friction does not come back as motion.

A bearing that reports no contact gets the variables of such a report beside its own
(`_ContactEstimator`), made from the motion and force that cross, so that summary, pictures and comparisons
find them as they find those of the project's bearings. They come from means over macro steps: a
contact shorter than a few of these is estimated too low.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np

from ....modelkit.ports import MODEL
from ....modelkit.variables import Causality, Variability
from ...common.errors import TouchdownError
from ...common.units import scaled
from ...components.component import (
    ACROSS,
    DIRECTIONS,
    FORCE,
    GAINS,
    MOUNTED,
    POSITION,
    Component,
    FmiType,
    PortDirection,
    ScalarVariable,
    Setting,
)
from ..assembly import LEAD, ORDER
from ..connections import Attachment, Connection
from ..steppers.stepper import Stepper
from ..system import System
from .account import SeatAccount

Place = Callable[[str], int | None]
"""Where a variable of the bearing's stands in what it is told; None where it is not told."""


class _Path:
    """A coordinate from a to b within `step` (s): the cubic with the rates va and vb at its ends."""

    def __init__(self, a: float, b: float, va: float, vb: float, step: float) -> None:
        self._step = step
        self._a, self._va = a, va * step
        self._c = 3.0 * (b - a) - (2.0 * va + vb) * step
        self._d = (va + vb) * step - 2.0 * (b - a)

    def at(self, s: float) -> float:
        """At the fraction `s` of the step."""
        return self._a + s * (self._va + s * (self._c + s * self._d))

    def rate(self, s: float) -> float:
        """Its velocity at the fraction `s` of the step."""
        return (self._va + s * (2.0 * self._c + 3.0 * s * self._d)) / self._step


class _Axis:
    """One way of a port (m, or of a tilt rad), and the force (or moment) that the body was given."""

    def __init__(self, system: System, account: SeatAccount, way: PortDirection, place: Place) -> None:
        a = account.attachment
        self.account, self._system = account, system
        self._places = [place(a.bearing_end.own(n)) for n in (way.place, way.rate, way.acceleration)]
        self._x, self._v = (system.position.get(a.motion(n)) for n in (way.place, way.rate))
        self._body = system.components[a.body]
        inputs = list(system.input_maps[a.body].inputs)
        names = [a.body_end.own(name) for name in (way.load, f"d{way.load}")]
        self._given = [inputs.index(name) if name in inputs else None for name in names]
        self._before = self._now()
        self._path = _Path(0.0, 0.0, 0.0, 0.0, 1.0)

    def _now(self) -> tuple[float, float | None]:
        """Position (m), and velocity (m/s) where it is known."""
        signals = self._system.signals
        x = 0.0 if self._x is None else float(signals[self._x])
        return x, None if self._v is None else float(signals[self._v])

    def follow(self, step: float) -> None:
        """Note where the body is at the end of a step of `step` (s), and with it how it came there."""
        (a, va), (b, vb) = self._before, self._now()
        mean = (b - a) / step
        self._path = _Path(a, b, mean if va is None else va, mean if vb is None else vb, step)
        self._before = b, vb

    def tell(self, inputs: np.ndarray, begin: float, end: float, span: float) -> None:
        """Prescribe the part between two fractions of the step, of `span` (s): its end is exact."""
        position, velocity, acceleration = self._places
        start, moved = self._path.at(begin), self._path.at(end) - self._path.at(begin)
        if velocity is None:  # held: in the middle
            inputs[position] = start + 0.5 * moved
            return
        inputs[position] = start
        inputs[velocity] = moved / span
        if acceleration is not None:
            inputs[velocity] = self._path.rate(begin)
            inputs[acceleration] = 2.0 * (moved - self._path.rate(begin) * span) / span**2

    def force_given(self, since_middle: float = 0.0) -> float:
        """Force (N) that the body was given, `since_middle` (s) after the middle of the step."""
        mean, slope = (0.0 if place is None else float(self._body.inputs[place]) for place in self._given)
        return mean + slope * since_middle

    def work(self, force: float, begin: float, end: float, step: float) -> float:
        """Work (J) of `force` (N) less that of the force given, over a part of the step of `step` (s)."""
        reference = self.force_given((0.5 * (begin + end) - 0.5) * step)
        return (force - reference) * (self._path.at(end) - self._path.at(begin))


class _Spin:
    """The spin at a port, from one end of the step to the other."""

    def __init__(self, system: System, account: SeatAccount, place: Place) -> None:
        a = account.attachment
        self._places = [place(a.bearing_end.own(name)) for name in ("omega", "alpha_free")]
        self._at, self._system = system.position.get(a.motion("omega")), system
        self._before = self._end = 0.0 if self._at is None else float(system.signals[self._at])

    def follow(self) -> None:
        """Note the spin (rad/s) at the end of a step."""
        if self._at is not None:
            self._before, self._end = self._end, float(self._system.signals[self._at])

    def tell(self, inputs: np.ndarray, begin: float, end: float, span: float) -> None:
        """Prescribe the part between two fractions of the step, of `span` (s)."""
        angle, acceleration = self._places
        gain = self._end - self._before
        if angle is not None:
            since = begin if acceleration is not None else 0.5 * (begin + end)
            inputs[angle] = self._before + gain * since
        if acceleration is not None:
            inputs[acceleration] = gain * (end - begin) / span


ESTIMATED_BY_MASTER = "estimated by the master from forces and motions that it passes on"
REPORT = "contact.first_time"  # what a bearing that reports its contact has
POWERED = ("shutdown_time", "active", "supplied")  # what magnetic bearings and exciters have
CLEARANCE = "clearance"
VARIABLES = {  # name: unit and meaning
    "contact.force": ("N", "mean contact force on the journal over the last macro step"),
    "contact.peak_force": ("N", "largest contact force since the start"),
    "contact.first_time": ("s", "begin of the macro step with the first contact, -1: none yet"),
    "contact.first_speed": ("m/s", "speed of the journal then"),
    "contact.peak_indentation": ("m", "how far the journal came beyond the clearance"),
    CLEARANCE: (
        "m",
        "distance from the middle at the first contact, the largest before that",
    ),
}


@dataclass(frozen=True)
class _Row:
    """The last two of a row of means (N) of a force, each over the same time, and the largest so far."""

    last: float = 0.0
    before: float = 0.0
    peak: float = 0.0

    def then(self, mean: float) -> _Row:
        """With the next one.

        The momentary peak is that of the parabola with the last three means, where it lies in the middle
        one: the mean over H of a force F is F + F'' H^2 / 24.
        """
        turn = 0.5 * (mean - 2.0 * self.last + self.before)
        lean = 0.5 * (mean - self.before)
        peak = max(self.peak, mean)
        if abs(lean) < -turn and min(mean, self.before) > 0.0:
            peak = max(peak, self.last - turn / 12.0 - lean * lean / (4.0 * turn))
        return _Row(mean, self.last, peak)


@dataclass(frozen=True)
class _Contact:
    """Estimates of a contact so far."""

    force: _Row = field(default_factory=_Row)  # means over macro steps
    first_time: float = -1.0  # s
    first_speed: float = 0.0  # m/s
    met: float = 0.0  # m, from the middle: at the first contact, or the farthest before it
    farthest: float = 0.0  # m


class _Saved(NamedTuple):
    """A state."""

    bearing: object
    contact: _Contact


class _ContactEstimator(Component):
    """A bearing with what the master hears at its `port`."""

    def __init__(self, bearing: Component, port: str) -> None:
        variables = bearing.variables
        estimated = {name: _variable(name) for name in VARIABLES if name not in variables}
        super().__init__(bearing.name, bearing.origin, {**variables, **estimated})
        self.units, self.can_save, self.any_step = bearing.units, bearing.can_save, bearing.any_step
        self.third_party = bearing.third_party
        self._bearing, self._port = bearing, port
        self._contact = _Contact()
        self._began: float | None = None  # s, of the step that is not heard yet

    # -- estimates -----------------------------------------------------------------------------------------

    def bind(self, inputs: Sequence[str], outputs: np.ndarray, names: Sequence[str]) -> None:
        self._bearing.bind(inputs, outputs, names)
        self.inputs, self.outputs = self._bearing.inputs, outputs
        place = {name: k for k, name in enumerate(inputs)}
        self._journal = [place[f"{self._port}.{axis}"] for axis in POSITION]
        middle = [f"{MOUNTED}.{axis}" for axis in POSITION]
        self._middle = [place[name] for name in middle] if all(name in place for name in middle) else []
        self._speed = [place[n] for axis in POSITION if (n := f"{self._port}.v{axis}") in place]
        self._force = [list(names).index(f"{self._port}.{force}") for force in FORCE]

    def step(self, time: float, step: float) -> None:
        self._bearing.step(time, step)
        self._began = time

    def pull(self) -> None:
        self._bearing.pull()
        if self._began is not None:
            self._listen(self._began)
            self._began = None

    def _listen(self, began: float) -> None:
        """Hear a macro step that began then; the inputs are those it began with."""
        contact, place = self._contact, self.inputs[self._journal]
        if self._middle:
            place = place - self.inputs[self._middle]
        radius = math.hypot(*place)
        force = math.hypot(*self.outputs[self._force])
        if contact.first_time < 0.0:
            contact = replace(contact, met=max(contact.met, radius))
            if force > 0.0:
                speed = math.hypot(*self.inputs[self._speed])
                contact = replace(contact, met=radius, first_time=began, first_speed=speed)
        farthest = max(contact.farthest, radius)
        self._contact = replace(contact, force=contact.force.then(force), farthest=farthest)

    def _values(self) -> Mapping[str, float]:
        contact = self._contact
        clearance = contact.met
        if CLEARANCE in self._bearing.variables:
            clearance = self._bearing.read([CLEARANCE])[0]
        return {
            "contact.force": contact.force.last,
            "contact.peak_force": contact.force.peak,
            "contact.first_time": contact.first_time,
            "contact.first_speed": contact.first_speed,
            "contact.peak_indentation": max(contact.farthest - clearance, 0.0),
            CLEARANCE: clearance,
        }

    def reader(self, names: Sequence[str]) -> Callable[[], np.ndarray]:
        read_names = [name for name in names if name in self._bearing.variables]
        is_read = np.array([name in self._bearing.variables for name in names], dtype=bool)
        estimated = [name for name in names if name not in self._bearing.variables]
        if not estimated:
            return self._bearing.reader(read_names)
        fetch, values = self._bearing.reader(read_names), np.zeros(len(names))

        def read() -> np.ndarray:
            values[is_read] = fetch()
            estimates = self._values()
            values[~is_read] = [estimates[name] for name in estimated]
            return values

        return read

    # -- the bearing's ---------------------------------------------------------------------------------

    def second(self) -> Component:
        return self._bearing.second()

    def own_name(self, name: str) -> str:
        return self._bearing.own_name(name)

    def set(self, values: Mapping[str, Setting]) -> None:
        self._bearing.set(values)

    def enter(self, start_time: float, stop_time: float | None = None) -> None:
        self._bearing.enter(start_time, stop_time)

    def exit(self) -> None:
        self._bearing.exit()

    def push(self) -> None:
        self._bearing.push()

    def save(self) -> object:
        return _Saved(self._bearing.save(), self._contact)

    def restore(self, state: object) -> None:
        assert isinstance(state, _Saved)
        self._bearing.restore(state.bearing)
        self._contact = state.contact

    def release(self, state: object) -> None:
        assert isinstance(state, _Saved)
        self._bearing.release(state.bearing)

    def warned(self) -> str:
        return self._bearing.warned()

    def close(self) -> str:
        return self._bearing.close()


def _variable(name: str) -> ScalarVariable:
    unit, meaning = VARIABLES[name]
    return ScalarVariable(
        name=name,
        reference=-1,
        kind=FmiType.REAL,
        causality=Causality.OUTPUT,
        variability=Variability.CONTINUOUS,
        unit=unit,
        minimum=None,
        maximum=None,
        start=None,
        description=f"{meaning}, {ESTIMATED_BY_MASTER}",
    )


def with_estimates(
    components: Mapping[str, Component], attachments: Sequence[Attachment]
) -> dict[str, Component]:
    """`components`, with what is estimated of foreign bearings on a journal that report no contact."""
    known = dict(components)
    for a in attachments:
        bearing = known[a.bearing]
        silent = REPORT not in bearing.variables and not any(p in bearing.variables for p in POWERED)
        if bearing.foreign and silent and a.on_journal:
            known[a.bearing] = _ContactEstimator(bearing, a.bearing_port)
    return known


def estimated_by_master(variable: ScalarVariable) -> bool:
    """Whether it is what the master estimates."""
    return variable.description.endswith(ESTIMATED_BY_MASTER)


LOADED_STEP_PARTS = 4  # of a step in which there is a load
FOLLOWS_PRESCRIBED = {
    ORDER: MODEL,
    LEAD: 0,
}  # it follows what is prescribed, and hands over what acted meanwhile


def witnesses(stepper: Stepper, accounts: Iterable[SeatAccount]) -> list[_ShadowInstance]:
    """One for each bearing of `accounts`, whose sides do not both state their work.

    Where there can be none, the accounts say why.
    """
    by_bearing: dict[str, list[SeatAccount]] = {}
    for account in accounts:
        by_bearing.setdefault(account.attachment.bearing, []).append(account)
    found: list[_ShadowInstance] = []
    for theirs in by_bearing.values():
        try:
            _check(stepper, theirs)
            found.append(_ShadowInstance(stepper.system, theirs))
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


class _ShadowInstance:
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
        set_in = {**system.settings, **system.texts}
        settings = {key: value for (name, key), value in set_in.items() if name == self._bearing}
        component.set(
            settings | {key: value for key, value in FOLLOWS_PRESCRIBED.items() if key in settings}
        )
        fed = [c for c in system.connections if c.target == self._bearing and not _carries(c)]
        component.set({c.input: _value(system, c) for c in fed if system.constant(c)})
        varying = [c for c in fed if not system.constant(c)]
        self._inputs = [c.input for c in varying]
        self._directions = [(a, way) for a in self._accounts for way in DIRECTIONS if self._moves(a, way)]
        forces = [a.attachment.bearing_end.own(way.load) for a, way in self._directions]
        self._forces = np.zeros(len(forces))
        component.bind(self._inputs, self._forces, forces)
        component.enter(system.start, system.stop)
        component.inputs[:] = [_value(system, c) for c in varying]
        component.push()
        component.exit()
        component.pull()

    def _moves(self, account: SeatAccount, way: PortDirection) -> bool:
        """Whether it is told of a motion that way, and gives a load; across the shaft it is."""
        port = account.attachment.bearing_end
        gives = port.own(way.load) in self._component.variables
        return way in ACROSS or (gives and self._place(port.own(way.place)) is not None)

    def _place(self, name: str) -> int | None:
        return self._inputs.index(name) if name in self._inputs else None

    def _find(self) -> None:
        """Find motion and loads where they now stand in the system."""
        system = self._system
        self._axes = [_Axis(system, a, way, self._place) for a, way in self._directions]
        self._spins = [_Spin(system, a, self._place) for a in self._accounts]
        self._input_map = system.input_maps[self._bearing]
        taken = list(self._input_map.inputs)
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
        loaded = self._forces.any() or any(axis.force_given() for axis in self._axes)
        try:
            residuals = self._walk(step, LOADED_STEP_PARTS if loaded else 1)
        except TouchdownError as error:
            _leave(self._accounts, f"the second instance that listens failed: {error}")
            self._accounts = ()
            return
        for account in self._accounts:
            works = [r for r, axis in zip(residuals, self._axes, strict=True) if axis.account is account]
            account.book(float(sum(works)))

    def _walk(self, step: float, parts: int) -> np.ndarray:
        """Take the step in parts; returns the residuals (J) of all axes."""
        component, span = self._component, step / parts
        residuals = np.zeros(len(self._axes))
        component.inputs[self._here] = self._input_map.of(self._system.signals)[self._there]
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
    """The present value of a connection's input."""
    return scaled(system.value(c.source_name), c.scale)
