"""A catalogue's entry of a bearing."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from ..angular.angular_row import SINGLE, SINGLES
from ..rating import Capacity, RatedBearing, bearing_capacity
from ..rolling.ball_set import BallSet
from ..rolling.ring import Ring
from .section import SHOULDER_HEIGHT, centroid_depth

NUMBERS = {  # name: unit and meaning
    "bore": ("m", "bore diameter"),
    "outside": ("m", "outside diameter"),
    "width": ("m", "width"),
    "balls": ("1", "balls in a row"),
    "rows": ("1", "rows of balls that share the load alike"),
    "ball_diameter": ("m", "ball diameter"),
    "pitch_diameter": ("m", "pitch diameter"),
    "inner_groove": ("1", "groove radius of the inner race over the ball's diameter"),
    "outer_groove": ("1", "groove radius of the outer race over the ball's diameter"),
    "contact_angle": ("rad", "nominal contact angle; for ratings and statics"),
    "row_distance": ("m", "of the rows of a pair with a contact angle; 0: no pair"),
    "preload": ("N", "by which that pair is clamped along the shaft"),
    "play": ("m", "radial play between balls and races; negative: preload"),
    "ring_mass": ("kg", "mass of the inner ring"),
    "ring_inertia": ("kg.m2", "moment of inertia of the inner ring"),
    "outer_ring_mass": ("kg", "mass of the outer ring"),
    "cage_mass": ("kg", "mass of the cage"),
    "static_rating": ("N", "basic static load rating of a row"),
    "dynamic_rating": ("N", "basic dynamic load rating of a row"),
    "damping": ("N.s/m", "damping between the rings (2.7)"),
}


@dataclass(frozen=True)
class Bearing:
    """A rolling bearing: geometry, masses, ratings. Lengths in m, masses in kg."""

    designation: str
    bore: float
    outside: float
    width: float
    balls: BallSet
    ring: Ring
    caged: bool
    outer_ring: float  # mass
    cage: float  # mass
    static_rating: float  # N, of a row
    dynamic_rating: float  # N, of a row
    contact_angle: float = 0.0  # rad
    damping: float = 0.0  # N s/m, between the rings (2.7)
    arrangement: int = SINGLE  # of its two rows, where it is a pair with a contact angle
    row_distance: float = 0.0  # m, of that pair
    preload: float = 0.0  # N, of that pair
    origins: Mapping[str, str] = field(default_factory=dict)  # where numbers are from, by their names

    @property
    def angle_in_drops(self) -> float:
        """Contact angle of its rows in a drop (rad): that of a pair; a single row takes no thrust there."""
        return 0.0 if self.arrangement in SINGLES else self.contact_angle

    def settings(self) -> dict[str, float]:
        """Values by parameter name; a model takes those it has."""
        b = self.balls
        pair = {
            "balls.contact_angle": self.angle_in_drops,
            "arrangement": self.arrangement,
            "row_distance": self.row_distance,
            "preload": self.preload,
            "land": self.width,
        }
        return {
            "balls.count": b.count,
            "balls.rows": b.rows,
            "balls.diameter": b.diameter,
            "balls.pitch_diameter": b.pitch_diameter,
            "balls.play": b.play,
            "balls.conformity": b.conformity,
            "balls.outer_conformity": b.outer_conformity,
            "balls.hertz": b.hertz,
            "balls.material": b.material,
            "ring.mass": self.ring.mass,
            "ring.inertia": self.ring.inertia,
            "ring.transverse_inertia": self.transverse_inertia,
            "cage.mass": self.cage,
            "rolling.static_rating": self.static_rating,
            "damping": self.damping,
            "contact.length": self.width,
            "contact.depth": self.depth,
            "shoulder.radius": self.face_radius,
            **({} if self.arrangement in SINGLES else pair),
        }

    def with_balls(self, material: int) -> Bearing:
        """The same with balls of another material (`contact.materials`)."""
        return replace(self, balls=replace(self.balls, material=material))

    @property
    def transverse_inertia(self) -> float:
        """Of the inner ring about a diameter (kg m2): that of a tube of its mass, inertia and width."""
        return 0.5 * self.ring.inertia + self.ring.mass * self.width**2 / 12.0

    @property
    def face_radius(self) -> float:
        """Mean radius of the inner ring's face, from the bore to the shoulder beside the groove (m)."""
        b = self.balls
        return 0.5 * (
            0.5 * self.bore + 0.5 * (b.pitch_diameter - b.diameter) + SHOULDER_HEIGHT * b.diameter
        )

    @property
    def depth(self) -> float:
        """From the bore to the centroid of the inner ring's section (m)."""
        b = self.balls
        groove = 0.5 * b.conformity
        return centroid_depth(self.bore, self.width, b.rows, b.diameter, b.pitch_diameter, groove)

    def numbers(self) -> dict[str, float]:
        """All its numbers by the names of `NUMBERS`, SI."""
        b = self.balls
        return {
            "bore": self.bore,
            "outside": self.outside,
            "width": self.width,
            "balls": b.count,
            "rows": b.rows,
            "ball_diameter": b.diameter,
            "pitch_diameter": b.pitch_diameter,
            "inner_groove": 0.5 * b.conformity,
            "outer_groove": 0.5 * (b.outer_conformity or b.conformity),
            "contact_angle": self.contact_angle,
            "row_distance": self.row_distance,
            "preload": self.preload,
            "play": b.play,
            "ring_mass": self.ring.mass,
            "ring_inertia": self.ring.inertia,
            "outer_ring_mass": self.outer_ring,
            "cage_mass": self.cage,
            "static_rating": self.static_rating,
            "dynamic_rating": self.dynamic_rating,
            "damping": self.damping,
        }

    def rated(self) -> RatedBearing:
        """As `bearings.rating` sees it."""
        return RatedBearing.of(self.settings(), self.contact_angle)

    def capacity(self) -> Capacity:
        """Load ratings of the whole bearing, all its rows (N)."""
        return bearing_capacity(self.rated(), self.static_rating, self.dynamic_rating)
