"""Races that are not circles: lobed by manufacture, or worn in one place.

In polar coordinates about the ring's centre, turning with the ring,

    r(s) = r0 + a cos(n (s - s0)) + w exp((cos(s - s1) - 1) / b^2)

`r0` is the circle's radius. Wear is a dent: it widens the outer race and narrows the inner one.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from touchdown.modelkit.kernel import kernel
from touchdown.modelkit.variables import SWITCH, choice, integer, real

SAMPLES = 20_000  # around a race, for the check of its curvature
DENT_SAMPLES = 801  # across a worn dent; odd: one is its middle
ROOM = 1.02  # radii of curvature of race and ball must differ by this factor where they nest


@dataclass(frozen=True)
class RaceProfile:
    """Deviation of a race from a circle; zero amplitude and zero wear: a circle."""

    lobes: int = integer(2, "number of lobes n", minimum=1, maximum=1000)
    amplitude: float = real(0.0, "m", "amplitude a of the lobes")
    phase: float = real(0.0, "rad", "angle of the first lobe s0 at the start")
    wear: float = real(0.0, "m", "depth of the worn dent", minimum=0.0)
    wear_angle: float = real(-math.pi / 2, "rad", "where the dent is at the start (s1)")
    wear_width: float = real(0.2, "rad", "width b of the dent", above=0.0)
    search: int = choice(0, SWITCH, "search the contact point even where the race is a circle")


@kernel
def active(profile):
    """Whether contacts with a race of this `profile`, a record, have to be searched for."""
    return profile.amplitude != 0.0 or profile.wear != 0.0 or profile.search == 1


@kernel
def radius_and_slopes(s, radius, profile, dent):
    """(r, dr/ds, d2r/ds2) of a race in m at the angle s (rad), on a circle of `radius` (m).

    `dent` is +1 where wear widens it, -1 where it narrows it.
    """
    turned = profile.lobes * (s - profile.phase)
    c, sn = profile.amplitude * math.cos(turned), profile.amplitude * math.sin(turned)
    r, d1, d2 = radius + c, -profile.lobes * sn, -float(profile.lobes * profile.lobes) * c
    if profile.wear != 0.0:
        off = s - profile.wear_angle
        cs, sns = math.cos(off), math.sin(off)
        sharp = 1.0 / (profile.wear_width * profile.wear_width)
        bump = dent * profile.wear * math.exp((cs - 1.0) * sharp)
        r += bump
        d1 -= bump * sharp * sns
        d2 += bump * sharp * (sharp * sns * sns - cs)
    return r, d1, d2


@kernel
def curvature(s, radius, profile, dent):
    """Curvature (1/m) at the angle s (rad), positive where it bends like a circle; rest as above."""
    r, d1, d2 = radius_and_slopes(s, radius, profile, dent)
    return (r * r + 2.0 * d1 * d1 - r * d2) / (r * r + d1 * d1) ** 1.5


@kernel
def sharpest(radius, profile, dent):
    """Largest curvature (1/m) of a race towards its ball, around it and again across its dent.

    A dent may be narrower than the samples around are apart; the others as for `radius_and_slopes`.
    """
    most = -math.inf
    for i in range(SAMPLES):
        most = max(most, dent * curvature(2.0 * math.pi / SAMPLES * i, radius, profile, dent))
    if profile.wear != 0.0:
        for i in range(DENT_SAMPLES):
            off = profile.wear_width * (8.0 / (DENT_SAMPLES - 1) * i - 4.0)
            most = max(most, dent * curvature(profile.wear_angle + off, radius, profile, dent))
    return most


def problems(name: str) -> tuple[str, ...]:
    """What `problem` may find of the profile in the group `name` of a model's parameters."""

    def bent(cause: str, remedy: str) -> str:
        return (
            f"{name}.{cause} = {{0:g}} m bends the race to a radius of {{1:g}} m, where a ball of "
            f"{{2:g}} m touches it at more than one point; make it smaller, or the {remedy}"
        )

    return (
        f"{name}.amplitude = {{0:g}} m and {name}.wear = {{1:g}} m leave nothing of a race of {{2:g}} m; "
        "they must be far smaller",
        bent("wear", "dent wider"),
        bent("amplitude", "lobes fewer"),
    )


@kernel
def problem(profile, radius, ball_radius, dent, told):
    """Why a ball would touch the race at more than one point: its number in `problems`, or 0.

    profile: a record; radius, ball_radius: m; dent: +1 where the ball rolls inside (outer race), else -1.
    The race must nowhere be hollowed out as sharply as the ball is round. told: `Model`'s m.told.
    """
    if not active(profile):
        return 0
    if abs(profile.amplitude) + profile.wear >= 0.5 * radius:
        told[0], told[1], told[2] = profile.amplitude, profile.wear, radius
        return 1
    most = sharpest(radius, profile, dent)
    if most * ball_radius * ROOM < 1.0:
        return 0
    worn = profile.wear / (profile.wear_width * profile.wear_width)
    lobed = abs(profile.amplitude) * profile.lobes * profile.lobes
    told[1], told[2] = 1.0 / most, ball_radius
    if worn > lobed:
        told[0] = profile.wear
        return 2
    told[0] = profile.amplitude
    return 3
