"""Normal force of a contact: the law, its stiffness from geometry, its damping from a ratio.

One law holds the three of Halminen (2016): Hertz (2.1), indentation-proportional damping (2.38) and the
rotor-ring law (2.12) with its exponent and dissipation parameter; (2.2), plain linear damping, is the
`viscous` term.

    f = k d^n (1 + eps d') + c d d' + v d'        for d > 0, never below zero

`elastic_and_damping` gives its two parts; `pair.damped_normal` adds them up, at an instant or over a kick.
A passive contact does not pull: where damping would make f negative the contact has parted. Halminen
(2016) does not say so; the force cut off is below 0.1 um of indentation in its cases.

The stiffness k of a ball on its race follows from geometry (2.43-2.46, corrected), and damping from a ratio
(2.47). Ball and race touch in an ellipse, whose axes are as kappa to 1. With K and E, the complete elliptic
integrals of the first and second kind of the parameter 1 - 1/kappa^2, Hertz's theory asks for

    (kappa^2 E - K)/(K - E) = ratio

of the curvatures across to those along the shaft (about 22-33 for a deep groove ball bearing). Halminen
(2016) fits powers and logarithms of the ratio instead, after Brewe and Hamrock (1977); with them an inner
race is 1.4-1.7 % too stiff, an outer race 0.6-0.7 %. It prints (2.44) upside down (its 2.45 would take
the root of a negative number) and names the two integrals of (2.46) the wrong way round: 1.0003 +
0.5968/ratio is the second kind and 1.5277 + 0.6023 ln(ratio) the first.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

from ...modelkit import numerics
from ...modelkit.kernel import inlined, kernel
from ...modelkit.variables import real


@dataclass(frozen=True)
class ContactLaw:
    """Constants of a normal contact. `stiffness` carries the unit N/m^exponent."""

    stiffness: float = real(
        2.4e9, "N/m^n", "contact stiffness k (n is the exponent)", above=0.0, needs="?law == 0"
    )
    exponent: float = real(
        1.5, "1", "exponent n of the indentation", minimum=1.0, maximum=3.0, needs="?law == 0"
    )
    damping: float = real(0.0, "N.s/m2", "damping: c times indentation times its rate (2.38)", minimum=0.0)
    dissipation: float = real(
        0.0,
        "s/m",
        "Hunt-Crossley coefficient epsilon (2.12): elastic force times (1 + epsilon d')",
        minimum=0.0,
    )
    viscous: float = real(0.0, "N.s/m", "linear damping while in contact (2.2)", minimum=0.0)
    damping_ratio: float = real(
        0.0, "1", "damping ratio (2.47) of the contact, added to `damping`", minimum=0.0
    )
    expected_indentation: float = real(
        1e-5, "m", "peak indentation for which the damping ratio holds", above=0.0
    )
    mass: float = real(
        0.0,
        "kg",
        "mass for which the damping ratio holds; 0: the lighter body's",
        minimum=0.0,
        needs="damping_ratio",
    )


@kernel
def damp(law, lighter):
    """Add to `law`, a record, the damping that its ratio asks for (2.47): 2 sqrt(k m) ratio over the depth.

    lighter: mass of the lighter body (kg). k is the slope of the force at the expected indentation; with
    an indentation of 1 the damping is that of a linear damper.
    """
    if law.damping_ratio == 0.0:
        return
    depth, mass = law.expected_indentation, law.mass if law.mass != 0.0 else lighter
    slope = law.exponent * law.stiffness * depth ** (law.exponent - 1.0)
    law.damping += 2.0 * math.sqrt(slope * mass) * law.damping_ratio / depth
    law.damping_ratio = 0.0


@kernel
def broadcast_law(law, rows):
    """Make `law`, a record, that of `rows` like contacts side by side, that share the load."""
    law.stiffness *= rows
    law.damping *= rows
    law.viscous *= rows
    law.mass *= rows


@kernel
def power(x, exponent):
    """x^exponent for a number x > 0; the Hertz exponent takes the short way."""
    if exponent == 1.5:
        return x * math.sqrt(x)
    return x**exponent


@inlined
def hertz(indentation, stiffness, damping):
    """(Elastic force (N), damping (N s/m), stiffness at this load (N/m)) of (2.1) and (2.38), zero apart.

    indentation: m; stiffness: N/m^1.5; damping: N s/m2.
    """
    depth = max(indentation, 0.0)
    root = math.sqrt(depth)
    return stiffness * depth * root, damping * depth, 1.5 * stiffness * root


@kernel
def elastic_force(indentation, law):
    """k d^n (N) at an indentation d (m), zero where bodies are apart (2.1); law: a record."""
    if indentation <= 0.0:
        return 0.0
    return law.stiffness * power(indentation, law.exponent)


@kernel
def elastic_energy(indentation, law):
    """Energy stored in the contact (J) at an indentation d (m): k d^(n+1) / (n+1); law: a record."""
    return elastic_force(indentation, law) * max(indentation, 0.0) / (law.exponent + 1.0)


@kernel
def elastic_and_damping(indentation, law):
    """(Elastic force (N), damping (N s/m)) at an `indentation` (m), zero where bodies are apart."""
    if indentation <= 0.0:
        return 0.0, 0.0
    elastic = law.stiffness * power(indentation, law.exponent)
    return elastic, law.dissipation * elastic + law.damping * indentation + law.viscous


EXACT, PRINTED = range(2)  # how the ellipse is found
MAX_STEPS = 40  # of the search for kappa; six are enough
ROUNDING = 4e-16  # of ln(kappa)


class Ellipse(NamedTuple):
    """The ellipse of a contact."""

    ellipticity: float  # kappa, its longer axis over the shorter
    first_kind: float  # complete elliptic integrals
    second_kind: float


@kernel
def exact_ellipse(ratio):
    """`Ellipse` by Hertz's theory, for curvatures of `ratio` (at least 1).

    ln(ratio) rises with ln(kappa), by 3/2 near a circle and by less than 2 anywhere: secants, the first of
    them from the circle, or the middle of what that leaves should one lead out of it.
    """
    log_ratio = max(math.log(ratio), 0.0)
    low, high = log_ratio / 2.0, log_ratio / 1.5
    log_kappa, step, off = high, high, -log_ratio
    kappa, first, second = 1.0, 0.5 * math.pi, 0.5 * math.pi
    for _ in range(MAX_STEPS):
        kappa = math.exp(log_kappa)
        complement = 1.0 / (kappa * kappa)
        integrals = numerics.complete_integrals((kappa - 1.0) * (kappa + 1.0) * complement, complement)
        first, second = integrals.first, integrals.second
        if not abs(step) > ROUNDING * max(log_kappa, 1.0):
            break
        before, off = off, math.log(kappa * kappa * integrals.left / integrals.lost) - log_ratio
        if off < 0.0:
            low = log_kappa
        else:
            high = log_kappa
        step *= -off / (off - before)
        if not low <= log_kappa + step <= high:
            step = 0.5 * (low + high) - log_kappa
        log_kappa += step
    return Ellipse(kappa, first, second)


@kernel
def printed_ellipse(ratio):
    """`Ellipse` by the fits that Halminen (2016) prints (2.46), for curvatures of `ratio`."""
    return Ellipse(1.0339 * ratio**0.636, 1.5277 + 0.6023 * math.log(ratio), 1.0003 + 0.5968 / ratio)


@kernel
def race_contact_stiffness(ball_diameter, race_radius, conformity, modulus, hertz):
    """Hertz stiffness of a ball on its race (2.45), N/m^1.5; not a number where they meet in no point.

    ball_diameter, race_radius in m; race_radius is positive for the inner race (convex) and negative
    for the outer one (concave). `conformity` is the groove radius over the ball radius, modulus E_tot (Pa);
    hertz: EXACT or PRINTED. (2.45) reads lengths in mm and gives N/mm^1.5; in SI it needs no factor.
    """
    ball_radius = ball_diameter / 2.0
    across = 1.0 / ball_radius + 1.0 / race_radius
    along = 1.0 / ball_radius - 1.0 / (conformity * ball_radius)
    if along <= 0.0 or across <= 0.0:
        return math.nan
    ratio = across / along
    ellipse = printed_ellipse(ratio) if hertz == PRINTED else exact_ellipse(ratio)
    curvature_sum = 1.0 / (across + along)
    root = math.sqrt(2.0 * curvature_sum * ellipse.second_kind / ellipse.first_kind**3.0)
    return math.pi / 3.0 * root * ellipse.ellipticity * modulus


@kernel
def in_series(inner, outer):
    """One stiffness for ball-inner and ball-outer contacts in series (2.5), N/m^1.5."""
    return (inner ** (-1.0 / 1.5) + outer ** (-1.0 / 1.5)) ** -1.5
