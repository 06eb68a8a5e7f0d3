"""A ball bearing as its ratings see it: geometry and material."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

INNER: Final = "inner"
OUTER: Final = "outer"
RACES = (INNER, OUTER)


@dataclass(frozen=True)
class RatedBearing:
    """A radial ball bearing. Lengths in m; a groove is its radius over the ball's diameter.

    Grooves are those of ISO/TS 16281 where they are not given. Raises ValueError for what is no bearing.
    """

    count: int  # balls in a row
    diameter: float  # of a ball
    pitch_diameter: float
    inner_groove: float = 0.52
    outer_groove: float = 0.53
    rows: int = 1
    contact_angle: float = 0.0  # rad, nominal
    modulus: float = 207e9  # Pa; ISO 76
    poisson: float = 0.3

    def __post_init__(self) -> None:
        lengths = 0.0 < self.diameter < self.pitch_diameter < math.inf
        grooves = all(0.5 < groove <= 1.0 for groove in (self.inner_groove, self.outer_groove))
        material = 0.0 < self.modulus < math.inf and 0.0 <= self.poisson <= 0.5
        if not (lengths and grooves and material and min(self.count, self.rows) >= 1):
            raise ValueError(f"not a ball bearing: {self}")
        if not 0.0 <= self.contact_angle < 0.5 * math.pi:
            raise ValueError(
                f"a contact angle of {self.contact_angle:g} rad is not that of a radial bearing"
            )

    @classmethod
    def of(cls, values: Mapping[str, float], contact_angle: float = 0.0) -> RatedBearing:
        """From the parameters of a ball bearing's model by name ("balls.count", ...), SI."""
        inner = values["balls.conformity"]
        return cls(
            count=int(values["balls.count"]),
            diameter=values["balls.diameter"],
            pitch_diameter=values["balls.pitch_diameter"],
            inner_groove=0.5 * inner,
            outer_groove=0.5 * (values.get("balls.outer_conformity", 0.0) or inner),
            rows=int(values.get("balls.rows", 1)),
            contact_angle=contact_angle,
            modulus=values["balls.modulus"],
            poisson=values["balls.poisson"],
        )

    @property
    def gamma(self) -> float:
        """D_w cos(alpha) / D_pw of the standards."""
        return self.diameter * math.cos(self.contact_angle) / self.pitch_diameter

    def groove(self, race: str) -> float:
        """Groove radius over ball diameter of the `INNER` or `OUTER` race."""
        return self.inner_groove if race == INNER else self.outer_groove

    def race_radius(self, race: str) -> float:
        """Radius of a race (m) in the plane in which a ball rolls: negative for the outer one, concave."""
        at_contact = 0.5 * self.pitch_diameter / math.cos(self.contact_angle)
        ball = 0.5 * self.diameter
        return at_contact - ball if race == INNER else -(at_contact + ball)
