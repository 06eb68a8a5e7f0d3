"""What is done to a component's inputs between taking and handing them over."""

# pyright: basic

from __future__ import annotations

import numpy as np

from touchdown.master.coupling.loop.kernels import kernel


@kernel
def scale(inputs: np.ndarray, factors: np.ndarray, offsets: np.ndarray) -> None:
    """Bring `inputs` (n,), in place, to the component's own units."""
    for i in range(len(inputs)):
        inputs[i] *= factors[i]
        inputs[i] += offsets[i]


@kernel
def cut(
    inputs: np.ndarray,
    means: np.ndarray,
    slopes: np.ndarray,
    last: np.ndarray,
    bearing: int,
    body: int,
    step: float,
    number: int,
) -> None:
    """Leave in a body's `inputs` what of a bearing's load acts in the step that begins with `number`.

    means, slopes, last: places in the inputs, as in `Part`; bearing, body: macro steps of `step` (s) that
    each takes in one.
    """
    begins = number % bearing
    middle = (begins + 0.5 * (body - bearing)) * step  # from that of the bearing's step
    for i in range(len(slopes)):
        inputs[means[i]] += inputs[slopes[i]] * middle
    if begins + body < bearing:
        for i in range(len(last)):
            inputs[last[i]] = 0.0
