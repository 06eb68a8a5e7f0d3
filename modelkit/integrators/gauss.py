"""Steps of linear equations by Gauss's collocation in three points, prepared once for each length.

    z' = A z + B u(t),    u(t) = mean + slope (t - t_mid)

The rule is the diagonal Pade approximant of order six: no step is unstable, with any A, and a quadratic
energy changes by exactly what its rate sums up to over the three points. So work and heat that are summed
there (`WEIGHTS`) close with it to rounding, and heat that is a square is never below zero.

Places and motion at the points and at the end are linear in what stands at the beginning. The matrices
that give them are kept, since all of the work is in finding them:

    points  Z = S [z; mean; slope]    (3 n, n + 2 c)        end  z' = E [z; mean; slope]    (n, n + 2 c)

Hairer, Lubich, Wanner: Geometric Numerical Integration, II.1.3 (coefficients), IV.2 (quadratic invariants).
"""

from __future__ import annotations

import math

import numpy as np

from ..kernel import kernel

POINTS = 3
_ROOT = math.sqrt(15.0)
PLACES = (0.5 - _ROOT / 10.0, 0.5, 0.5 + _ROOT / 10.0)  # of the points in a step of length one
WEIGHTS = (5.0 / 18.0, 4.0 / 9.0, 5.0 / 18.0)
_UP_TO = (
    (5.0 / 36.0, 2.0 / 9.0 - _ROOT / 15.0, 5.0 / 36.0 - _ROOT / 30.0),
    (5.0 / 36.0 + _ROOT / 24.0, 2.0 / 9.0, 5.0 / 36.0 - _ROOT / 24.0),
    (5.0 / 36.0 + _ROOT / 30.0, 2.0 / 9.0 + _ROOT / 15.0, 5.0 / 36.0),
)


@kernel
def solve_in_place(matrix, right):
    """Overwrite `right` (n, k) with matrix^-1 right; `matrix` (n, n) is used up. Rows are exchanged."""
    n, count = right.shape
    for i in range(n):
        pivot = i
        for j in range(i + 1, n):
            if abs(matrix[j, i]) > abs(matrix[pivot, i]):
                pivot = j
        if pivot != i:
            for k in range(i, n):
                matrix[i, k], matrix[pivot, k] = matrix[pivot, k], matrix[i, k]
            for k in range(count):
                right[i, k], right[pivot, k] = right[pivot, k], right[i, k]
        for j in range(i + 1, n):
            factor = matrix[j, i] / matrix[i, i]
            if factor != 0.0:
                for k in range(i + 1, n):
                    matrix[j, k] -= factor * matrix[i, k]
                for k in range(count):
                    right[j, k] -= factor * right[i, k]
    for i in range(n - 1, -1, -1):
        for k in range(count):
            total = right[i, k]
            for j in range(i + 1, n):
                total -= matrix[i, j] * right[j, k]
            right[i, k] = total / matrix[i, i]


@kernel
def prepare_steps(a, b, h, at_points, at_end):
    """Fill `at_points` (3 n, n + 2 c) and `at_end` (n, n + 2 c) for steps of h (s).

    a (n, n) and b (n, c) as in the equations above; what stands beside n and c in wider arrays is left.
    """
    n, c = b.shape
    matrix = np.zeros((POINTS * n, POINTS * n))
    right = np.zeros((POINTS * n, n + 2 * c))
    for i in range(POINTS):
        for r in range(n):
            matrix[i * n + r, i * n + r] = 1.0
            right[i * n + r, r] = 1.0
        for j in range(POINTS):
            part = h * _UP_TO[i][j]
            late = part * h * (PLACES[j] - 0.5)
            for r in range(n):
                for k in range(n):
                    matrix[i * n + r, j * n + k] -= part * a[r, k]
                for k in range(c):
                    right[i * n + r, n + k] += part * b[r, k]
                    right[i * n + r, n + c + k] += late * b[r, k]
    solve_in_place(matrix, right)
    for r in range(POINTS * n):
        for k in range(n + 2 * c):
            at_points[r, k] = right[r, k]
    for r in range(n):
        for k in range(n + 2 * c):
            at_end[r, k] = 1.0 if k == r else 0.0
    for i in range(POINTS):
        part = h * WEIGHTS[i]
        late = part * h * (PLACES[i] - 0.5)
        for r in range(n):
            for k in range(n):
                for m in range(n + 2 * c):
                    at_end[r, m] += part * a[r, k] * right[i * n + k, m]
            for k in range(c):
                at_end[r, n + k] += part * b[r, k]
                at_end[r, n + c + k] += late * b[r, k]


@kernel
def apply(matrix, rows, vector, width, result):
    """result[:rows] = matrix[:rows, :width] vector[:width]."""
    for r in range(rows):
        total = 0.0
        for k in range(width):
            total += matrix[r, k] * vector[k]
        result[r] = total
