"""A damped oscillator under a load that is linear in time, solved exactly.

    z'' + c z' + k z = f + g (t - h/2),    0 <= t <= h        (k in 1/s2, c in 1/s; both may be zero)

Underdamped, overdamped and free bodies alike. z in m, v = z' in m/s, h in s; f in m/s2 and g in m/s3 are
the mean of the load and its slope, per mass.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from touchdown.modelkit.kernel import kernel

SERIES = 0.5  # below this k h^2 or c h the closed form cancels and a power series takes its place
TERMS = 16  # of the series, which leaves SERIES^16/16!


class Step(NamedTuple):
    """What a step of h seconds does, per unit of what it starts from.

    (z, v) at the end = [[zz, zv], [vz, vv]] (z, v) at the start + f (zf, vf) + g (zg, vg).
    """

    zz: float  # 1
    zv: float  # s
    vz: float  # 1/s
    vv: float  # 1
    zf: float  # s2
    vf: float  # s
    zg: float  # s3
    vg: float  # s2


@kernel
def _free(k, c, h):
    """Displacement after h (s) of a unit velocity (s), and of a unit displacement (1); k > 0 in 1/s2."""
    a = 0.5 * c
    d = k - a * a
    if d > 0.0:
        w = math.sqrt(d)
        fading = math.exp(-a * h)
        s, co = fading * math.sin(w * h) / w, fading * math.cos(w * h)
    elif d < 0.0:
        w = math.sqrt(-d)
        slow, fast = math.exp((w - a) * h), math.exp((-w - a) * h)
        s, co = 0.5 * (slow - fast) / w, 0.5 * (slow + fast)
    else:
        s, co = h * math.exp(-a * h), math.exp(-a * h)
    return s, co + a * s


@kernel
def step(k, c, h):
    """The `Step` of h seconds of an oscillator of stiffness k (1/s2) and damping c (1/s), both >= 0."""
    if max(k * h * h, c * h) < SERIES:
        return _series(k, c, h)
    if k <= 1e-12 * c * c:
        return _dashpot(c, h)
    zv, zz = _free(k, c, h)
    zf = (1.0 - zz) / k
    ramp = (h - zv - c * zf) / k
    return Step(zz, zv, -k * zv, zz - c * zv, zf, zv, ramp - 0.5 * h * zf, zf - 0.5 * h * zv)


@kernel
def _series(k, c, h):
    """`step` by power series: with A = [[0, 1], [-k, -c]], sums of A^i (0, 1) h^j/j!."""
    w0, w1 = 0.0, h  # A^i (0, 1) h^(i+1)/(i+1)!
    zf, vf, zg, vg = 0.0, 0.0, 0.0, 0.0
    for i in range(TERMS):
        zf += w0
        vf += w1
        zg += w0 * h / (i + 2)
        vg += w1 * h / (i + 2)
        w0, w1 = w1 * h / (i + 2), -(k * w0 + c * w1) * h / (i + 2)
    zg -= 0.5 * h * zf
    vg -= 0.5 * h * vf
    # vf is z after unit velocity; the rest follows from the equation of motion
    return Step(1.0 - k * zf, vf, -k * vf, 1.0 - k * zf - c * vf, zf, vf, zg, vg)


@kernel
def _dashpot(c, h):
    """`step` of a body on a dashpot c (1/s) without a spring."""
    fading = math.exp(-c * h)
    zv = (1.0 - fading) / c
    zf = (h - zv) / c
    ramp = (0.5 * h * h - zf) / c
    return Step(1.0, zv, 0.0, fading, zf, zv, ramp - 0.5 * h * zf, zf - 0.5 * h * zv)


@kernel
def load_for(s, z, v):
    """Mean f (m/s2) and slope g (m/s3) of the load that brings the resting oscillator to z (m), v (m/s).

    s: the `Step` in which it does.
    """
    determinant = s.zf * s.vg - s.vf * s.zg
    return (z * s.vg - v * s.zg) / determinant, (s.zf * v - s.vf * z) / determinant
