"""What an FMU is given for a polynomial: two held values, one after the other, that act as it would.

A held input acts as a smooth one, to fourth order in the step, where mean and first moment are kept. An FMU
that gives force answers at once to the motion it is told, so the last of these must be that of the end.
"""

from __future__ import annotations

from touchdown.master.coupling.bonds.polynomials import Polynomial

FIRST = 2.0 / 3.0  # of a stretch, for which the first of two motions is held


def motion_holds(p: Polynomial, begin: float, end: float) -> tuple[float, float]:
    """For 2/3 and 1/3 of [begin, end]: mean kept, the second is the value at the end.

    Where it is a straight line the first moment is kept as well; of c tau^2 it is c/36 too large.
    """
    last = p.at(end)
    return 1.5 * p.mean(begin, end) - 0.5 * last, last


def force_holds(p: Polynomial, begin: float, end: float, split: float) -> tuple[float, float]:
    """For [begin, end] divided at the share `split` of it: mean and first moment are kept."""
    mean = p.mean(begin, end)
    jump = 2.0 * p.moment(begin, end) / (split * (1.0 - split))
    return mean - (1.0 - split) * jump, mean + split * jump
