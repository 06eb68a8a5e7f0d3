"""A rolling bearing with what a run did to it: for pressures, safety and life, all of them estimates."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from touchdown.bearings import rating
from touchdown.master.coupling.connections import Attachment
from touchdown.master.report.facts.origins import Origin, catalogued, origin_of
from touchdown.master.report.facts.subject import Subject

LOAD, RING = "balls.force", "ring.omega"
STATIC = "rolling.static_rating"
TURN = 2.0 * math.pi


@dataclass(frozen=True)
class Loads:
    """On a bearing over the recorded times; each of shape (rows,)."""

    time: np.ndarray  # s
    ball: np.ndarray  # N, of the most loaded ball
    ring: np.ndarray  # rad/s, speed of the inner ring; the outer one does not turn
    peak: float  # N, of `ball`, also between recorded values


@dataclass(frozen=True)
class Stated:
    """Load ratings of a row as scene or catalogue have them, and where each is from, in words."""

    row: rating.Capacity  # N; 0: there is none, and the standard's formula stands for it
    static: str
    dynamic: str


@dataclass(frozen=True)
class Rated:
    """A bearing, its ratings, and its loads. The model's ball force is taken as the normal one."""

    bearing: rating.RatedBearing
    loads: Loads
    stated: Stated

    @cached_property
    def capacity(self) -> rating.Capacity:
        """Static and dynamic load rating of the whole bearing (N)."""
        return rating.capacity(self.bearing, self.stated.row.static, self.stated.row.dynamic)

    def pressure(self, race: str) -> np.ndarray:
        """The largest on a race, `rating.INNER` or OUTER, over the recorded times (Pa, (rows,))."""
        return rating.point_contact(self.bearing, race).pressure(self.loads.ball)

    def peak_pressure(self, race: str) -> float:
        """The largest of the run on a race (Pa)."""
        return float(rating.point_contact(self.bearing, race).pressure(self.loads.peak))

    @property
    def half_axes(self) -> tuple[float, float]:
        """Of the largest contact on the inner race (m): across the groove, and along it."""
        across, along = rating.point_contact(self.bearing, rating.INNER).semi_axes(self.loads.peak)
        return float(across), float(along)

    @property
    def pressure_safety(self) -> float:
        """Load at which a race is pressed with 4200 MPa over the largest of the run."""
        hardest = max(self.peak_pressure(race) for race in (rating.INNER, rating.OUTER))
        return float(rating.pressure_safety(hardest)) if hardest > 0.0 else math.inf

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
        """Such runs until 10 % of such bearings have failed by fatigue; inf: this run takes nothing."""
        return rating.drops(self.damage)


def rated(subject: Subject, a: Attachment) -> Rated | str:
    """A seat's bearing with its loads, or why it cannot be rated."""
    component = subject.run.system.components[a.bearing]
    lacking = [name for name in (LOAD, RING) if not subject.has(a, name)]
    if lacking:
        return f"{a.bearing} has no {' and no '.join(lacking)}, or it was not recorded"
    names = [n for n in component.variables if n.startswith("balls.")]
    entry = catalogued(subject.result.scene.components[a.bearing].preset)
    try:
        values = dict(zip(names, component.read(names), strict=True))
        bearing = rating.RatedBearing.of(values, entry.contact_angle if entry else 0.0)
    except KeyError as error:
        return f"{a.bearing} does not state {error.args[0]}"
    except ValueError as error:
        return str(error)
    peak = subject.setting(a, "balls.peak_force")
    ball = subject.values(a, LOAD)
    loads = Loads(
        subject.run.recording.time,
        ball,
        subject.values(a, RING),
        max(float(np.max(ball)), peak or 0.0),
    )
    return Rated(bearing, loads, _stated(subject, a))


def _stated(subject: Subject, a: Attachment) -> Stated:
    """What the scene or the catalogue has; a model's default is not taken for a rating."""
    spec = subject.result.scene.components[a.bearing]
    entry = catalogued(spec.preset)
    own = origin_of(spec, STATIC) in (Origin.SET, Origin.SCENE, Origin.TAKEN_OVER)
    static = subject.setting(a, STATIC) if own else None
    known, from_entry = rating.Capacity(0.0, 0.0), {}
    if entry:
        known, from_entry = rating.Capacity(entry.static_rating, entry.dynamic_rating), entry.origins
    return Stated(
        rating.Capacity(static or known.static, known.dynamic),
        "the scene" if static else _origin(from_entry.get("static_rating", ""), "ISO 76", known.static),
        _origin(from_entry.get("dynamic_rating", ""), "ISO 281", known.dynamic),
    )


def _origin(of_entry: str, standard: str, known: float) -> str:
    """Where a rating is from: the catalogue, which may have it by the standard, or the geometry at hand."""
    if not known:
        return f"{standard}, from the geometry"
    return f"the catalogue: {of_entry}" if of_entry else "the catalogue"
