"""Macro steps that people can read: 1, 2 or 5 times a power of ten."""

from __future__ import annotations

import math

from touchdown.master.scene.run_spec import RunSpec


def shorter_step(run: RunSpec, share: float, order: int) -> float:
    """A macro step (s) with which the ledger should hold, after `share` of the turnover was too much.

    From the order at which the residual falls with the step, to half of what is warned of.
    """
    wanted = 0.5 * run.warn_residual / share if math.isfinite(share) else 0.0
    step = run.macro_step * max(wanted, 1e-9) ** (1.0 / order)
    return tidy(min(step, 0.5 * run.macro_step))


def tidy(step: float) -> float:
    """The largest of 1, 2 or 5 times a power of ten that is not above `step`."""
    power = 10.0 ** math.floor(math.log10(step))
    return power * max(digit for digit in (1, 2, 5) if digit * power <= step * (1.0 + 1e-9))
