"""Complete elliptic integrals by the arithmetic-geometric mean (Abramowitz and Stegun, 17.6).

With a_0 = 1, b_0 = sqrt(1 - m), c_0 = sqrt(m) and the means of each pair the next one,

    K = pi / (2 a),    (K - E) / K = sum 2^(n - 1) c_n^2

Contacts that are nearly circular need K - E and m K - (K - E), which cancel if they are made of K and E.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from touchdown.modelkit.kernel import kernel

MOST_MEANS = 20  # each doubles the digits; a modulus of 1 - 1e-300 takes 14


class Complete(NamedTuple):
    """K and E of a parameter m, and of what is between them."""

    first: float  # K
    second: float  # E
    lost: float  # (K - E) / K
    left: float  # m - (K - E) / K


@kernel
def complete(parameter, complement):
    """`Complete` integrals of a `parameter` m from 0 to 1, to rounding; complement: 1 - m, above 0."""
    a, b, weight, later = 1.0, math.sqrt(complement), 0.5, 0.0
    for _ in range(MOST_MEANS):
        c = 0.5 * (a - b)
        a, b, weight = 0.5 * (a + b), math.sqrt(a * b), 2.0 * weight
        later += weight * c * c
        if not c > 1e-15 * a:
            break
    lost = 0.5 * parameter + later
    first = 0.5 * math.pi / a
    return Complete(first, first * (1.0 - lost), lost, 0.5 * parameter - later)
