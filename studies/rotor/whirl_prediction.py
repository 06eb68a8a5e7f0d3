"""The whirl that a rotor may get into, predicted without a drop: how fast, how hard, what drives it.

The bearings are measured on a rig, each by itself: its journal goes round pressed into it, and the force
across and along the circle is read. Receptances of rotor and mount do the rest
(`rotor.modal.contact_whirl`).
"""

from __future__ import annotations

import math
from bisect import bisect_left
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import Any, NamedTuple

import numpy as np

from ...bearings import rating
from ...bearings.supports.mount_law import Elements, circle_stiffness, mount_dynamic_stiffness
from ...master.common.errors import TouchdownError
from ...master.common.text import aligned
from ...master.components.component import POSITION
from ...master.coupling.connections import Attachment
from ...master.coupling.simulation import opened
from ...master.coupling.system import System
from ...master.scene.scene import Scene
from ...modelkit.variables import from_values
from ...rotor.modal.contact_whirl import (
    Carrier,
    ContactWhirl,
    ElasticModes,
    Ground,
    WhirlCircle,
    WhirlSeat,
    circling,
    on_modes,
    receptance,
    rigid,
    steady,
)
from ...rotor.modal.modes import RIGID_MODES
from .rig import Rig
from .supports import SHUTDOWN, RotorModel, foundation_of, rotor_model

DEPTHS = np.geomspace(1e-6, 150e-6, 8)  # m, that journals are pressed in on the rig
SHALLOWEST, STOPPING_POINTS = 1e-8, 400  # m, where an impact's energy is counted from; depths
BEGIN = 0.9  # of the clearance: where a journal on the rig starts, without a touch
MEASURED_AT = (150.0, 700.0)  # Hz
SLOWEST, FASTEST = 5.0, 3000.0  # Hz, between which a whirl is looked for
BALLS = "balls.force"  # N, of the most loaded ball
DRAG, DISSIPATION, DAMPING = "rolling.resistance", "balls.dissipation", "balls.damping_ratio"
ASSUMED = {
    "drag of the balls": (DRAG,),
    "damping of the balls": (DISSIPATION, DAMPING),
}  # makers state neither
MORE = 2.0  # times what is assumed, to see what depends on it
SOME_DAMPING = 0.02  # `balls.damping_ratio`, where there is no damping to double
CLEARANCE, SLIDING, RATING = "clearance", "slide[1].stiffness", "rolling.static_rating"
HERTZ = 2.0 * math.pi
BACKWARD, FORWARD = -1.0, 1.0
# A whirl's centrifugal acceleration over gravity, above which drops of rotor I went on whirling and below
# which they fell back, on 40 mounts drawn at random: found by running them, not derived
LASTING = 10.0
MOST_UNLIKE = 1.2  # K - m W^2 of a mount one way over the other, up to which a whirl is a circle
SURE = 1.5  # a margin from which on, or one over it, an answer is sure


