"""A component at the ends of bonds takes a macro step in parts, each with inputs of its own."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ...common.units import Scale
from ..system import System
from .bond import BondHold
from .exchange import FIRST_SHARE, BondExchange, force_holds


class _Part(NamedTuple):
    """Of a macro step, as shares of it."""

    begin: float
    length: float
    hold: int  # which of the two holds of its stretch acts
    ends: bool  # whether that hold ends with it


class _Stretch(NamedTuple):
    """Of a macro step: over it inputs are two holds, the first for the share `split`."""

    begin: float
    end: float
    split: float
    parts: tuple[_Part, ...]


def _stretches(count: int, split: float, any_step: bool) -> tuple[_Stretch, ...]:
    """A macro step in `count` stretches, each in two parts; in equal ones for what takes no others."""
    return tuple(_stretch(k / count, (k + 1) / count, split, any_step) for k in range(count))


def _stretch(begin: float, end: float, split: float, any_step: bool) -> _Stretch:
    length = end - begin
    if split == FIRST_SHARE and not any_step:
        third = length / 3.0
        parts: tuple[_Part, ...] = (
            _Part(begin, third, 0, False),
            _Part(begin + third, third, 0, True),
            _Part(end - third, third, 1, True),
        )
    else:
        first = split * length
        parts = _Part(begin, first, 0, True), _Part(begin + first, length - first, 1, True)
    return _Stretch(begin, end, split, parts)


@dataclass(frozen=True)
class _Input:
    """Where a component takes what crosses a bond."""

    crossing: BondExchange
    places: tuple[int, ...]  # in its inputs
    scales: tuple[Scale | None, ...]

    def put(self, inputs: np.ndarray, values: Sequence[float]) -> None:
        """Hand `values` over."""
        for place, scale, value in zip(self.places, self.scales, values, strict=True):
            inputs[place] = value if scale is None else scale[0] * value + scale[1]


class SubstepLoads(NamedTuple):
    """Places of a seat's loads in the inputs of the body that it holds."""

    means: np.ndarray
    slopes: np.ndarray  # of those means that have one
    last: np.ndarray  # what is due at the end of the macro step only

    def cut(self, inputs: np.ndarray, part: _Part, step: float) -> None:
        """Leave in `inputs` what acts in a part of a macro step of `step` (s)."""
        later = (part.begin + 0.5 * part.length - 0.5) * step
        inputs[self.means[: len(self.slopes)]] += inputs[self.slopes] * later
        if part.begin + part.length < 1.0 - 1e-9:
            inputs[self.last] = 0.0


class BondedTurn:
    """Steps one component."""

    def __init__(
        self, system: System, name: str, crossings: Sequence[BondExchange], loads: Sequence[SubstepLoads]
    ) -> None:
        self._system, self._name, self._loads = system, name, loads
        self._component = system.components[name]
        inputs = list(system.input_maps[name].inputs)

        def make_input(crossing: BondExchange, force: bool) -> _Input:
            wires = [crossing.bond.force] if force else list(crossing.bond.motion)
            return _Input(
                crossing, tuple(inputs.index(c.input) for c in wires), tuple(c.scale for c in wires)
            )

        self._gives = [make_input(c, force=False) for c in crossings if c.bond.force_side == name]
        self._takes = [make_input(c, force=True) for c in crossings if c.bond.motion_side == name]
        self._stretches = self._divided(
            [c.way for c in crossings if name in (c.bond.force_side, c.bond.motion_side)]
        )

    def _divided(self, ways: Sequence[BondHold]) -> tuple[_Stretch, ...]:
        if all(way.held for way in ways) and not self._gives:
            return (_Stretch(0.0, 1.0, 0.5, (_Part(0.0, 1.0, 0, True),)),)
        moves = bool(self._gives) and not all(way.held for way in ways)
        count = max(way.stretches for way in ways) if self._gives else 1
        return _stretches(count, FIRST_SHARE if moves else 0.5, self._component.any_step)

    def take(self, time: float, step: float) -> None:
        """The whole macro step."""
        component = self._component
        self._system.take_inputs(self._name)
        base = component.inputs.copy()
        for stretch in self._stretches:
            held = list(self._holds(stretch))
            for part in stretch.parts:
                component.inputs[:] = base
                for loads in self._loads:
                    loads.cut(component.inputs, part, step)
                for put, holds in held:
                    put.put(component.inputs, holds[part.hold])
                component.push()
                component.step(time + part.begin * step, part.length * step)
                component.pull()
                if part.ends:
                    self._tell(held, part)

    def _holds(self, stretch: _Stretch) -> Iterator[tuple[_Input, tuple[list[float], list[float]]]]:
        """Inputs in both holds of a stretch."""
        for put in self._gives:
            yield put, put.crossing.motion_holds(stretch.begin, stretch.end)
        for put in self._takes:
            first, last = force_holds(put.crossing.force, stretch.begin, stretch.end, stretch.split)
            yield put, ([first], [last])

    def _tell(self, held: Sequence[tuple[_Input, tuple[list[float], list[float]]]], part: _Part) -> None:
        for put, holds in held[: len(self._gives)]:
            put.crossing.observe(part.begin + part.length, holds[part.hold], last=part.hold == 1)
