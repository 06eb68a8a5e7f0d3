"""A controller by itself, told one position after another, without a rotor: to be pressed, or measured."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import count, takewhile

import numpy as np

from ..common.errors import TouchdownError
from ..components.component import Component
from .connections import AXIS, SET_POINTS, TOLD, TOLD_OF_ALL


def control_axes(component: Component) -> list[int]:
    """Its axes, counted from 1: those that have a position."""
    names = component.variables
    return list(takewhile(lambda k: AXIS.format(k, TOLD[0]) in names, count(1)))


def set_points(component: Component, axis: int) -> dict[str, str]:
    """An axis' set points that it gives, and their units. Raises TouchdownError where it gives none."""
    names = {AXIS.format(axis, kind): unit for kind, unit in SET_POINTS.items()}
    found = {name: unit for name, unit in names.items() if name in component.variables}
    if found:
        return found
    either = " or ".join(f"{name} (output in {unit})" for name, unit in names.items())
    raise TouchdownError(
        f"{component.origin} has no variable {either}; name what it calls it in a file of names"
    )


class ControllerAlone:
    """Axes of a controller that was not initialised, from its start on."""

    def __init__(
        self, component: Component, axes: Sequence[int], period: float, kinds: Sequence[str] = ()
    ) -> None:
        """period (s): from sample to sample; kinds: of the axes' set points (none: the first each has).

        Raises TouchdownError where it lacks what a controller has.
        """
        self._component, self._period = component, period
        self._calls = 0
        there = component.variables
        self._sensed = [AXIS.format(k, TOLD[0]) for k in axes]
        inputs = [*self._sensed, *TOLD_OF_ALL]
        self._fed = [name for name in inputs if name in there]
        component.bind(self._fed, np.zeros(0), [])
        read = [AXIS.format(*one) for one in zip(axes, kinds, strict=True)] if kinds else None
        self._read = component.reader(read or [next(iter(set_points(component, k))) for k in axes])
        component.enter(0.0)
        self._feed(np.zeros(len(axes)), 0)
        component.exit()

    def sample(self, positions: np.ndarray, parts: int = 1) -> np.ndarray:
        """Set points (n,), A or N, after a call with positions (n,), m; `parts` calls make a period."""
        step = self._period / parts
        self._feed(positions, self._calls // parts + 1)
        self._component.step(self._calls * step, step)
        self._calls += 1
        return np.array(self._read())

    def _feed(self, positions: np.ndarray, tick: int) -> None:
        values = dict(zip(self._sensed, map(float, positions), strict=True))
        values |= dict(zip(TOLD_OF_ALL, (float(tick), self._period), strict=True))
        self._component.inputs[:] = [values[name] for name in self._fed]
        self._component.push()
