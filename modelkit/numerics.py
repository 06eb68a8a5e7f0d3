"""Mathematics that kernels need: angles, elliptic integrals, an exact oscillator, checks of memory.

`cosine_and_sine` uses sums and products alone, so that loops over angles become vector code: two parts of
pi/2 bring the angle into a quarter turn around zero (Cody and Waite), where the polynomials of fdlibm hold
to rounding.

`complete_integrals` gives the elliptic ones by the arithmetic-geometric mean (Abramowitz and Stegun,
17.6). With a_0 = 1, b_0 = sqrt(1 - m), c_0 = sqrt(m) and the means of each pair the next one,

    K = pi / (2 a),    (K - E) / K = sum 2^(n - 1) c_n^2

Contacts that are nearly circular need K - E and m K - (K - E), which cancel if they are made of K and E.

`oscillator_step` solves a damped oscillator under a load that is linear in time, exactly:

    z'' + c z' + k z = f + g (t - h/2),    0 <= t <= h        (k in 1/s2, c in 1/s; both may be zero)

It may be underdamped, overdamped or free. z in m, v = z' in m/s, h in s; f in m/s2 and g in m/s3 are the
mean of the load and its slope, per mass.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from .kernel import inlined, kernel

QUARTERS_PER_RAD = 2.0 / math.pi
QUARTER, QUARTER_REST = 1.57079632673412561417, 6.07710050650619224932e-11  # add up to pi/2
ROUNDING_SHIFT = 6755399441055744.0  # 1.5 * 2^52: adding it leaves no room for a fraction


@inlined
def cosine_and_sine(angle):
    """(cos, sin) of `angle` (rad), to 2e-16 up to a million radians."""
    quarters = (angle * QUARTERS_PER_RAD + ROUNDING_SHIFT) - ROUNDING_SHIFT
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
    turns = (quarters * 0.25 - 0.375 + ROUNDING_SHIFT) - ROUNDING_SHIFT
    quadrant = quarters - 4.0 * turns
    odd = (quadrant == 1.0) | (quadrant == 3.0)
    cosine, sine = s if odd else c, c if odd else s
    return (
        -cosine if (quadrant == 1.0) | (quadrant == 2.0) else cosine,
        -sine if quadrant >= 2.0 else sine,
    )


MAX_MEANS = 20  # each doubles the digits; a modulus of 1 - 1e-300 takes 14


class Complete(NamedTuple):
    """K and E of a parameter m, and of what is between them."""

    first: float  # K
    second: float  # E
    lost: float  # (K - E) / K
    left: float  # m - (K - E) / K


@inlined
def squared(x):
    """x times itself, which Python and machine code round alike; a power they may not."""
    return x * x


@kernel
def complete_integrals(parameter, complement):
    """`Complete` integrals of a `parameter` m from 0 to 1, to rounding; complement: 1 - m, above 0."""
    a, b, weight, later = 1.0, math.sqrt(complement), 0.5, 0.0
    for _ in range(MAX_MEANS):
        c = 0.5 * (a - b)
        a, b, weight = 0.5 * (a + b), math.sqrt(a * b), 2.0 * weight
        later += weight * c * c
        if not c > 1e-15 * a:
            break
    lost = 0.5 * parameter + later
    first = 0.5 * math.pi / a
    return Complete(first, first * (1.0 - lost), lost, 0.5 * parameter - later)


SERIES_LIMIT = 0.5  # below this k h^2 or c h the closed form cancels and a power series takes its place
SERIES_TERMS = 16  # of the series, which leaves SERIES_LIMIT^16/16!


class Step(NamedTuple):
    """The effect of a step of h seconds, per unit of each initial value and load.

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
def oscillator_step(k, c, h):
    """The `Step` of h seconds of an oscillator of stiffness k (1/s2) and damping c (1/s), both >= 0."""
    if max(k * h * h, c * h) < SERIES_LIMIT:
        return _series(k, c, h)
    if k <= 1e-12 * c * c:
        return _dashpot(c, h)
    zv, zz = _free(k, c, h)
    zf = (1.0 - zz) / k
    ramp = (h - zv - c * zf) / k
    return Step(zz, zv, -k * zv, zz - c * zv, zf, zv, ramp - 0.5 * h * zf, zf - 0.5 * h * zv)


@kernel
def _series(k, c, h):
    """`oscillator_step` by power series: with A = [[0, 1], [-k, -c]], sums of A^i (0, 1) h^j/j!."""
    w0, w1 = 0.0, h  # A^i (0, 1) h^(i+1)/(i+1)!
    zf, vf, zg, vg = 0.0, 0.0, 0.0, 0.0
    for i in range(SERIES_TERMS):
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
    """`oscillator_step` of a body on a dashpot c (1/s) without a spring."""
    fading = math.exp(-c * h)
    zv = (1.0 - fading) / c
    zf = (h - zv) / c
    ramp = (0.5 * h * h - zf) / c
    return Step(1.0, zv, 0.0, fading, zf, zv, ramp - 0.5 * h * zf, zf - 0.5 * h * zv)


# (omega h)^2 of a step; below, Hermite's rule errs by 1e-11, and the exact form of the area cancels
HERMITE_LIMIT = 1e-4


@kernel
def area(k, c, h, f, start, end):
    """int z dt (m s) over a step of h (s) from `start` (z, v) to `end` (z, v) under the mean load f (m/s2).

    It follows from the equation of motion, of stiffness k (1/s2) and damping c (1/s).
    """
    z, v = start
    z_end, v_end = end
    if k * h * h < HERMITE_LIMIT:
        return 0.5 * h * (z + z_end) + h * h / 12.0 * (v - v_end)
    return (f * h - (v_end - v) - c * (z_end - z)) / k


@kernel
def load_for(s, z, v):
    """Mean f (m/s2) and slope g (m/s3) of the load that brings the resting oscillator to z (m), v (m/s).

    s: the `Step` in which it does.
    """
    determinant = s.zf * s.vg - s.vf * s.zg
    return (z * s.vg - v * s.zg) / determinant, (s.zf * v - s.vf * z) / determinant


@kernel
def blank(words, constants):
    """Set error weights, constants and what was told of a problem to zero.

    words: the memory (float64); constants: where they lie (`modelkit.model.constants`).
    """
    for i in range(constants[1], len(words)):
        words[i] = 0.0


@kernel
def missing(words, constants):
    """Number of the text that names the first constant that is not a finite number; 0: all are.

    words: the memory (float64); constants: where they lie (`modelkit.model.constants`). A count is found
    finite: as a float its bits are a tiny number.
    """
    for k in range(2, len(constants)):
        for i in range(constants[k - 1], constants[k]):
            if not math.isfinite(words[i]):
                return constants[0] + k - 1
    return 0
