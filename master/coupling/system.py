"""A system: components that are wired up, exchange what they give, and can be stepped."""

from __future__ import annotations

from collections.abc import Callable, Container, Iterable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from ..common.errors import TouchdownError
from ..common.units import scaled
from ..components.component import MAX_EXACT_INTEGER, REACH, Component, FmiType
from .bonds.bond import Bond
from .connections import Attachment, Connection, hit_together, split_name, used_modes
from .signal_layout import InputMap, lay_out_signals

RATE = "contact.rate"  # of a touchdown bearing: how fast the journal swings on its contact, rad/s


@dataclass
class System:
    """Components ready to be stepped; `signals` holds every exchanged output."""

    components: dict[str, Component]
    attachments: list[Attachment]
    connections: list[Connection]
    settings: dict[tuple[str, str], float]
    every: dict[str, int]  # macro steps of the run that each component takes in one
    remarks: Sequence[str] = ()  # what is to be said of it before it runs, a line each
    bonds: Sequence[Bond] = ()
    start: float = 0.0  # s, where its components begin
    stop: float | None = None  # s, after which none of their steps ends, where that is known
    periods: Mapping[str, float] = field(default_factory=dict[str, float])  # s, of components that sample
    texts: Mapping[tuple[str, str], str] = field(default_factory=dict[tuple[str, str], str])  # that are set
    order: list[str] = field(init=False)  # bearings, and what gives a bond's force, before what takes it
    signals: np.ndarray = field(init=False)
    position: Mapping[str, int] = field(init=False)  # of COMPONENT.VARIABLE in the signals
    input_maps: Mapping[str, InputMap] = field(init=False)  # by component: what it takes of the signals
    retired: set[str] = field(init=False, default_factory=set[str])
    hit_together: Sequence[Attachment] = field(init=False)  # seats of bodies that two bearings can hit

    def __post_init__(self) -> None:
        bearings = dict.fromkeys(a.bearing for a in self.attachments)
        order = [*bearings, *(name for name in self.components if name not in bearings)]
        before = [(a.bearing, a.body) for a in self.attachments]
        self.order = _in_order(order, [*before, *((b.force_side, b.motion_side) for b in self.bonds)])
        self.hit_together = hit_together(self.attachments, self.components)
        self._lay_out()

    def warnings(self) -> dict[str, str]:
        """What FMUs warned of, by component."""
        return {name: said for name, component in self.components.items() if (said := component.warned())}

    def close(self) -> str:
        """End and free every component; returns what went wrong first, or ""."""
        problems = [component.close() for component in self.components.values()]
        return next(filter(None, problems), "")

    def value(self, name: str) -> float:
        """Value of COMPONENT.VARIABLE."""
        component, variable = split_name(name, self.components)
        return component.read([variable.name])[0]

    @property
    def divisible(self) -> bool:
        """Whether all components take the same macro steps, of any length, but for those that sample."""
        return all(
            self.every[name] == 1 and (c.any_step or name in self.periods)
            for name, c in self.components.items()
        )

    def __contains__(self, name: str) -> bool:
        """Whether there is COMPONENT.VARIABLE."""
        head, _, tail = name.partition(".")
        return head in self.components and tail in self.components[head].variables

    def reader(self, names: Sequence[str]) -> Callable[[], np.ndarray]:
        """A function that fetches COMPONENT.VARIABLE of one component, for many calls."""
        (component,) = {split_name(name, self.components)[0] for name in names}
        return component.reader([name.partition(".")[2] for name in names])

    def signal(self, name: str) -> float:
        """The latest value of an exchanged COMPONENT.VARIABLE."""
        return float(self.signals[self.position[name]])

    def constant(self, c: Connection) -> bool:
        """Whether what crosses is settled once its source is initialised."""
        return self.components[c.source].variable(c.output).constant

    def initialise(self) -> None:
        """Bring all components through initialisation, exchanging until every input has its value."""
        for component in self.components.values():
            component.enter(self.start, self.stop)
        bodies_first = list(reversed(self.order))
        silent = set(bodies_first)  # what has not told its outputs yet
        for _ in range(2):  # bodies to bearings, and loads back
            for name in bodies_first:
                self._feed_numbers(name, silent)
                self.components[name].pull()
                silent.discard(name)
        self._feed_constants()
        self.connections = used_modes(self.connections, self.components)
        self._lay_out()
        for name in bodies_first:
            self.components[name].pull()
        for name in bodies_first:
            self._feed_numbers(name)
            self.components[name].exit()
            self.components[name].pull()

    def _feed_numbers(self, name: str, silent: Container[str] = ()) -> None:
        """`feed`, but of numbers alone; inputs that `silent` components feed keep their start values.

        A component that will refuse its parameters gives none until it exits from initialisation;
        those that are handed them would refuse, and be blamed, first.
        """
        self.take_inputs(name)
        self._keep_starts(name, silent)
        component = self.components[name]
        if np.isfinite(component.inputs).all():
            component.push()

    def _keep_starts(self, name: str, silent: Container[str]) -> None:
        """Put start values into a component's inputs where what feeds them is `silent` as yet.

        Others' components may not stand a pressure of 0, or a choice with that number.
        """
        component = self.components[name]
        waiting = {c.input for c in self._live() if c.target == name and c.source in silent}
        for place, name_inside in enumerate(self.input_maps[name].inputs):
            start = component.variable(name_inside).start
            if name_inside in waiting and start is not None:
                component.inputs[place] = start

    def feed(self, name: str) -> None:
        """Hand a component its inputs from the signals."""
        self.take_inputs(name)
        self.components[name].push()

    def take_inputs(self, name: str) -> None:
        """Fill a component's inputs from the signals, not yet handing them over."""
        self.components[name].inputs[:] = self.input_maps[name].of(self.signals)

    def retire(self, names: Iterable[str]) -> None:
        """Stop exchanging with components that have nothing left to do; what they gave last stays."""
        for name in self.order:  # the last of what the retired gave, where it has not been taken yet
            self.feed(name)
        self.retired |= set(names)
        self.order = [name for name in self.order if name not in self.retired]
        self._lay_out()
        for name in self.order:
            self.components[name].pull()

    def _feed_constants(self) -> None:
        constant = [c for c in self.connections if self.constant(c)]
        for target in dict.fromkeys(c.target for c in constant):
            mine = [c for c in constant if c.target == target]
            values: dict[str, float] = {}
            for source in dict.fromkeys(c.source for c in mine):
                theirs = [c for c in mine if c.source == source]
                outputs = self.components[source].read([c.output for c in theirs])
                for c, value in zip(theirs, outputs, strict=True):
                    _refuse_rounded(self.components[source], c.output, value)
                    values[c.input] = scaled(value, c.scale)
            self.components[target].set(values)

    def _live(self) -> list[Connection]:
        """Connections that carry something at every step."""
        return [
            c for c in self.connections if not self.constant(c) and not self.retired & {c.source, c.target}
        ]

    def _lay_out(self) -> None:
        """Give everything that is exchanged its place, for exchanges from now on."""
        attachments = [a for a in self.attachments if not self.retired & {a.bearing, a.body}]
        watched = [(a.bearing, REACH) for a in self.hit_together]
        layout = lay_out_signals(self.components, self._live(), attachments, watched)
        self.signals, self.position, self.input_maps = layout.signals, layout.position, layout.input_maps


