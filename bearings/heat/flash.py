"""Temperature where two bodies slide on each other: a flash above their own.

In a line contact of half the width b friction makes q watts a metre. The strip runs over either body with a
speed v, faster than heat spreads in it (v b far above k/(rho c), 1e-5 m2/s of steel), and would warm it by

    K q/(B sqrt(b v))        B = sqrt(k rho c)        K = 0.786

at most, if the body took all of that: the largest value under Hertz's half ellipse, which Blok has as
1.11 q/(B sqrt(2 b v)). Surfaces that touch are as warm as each other, so each takes its part of the heat by
w = B sqrt(v):

    T = (w_1 T_1 + w_2 T_2 + K q/sqrt(b))/(w_1 + w_2)

A body over which the strip stays takes none of it, as heat has no time to get away from there.

Blok, Proc. General Discussion on Lubrication and Lubricants, Inst. Mech. Eng. 2 (1937) 222; Jaeger, J.
Proc. Roy. Soc. New South Wales 76 (1942) 203; for gears AGMA 925-A03, where K is 0.80. Roughness, which is
hotter yet, films, and what a hot surface does to friction are left out.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from ...modelkit.kernel import kernel
from ..contact.materials import SILICON_NITRIDE, SILICON_NITRIDE_DENSITY, STEEL_DENSITY
from .warm_parts import thermal_of

SHAPE = 0.7859834  # K: of 2/pi^1.5 times the integral of sqrt((1 - s^2)/(x - s)) from -1 to x, its maximum
# K above a start at 20 C, and what a surface of bearing steel (52100) does from there on. Tempered above
# 260 C it has less than 58 HRC (ASM International, Martensitic heat treating, 2019); 727 C is the eutectoid
# of iron and carbon; the last is rounded, and from memory
MOLTEN, AUSTENITIC, TEMPERED = 1280.0, 707.0, 240.0
LIMITS = (
    (MOLTEN, "melts"),
    (AUSTENITIC, "turns to austenite"),
    (TEMPERED, "is tempered, and loses its hardness"),
)


class Surface(NamedTuple):
    """A body in a contact that slides."""

    speed: float  # m/s, over the strip of contact
    warmth: float  # K
    material: int


@kernel
def _takes(surface):
    """w of a `Surface`: how readily it takes heat (W s^0.5/m2/K times the root of m/s)."""
    ceramic = surface.material == SILICON_NITRIDE
    density, heat = SILICON_NITRIDE_DENSITY if ceramic else STEEL_DENSITY, thermal_of(surface.material)
    return math.sqrt(heat.conductivity * density * heat.specific * abs(surface.speed))


@kernel
def contact_temperature(made, half_width, one, other):
    """The highest (K) in a strip of `half_width` (m) that makes heat (W/m) between two `Surface`s."""
    first, second = _takes(one), _takes(other)
    if first + second == 0.0 or half_width == 0.0:
        return max(one.warmth, other.warmth)
    flash = SHAPE * made / math.sqrt(half_width)
    return (first * one.warmth + second * other.warmth + flash) / (first + second)


def damage(warmth: float) -> str | None:
    """What steel does that is warmer than at the start by `warmth` (K); None: it bears that."""
    return next((f"above {limit:g} K steel {does}" for limit, does in LIMITS if warmth > limit), None)
