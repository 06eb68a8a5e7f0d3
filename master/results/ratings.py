"""Load of a run on its bearings: pressure, safety, fatigue; and the source of their ratings."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import StrEnum
from functools import cache, cached_property

import numpy as np

from ...bearings import rating
from ...bearings.catalogue import Bearing, bearing
from ...modelkit.errors import TouchdownError
from ..coupling.connections import Attachment
from ..scene.scene import ComponentSpec
from .final_state import Finished


class Origin(StrEnum):
    """As tables word it."""

    SET = "set for this run"
    SCENE = "scene"
    TAKEN_OVER = "scene, taken over in the swap"
    CATALOGUE = "catalogue"
    DEFAULT = "default"


def setting_origin(spec: ComponentSpec, variable: str) -> Origin:
    """Of a component's parameter: the last that had a say, as a run applies them."""
    if variable in spec.set:
        return Origin.SET if variable in spec.own else Origin.SCENE
    if variable in spec.inherited:
        return Origin.TAKEN_OVER
    entry = catalogued(spec.preset)
    if entry is not None and variable in entry.settings():
        return Origin.CATALOGUE
    return Origin.DEFAULT


@cache
def catalogued(preset: str | None) -> Bearing | None:
    """The entry of a component's preset; None without one, or where it is gone since."""
    try:
        return bearing(preset) if preset is not None else None
    except TouchdownError:
        return None


FEW_DROPS = 1000.0  # more than a bearing ever sees: fatigue beyond them ends none
LOAD, RING = "balls.force", "ring.omega"
STATIC = "rolling.static_rating"
TURN = 2.0 * math.pi


@dataclass(frozen=True)
class _Load:
    """On a bearing over the recorded times; each of shape (rows,)."""

    time: np.ndarray  # s
    ball: np.ndarray  # N, of the most loaded ball
    ring: np.ndarray  # rad/s, speed of the inner ring; the outer one does not turn
    peak: float  # N, of `ball`, also between recorded values


@dataclass(frozen=True)
class _Stated:
    """Load ratings of a row as scene or catalogue have them, and where each is from, in words."""

    row: rating.Capacity  # N; 0: there is none, and the standard's formula stands for it
    static: str
    dynamic: str


@dataclass(frozen=True)
class Rated:
    """A bearing, its ratings, and its loads. The model's ball force is taken as the normal one."""

    bearing: rating.RatedBearing
    loads: _Load
    stated: _Stated

    @cached_property
    def capacity(self) -> rating.Capacity:
        """Static and dynamic load rating of the whole bearing (N)."""
        return rating.bearing_capacity(self.bearing, self.stated.row.static, self.stated.row.dynamic)

    def pressure(self, race: str) -> np.ndarray:
        """The largest on a race, `rating.INNER` or OUTER, over the recorded times (Pa, (rows,))."""
        return rating.point_contact(self.bearing, race).pressure(self.loads.ball)

    def peak_pressure(self, race: str) -> float:
        """The largest of the run on a race (Pa)."""
        return float(rating.point_contact(self.bearing, race).pressure(self.loads.peak))

    def load_at(self, pressure: float) -> float:
        """Of a ball (N), with which it presses either race with a largest `pressure` (Pa) at most."""
        return min(float(rating.point_contact(self.bearing, race).load(pressure)) for race in rating.RACES)

    @property
    def half_axes(self) -> tuple[float, float]:
        """Of the largest contact on the inner race (m): across the groove, and along it."""
        across, along = rating.point_contact(self.bearing, rating.INNER).semi_axes(self.loads.peak)
        return float(across), float(along)

    @property
    def pressure_safety(self) -> float:
        """Load at which a race is pressed to its limit (4200 MPa; hybrid 4600) over the run's largest."""
        hardest = max(self.peak_pressure(race) for race in (rating.INNER, rating.OUTER))
        limit = self.bearing.pressure_limit
        return float(rating.pressure_safety(hardest, limit)) if hardest > 0.0 else math.inf

    @property
    def equivalent_load(self) -> float:
        """Static radial load (N) under which the most loaded ball carries the run's peak (ISO 76)."""
        b = self.bearing
        return self.loads.peak * b.rows * b.count * math.cos(b.contact_angle) / rating.BALL_SHARE

    @property
    def static_safety(self) -> float:
        """s_0 = C_0 / P_0."""
        return float(rating.static_safety(self.capacity.static, self.equivalent_load))

    @property
    def safety(self) -> float:
        """The lowest of both."""
        return min(self.static_safety, self.pressure_safety)

    @property
    def safety_by(self) -> str:
        """Which of both the lowest is, in words."""
        limit = f"against {1e-9 * self.bearing.pressure_limit:g} GPa on a race"
        return limit if self.pressure_safety <= self.static_safety else "by the rating C₀"

    @property
    def turns(self) -> float:
        """Of the inner ring in the run."""
        return float(np.sum(self._turns))

    @property
    def _turns(self) -> np.ndarray:
        """Of the inner ring about each recorded time, (rows,)."""
        return np.abs(self.loads.ring) * np.gradient(self.loads.time) / TURN

    @cached_property
    def damage(self) -> float:
        """Share of the rating life (ISO/TS 16281) that the run takes."""
        return rating.drop_damage(self.bearing, self.capacity.dynamic, self.loads.ball, self._turns)

    @property
    def drops(self) -> float:
        """Runs like this one until 10 % of such bearings have failed by fatigue; inf: it takes no life."""
        return rating.drops(self.damage)

    @property
    def ends_by(self) -> tuple[str, str]:
        """The failure that would come first, should drops be like this one, and its distance; in words.

        Fatigue is named where it comes within `FEW_DROPS`; beyond, a slightly harder drop dents it before.
        """
        if self.safety < 1.0:
            return (
                "a dent",
                f"in this drop: it stands {self.safety:.2g} of the largest ball load without one",
            )
        if self.drops < FEW_DROPS:
            return "fatigue", f"in one bearing of ten after {self.drops:.2g} such drops"
        return "a dent", f"by {self.safety:.3g} times the largest ball load; fatigue is further off"


