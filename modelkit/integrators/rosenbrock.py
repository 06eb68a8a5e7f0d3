"""An integrator for models with a stiff part: a linearly implicit (Rosenbrock-W) method, adaptive.

ROS34PW2 of Rang and Angermann, BIT 45 (2005) 761-787: four stages, order 3 with whatever matrix J stands
for the Jacobian. So J holds only what is stiff, here the slopes of friction on light balls (about 1e7
per second under load), and costs next to nothing to solve with; everything else is treated explicitly.

The stages are transformed as in Hairer and Wanner II, eq. (IV.7.25), so that no product with J is needed:

    (1/(h g) - J) u_i = f(y + sum_j a_ij u_j) + sum_j c_ij u_j / h,    y' = y + sum_i m_i u_i
"""

from __future__ import annotations

import math

import numpy as np

from touchdown.modelkit.integrators.dopri import MOST_STEPS, SMALLEST_STEP
from touchdown.modelkit.kernel import inlined
from touchdown.modelkit.status import OK, STEP_UNDERFLOW, TOO_MANY_STEPS

G = 4.3586652150845900e-01

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

_INVERSE = np.linalg.inv(GAMMA)
A = ALPHA @ _INVERSE
C = np.diag(np.diag(_INVERSE)) - _INVERSE
M = WEIGHTS @ _INVERSE
E = (WEIGHTS - EMBEDDED) @ _INVERSE

T2, T3, T4 = (float(row.sum()) for row in ALPHA[1:])
A21, A31, A32 = float(A[1, 0]), float(A[2, 0]), float(A[2, 1])
A41, A42, A43 = float(A[3, 0]), float(A[3, 1]), float(A[3, 2])
C21, C31, C32 = float(C[1, 0]), float(C[2, 0]), float(C[2, 1])
C41, C42, C43 = float(C[3, 0]), float(C[3, 1]), float(C[3, 2])
M1, M2, M3, M4 = (float(m) for m in M)
E1, E2, E3, E4 = (float(e) for e in E)


@inlined
def integrate(rhs, linearise, solve, observe, m, y, n, weight, k, span, h, tolerance):
    """Advance y[:n] over `span` seconds in place.

    As `dopri.integrate`, with two more kernels for the stiff part: linearise(y, j, m) fills j with what
    describes J at y, and solve(j, s, r, m) overwrites r with the solution x of (s - J) x = r.
    """
    t = 0.0
    status = OK
    steps = 0
    u1, u2, u3, u4, f, w, j, f0 = k[0], k[1], k[2], k[3], k[4], k[5], k[6], k[7]
    rhs(t, y, f0, m)
    linearise(y, j, m)
    evaluations = 1
    while t < span:
        steps += 1
        if steps > MOST_STEPS:
            status = TOO_MANY_STEPS
            break
        last = t + h * 1.000001 >= span
        step = span - t if last else h
        inverse = 1.0 / step
        shift = inverse / G
        for i in range(n):
            u1[i] = f0[i]
        solve(j, shift, u1, m)
        for i in range(n):
            w[i] = y[i] + A21 * u1[i]
        rhs(t + T2 * step, w, f, m)
        for i in range(n):
            u2[i] = f[i] + inverse * (C21 * u1[i])
        solve(j, shift, u2, m)
        for i in range(n):
            w[i] = y[i] + A31 * u1[i] + A32 * u2[i]
        rhs(t + T3 * step, w, f, m)
        for i in range(n):
            u3[i] = f[i] + inverse * (C31 * u1[i] + C32 * u2[i])
        solve(j, shift, u3, m)
        for i in range(n):
            w[i] = y[i] + A41 * u1[i] + A42 * u2[i] + A43 * u3[i]
        rhs(t + T4 * step, w, f, m)
        for i in range(n):
            u4[i] = f[i] + inverse * (C41 * u1[i] + C42 * u2[i] + C43 * u3[i])
        solve(j, shift, u4, m)
        evaluations += 4
        error = 0.0
        for i in range(n):
            w[i] = y[i] + M1 * u1[i] + M2 * u2[i] + M3 * u3[i] + M4 * u4[i]
            e = abs(E1 * u1[i] + E2 * u2[i] + E3 * u3[i] + E4 * u4[i]) * weight[i]
            if e > error or e != e:  # nothing is larger than a NaN, so it stays
                error = e
        error /= tolerance
        if error <= 1.0:
            t = span if last else t + step
            for i in range(n):
                y[i] = w[i]
            rhs(t, y, f0, m)
            linearise(y, j, m)
            observe(t, y, m)
            grown = step * min(4.0, 0.9 / max(error, 1e-6) ** (1.0 / 3.0))
            h = max(h, grown) if last else grown
        else:
            h = step * (max(0.2, 0.9 / error ** (1.0 / 3.0)) if math.isfinite(error) else 0.1)
            if h < SMALLEST_STEP:
                status = STEP_UNDERFLOW
                break
    return h, status, evaluations
