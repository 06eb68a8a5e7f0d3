"""Where everything that is exchanged stands: one array of signals, and what each component takes of it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ..components.component import JUMP, WORK, Component
from .connections import Attachment, Connection, full
from .loop.kernels.signal_exchange import scale


@dataclass(frozen=True)
class Scaling:
    """Scales of a component's exchanged inputs."""

    factors: np.ndarray
    offsets: np.ndarray

    def cut(self, inputs: np.ndarray, number: int = 0) -> None:
        """Apply them to `inputs`, in any macro step."""
        scale(inputs, self.factors, self.offsets)


@dataclass(frozen=True)
class InputMap:
    """The signals that a component takes, in the order of its inputs."""

    inputs: tuple[str, ...]  # its variables
    places: np.ndarray  # in the signals
    scalings: tuple[Scaling, ...] = ()  # one, where an input has a scale

    def of(self, signals: np.ndarray) -> np.ndarray:
        """The inputs, in the component's own units."""
        inputs = signals[self.places]
        for scaling in self.scalings:
            scaling.cut(inputs)
        return inputs


@dataclass(frozen=True)
class _Layout:
    """Places of exchanged outputs; the components read into `signals`."""

    signals: np.ndarray
    position: Mapping[str, int]  # of COMPONENT.VARIABLE in the signals
    input_maps: Mapping[str, InputMap]  # by component


def lay_out_signals(
    components: Mapping[str, Component],
    connections: Sequence[Connection],
    attachments: Iterable[Attachment],
    watched: Iterable[tuple[str, str]] = (),
) -> _Layout:
    """Give every exchanged output, and every account, its place, and bind the components to them.

    watched: components and their outputs that are looked at in every step, connected or not.
    """
    outputs = _outputs(components, connections, attachments)
    for name, variable in watched:
        outputs[name] |= {variable: None}
    names = [full(name, variable) for name, variables in outputs.items() for variable in variables]
    position = {name: i for i, name in enumerate(names)}
    signals = np.zeros(len(names))
    input_maps: dict[str, InputMap] = {}
    start = 0
    for name, component in components.items():
        end = start + len(outputs[name])
        input_maps[name] = _input_map([c for c in connections if c.target == name], position)
        component.bind(input_maps[name].inputs, signals[start:end], list(outputs[name]))
        start = end
    return _Layout(signals, position, input_maps)


def _outputs(
    components: Mapping[str, Component],
    connections: Iterable[Connection],
    attachments: Iterable[Attachment],
) -> dict[str, dict[str, None]]:
    """The outputs of each component in order: those that are connected, and the accounts of attachments."""
    outputs: dict[str, dict[str, None]] = {name: {} for name in components}
    for c in connections:
        outputs[c.source][c.output] = None
    for a in attachments:
        for end in (a.bearing_end, a.body_end):
            accounts = (end.own(account) for account in (WORK, JUMP))
            has = components[end.component].variables
            outputs[end.component] |= dict.fromkeys(name for name in accounts if name in has)
    return outputs


def _input_map(fed: Sequence[Connection], position: Mapping[str, int]) -> InputMap:
    places = np.array([position[c.source_name] for c in fed], dtype=np.intp)
    scalings: tuple[Scaling, ...] = ()
    if any(c.scale for c in fed):
        scalings = (Scaling(*np.ascontiguousarray(np.array([c.scale or (1.0, 0.0) for c in fed]).T)),)
    return InputMap(tuple(c.input for c in fed), places, scalings)