def _refuse_rounded(source: Component, output: str, value: float) -> None:
    """Raise TouchdownError where the `value` of a whole number may not be all of its digits.

    2^53 itself is refused, too: the next one is read as the same.
    """
    if source.variable(output).kind is not FmiType.REAL and abs(value) >= MAX_EXACT_INTEGER:
        raise TouchdownError(
            f"component {source.name}: {output} = {value:.0f} cannot be handed over; constant whole "
            "numbers can below 2^53"
        )


def _in_order(names: Sequence[str], before: Sequence[tuple[str, str]]) -> list[str]:
    """`names` as they stand, but for those of `before`, whose first comes first; circles are cut open."""
    left, ordered = list(names), list[str]()
    while left:
        late = {second for first, second in before if first in left and first != second}
        ordered.append(next((name for name in left if name not in late), left[0]))
        left.remove(ordered[-1])
    return ordered


def fastest_contact(system: System) -> tuple[str, float]:
    """The bearing whose contact asks for the shortest macro step, and its rate (rad/s).

    A bearing that takes several macro steps in one counts as that much faster.

    Raises TouchdownError where no bearing states one.
    """
    rates = {
        name: system.every[name] * system.value(f"{name}.{RATE}")
        for name in dict.fromkeys(a.bearing for a in system.attachments)
        if RATE in system.components[name].variables
    }
    if not any(rates.values()):
        raise TouchdownError(
            f"no bearing says how fast its contact is (output {RATE}), so no macro step can be advised; "
            "give one"
        )
    return max(rates.items(), key=lambda item: item[1])
