"""An integrator for models with a stiff part: a linearly implicit (Rosenbrock-W) method, adaptive.

ROS34PW2 of Rang and Angermann, BIT 45 (2005) 761-787: four stages, order 3 with any matrix J that stands
for the Jacobian. So J holds only what is stiff, here the slopes of friction on light balls (about 1e7
per second under load), and costs next to nothing to solve with; everything else is treated explicitly.

The stages are transformed as in Hairer and Wanner II, eq. (IV.7.25), so that no product with J is needed:

    (1/(h g) - J) u_i = f(q + sum_j a_ij u_j) + sum_j c_ij u_j / h,    q' = q + sum_i m_i u_i
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..kernel import kernel
from ..status import OK, STEP_UNDERFLOW, TOO_MANY_STEPS
from .control import MAX_STEPS, SMALLEST_STEP, grown, is_last, shrunk

STAGES = 4
EXPONENT = 1.0 / 3.0  # the error is of order 3 in the step
MIN_ERROR, MAX_FACTOR = 1e-6, 4.0

G = 4.3586652150845900e-01  # the method's gamma

# as published: sums of slopes (4, 4), of products with J (4, 4), weights of order 3 and 2 (4,)
ALPHA = np.array(
    [
        [0.0, 0.0, 0.0, 0.0],
        [8.7173304301691801e-01, 0.0, 0.0, 0.0],
        [8.4457060015369423e-01, -1.1299064236484185e-01, 0.0, 0.0],
        [0.0, 0.0, 1.0, 0.0],
    ]
)
GAMMA = np.array(
    [
        [G, 0.0, 0.0, 0.0],
        [-8.7173304301691801e-01, G, 0.0, 0.0],
        [-9.0338057013044082e-01, 5.4180672388095326e-02, G, 0.0],
        [2.4212380706095346e-01, -1.2232505839045147e00, 5.4526025533510214e-01, G],
    ]
)
WEIGHTS = np.array(
    [2.4212380706095346e-01, -1.2232505839045147e00, 1.5452602553351020e00, 4.3586652150845900e-01]
)
EMBEDDED = np.array([3.7810903145819369e-01, -9.6042292212423178e-02, 5.0e-01, 2.1793326075422950e-01])

# transformed: of the stages u_i, in q and in the slopes (4, 4), in the end and in the error (4,)
_INVERSE = np.linalg.inv(GAMMA)
A = ALPHA @ _INVERSE
C = np.diag(np.diag(_INVERSE)) - _INVERSE
M = WEIGHTS @ _INVERSE
E = (WEIGHTS - EMBEDDED) @ _INVERSE

# as scalars, which become constants of the machine code
T2, T3, T4 = (float(row.sum()) for row in ALPHA[1:])
A21, A31, A32 = float(A[1, 0]), float(A[2, 0]), float(A[2, 1])
A41, A42, A43 = float(A[3, 0]), float(A[3, 1]), float(A[3, 2])
C21, C31, C32 = float(C[1, 0]), float(C[2, 0]), float(C[2, 1])
C41, C42, C43 = float(C[3, 0]), float(C[3, 1]), float(C[3, 2])
M1, M2, M3, M4 = (float(m) for m in M)
E1, E2, E3, E4 = (float(e) for e in E)


class _ScratchRows(NamedTuple):
    """The rows of scratch, each (n,) or wider."""

    u1: np.ndarray  # transformed stages, in units of q
    u2: np.ndarray
    u3: np.ndarray
    u4: np.ndarray
    slope: np.ndarray  # dq at a stage
    trial: np.ndarray  # trial state
    stiff: np.ndarray  # what `linearise` says of J at q
    f: np.ndarray  # dq at q


@kernel
def row_step(rhs, solve, m, q, parts, n, rows, t, h):
    """One step of h (s) from q (n,) at t (s), where `rows.f` and `rows.stiff` are known.

    Fills the stages and, in `rows.trial`, its end; returns nothing.
    """
    u1, u2, u3, u4, slope, trial, stiff, f = rows
    first = parts.first
    inverse = 1.0 / h
    shift = inverse / G
    for i in range(n):
        u1[i] = f[i]
    solve(stiff, shift, u1, m)
    for i in range(first, n):
        trial[i] = q[i] + A21 * u1[i]
    rhs(t + T2 * h, trial, slope, m)
    for i in range(n):
        u2[i] = slope[i] + inverse * (C21 * u1[i])
    solve(stiff, shift, u2, m)
    for i in range(first, n):
        trial[i] = q[i] + A31 * u1[i] + A32 * u2[i]
    rhs(t + T3 * h, trial, slope, m)
    for i in range(n):
        u3[i] = slope[i] + inverse * (C31 * u1[i] + C32 * u2[i])
    solve(stiff, shift, u3, m)
    for i in range(first, n):
        trial[i] = q[i] + A41 * u1[i] + A42 * u2[i] + A43 * u3[i]
    rhs(t + T4 * h, trial, slope, m)
    for i in range(n):
        u4[i] = slope[i] + inverse * (C41 * u1[i] + C42 * u2[i] + C43 * u3[i])
    solve(stiff, shift, u4, m)
    for i in range(n):
        trial[i] = q[i] + M1 * u1[i] + M2 * u2[i] + M3 * u3[i] + M4 * u4[i]


@kernel
def _error_norm(rows, n, weight):
    """Largest error of a step over the scales 1 / weight (n,), from its stages; may be a NaN."""
    u1, u2, u3, u4 = rows.u1, rows.u2, rows.u3, rows.u4
    error_norm = 0.0
    for i in range(n):
        e = abs(E1 * u1[i] + E2 * u2[i] + E3 * u3[i] + E4 * u4[i]) * weight[i]
        if e > error_norm or e != e:  # nothing is larger than a NaN, so it stays
            error_norm = e
    return error_norm


@kernel
def integrate(rhs, linearise, solve, observe, m, q, parts, n, weight, work, span, h, tolerance):
    """Advance the state q[:n] over `span` (s) in place.

    As `dopri.integrate`, with two more kernels for the stiff part: linearise(q, stiff, m) fills stiff (n,)
    with what describes J (1/s) at q, and solve(stiff, shift, r, m) overwrites r (n,) with the solution x
    of (shift - J) x = r, shift in 1/s. work: `dopri.scratch`, (8, n) or wider, rows as `_ScratchRows`.
    Returns (step to try first next time (s), status, number of evaluations of rhs).
    """
    t = 0.0
    status = OK
    steps = 0
    rows = _ScratchRows(work[0], work[1], work[2], work[3], work[4], work[5], work[6], work[7])
    f, trial, stiff = rows.f, rows.trial, rows.stiff
    rhs(t, q, f, m)
    linearise(q, stiff, m)
    evaluations = 1
    while t < span:
        steps += 1
        if steps > MAX_STEPS:
            status = TOO_MANY_STEPS
            break
        last = is_last(t, h, span)
        step = span - t if last else h
        row_step(rhs, solve, m, q, parts, n, rows, t, step)
        evaluations += STAGES
        error_norm = _error_norm(rows, n, weight) / tolerance
        if error_norm <= 1.0:
            t = span if last else t + step
            for i in range(n):
                q[i] = trial[i]
            rhs(t, q, f, m)
            linearise(q, stiff, m)
            observe(t, q, m)
            longer = grown(step, error_norm, EXPONENT, MIN_ERROR, MAX_FACTOR)
            # a step cut short by the end of the span says little about the next one
            h = max(h, longer) if last else longer
        else:
            h = shrunk(step, error_norm, EXPONENT)
            if h < SMALLEST_STEP:
                status = STEP_UNDERFLOW
                break
    return h, status, evaluations