@dataclass(frozen=True)
class Measured:
    """A bearing whose journal went round pressed in, by frequency and depth."""

    omega: np.ndarray  # (F,), rad/s, without its sign
    depth: np.ndarray  # (D,), m
    force: np.ndarray  # (F, D), complex, N: outwards, and along the circle in the sense of the whirl
    ball: np.ndarray  # (F, D), N, of the most loaded ball; 0: it tells none

    def __call__(self, depth: float, omega: float) -> complex:
        """Force on the journal (N), outwards and counter-clockwise, on a circle at `omega` (rad/s)."""
        k, part = self._place(depth)
        found = self._between(omega, [_power(row, k, part) for row in self._rows])
        return complex(found.real, math.copysign(1.0, omega) * found.imag)

    def stopping(self, energy: float, omega: float) -> float:
        """The force inwards (N) at which a bearing that is pressed in has taken up an `energy` (J)."""
        depth = np.geomspace(SHALLOWEST, self.depth[-1] ** 2 / self.depth[0], STOPPING_POINTS)
        force = np.array([-self(float(one), omega).real for one in depth])
        stored = np.cumsum(0.5 * (force[1:] + force[:-1]) * np.diff(depth))
        return float(np.interp(energy, np.append(0.0, stored), force))

    def loaded(self, depth: float, omega: float) -> float:
        """The most loaded ball (N)."""
        shares = self.ball / np.abs(self.force)
        share = self._between(omega, [np.interp(math.log(depth), self._logs, row) for row in shares])
        return float(np.real(share)) * abs(self(depth, omega))

    # plain numbers, since an equation's residual asks for a single force ten thousand times
    @cached_property
    def _logs(self) -> list[float]:
        return [float(one) for one in np.log(self.depth)]

    @cached_property
    def _rows(self) -> list[tuple[list[float], list[float]]]:
        """At each frequency, by depth: logarithm of the force inwards, force along over inwards."""
        return [
            (np.log(-np.real(row)).tolist(), (np.imag(row) / np.real(row)).tolist()) for row in self.force
        ]

    def _place(self, depth: float) -> tuple[int, float]:
        """Between which depths, from number k on, and how far: below 0 or above 1 beyond all of them."""
        log_depth, logs = math.log(depth), self._logs
        k = min(max(bisect_left(logs, log_depth) - 1, 0), len(logs) - 2)
        return k, (log_depth - logs[k]) / (logs[k + 1] - logs[k])

    def _between(self, omega: float, found: Sequence[complex]) -> complex:
        """Of the values at the measured frequencies, by the square of them, as inertia goes."""
        squares = self._squares
        square = min(max(omega * omega, squares[0]), squares[-1])
        k = min(max(bisect_left(squares, square) - 1, 0), len(squares) - 2)
        return found[k] + (square - squares[k]) / (squares[k + 1] - squares[k]) * (found[k + 1] - found[k])

    @cached_property
    def _squares(self) -> list[float]:
        return (self.omega**2).tolist()


def _power(row: tuple[list[float], list[float]], k: int, part: float) -> complex:
    """Outwards, and along: a power law from depth to depth, beyond them the last one; the ratio stays."""
    pressed, ratio = row
    inwards = math.exp(pressed[k] + part * (pressed[k + 1] - pressed[k]))
    there = min(max(part, 0.0), 1.0)
    return complex(-inwards, -inwards * (ratio[k] + there * (ratio[k + 1] - ratio[k])))


class _Limits(NamedTuple):
    """Loads (N) that a bearing does not bear; nan: it tells too little of its balls."""

    ball: float  # of a ball, that dents a race
    static: float  # of the bearing: C0


def _alike(omega: float, stroke: float) -> float:
    """The `_anisotropy` of what is alike in all directions."""
    return 1.0


def _anisotropy(elements: Elements, mass: float, omega: float, stroke: float) -> float:
    """How much more a mount under a `mass` (kg) resists one way than the other: K - m W^2.

    It is moved at `omega` (rad/s) by `stroke` (m). By what makes a force on the circle that goes the other
    way round, over what resists; inf: as much.
    """
    k = mount_dynamic_stiffness(elements, omega, stroke) - mass * omega * omega * np.eye(2)
    around = abs(k[0, 0] + k[1, 1] + 1j * (k[1, 0] - k[0, 1]))
    other = abs(k[0, 0] - k[1, 1] + 1j * (k[1, 0] + k[0, 1]))
    return float((around + other) / (around - other)) if around > other else math.inf


@dataclass(frozen=True)
class _Journal:
    """A touchdown bearing of the scene, measured, and what it stands on."""

    name: str
    node: int
    clearance: float  # m
    limits: _Limits
    assumed: Mapping[str, float]  # parameters of `ASSUMED` that it has
    measured: Mapping[float, Measured]  # by direction
    carrier: Carrier
    carried: float = math.inf  # kg, of the body that it stands on; inf: the ground
    unlike: Callable[[float, float], float] = _alike  # anisotropy of its mount by frequency and stroke


