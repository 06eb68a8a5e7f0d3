"""Contact stiffness from geometry (2.43-2.46), as corrected, and damping from a ratio (2.47).

A ball and its race touch in an ellipse, whose axes are as kappa to 1. With K and E, the complete elliptic
integrals of the first and second kind of the parameter 1 - 1/kappa^2, Hertz's theory asks for

    (kappa^2 E - K)/(K - E) = ratio

of the curvatures across to those along the shaft (about 22-33 for a deep groove ball bearing). The source
fits powers and logarithms of the ratio instead, after Brewe and Hamrock (1977); with them an inner race is
1.4-1.7 % too stiff, an outer race 0.6-0.7 %. It prints (2.44) upside down (its 2.45 would take the root of
a negative number) and names the two integrals of (2.46) the wrong way round: 1.0003 + 0.5968/ratio is the
second kind and 1.5277 + 0.6023 ln(ratio) the first.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cache
from typing import NamedTuple, cast

from scipy.optimize import brentq
from scipy.special import ellipe, ellipkm1

CIRCLE = 1e-6  # of a ratio above 1; closer to it the ellipse is a circle, and K - E cancels


class Ellipse(NamedTuple):
    """The ellipse of a contact."""

    ellipticity: float  # kappa, its longer axis over the shorter
    first_kind: float  # complete elliptic integrals
    second_kind: float


@cache
def exact_ellipse(ratio: float) -> Ellipse:
    """By Hertz's theory, for curvatures of `ratio` (at least 1)."""
    if ratio < 1.0 + CIRCLE:
        return Ellipse(1.0, 0.5 * math.pi, 0.5 * math.pi)

    def of(kappa: float) -> Ellipse:
        complement = kappa**-2.0
        return Ellipse(kappa, float(ellipkm1(complement)), float(ellipe(1.0 - complement)))

    def mismatch(kappa: float) -> float:
        _, first, second = of(kappa)
        return (kappa**2 * second - first) / (first - second) - ratio

    # kappa is below its ratio, and about the ratio to the power of 2/3 near a circle
    kappa = brentq(mismatch, 1.0 + 0.5 * (ratio - 1.0) / ratio, ratio, xtol=1e-14)
    return of(cast(float, kappa))


def printed_ellipse(ratio: float) -> Ellipse:
    """By the fits that the source prints (2.46), for curvatures of `ratio`."""
    return Ellipse(1.0339 * ratio**0.636, 1.5277 + 0.6023 * math.log(ratio), 1.0003 + 0.5968 / ratio)


def effective_modulus(modulus: float, poisson: float) -> float:
    """E_tot of (2.46) for two bodies of the same material (Pa)."""
    return modulus / (1.0 - poisson**2)


def race_contact_stiffness(
    ball_diameter: float,
    race_radius: float,
    conformity: float,
    modulus: float,
    poisson: float,
    ellipse: Callable[[float], Ellipse] = exact_ellipse,
) -> float:
    """Hertz stiffness of a ball on its race (N/m^1.5).

    ball_diameter, race_radius in m; race_radius is positive for the inner race (convex) and negative
    for the outer one (concave). `conformity` is the groove radius over the ball radius; `ellipse` gives the
    contact's for a ratio of curvatures. (2.45) reads lengths in mm and gives N/mm^1.5; in SI it needs no
    factor. Raises ValueError where ball and race do not touch in a point.
    """
    ball_radius = ball_diameter / 2.0
    across = 1.0 / ball_radius + 1.0 / race_radius
    along = 1.0 / ball_radius - 1.0 / (conformity * ball_radius)
    if along <= 0.0 or across <= 0.0:
        raise ValueError(
            f"no point contact: ball diameter {ball_diameter:g} m, race radius {race_radius:g} m, "
            f"conformity {conformity:g}; a conformity above 1 and a race wider than the ball are needed"
        )
    ellipticity, first_kind, second_kind = ellipse(across / along)
    curvature_sum = 1.0 / (across + along)
    root = math.sqrt(2.0 * curvature_sum * second_kind / first_kind**3)
    return math.pi / 3.0 * root * ellipticity * effective_modulus(modulus, poisson)


def in_series(inner: float, outer: float) -> float:
    """One stiffness for ball-inner and ball-outer contacts in series (2.5), N/m^1.5."""
    return (inner ** (-1.0 / 1.5) + outer ** (-1.0 / 1.5)) ** -1.5


def damping_from_ratio(stiffness: float, mass: float, ratio: float, indentation: float = 1.0) -> float:
    """Damping coefficient from a damping ratio (2.47): 2 sqrt(k m) ratio over the peak indentation.

    For the indentation-proportional law (2.38) pass the expected peak `indentation` (m); the result is
    then in N s/m^2 when `stiffness` is the slope of the force at that indentation (N/m).
    """
    return 2.0 * math.sqrt(stiffness * mass) * ratio / indentation
