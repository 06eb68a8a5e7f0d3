"""Contact stiffness from geometry (2.43-2.46), as corrected, and damping from a ratio (2.47).

The source prints (2.44) upside down (its 2.45 would take the root of a negative number) and names the
two elliptic integrals of (2.46) the wrong way round. Here, after Brewe and Hamrock (1977), the ratio is
that of the curvatures across to those along the shaft (about 22-33 for a deep groove ball bearing),
1.0003 + 0.5968/ratio is the second kind and 1.5277 + 0.6023 ln(ratio) the first.
"""

from __future__ import annotations

import math


def effective_modulus(modulus: float, poisson: float) -> float:
    """E_tot of (2.46) for two bodies of the same material (Pa)."""
    return modulus / (1.0 - poisson**2)


def race_contact_stiffness(
    ball_diameter: float,
    race_radius: float,
    conformity: float,
    modulus: float,
    poisson: float,
) -> float:
    """Hertz stiffness of a ball on its race (N/m^1.5).

    ball_diameter, race_radius in m; race_radius is positive for the inner race (convex) and negative
    for the outer one (concave). `conformity` is the groove radius over the ball radius. (2.45) reads
    lengths in mm and gives N/mm^1.5; in SI it needs no factor.
    """
    ball_radius = ball_diameter / 2.0
    across = 1.0 / ball_radius + 1.0 / race_radius
    along = 1.0 / ball_radius - 1.0 / (conformity * ball_radius)
    if along <= 0.0 or across <= 0.0:
        raise ValueError(
            f"no point contact: ball diameter {ball_diameter:g} m, race radius {race_radius:g} m, "
            f"conformity {conformity:g}; a conformity above 1 and a race wider than the ball are needed"
        )
    ratio = across / along
    second_kind = 1.0003 + 0.5968 / ratio
    first_kind = 1.5277 + 0.6023 * math.log(ratio)
    ellipticity = 1.0339 * ratio**0.636
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