@dataclass(frozen=True)
class Machine:
    """A scene's rotor in its touchdown bearings."""

    model: RotorModel
    spin: float  # rad/s, of the rotor; counter-clockwise
    journals: tuple[_Journal, ...]
    ground: Ground | None = None  # where bearings share a foundation

    def predicted(self, direction: float = BACKWARD) -> PredictedWhirl:
        """The whirl against the spin, or with it."""
        sign = direction * math.copysign(1.0, self.spin)
        rotor = receptance(
            self.model.basis, self.model.damping_ratio, [j.node for j in self.journals], self.spin
        )
        found = PredictedWhirl(self, direction, (), None)
        if found.braked:
            return found
        seats = [WhirlSeat(j.clearance, j.measured[sign], j.carrier) for j in self.journals]
        whirl = ContactWhirl(rotor, seats, self.ground)
        way, settled = whirl.settled(sign * HERTZ * SLOWEST, sign * HERTZ * FASTEST)
        refused = "" if settled is None else self._ellipse(settled)
        return replace(found, way=tuple(way), settled=None if refused else settled, refused=refused)

    def _ellipse(self, circle: WhirlCircle) -> str:
        """Why a whirl is not a circle; "": it is, or nearly."""
        ratios = [
            j.unlike(circle.omega, float(s)) for j, s in zip(self.journals, circle.stroke, strict=True)
        ]
        ratio, name = max(zip(ratios, (j.name for j in self.journals), strict=True))
        if ratio <= MOST_UNLIKE:
            return ""
        return (
            f"the mount of {name}, with its mass at {abs(circle.omega) / HERTZ:.4g} Hz, is {ratio:.3g} "
            "times as stiff one way as the other, and the whirl an ellipse; only circles are predicted, up "
            f"to {MOST_UNLIKE:g} times"
        )


@dataclass(frozen=True)
class PredictedWhirl:
    """The prediction of a whirl."""

    machine: Machine
    direction: float
    way: tuple[WhirlCircle, ...]  # through which it is driven
    settled: WhirlCircle | None
    refused: str = ""  # why it is not predicted

    @property
    def frequency(self) -> float:
        """Hz, of the circle that it settles in; nan: there is none."""
        return abs(self.settled.omega) / HERTZ if self.settled else math.nan

    @property
    def balls(self) -> tuple[float, ...]:
        """The most loaded ball (N) of each bearing."""
        if self.settled is None:
            return ()
        omega, sign = self.settled.omega, math.copysign(1.0, self.settled.omega)
        there = zip(self.machine.journals, self.settled.depth, strict=True)
        return tuple(j.measured[sign].loaded(float(depth), omega) for j, depth in there)

    @property
    def margin(self) -> float:
        """Its centrifugal acceleration over what lasts against gravity (`LASTING`); 0: there is none."""
        if self.settled is None:
            return 0.0
        clearance = min(j.clearance for j in self.machine.journals)
        gravity = abs(self.machine.model.gravity)
        return self.settled.omega**2 * clearance / (LASTING * gravity) if gravity > 0.0 else math.inf

    @property
    def impact(self) -> float:
        """About the largest force (N) on a bearing while gravity breaks a whirl up into bounces; nan: none.

        Journal and carrier meet at the speeds that both have on the circle, and that of a fall through the
        clearance: v^2 = (W (c + stroke))^2 + 4 g c, of the masses of rigid rotor and carrier.
        """
        if self.settled is None:
            return math.nan
        omega, model, found = self.settled.omega, self.machine.model, list[float]()
        for j, stroke in zip(self.machine.journals, self.settled.stroke, strict=True):
            gain = float(np.sum(model.basis.deflections([j.node])[0, :RIGID_MODES] ** 2)) + 1.0 / j.carried
            square = (omega * (j.clearance + stroke)) ** 2 + 4.0 * abs(model.gravity) * j.clearance
            found.append(j.measured[math.copysign(1.0, omega)].stopping(0.5 * square / gain, omega))
        return max(found)

    @property
    def answer(self) -> str:
        """Whether it lasts once it has begun, in words."""
        if self.margin >= SURE:
            return "and lasts once it has begun"
        if self.margin <= 1.0 / SURE:
            return "too slow to last against gravity, which breaks it up into bounces"
        return "and whether it lasts against gravity is not sure"

    @property
    def why_none(self) -> str:
        """Why there is none, in words."""
        if self.refused:
            return self.refused
        if not self.way:
            return "the bearings' forces brake it" if self.braked else "rotor and mounts allow no circle"
        if self.way[-1].drive >= 1.0:
            return "rotor and mounts brake more than the bearings drive"
        hertz = abs(self.way[-1].omega) / HERTZ
        if hertz < FASTEST * (1.0 - 1e-9):  # the path of circles is lost on the way
            return f"no circle was found beyond {hertz:.0f} Hz; the whirl is not known"
        return f"it would be driven beyond {hertz:.0f} Hz"

    @property
    def beyond(self) -> list[str]:
        """The limits of the model that its figures break, in words."""
        circle, broken = self.settled, list[str]()
        if circle is None:
            return broken
        if self.frequency > MEASURED_AT[-1]:
            broken.append(f"{self.frequency:.4g} Hz; bearings are measured up to {MEASURED_AT[-1]:g} Hz")
        if self.frequency < MEASURED_AT[0]:
            broken.append(f"{self.frequency:.4g} Hz; bearings are measured from {MEASURED_AT[0]:g} Hz on")
        for k, j in enumerate(self.machine.journals):
            depth, force, stroke = (float(one[k]) for one in (circle.depth, circle.force, circle.stroke))
            if depth > DEPTHS[-1]:
                broken.append(
                    f"{j.name} pressed in by {1e6 * depth:,.0f} um; measured up to {1e6 * DEPTHS[-1]:g} um"
                )
            if depth < DEPTHS[0]:
                broken.append(
                    f"{j.name} pressed in by {1e6 * depth:.3g} um; measured from {1e6 * DEPTHS[0]:g} um on"
                )
            if force > j.limits.static:
                broken.append(f"{j.name} loaded by {force:,.0f} N; its C0 is {j.limits.static:,.0f} N")
            if stroke > j.clearance:
                broken.append(
                    f"mount of {j.name} moved by {1e6 * stroke:,.0f} um; the clearance is "
                    f"{1e6 * j.clearance:,.0f} um"
                )
        return broken

    @property
    def braked(self) -> bool:
        """Whether no bearing drives it."""
        sign = self.direction * math.copysign(1.0, self.machine.spin)
        return all(np.all(np.imag(j.measured[sign].force) <= 0.0) for j in self.machine.journals)


