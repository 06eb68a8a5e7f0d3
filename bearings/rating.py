"""Ratings of ball bearings: contact pressure, static safety, rating life, drops until a limit.

Load ratings are those of radial ball bearings. The static one is computed as ISO/TR 10657 derives the
factors that ISO 76 tabulates, and meets them. The dynamic one takes the factors f_c that ISO 281 tabulates,
less where grooves are wider than those they are for, by the formula behind them (ISO/TR 1281-1). Makers
state their own ratings, for other grooves and better steel.

From the dynamic rating follows how much of a bearing's rating life a drop takes (Palmgren and Miner). That
is an estimate: rating lives are of bearings that run long, lubricated and not pressed beyond half of C, and
a drop does none of that. They rank designs and loads, and tell when fatigue is not what ends a touchdown
bearing.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ..modelkit.kernel import interpret
from .contact.laws import EXACT, exact_ellipse, race_contact_stiffness
from .contact.materials import (
    SILICON_NITRIDE_NUMBERS,
    STEEL,
    STEEL_NUMBERS,
    Elastic,
    effective_modulus,
)

INNER: Final = "inner"
OUTER: Final = "outer"
RACES = (INNER, OUTER)


@dataclass(frozen=True)
class RatedBearing:
    """A radial ball bearing. Lengths in m; a groove is its radius over the ball's diameter.

    Grooves are those of ISO/TS 16281 where they are not given. Raises ValueError for what is not a bearing.
    """

    count: int  # balls in a row
    diameter: float  # of a ball
    pitch_diameter: float
    inner_groove: float = 0.52
    outer_groove: float = 0.53
    rows: int = 1
    contact_angle: float = 0.0  # rad, nominal
    balls: Elastic = STEEL_NUMBERS
    rings: Elastic = STEEL_NUMBERS
    hybrid: bool = False  # ceramic balls in steel rings; of ceramic rings no standard tells

    def __post_init__(self) -> None:
        lengths = 0.0 < self.diameter < self.pitch_diameter < math.inf
        grooves = all(0.5 < groove <= 1.0 for groove in (self.inner_groove, self.outer_groove))
        bodies = (self.balls, self.rings)
        materials = all(0.0 < one.modulus < math.inf and 0.0 <= one.poisson <= 0.5 for one in bodies)
        if not (lengths and grooves and materials and min(self.count, self.rows) >= 1):
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
            balls=_elastic("balls", values),
            rings=_elastic("ring", values),
            hybrid=values.get("balls.material", STEEL) != STEEL
            and values.get("ring.material", STEEL) == STEEL,
        )

    @property
    def modulus(self) -> float:
        """E_tot of ball and race (Pa)."""
        return interpret(effective_modulus, self.balls, self.rings)

    @property
    def pressure_limit(self) -> float:
        """Largest pressure (Pa) that leaves a dent of 1e-4 of the ball's diameter."""
        return HYBRID_PRESSURE_LIMIT if self.hybrid else PRESSURE_LIMIT

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


def _elastic(body: str, values: Mapping[str, float]) -> Elastic:
    """Of balls or ring, from a model's parameters by name; what is 0 or not there is the material's."""
    usual = STEEL_NUMBERS if values.get(f"{body}.material", STEEL) == STEEL else SILICON_NITRIDE_NUMBERS
    return Elastic(*(values.get(f"{body}.{name}", 0.0) or getattr(usual, name) for name in Elastic._fields))


@dataclass(frozen=True)
class PointContact:
    """A contact by what a load of 1 N makes; loads are of one ball (N, of any shape)."""

    across: float  # semi-axis across the groove (m)
    along: float  # semi-axis the ball rolls along (m)
    stiffness: float  # N/m^1.5

    def semi_axes(self, load: ArrayLike) -> tuple[np.ndarray, np.ndarray]:
        """Of the ellipse across the groove and along it (m)."""
        root = np.cbrt(_pressing(load))
        return self.across * root, self.along * root

    def pressure(self, load: ArrayLike) -> np.ndarray:
        """Largest, in the middle of the ellipse (Pa)."""
        return 1.5 / (math.pi * self.across * self.along) * np.cbrt(_pressing(load))

    def load(self, pressure: ArrayLike) -> np.ndarray:
        """The load (N) with this largest pressure (Pa)."""
        return (np.asarray(pressure, float) * (math.pi * self.across * self.along) / 1.5) ** 3

    def approach(self, load: ArrayLike) -> np.ndarray:
        """Of ball and race (m)."""
        return (_pressing(load) / self.stiffness) ** (2.0 / 3.0)


