"""Temperatures of the parts of a bearing, each of them even in itself.

With the capacities C, the conductances G and the heat P, all over the bodies of `warm_parts`,

    C T' = P - G T

A step of H seconds with P held is exact: with M = -H C^-1 G and Q = P H, the heat given in the step,

    T' = exp(M) T + phi(M) C^-1 Q        phi(M) = 1 + M/2! + M^2/3! + ...

for any H, also where nothing leads to the surroundings. Both functions come from their series, for M halved
until it is small, and from phi(2 M) = (1 + exp(M)) phi(M)/2 and exp(2 M) = exp(M)^2.
"""

from __future__ import annotations

import numpy as np

from ...modelkit.kernel import kernel

SMALL = 0.5  # largest sum of a row, halved
TERMS = 15  # of the series: 0.5^15/15! is 2e-17


@kernel
def _product(a, b, to):
    """Set `to` (n, n) to the product of a and b (n, n)."""
    for i in range(len(a)):
        for j in range(len(a)):
            total = 0.0
            for k in range(len(a)):
                total += a[i, k] * b[k, j]
            to[i, j] = total


@kernel
def _halvings(m):
    """How often the matrix m (n, n) is to be halved to be `SMALL`."""
    largest, count = 0.0, 0
    for i in range(len(m)):
        total = 0.0
        for j in range(len(m)):
            total += abs(m[i, j])
        largest = max(largest, total)
    while largest > SMALL and count < 1000:
        largest, count = 0.5 * largest, count + 1
    return count


@kernel
def _series(m, kept, gained):
    """Set `kept` and `gained` (n, n) to exp(m) and phi(m) of a small matrix m (n, n)."""
    n, factor = len(m), 1.0
    power, scratch = np.zeros((n, n)), np.empty((n, n))
    for i in range(n):
        power[i, i] = 1.0
    for k in range(TERMS + 1):
        for i in range(n):
            for j in range(n):
                so_far = kept[i, j] if k > 0 else 0.0, gained[i, j] if k > 0 else 0.0
                kept[i, j] = so_far[0] + factor * power[i, j]
                gained[i, j] = so_far[1] + factor / (k + 1.0) * power[i, j]
        _product(power, m, scratch)
        power, scratch = scratch, power
        factor /= k + 1.0


@kernel
def set_step(inverse, conductances, step, kept, gained):
    """Set the matrices of a step of `step` (s): `kept` (n, n), exp(M), and `gained` (n, n), K/J.

    inverse: (n,) one over the capacities (K/J), 0 for a body that keeps its temperature; conductances:
    (n, n), W/K.
    """
    n = len(inverse)
    m, scratch, other = np.empty((n, n)), np.empty((n, n)), np.empty((n, n))
    for i in range(n):
        for j in range(n):
            m[i, j] = -step * inverse[i] * conductances[i, j]
    halvings = _halvings(m)
    for i in range(n):
        for j in range(n):
            m[i, j] *= 0.5**halvings
    _series(m, kept, gained)
    for _ in range(halvings):
        _product(kept, gained, scratch)
        _product(kept, kept, other)
        for i in range(n):
            for j in range(n):
                gained[i, j] = 0.5 * (gained[i, j] + scratch[i, j])
                kept[i, j] = other[i, j]
    for i in range(n):
        for j in range(n):
            gained[i, j] *= inverse[j]


@kernel
def take_step(kept, gained, heat, warmth):
    """Take `warmth` (n,) (K) over a step whose matrices are `kept` and `gained`; heat: (n,), J."""
    n = len(warmth)
    ends = np.empty(n)
    for i in range(n):
        ends[i] = 0.0
        for j in range(n):
            ends[i] += kept[i, j] * warmth[j] + gained[i, j] * heat[j]
    for i in range(n):
        warmth[i] = ends[i]