def machine(scene: Scene, spin: float | None = None) -> Machine:
    """A scene's rotor in its touchdown bearings, measured; spin: rad/s, by default that of the scene.

    Raises TouchdownError where its rotor is not one of elements, or no bearing may be touched.
    """
    model = rotor_model(scene)
    turning = model.speed if spin is None else math.copysign(spin, model.speed)
    if turning == 0.0:
        raise TouchdownError(
            f"scene {scene.name}: its rotor does not spin, and drives no whirl; give --speed"
        )
    with opened(model.scene, in_process=True, listening=False) as idle:
        touchdown = [a for a in model.journals if SHUTDOWN not in idle.components[a.bearing].variables]
        numbers = {
            a.bearing: _numbers(idle.value, idle.components[a.bearing].variables, a) for a in touchdown
        }
        assumed = {
            a.bearing: {
                name: idle.value(f"{a.bearing}.{name}")
                for name in (name for several in ASSUMED.values() for name in several)
                if f"{a.bearing}.{name}" in idle
            }
            for a in touchdown
        }
    if not touchdown:
        raise TouchdownError(f"scene {scene.name} has no touchdown bearing to whirl in")
    kept: _Kept = {}
    journals = tuple(
        replace(_journal(model, a, turning, *numbers[a.bearing], kept), assumed=assumed[a.bearing])
        for a in touchdown
    )
    return with_mounts(Machine(model, turning, journals), scene)


