"""Races that are not circles: lobed by manufacture, or worn in one place.

In polar coordinates about the ring's centre, turning with the ring,

    r(s) = r0 + a cos(n (s - s0)) + w exp((cos(s - s1) - 1) / b^2)

`r0` is the circle's radius. Wear is a dent: it widens the outer race and narrows the inner one.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from touchdown.modelkit.kernel import kernel
from touchdown.modelkit.variables import as_record, integer, real

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
    search: int = integer(
        0, "1: search the contact point even where the race is a circle", minimum=0, maximum=1
    )

    @property
    def active(self) -> bool:
        """Whether contacts have to be searched for."""
        return bool(self.amplitude != 0.0 or self.wear != 0.0 or self.search)


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
def _curvature(angles, radius, profile, dent):
    """(n,) curvature (1/m) at (n,) angles (rad); the others as for `radius_and_slopes`."""
    bent = np.empty(len(angles))
    for i in range(len(angles)):
        r, d1, d2 = radius_and_slopes(angles[i], radius, profile, dent)
        bent[i] = (r * r + 2.0 * d1 * d1 - r * d2) / (r * r + d1 * d1) ** 1.5
    return bent


def curvature(radius: float, profile: RaceProfile, dent: float) -> np.ndarray:
    """Curvature (1/m) around the race and again across its dent, positive where it bends like a circle."""
    around = np.linspace(0.0, 2.0 * math.pi, SAMPLES, endpoint=False)
    if profile.wear != 0.0:  # a dent may be narrower than the samples are apart
        across = profile.wear_angle + profile.wear_width * np.linspace(-4.0, 4.0, DENT_SAMPLES)
        around = np.concatenate([around, across])
    return _curvature(around, radius, as_record(profile), dent)


def problem(name: str, profile: RaceProfile, radius: float, ball_radius: float, hollow: bool) -> str | None:
    """Why a ball would touch the race at more than one point, or None.

    `hollow`: the ball rolls inside (outer race). The race must nowhere be hollowed out as sharply as
    the ball is round.
    """
    if not profile.active:
        return None
    if abs(profile.amplitude) + profile.wear >= 0.5 * radius:
        return (
            f"{name}.amplitude = {profile.amplitude:g} m and {name}.wear = {profile.wear:g} m leave "
            f"nothing of a race of {radius:g} m; they must be far smaller"
        )
    bent = curvature(radius, profile, 1.0 if hollow else -1.0)
    sharpest = float(np.max(bent)) if hollow else -float(np.min(bent))
    if sharpest * ball_radius * ROOM < 1.0:
        return None
    worn, lobed = profile.wear / profile.wear_width**2, abs(profile.amplitude) * profile.lobes**2
    cause, remedy = ("wear", "dent wider") if worn > lobed else ("amplitude", "lobes fewer")
    value = getattr(profile, cause)
    return (
        f"{name}.{cause} = {value:g} m bends the race to a radius of {1.0 / sharpest:.3g} m, where a ball "
        f"of {ball_radius:g} m touches it at more than one point; make it smaller, or the {remedy}"
    )