def rated(run: Finished, a: Attachment) -> Rated | str:
    """A seat's bearing with its loads, or why it cannot be rated."""
    component, recording = run.system.components[a.bearing], run.recording
    lacking = [name for name in (LOAD, RING) if f"{a.bearing}.{name}" not in recording]
    if lacking:
        return f"{a.bearing} has no {' and no '.join(lacking)}, or it was not recorded"
    names = [n for n in component.variables if n.startswith(("balls.", "ring."))]
    entry = catalogued(run.scene.components[a.bearing].preset)
    try:
        values = dict(zip(names, component.read(names), strict=True))
        bearing = rating.RatedBearing.of(values, entry.contact_angle if entry else 0.0)
    except KeyError as error:
        return f"{a.bearing} does not state {error.args[0]}"
    except ValueError as error:
        return str(error)
    ball, peak = recording[f"{a.bearing}.{LOAD}"], values.get("balls.peak_force", 0.0)
    loads = _Load(recording.time, ball, recording[f"{a.bearing}.{RING}"], max(float(np.max(ball)), peak))
    return Rated(bearing, loads, _stated(run, a))


def _stated(run: Finished, a: Attachment) -> _Stated:
    """The ratings of the scene or the catalogue; a model's default is not taken for a rating."""
    spec = run.scene.components[a.bearing]
    entry = catalogued(spec.preset)
    is_stated = setting_origin(spec, STATIC) in (Origin.SET, Origin.SCENE, Origin.TAKEN_OVER)
    has = f"{a.bearing}.{STATIC}" in run.system  # not every model that the scene's was swapped for
    static = run.system.value(f"{a.bearing}.{STATIC}") if is_stated and has else None
    known, from_entry = rating.Capacity(0.0, 0.0), {}
    if entry:
        known, from_entry = rating.Capacity(entry.static_rating, entry.dynamic_rating), entry.origins
    return _Stated(
        rating.Capacity(static or known.static, known.dynamic),
        "the scene" if static else _origin(from_entry.get("static_rating", ""), "ISO 76", known.static),
        _origin(from_entry.get("dynamic_rating", ""), "ISO 281", known.dynamic),
    )


def _origin(of_entry: str, standard: str, known: float) -> str:
    """Where a rating is from: the catalogue, which may have it by the standard, or the geometry at hand."""
    if not known:
        return f"{standard}, from the geometry"
    return f"the catalogue: {of_entry}" if of_entry else "the catalogue"


MAX_DROPS = 1e15  # more are not told apart


RATINGS = "largest_ball_pressure", "lowest_static_safety", "drops_until_fatigue", "bearing_ends_by"


def rating_quantities(run: Finished, a: Attachment) -> dict[str, object]:
    """Largest pressure, lowest static safety, drops until fatigue and what ends a bearing first.

    Nothing without balls, or where they carried nothing; balls that cannot be rated have None for each.
    """
    if len(run.recording.time) < 2:  # broken off before its first step
        return {}
    one = rated(run, a)
    if isinstance(one, str):
        return {key: None for key in RATINGS if f"{a.bearing}.balls.count" in run.system}
    if one.loads.peak <= 0.0:
        return {}
    pressure = max(one.peak_pressure(race) for race in rating.RACES)
    values = pressure, one.safety, min(one.drops, MAX_DROPS), ", ".join(one.ends_by)
    return dict(zip(RATINGS, values, strict=True))
