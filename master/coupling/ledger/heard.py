"""What the master hears of contact in a bearing that reports none: from the motion and force that cross.

Such a bearing gets the variables of a report beside its own, so that summary, pictures and comparisons
find them as they find those of the project's bearings. They come of means over macro steps: a contact
shorter than a few of these is heard too low.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np

from touchdown.master.components.component import Component, Kind, Variable
from touchdown.master.components.contract import FORCE, MOUNTED, POSITION
from touchdown.master.coupling.connections import Attachment
from touchdown.modelkit.variables import Causality, Variability

BY_MASTER = "heard by the master from what crosses"
REPORT = "contact.first_time"  # what a bearing that reports its contact has
POWERED = ("shutdown_time", "active")  # what a magnetic bearing has
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
class Row:
    """The last two of a row of means (N) of a force, each over the same time, and the largest so far."""

    last: float = 0.0
    before: float = 0.0
    peak: float = 0.0

    def then(self, mean: float) -> Row:
        """With the next one.

        The momentary peak is that of the parabola with the last three means, where it lies in the middle
        one: the mean over H of a force F is F + F'' H^2 / 24.
        """
        turn = 0.5 * (mean - 2.0 * self.last + self.before)
        lean = 0.5 * (mean - self.before)
        peak = max(self.peak, mean)
        if abs(lean) < -turn and min(mean, self.before) > 0.0:
            peak = max(peak, self.last - turn / 12.0 - lean * lean / (4.0 * turn))
        return Row(mean, self.last, peak)


@dataclass(frozen=True)
class Contact:
    """What was heard so far."""

    force: Row = field(default_factory=Row)  # means over macro steps
    first_time: float = -1.0  # s
    first_speed: float = 0.0  # m/s
    met: float = 0.0  # m, from the middle: at the first contact, or the farthest before it
    farthest: float = 0.0  # m


class Saved(NamedTuple):
    """A state."""

    bearing: object
    contact: Contact


class Heard(Component):
    """A bearing with what the master hears at its `port`."""

    def __init__(self, bearing: Component, port: str) -> None:
        own = bearing.variables
        told = {name: _variable(name) for name in VARIABLES if name not in own}
        super().__init__(bearing.name, bearing.origin, {**own, **told})
        self.units, self.can_save, self.any_step = bearing.units, bearing.can_save, bearing.any_step
        self._bearing, self._port = bearing, port
        self._contact = Contact()
        self._began: float | None = None  # s, of the step that is not heard yet

    # -- heard -----------------------------------------------------------------------------------------

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
        own = [name for name in names if name in self._bearing.variables]
        at = np.array([name in self._bearing.variables for name in names], dtype=bool)
        heard = [name for name in names if name not in self._bearing.variables]
        if not heard:
            return self._bearing.reader(own)
        fetch, values = self._bearing.reader(own), np.zeros(len(names))

        def read() -> np.ndarray:
            values[at] = fetch()
            told = self._values()
            values[~at] = [told[name] for name in heard]
            return values

        return read

    # -- the bearing's ---------------------------------------------------------------------------------

    def second(self) -> Component:
        return self._bearing.second()

    def own_name(self, name: str) -> str:
        return self._bearing.own_name(name)

    def set(self, values: Mapping[str, float]) -> None:
        self._bearing.set(values)

    def enter(self, start_time: float) -> None:
        self._bearing.enter(start_time)

    def exit(self) -> None:
        self._bearing.exit()

    def push(self) -> None:
        self._bearing.push()

    def save(self) -> object:
        return Saved(self._bearing.save(), self._contact)

    def restore(self, state: object) -> None:
        assert isinstance(state, Saved)
        self._bearing.restore(state.bearing)
        self._contact = state.contact

    def release(self, state: object) -> None:
        assert isinstance(state, Saved)
        self._bearing.release(state.bearing)

    def close(self) -> str:
        return self._bearing.close()


def _variable(name: str) -> Variable:
    unit, meaning = VARIABLES[name]
    return Variable(
        name=name,
        reference=-1,
        kind=Kind.REAL,
        causality=Causality.OUTPUT,
        variability=Variability.CONTINUOUS,
        unit=unit,
        minimum=None,
        maximum=None,
        start=None,
        description=f"{meaning}, {BY_MASTER}",
    )


def heard(components: Mapping[str, Component], attachments: Sequence[Attachment]) -> dict[str, Component]:
    """`components`, with what is heard of bearings of others' on a journal that report no contact."""
    listened = dict(components)
    for a in attachments:
        bearing = listened[a.bearing]
        silent = REPORT not in bearing.variables and not any(p in bearing.variables for p in POWERED)
        if bearing.foreign and silent and a.on_journal:
            listened[a.bearing] = Heard(bearing, a.bearing_port)
    return listened


def told_by_master(variable: Variable) -> bool:
    """Whether it is what the master heard."""
    return variable.description.endswith(BY_MASTER)
