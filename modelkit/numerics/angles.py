"""Cosine and sine from sums and products alone, so that loops over angles become vector code.

The angle is brought into a quarter turn around zero by two parts of pi/2 (Cody and Waite), where the
polynomials of fdlibm hold to rounding.
"""

from __future__ import annotations

import math

from touchdown.modelkit.kernel import woven

PER_QUARTER = 2.0 / math.pi
QUARTER, QUARTER_REST = 1.57079632673412561417, 6.07710050650619224932e-11  # add up to pi/2
ROUND = 6755399441055744.0  # 1.5 * 2^52: adding it leaves no room for a fraction


@woven
def cosine_and_sine(angle):
    """(cos, sin) of `angle` (rad), to 2e-16 up to a million radians."""
    quarters = (angle * PER_QUARTER + ROUND) - ROUND
    rest = (angle - quarters * QUARTER) - quarters * QUARTER_REST
    square = rest * rest
    tail = square * (
        2.75573137070700676789e-06
        + square * (-2.50507602534068634195e-08 + square * 1.58969099521155010221e-10)
    )
    s = 8.33333333332248946124e-03 + square * -1.98412698298579493134e-04 + square * tail
    s = rest + rest * square * (-1.66666666666666324348e-01 + square * s)
    tail = square * (2.08757232129817482790e-09 + square * -1.13596475577881948265e-11)
    c = 2.48015872894767294178e-05 + square * -2.75573143513906633035e-07 + square * tail
    c = 4.16666666666666019037e-02 + square * (-1.38888888888741095749e-03 + square * c)
    c = 1.0 - 0.5 * square + square * square * c
    turns = (quarters * 0.25 - 0.375 + ROUND) - ROUND
    quadrant = quarters - 4.0 * turns
    odd = (quadrant == 1.0) | (quadrant == 3.0)
    cosine, sine = s if odd else c, c if odd else s
    return (
        -cosine if (quadrant == 1.0) | (quadrant == 2.0) else cosine,
        -sine if quadrant >= 2.0 else sine,
    )
