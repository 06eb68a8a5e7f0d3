"""The motion that a body made over a step that is over, told to a bearing part by part."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from touchdown.master.coupling.ledger.account import SeatAccount
from touchdown.master.coupling.system import System

Place = Callable[[str], int | None]
"""Where a variable of the bearing's stands in what it is told; None where it is not told."""


class Path:
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


class Axis:
    """One direction of a port: the body's way along it, and the force that the body was given."""

    def __init__(self, system: System, account: SeatAccount, axis: str, place: Place) -> None:
        a = account.attachment
        self.account, self._system = account, system
        self._told = [place(a.bearing_end.own(n)) for n in (axis, f"v{axis}", f"a{axis}_free")]
        self._x, self._v = (system.position.get(a.motion(n)) for n in (axis, f"v{axis}"))
        self._body = system.components[a.body]
        inputs = list(system.intakes[a.body].inputs)
        names = [a.body_end.own(name) for name in (f"f{axis}", f"df{axis}")]
        self._given = [inputs.index(name) if name in inputs else None for name in names]
        self._before = self._now()
        self._path = Path(0.0, 0.0, 0.0, 0.0, 1.0)

    def _now(self) -> tuple[float, float | None]:
        """Position (m), and velocity (m/s) where it is known."""
        signals = self._system.signals
        x = 0.0 if self._x is None else float(signals[self._x])
        return x, None if self._v is None else float(signals[self._v])

    def follow(self, step: float) -> None:
        """Note where the body is at the end of a step of `step` (s), and with it how it came there."""
        (a, va), (b, vb) = self._before, self._now()
        mean = (b - a) / step
        self._path = Path(a, b, mean if va is None else va, mean if vb is None else vb, step)
        self._before = b, vb

    def tell(self, inputs: np.ndarray, begin: float, end: float, span: float) -> None:
        """Prescribe the part between two fractions of the step, of `span` (s), so that it ends right."""
        at, velocity, acceleration = self._told
        start, moved = self._path.at(begin), self._path.at(end) - self._path.at(begin)
        if velocity is None:  # held: in the middle
            inputs[at] = start + 0.5 * moved
            return
        inputs[at] = start
        inputs[velocity] = moved / span
        if acceleration is not None:
            inputs[velocity] = self._path.rate(begin)
            inputs[acceleration] = 2.0 * (moved - self._path.rate(begin) * span) / span**2

    def given(self, since_middle: float = 0.0) -> float:
        """Force (N) that the body was given, `since_middle` (s) after the middle of the step."""
        mean, slope = (0.0 if place is None else float(self._body.inputs[place]) for place in self._given)
        return mean + slope * since_middle

    def work(self, force: float, begin: float, end: float, step: float) -> float:
        """Work (J) of `force` (N) less that of the force given, over a part of the step of `step` (s)."""
        given = self.given((0.5 * (begin + end) - 0.5) * step)
        return (force - given) * (self._path.at(end) - self._path.at(begin))


class Spin:
    """The spin at a port, from one end of the step to the other."""

    def __init__(self, system: System, account: SeatAccount, place: Place) -> None:
        a = account.attachment
        self._told = [place(a.bearing_end.own(name)) for name in ("omega", "alpha_free")]
        self._at, self._system = system.position.get(a.motion("omega")), system
        self._before = self._end = 0.0 if self._at is None else float(system.signals[self._at])

    def follow(self) -> None:
        """Note the spin (rad/s) at the end of a step."""
        if self._at is not None:
            self._before, self._end = self._end, float(self._system.signals[self._at])

    def tell(self, inputs: np.ndarray, begin: float, end: float, span: float) -> None:
        """Prescribe the part between two fractions of the step, of `span` (s)."""
        at, acceleration = self._told
        gain = self._end - self._before
        if at is not None:
            inputs[at] = self._before + gain * (begin if acceleration is not None else 0.5 * (begin + end))
        if acceleration is not None:
            inputs[acceleration] = gain * (end - begin) / span