def _numbers(value: Callable[[str], float], known: Iterable[str], a: Attachment) -> tuple[float, _Limits]:
    """Clearance (m) of a bearing, and its limits."""
    if CLEARANCE not in known:
        raise TouchdownError(
            f"{a.bearing} states no {CLEARANCE}: where contact begins is unknown; map "
            "one of its parameters to that name ([components.NAME.names])"
        )
    numbers = {
        n: value(f"{a.bearing}.{n}") for n in known if n.startswith(("balls.", "ring.")) and "[" not in n
    }
    try:
        bearing = rating.RatedBearing.of(numbers)
    except (KeyError, ValueError):  # it does not state its balls, or is not a ball bearing
        return value(f"{a.bearing}.{CLEARANCE}"), _Limits(math.nan, math.nan)
    races = (rating.point_contact(bearing, race) for race in (rating.INNER, rating.OUTER))
    limit = min(float(race.load(bearing.pressure_limit)) for race in races)
    stated = value(f"{a.bearing}.{RATING}") if RATING in known else 0.0
    return value(f"{a.bearing}.{CLEARANCE}"), _Limits(
        limit, rating.bearing_capacity(bearing, stated).static
    )


def _journal(
    model: RotorModel, a: Attachment, spin: float, clearance: float, limits: _Limits, kept: _Kept
) -> _Journal:
    spec = model.scene.components[a.bearing]
    same = (spec.fmu, spec.preset, tuple(sorted(spec.set.items(), key=str)), a.bearing_port)
    if same not in kept:
        kept[same] = {sign: _measured(model, a, spin, clearance, sign) for sign in (BACKWARD, FORWARD)}
    return _Journal(a.bearing, model.shaft.node(a.body_port), clearance, limits, {}, kept[same], rigid)


def _under(system: System, place: str) -> dict[str, Any]:
    """What a `_Journal` stands on at a place, COMPONENT.PORT; of a foundation see `_ground`."""
    foundation = foundation_of(system, place)
    name, _, port = place.partition(".")
    shared = _is_shared(system, name)
    head = f"{name}.mount_{port}" if shared else name
    carrier, unlike = rigid, _alike
    if foundation is not None and not shared:
        carrier = steady(foundation.mass, foundation.stiffness, foundation.damping)
    if f"{head}.{SLIDING}" in system:
        elements = from_values(Elements, lambda inner: system.value(f"{head}.{inner}"))
        unlike = partial(_anisotropy, elements, 0.0 if foundation is None else foundation.mass)
        if foundation is not None and not shared:
            carrier = circling(partial(circle_stiffness, elements), foundation.mass)
    carried = math.inf if foundation is None else foundation.mass
    return {"carrier": carrier, "carried": carried, "unlike": unlike}


def _is_shared(system: System, name: str) -> bool:
    """Whether a component is a foundation with modes, or may have them."""
    return f"{name}.modes" in system and f"{name}.seats" in system


def _ground(system: System, places: Sequence[str]) -> Ground | None:
    """Foundations under some of these places (COMPONENT.PORT, or "": none) of a system; None without."""
    names = dict.fromkeys(place.partition(".")[0] for place in places if place)
    shared = [_on_foundation(system, name, places) for name in names if _is_shared(system, name)]
    if not shared:
        return None

    def receptance_of(omega: float, force: np.ndarray) -> np.ndarray:
        found = np.zeros((len(places), len(places)), complex)
        for indices, ground in shared:
            found[np.ix_(indices, indices)] = ground(omega, force[indices])
        return found

    return receptance_of


def _on_foundation(system: System, name: str, places: Sequence[str]) -> tuple[list[int], Ground]:
    """Which of the places are on a foundation, and what it is there."""
    indices = [k for k, place in enumerate(places) if place.partition(".")[0] == name]
    ports = [places[k].partition(".")[2] for k in indices]
    numbers = range(1, 1 + int(system.value(f"{name}.modes")))

    def of_modes(what: str) -> np.ndarray:
        return np.array([system.value(f"{name}.mode[{i}].{what}") for i in numbers])

    shape = np.array([[of_modes(f"{port}.{axis}") for axis in POSITION] for port in ports])
    shape = np.moveaxis(shape, 2, 0) / np.sqrt(of_modes("mass"))[:, None, None]
    modes = ElasticModes(of_modes("omega"), of_modes("damping_ratio"), shape)
    elements = [
        from_values(Elements, lambda inner, p=port: system.value(f"{name}.mount_{p}.{inner}"))
        for port in ports
    ]
    mounts = [partial(circle_stiffness, one) for one in elements]
    return indices, on_modes(modes, mounts, [1.0 / system.value(f"{name}.{port}.inv_m") for port in ports])