def _pressing(load: ArrayLike) -> np.ndarray:
    """Loads without pull, which a contact does not bear."""
    return np.maximum(np.asarray(load, float), 0.0)


def point_contact(bearing: RatedBearing, race: str) -> PointContact:
    """The contact of a ball with the `INNER` or `OUTER` race, exact elliptic integrals.

    With kappa the ratio of the axes, E the elliptic integral of the second kind and s the sum of the four
    curvatures, the longer semi-axis is (6 kappa^2 E Q (1 - nu^2) / (pi s E_modulus))^(1/3).
    """
    b, groove, radius = bearing, bearing.groove(race), bearing.race_radius(race)
    along = 2.0 / b.diameter + 1.0 / radius
    across = 2.0 / b.diameter - 1.0 / (groove * b.diameter)
    ellipse = interpret(exact_ellipse, along / across)
    compliance = 6.0 * ellipse.second_kind / (math.pi * (along + across))
    longer = (ellipse.ellipticity**2 * compliance / b.modulus) ** (1.0 / 3.0)
    stiffness = interpret(race_contact_stiffness, b.diameter, radius, 2.0 * groove, b.modulus, EXACT)
    return PointContact(longer, longer / ellipse.ellipticity, stiffness)


ROUNDING = 1e-13
TINY = 1e-20  # m


@dataclass(frozen=True)
class LoadDistribution:
    """Loads of the balls of a row; the first is under the load."""

    angles: np.ndarray  # (count,), rad, from the direction of the load
    loads: np.ndarray  # (count,), N, along the contact's normal
    deflection: float  # m, of the rings against each other along the load, from the middle


def load_distribution(
    bearing: RatedBearing, radial_load: float, clearance: float = 0.0
) -> LoadDistribution:
    """A bearing under `radial_load` (N, above 0), rings rigid but for the contacts, no axial displacement.

    clearance: radial play between balls and races (m), half of what tables call radial internal clearance;
    negative is preload. Rows share the load alike. Raises ValueError for any other load.
    """
    from scipy.optimize import root_scalar  # not in the time of every start

    if not 0.0 < radial_load < math.inf:
        raise ValueError(f"a radial load of {radial_load:g} N; it must be above 0")
    tilt = math.cos(bearing.contact_angle)
    angles = 2.0 * math.pi / bearing.count * np.arange(bearing.count)
    compliance = sum(point_contact(bearing, race).stiffness ** (-2.0 / 3.0) for race in RACES)

    def loads(deflection: float) -> np.ndarray:
        pressed = np.maximum((deflection * np.cos(angles) - clearance) * tilt, 0.0)
        return (pressed / compliance) ** 1.5

    def lacking(deflection: float) -> float:
        return bearing.rows * tilt * float(loads(deflection) @ np.cos(angles)) - radial_load

    one_ball = (radial_load / (bearing.rows * tilt)) ** (2.0 / 3.0) * compliance / tilt  # bears all of it
    most = max(clearance, 0.0) + (1.0 + ROUNDING) * one_ball
    found = root_scalar(lacking, bracket=(0.0, most), xtol=TINY, rtol=ROUNDING).root
    return LoadDistribution(angles, loads(found), found)


