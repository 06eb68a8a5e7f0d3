"""What a report is about: a run, and what several chapters ask of it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from functools import cache, cached_property

import numpy as np

from ...bearings import rating
from ...bearings.catalogue import Bearing, CatalogueError, bearing
from ..common.errors import TouchdownError
from ..coupling.connections import Attachment
from ..coupling.loop.span import origin_of, zero_of
from ..results.ending import Finished
from ..results.first_impact import FIRST_IMPACT_PREFIX
from ..results.result import Result
from ..results.summary import SPREAD, seat_name, touchdown_seats
from ..results.whirl.evidence import CONTACT as FIRST_CONTACT
from ..scene.run_spec import RunSpec
from ..scene.scene import ComponentSpec, Scene
from .blocks import Absent
from .numbers import digits, quantity
from .series import Chart, Line, chosen_rows


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
    except CatalogueError:
        return None


def run_origin(scene: Scene, key: str) -> Origin:
    """Of a key of [run]."""
    if key in scene.own:
        return Origin.SET
    return Origin.DEFAULT if getattr(scene.run, key) == getattr(RunSpec(), key) else Origin.SCENE


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
        """Such runs until 10 % of such bearings have failed by fatigue; inf: this run takes nothing."""
        return rating.drops(self.damage)


def rated(subject: Subject, a: Attachment) -> Rated | str:
    """A seat's bearing with its loads, or why it cannot be rated."""
    component = subject.run.system.components[a.bearing]
    lacking = [name for name in (LOAD, RING) if not subject.has(a, name)]
    if lacking:
        return f"{a.bearing} has no {' and no '.join(lacking)}, or it was not recorded"
    names = [n for n in component.variables if n.startswith(("balls.", "ring."))]
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
    own = setting_origin(spec, STATIC) in (Origin.SET, Origin.SCENE, Origin.TAKEN_OVER)
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


COLOURS = ("blue", "orange", "green", "purple", "grey", "ink")
SHOWN_IMPACT = (0.002, 0.018)  # s before and after the first contact


@dataclass(frozen=True)
class Subject:
    """A run that is over."""

    result: Result

    @cached_property
    def run(self) -> Finished:
        """As pictures take it."""
        return Finished(self.result.scene, self.result.ending, self.result.recording)

    @property
    def summary(self) -> Mapping[str, object]:
        """The figures of the run."""
        return self.result.summary

    @cached_property
    def seats(self) -> list[Attachment]:
        """Where a journal can touch down, in the scene's order."""
        return touchdown_seats(self.result.ending)

    @cached_property
    def zero(self) -> float:
        """When the scene's zero was (s on the simulation's clock)."""
        try:
            return zero_of(self.result.scene, self.result.ending)
        except TouchdownError:  # a component that failed tells nothing any more
            return 0.0

    @cached_property
    def _origin(self) -> float:
        try:
            return origin_of(self.result.scene, self.result.ending)
        except TouchdownError:  # as above
            return 0.0

    @property
    def length(self) -> float:
        """How long the run was (s): from the scene's zero on, or from its start where it names none."""
        return float(self.run.recording.time[-1]) - self._origin

    @property
    def fall(self) -> float | None:
        """How long it was until the first contact (s), counted as `length`; None: nothing touched."""
        return None if self.first_contact is None else self.first_contact - self._origin

    @property
    def rotor(self) -> str:
        """The body that drops: the first that a touchdown bearing can catch."""
        return self.need_seats()[0].body

    def need_seats(self) -> list[Attachment]:
        """The seats. Raises Absent where there are none."""
        if not self.seats:
            raise Absent("the scene has no touchdown bearing that tells of its contact.")
        return self.seats

    def name(self, a: Attachment) -> str:
        """Of a seat, for people, such as A."""
        return seat_name(a, self.seats)

    def figure(self, key: str, a: Attachment) -> float | None:
        """A number of the summary that each touchdown bearing has; None where there is none."""
        tail = f"_{a.bearing}" if len(self.seats) > 1 else ""
        return number(self.summary.get(f"{key}{tail}"))

    def firmness(self, key: str, a: Attachment | None = None) -> str:
        """What a peak of the whole drop is worth: its spread over siblings, or that it has none.

        key: of the summary, in its units; a: the seat, where each bearing has the figure.
        """
        if a is not None and len(self.seats) > 1:
            key = f"{key}_{a.bearing}"
        spread = self.summary.get(SPREAD)
        if isinstance(spread, dict) and (one := spread["figures"].get(key)) is not None:
            ends = f"{digits(one['least'], 4)} to {digits(one['most'], 4)}"
            return f"{ends}, median {digits(one['median'], 4)}, with {spread['siblings']} siblings"
        first = FIRST_IMPACT_PREFIX + key.removeprefix("peak_")
        if key.startswith(FIRST_IMPACT_PREFIX) or self.summary.get(first, object()) == self.summary[key]:
            return "in the first impact"
        return "one draw of a chaotic drop"

    def whirl(self, a: Attachment, key: str = "") -> object:
        """Of the verdict at a seat: in words, or one of its figures."""
        return self.summary.get(f"whirl_{self.name(a)}{key}")

    def has(self, a: Attachment, variable: str) -> bool:
        """Whether a bearing's variable was recorded."""
        return f"{a.bearing}.{variable}" in self.run.recording

    def values(self, a: Attachment, variable: str) -> np.ndarray:
        """A bearing's variable over the recorded times, (rows,), in SI."""
        return self.run.recording[f"{a.bearing}.{variable}"]

    def setting(self, a: Attachment, variable: str) -> float | None:
        """A bearing's parameter or output at the end; None where it has none of that name."""
        name = f"{a.bearing}.{variable}"
        return self.run.system.value(name) if name in self.run.system else None

    @cached_property
    def first_contact(self) -> float | None:
        """The first anywhere (s from the zero); None: nothing touched."""
        times = [t for a in self.seats if (t := self.figure(FIRST_CONTACT, a)) is not None]
        return min(times, default=None)

    def chart(self, name: str, title: str, axis: str, curves: list[Line]) -> Chart:
        """A chart of curves that have a value for each recorded time."""
        time = self.run.recording.time
        rows = chosen_rows(time, [c.values for c in curves], self.first_contact)
        kept = [Line(c.label, c.colour, c.values[rows]) for c in curves]
        return Chart(name, title, axis, time[rows], kept, self.impact)

    @cached_property
    def impact(self) -> tuple[float, float] | None:
        """The surroundings of the first contact (s)."""
        if self.first_contact is None:
            return None
        before, after = SHOWN_IMPACT
        return self.first_contact - before, self.first_contact + after

    @property
    def interval(self) -> str:
        """From one recorded moment to the next, for people."""
        time = self.run.recording.time
        return quantity(float(np.median(np.diff(time))), "s") if len(time) > 1 else "moment"


def number(value: object) -> float | None:
    """A figure, where it is a number."""
    return float(value) if isinstance(value, (int, float)) and not isinstance(value, bool) else None
