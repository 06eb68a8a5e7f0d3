"""Components with macro steps of their own: multiples of the run's.

A bearing may be stepped less often than the body it holds. Its load is then mean + slope (t - t_mid) over
its own, longer step, and the body takes, for each of its shorter ones, the part that falls into it. The
other way round there would be no state of the body to start the bearing's next step from: refused.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from ...common.errors import TouchdownError
from ...components.component import LOAD, SLOPE
from ..connections import Attachment
from ..loop.kernels.signal_exchange import cut
from ..system import System


@dataclass(frozen=True)
class StepPart:
    """A body's inputs from a bearing that takes `bearing` macro steps while the body takes `body`."""

    bearing: int
    body: int
    step: float  # s, the run's
    means: np.ndarray  # places in the body's inputs
    slopes: np.ndarray  # of those means that have one
    last: np.ndarray  # what is due at the end of the bearing's step only

    def cut(self, inputs: np.ndarray, number: int) -> None:
        """Leave in `inputs` what acts in the body's step that begins with macro step `number`."""
        cut(inputs, self.means, self.slopes, self.last, self.bearing, self.body, self.step, number)


class Rates:
    """Hands bodies their part of the loads of bearings that take longer steps."""

    def __init__(self, system: System, step: float) -> None:
        self._parts: dict[str, list[StepPart]] = {}
        for a in system.attachments:
            bearing, body = system.every[a.bearing], system.every[a.body]
            if bearing % body:
                raise TouchdownError(
                    f"{a.body} takes {body} macro steps in one, {a.bearing}, which holds it, {bearing}; "
                    "a bearing's number must be a multiple of its body's: change `every` of one of them"
                )
            if bearing > body and not system.retired & {a.bearing, a.body}:
                self._parts.setdefault(a.body, []).append(_part(system, a, bearing, body, step))

    def parts(self, name: str) -> list[StepPart]:
        """The cutter of the inputs of component `name` to its own macro steps."""
        return self._parts.get(name, [])


def parts_of(system: System, body: str) -> list[StepPart]:
    """Where the loads of all bearings that hold `body` stand in its inputs, each taken step by step."""
    held = [a for a in system.attachments if a.body == body and a.bearing not in system.retired]
    return [_part(system, a, 1, 1, 0.0) for a in held]


def _part(system: System, a: Attachment, bearing: int, body: int, step: float) -> StepPart:
    inputs = system.input_maps[a.body].inputs

    def places(names: Iterable[str]) -> np.ndarray:
        return np.array([inputs.index(name) for name in names if name in inputs], dtype=np.intp)

    return StepPart(
        bearing,
        body,
        step,
        means=places(map(a.body_end.own, LOAD)),
        slopes=places(map(a.body_end.own, SLOPE)),
        last=places(name for name in inputs if name.startswith(a.body_end.own("mode["))),
    )