_Kept = dict[tuple[object, ...], dict[float, Measured]]


def _measured(model: RotorModel, a: Attachment, spin: float, clearance: float, sign: float) -> Measured:
    """A bearing on the rig, its journal going round in the direction of `sign`."""
    # the deepest first: it makes the ring roll with the journal, as in a whirl that has lasted
    radii = [BEGIN * clearance, *(clearance + DEPTHS[::-1])]
    omega = HERTZ * np.array(MEASURED_AT)
    force = np.empty((len(omega), len(DEPTHS)), complex)
    ball = np.zeros(force.shape)
    for row, rate in enumerate(omega):
        with opened(model.scene, in_process=True, listening=False) as idle:
            component = idle.components[a.bearing]
            step = model.scene.run.macro_step * idle.every[a.bearing]
            rig = Rig(component, a.bearing_port, model.places[a.bearing], step, BALLS)
            rig.spin = spin
            found = rig.circled(radii, sign * rate, clearance)[::-1]
        force[row] = [complex(one.force.real, sign * one.force.imag) for one in found]
        if BALLS in component.variables:
            ball[row] = [one.watched for one in found]
    if np.any(np.real(force) >= 0.0):
        raise TouchdownError(
            f"{a.bearing} does not push back a journal that goes round in it, pressed in by "
            f"{1e6 * DEPTHS[0]:g} to {1e6 * DEPTHS[-1]:g} um; no whirl can be predicted"
        )
    return Measured(omega, DEPTHS, force, ball)


@dataclass(frozen=True)
class Sensitivity:
    """The effect of more of a quantity that is assumed of the bearings on a predicted whirl."""

    more: str  # of what, for people
    force: float  # largest of a bearing, over that with the bearings as they are
    ball: float  # likewise, of the most loaded ball; nan: they tell none
    frequency: float  # likewise

    def __str__(self) -> str:
        ball = f", {self.ball:.3g} times the ball load" if math.isfinite(self.ball) else ""
        return f"{self.force:.3g} times the force{ball}, {self.frequency:.3g} times the frequency"


def sensitivities(found: PredictedWhirl, scene: Scene) -> list[Sensitivity]:
    """How a whirl predicted for `scene` depends on `ASSUMED`: its bearings are measured anew for each.

    None where there is no whirl, with the bearings as they are or as they are made.
    """
    known, results = found.machine, list[Sensitivity]()
    if found.settled is None:
        return results
    for what, names in ASSUMED.items():
        more, settings = _with_more(known, what, names)
        if not settings:
            continue
        other = machine(scene.set(settings), abs(known.spin)).predicted(found.direction)
        if other.settled is None:
            continue
        force = float(other.settled.force.max() / found.settled.force.max())
        largest = max(found.balls)
        ball = max(other.balls) / largest if largest > 0.0 else math.nan
        results.append(Sensitivity(more, force, ball, other.frequency / found.frequency))
    return results


def _with_more(known: Machine, what: str, names: Sequence[str]) -> tuple[str, Mapping[str, object]]:
    """Settings with more of something, and what that is, for people; none where no bearing has it."""
    for name in names:
        more = {
            f"{j.name}.{name}": MORE * j.assumed[name]
            for j in known.journals
            if j.assumed.get(name, 0.0) > 0.0
        }
        if more:
            return f"twice the {what} ({name}, assumed)", more
    some = {
        f"{j.name}.{DAMPING}": SOME_DAMPING
        for j in known.journals
        if DAMPING in names and DAMPING in j.assumed
    }
    return f"some {what} ({DAMPING} = {SOME_DAMPING:g}; there is none)", some