PRESSURE_LIMIT = 4.2e9  # Pa; of ISO 76 for ball bearings: a ball and its race keep 1e-4 of its diameter
# Pa; of ISO 20056-2 for silicon nitride balls in steel rings (its number from memory): the ball keeps no
# dent, so the race may have all of it
HYBRID_PRESSURE_LIMIT = 4.6e9
BALL_SHARE = 5.0  # of the mean load, on the most loaded ball of a bearing with usual clearance (ISO 76)
STEEL_FACTOR = 1.3  # b_m of ISO 281, radial ball bearings of contemporary steel
LARGE_BALL_MM = 25.4  # mm, from which on the rating rises less
INNER_GROOVE, OUTER_GROOVE = 0.52, 0.53  # the widest for which f_c holds
EXPONENT = 10.0 / 3.0
FACTORS = (  # f_c of ISO 281 (2007), Table 2, single-row radial ball bearings, for 0.01, 0.02, ... of gamma
    *(29.1, 35.8, 40.3, 43.8, 46.7, 49.1, 51.1, 52.8, 54.3, 55.5),
    *(56.6, 57.5, 58.2, 58.8, 59.3, 59.6, 59.8, 59.9, 60.0, 59.9),
    *(59.8, 59.6, 59.3, 59.0, 58.6, 58.2, 57.7, 57.1, 56.6, 56.0),
    *(55.3, 54.6, 53.9, 53.2, 52.4, 51.7, 50.9, 50.0, 49.2, 48.4),
)


class Capacity(NamedTuple):
    """Load ratings of a whole bearing, all its rows."""

    static: float  # C_0r, N
    dynamic: float  # C_r, N


def bearing_capacity(bearing: RatedBearing, static: float = 0.0, dynamic: float = 0.0) -> Capacity:
    """`Capacity` by the ratings of a row that a maker states (N), where above 0, else by the standards.

    Those stated are of steel balls. With ceramic ones the static rating is another by the ratio that the
    standards give; the dynamic one stays (ISO 20056-1: such bearings live at least as long).
    """
    steel = replace(bearing, balls=STEEL_NUMBERS, rings=STEEL_NUMBERS, hybrid=False)
    all_static = bearing.rows * static * static_rating(bearing) / static_rating(steel)
    all_dynamic = bearing.rows**0.7 * dynamic
    return Capacity(all_static or static_rating(bearing), all_dynamic or dynamic_rating(bearing))


def static_rating(bearing: RatedBearing) -> float:
    """C_0r (N) by ISO 76, hybrid by ISO 20056-2: the most loaded ball presses a race to the limit."""
    most = min(float(point_contact(bearing, race).load(bearing.pressure_limit)) for race in RACES)
    return bearing.rows * bearing.count * math.cos(bearing.contact_angle) * most / BALL_SHARE


def _ring_ratio(gamma: float, inner: float, outer: float) -> float:
    """Rating of the inner ring over that of the outer one (ISO/TS 16281, what its Q_ci raises to 10/3)."""
    grooves = inner / outer * (2.0 * outer - 1.0) / (2.0 * inner - 1.0)
    return 1.044 * ((1.0 - gamma) / (1.0 + gamma)) ** 1.72 * grooves**0.41


def dynamic_rating(bearing: RatedBearing) -> float:
    """C_r (N) by ISO 281, b_m = 1.3; beyond its table, gamma from 0.01 to 0.40, by the nearest value."""
    b = bearing
    wider = max(b.inner_groove, INNER_GROOVE), max(b.outer_groove, OUTER_GROOVE)
    share = _grooves(b.gamma, *wider) / _grooves(b.gamma, INNER_GROOVE, OUTER_GROOVE)
    factor = share * float(np.interp(100.0 * b.gamma, np.arange(1, len(FACTORS) + 1), FACTORS))
    size = 1e3 * b.diameter
    ball = size**1.8 if size <= LARGE_BALL_MM else 3.647 * size**1.4
    rows = (b.rows * math.cos(b.contact_angle)) ** 0.7
    return STEEL_FACTOR * factor * rows * b.count ** (2.0 / 3.0) * ball


def _grooves(gamma: float, inner: float, outer: float) -> float:
    """The factor of f_c that depends on the grooves (ISO/TR 1281-1)."""
    both = (1.0 + _ring_ratio(gamma, inner, outer) ** EXPONENT) ** (-1.0 / EXPONENT)
    return both * (2.0 * inner / (2.0 * inner - 1.0)) ** 0.41