# -- over settings of what the bearings stand on -----------------------------------------------------


def with_mounts(known: Machine, scene: Scene) -> Machine:
    """The same rotor and bearings on the mounts of `scene`, which differs from theirs in nothing else."""
    mounts = {place.partition(".")[0] for place in known.model.mounts.values()}
    alone = replace(
        scene,
        components={name: spec for name, spec in scene.components.items() if name in mounts},
        attach=(),
        sense=(),
        connect=(),
        bond=(),
        zero=None,
        energy_scale=(),
        gaps=(),
        requirements=(),
    )
    with opened(alone, in_process=True, listening=False) as system:
        system.initialise()
        carriers = {place: _under(system, place) for place in known.model.mounts.values()}
        ground = _ground(system, [known.model.mounts.get(j.name, "") for j in known.journals])
    journals = tuple(
        replace(j, **carriers[place]) if (place := known.model.mounts.get(j.name)) else j
        for j in known.journals
    )
    return replace(known, journals=journals, ground=ground)


def over(
    known: Machine,
    scene: Scene,
    points: Sequence[Mapping[str, object]],
    tick: Callable[[int], object] = lambda done: None,
    spin: float | None = None,
) -> list[PredictedWhirl]:
    """The backward whirl of a scene with each of these settings; the machine is that of the scene.

    Bearings are measured anew only where more than their mounts is set. tick: called with how many more
    are done. spin: rad/s, by default that of the scene with its settings.
    """
    mounts = {place.partition(".")[0] for place in known.model.mounts.values()}
    found: list[PredictedWhirl] = []
    for point in points:
        single = {one.strip(): value for name, value in point.items() for one in name.split(",")}
        there = scene.set(single)
        changed = {name.partition(".")[0] for one in single for name in scene.matching_settings(one)}
        variant = with_mounts(known, there) if changed <= mounts else machine(there, spin)
        found.append(variant.predicted())
        tick(1)
    return found


# -- for people ------------------------------------------------------------------------------------------

HEAD = "bearing", "force", "most loaded ball", "brinells at", "stroke of its mount", "friction required"
ASSUMPTIONS = (
    "a steady circle, by the receptances of rotor, mounts and bearings at its frequency, without "
    "unbalance; impacts on the way there press harder",
    "whether a drop gets into it depends on friction, phase and alignment: `touchdown verdict` shows it",
)


def lines(found: PredictedWhirl) -> Iterator[str]:
    """The prediction, for people."""
    model, way = found.machine.model, "backward" if found.direction == BACKWARD else "forward"
    if found.settled is None:
        yield f"{way} whirl: {'not predicted' if found.refused else 'none'}; {found.why_none}"
        return
    yield f"{way} whirl: {found.frequency:.4g} Hz, {found.answer}"
    if math.isfinite(found.margin):
        yield (
            f"  its centrifugal acceleration is {LASTING * found.margin:.3g} times gravity; "
            f"drops of rotor I fell back below {LASTING:g} (other rotors: not validated)"
        )
    else:
        yield "  no gravity acts across its shaft, to which it could fall back"
    if found.margin < SURE:
        most = f"{found.impact:,.0f} N"
        yield f"  its bounces press by up to about {most}; how long they go on is not predicted"
    rows: list[tuple[str, ...]] = [HEAD]
    for k, journal in enumerate(found.machine.journals):
        ball, limit = found.balls[k], journal.limits.ball
        rows.append(
            (
                journal.name,
                f"{found.settled.force[k]:,.0f} N",
                f"{ball:,.0f} N" if ball > 0.0 else "not told",
                f"{limit:,.0f} N" if math.isfinite(limit) else "not told",
                f"{1e6 * found.settled.stroke[k]:.3g} um" if journal.name in model.mounts else "no mount",
                f"{found.settled.friction[k]:.3g}",
            )
        )
    yield from aligned(rows, indent="  ")
    if found.beyond:
        yield "  beyond the limits of the model, so that its figures are not reliable:"
    yield from (f"    {limit}" for limit in found.beyond)


# -- as a table ------------------------------------------------------------------------------------------