def static_safety(rating: float, load: ArrayLike) -> np.ndarray:
    """s_0 = C_0 / P_0 (ISO 76) of a bearing under a radial `load` (N, any shape); inf without one."""
    with np.errstate(divide="ignore"):
        return rating / np.abs(np.asarray(load, float))


def pressure_safety(pressure: ArrayLike, limit: float = PRESSURE_LIMIT) -> np.ndarray:
    """The same from a contact's largest pressure (Pa): loads are as third powers of pressures."""
    with np.errstate(divide="ignore"):
        return (limit / np.asarray(pressure, float)) ** 3


MILLION = 1e6  # revolutions
WEIBULL_SLOPE = 10.0 / 9.0  # of the Weibull distribution, point contact
TURNING, RESTING = 3.0, EXPONENT  # exponents of the mean load on a ring that turns or rests under the load


def ball_ratings(bearing: RatedBearing, dynamic_rating: float) -> tuple[float, float]:
    """Q_ci and Q_ce (N), dynamic ratings of a ball on inner and outer race, from C_r (ISO/TS 16281)."""
    ratio = _ring_ratio(bearing.gamma, bearing.inner_groove, bearing.outer_groove) ** EXPONENT
    mean = dynamic_rating / (bearing.count * math.cos(bearing.contact_angle) * bearing.rows**0.7)
    root = 1.0 / EXPONENT
    return mean / 0.407 * (1.0 + ratio) ** root, mean / 0.389 * (1.0 + 1.0 / ratio) ** root


def reference_rating_life(
    bearing: RatedBearing, dynamic_rating: float, loads: ArrayLike, turning: str = INNER
) -> float:
    """L_10r (ISO/TS 16281) in revolutions of the rings against each other; inf without load.

    dynamic_rating: C_r of the whole bearing (N); loads: of each ball (count,) or, where they differ on
    inner and outer race, (count, 2), N; turning: the ring that turns under the load, the other rests.
    Rows carry the same.
    """
    pressing = np.maximum(np.asarray(loads, float).reshape(bearing.count, -1), 0.0)
    exponents = {INNER: (TURNING, RESTING), OUTER: (RESTING, TURNING)}[turning]
    ratings = ball_ratings(bearing, dynamic_rating)
    worn = 0.0
    for on_race, rating, exponent in zip(
        (pressing[:, 0], pressing[:, -1]), ratings, exponents, strict=True
    ):
        equivalent = float(np.mean(on_race**exponent)) ** (1.0 / exponent)
        worn += bearing.rows * (equivalent / rating) ** EXPONENT
    return MILLION * worn ** (-1.0 / WEIBULL_SLOPE) if worn > 0.0 else math.inf


def drop_damage(
    bearing: RatedBearing, dynamic_rating: float, largest_load: ArrayLike, revolutions: ArrayLike
) -> float:
    """Share of the life L_10r (ISO/TS 16281) that a drop takes: the sum of revolutions over life.

    largest_load: of the most loaded ball (N, (K,)), from a histogram or a recording; revolutions: of the
    rings against each other while it acts ((K,), at least 0). The other balls are taken as loaded as in a
    bearing without clearance, whose life falls with the third power of that load. Raises ValueError for
    arrays of different lengths.
    """
    load, turns = np.maximum(np.asarray(largest_load, float), 0.0), np.asarray(revolutions, float)
    if load.shape != turns.shape:
        raise ValueError(f"{load.size} loads and {turns.size} numbers of revolutions")
    shared = load_distribution(bearing, 1.0).loads
    life = reference_rating_life(bearing, dynamic_rating, shared / shared.max())  # revolutions, at 1 N
    return float(np.sum(turns * load**3)) / life


def drops(damage: float) -> float:
    """Drops until 10 % of such bearings have failed by fatigue, all of one `damage`; inf without any."""
    return 1.0 / damage if damage > 0.0 else math.inf
