"""The closed loops: magnetic bearings with controllers, sampled, or with their own law, in continuous time.

Sampled: between ticks the plant is integrated exactly with the control currents held; what a controller
makes of a sample acts from the next tick on. All controllers must have the same time between samples, that
of the bearings or, by their own clocks, a multiple of it. Then a period goes from a used sample to the
next, the old set points act for one tick of it, the new ones for the rest, and S is that at these samples.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from scipy.linalg import block_diag, eigvals, expm, matrix_balance
from scipy.optimize import linear_sum_assignment

from ...bearings.magnetic.law_file import UP_TO
from ...bearings.magnetic.linear import SIGNAL, LinearActuator, LinearLaw
from ...bearings.magnetic.state_space import MEMORY, SAME, law_of_axes
from ...master.common.errors import TouchdownError
from ...master.common.text import HZ
from ...master.components.component import Component
from ...master.components.in_process import InProcessComponent
from ...master.coupling.connections import COMMAND, SET_POINTS
from ...master.coupling.simulation import opened
from ...master.coupling.system import System
from ...master.scene.scene import Scene
from .measured_loop import MeasuredLaw, measure
from .plant import FreeRotor, free_rotor

ACTUATOR, AXIAL = "amb_actuator", "amb_axial"  # models, by their FMUs' names
CONTROLLER = "amb_controller"
LAW = "amb"
SENSOR = 1.0  # of sensing.at and sensed
LOWEST = 2.0 * math.pi  # rad/s, lowest line
HIGHEST = 2.0 * math.pi * 1e4  # rad/s, where nothing is sampled
LINES = 1500
WIDE = 0.03  # damping ratio of a root whose surroundings these lines show
ASIDE = 1.5  # by which lines beside a root are farther away, one after another
CLOSEST = 0.05  # distance of two lines over that to the nearest root, at least
NARROWEST = 1e-9  # distance of the nearest line to a root, over its frequency
BATCH = 128  # lines at once
TINY = 1e-9  # of a discrete eigenvalue
LASTING = 0.5  # of a mode's amplitude, left after a period: those above swing on between samples
ROUNDING = 1e-9  # of a pole's size, what its parts err by
SLOW = 1e3  # 1/s; a pole nearer to 0 errs by as much as one of this size


@dataclass(frozen=True)
class ClosedLoops:
    """All loops closed, at one speed: x+ = A x + B d, or x' = A x + B d.

    d: what is added where each loop is cut; there is C x + d behind the cut.
    """

    A: np.ndarray
    B: np.ndarray  # (states, axes)
    C: np.ndarray  # (axes, states)
    period: float  # s, from sample to sample; 0: continuous

    def balanced(self) -> ClosedLoops:
        """The same with other units of the states, in which rounding does not show at narrow peaks."""
        a, (scale, _) = matrix_balance(self.A, permute=False, separate=True)
        return ClosedLoops(a, self.B / scale[:, None], self.C * scale, self.period)

    def sensitivity(self, omega: np.ndarray) -> np.ndarray:
        """S = 1 + C (lambda - A)^-1 B at angular frequencies (n,), rad/s: (n, axes, axes)."""
        points = np.exp(1j * omega * self.period) if self.period else 1j * omega
        eye, ones = np.eye(len(self.A)), np.eye(len(self.C))
        parts = np.split(points, range(BATCH, len(points), BATCH))
        return np.concatenate(
            [ones + self.C @ np.linalg.solve(z[:, None, None] * eye - self.A, self.B) for z in parts]
        )

    def one(self, axis: int) -> Callable[[float], complex]:
        """S of a loop by angular frequency (rad/s)."""
        part = ClosedLoops(self.A, self.B[:, axis : axis + 1], self.C[axis : axis + 1], self.period)
        return lambda omega: complex(part.sensitivity(np.array([omega]))[0, 0, 0])

    @cached_property
    def poles(self) -> np.ndarray:
        """Poles (1/s)."""
        return self._rates(np.linalg.eigvals(self.A))

    @cached_property
    def roots(self) -> np.ndarray:
        """Poles, and of each loop, the others closed, poles and zeros of its gain L (1/s)."""
        found = [self.poles]
        for axis in range(len(self.C)):
            b, c = self.B[:, axis : axis + 1], self.C[axis : axis + 1]
            bordered = np.block([[self.A, b], [c, np.zeros((1, 1))]])
            mass = np.diag([*np.ones(len(self.A)), 0.0])
            zeros = np.asarray(eigvals(bordered, mass))
            found += [self._rates(np.linalg.eigvals(self.A - b @ c)), self._rates(zeros)]
        return np.concatenate(found)

    def _rates(self, values: np.ndarray) -> np.ndarray:
        """Eigenvalues as 1/s; those that only rounding keeps from 0 or infinity are left out."""
        found: np.ndarray = values[np.isfinite(values)].astype(complex)
        if not self.period:
            return found
        return np.log(found[np.abs(found) > TINY]) / self.period

    def lines(self, highest: float) -> np.ndarray:
        """Angular frequencies (rad/s), from `LOWEST`, that show every peak and dip of S and L.

        log |S| and log |L| are sums over their poles and zeros, and change within the distance to the
        nearest one. So lines stand around each root, nowhere farther apart than half of that distance. Nor
        are they much nearer, as around two equal roots, where rounding would make summits between them.
        """
        lines = [np.geomspace(LOWEST, highest, LINES)]
        for root in map(complex, self.roots):
            if LOWEST < root.imag < highest and abs(root.real) < WIDE * root.imag:
                nearest = max(0.25 * abs(root.real), NARROWEST * root.imag)
                away = nearest * ASIDE ** np.arange(math.log(WIDE * root.imag / nearest) / math.log(ASIDE))
                lines += [root.imag - away, root.imag + away]
        every = np.unique(np.concatenate(lines))
        every = every[(every >= LOWEST) & (every <= highest)]
        apart = CLOSEST * np.abs(1j * every[:, None] - self.roots).min(axis=1)
        kept = [0]
        for k in range(1, len(every)):
            if every[k] - every[kept[-1]] >= apart[k]:
                kept.append(k)
        return every[kept]


def growing(poles: np.ndarray) -> complex | None:
    """The pole (1/s) that grows fastest; None where none does by more than rounding."""
    worst = max(map(complex, poles), key=lambda pole: pole.real)
    return worst if worst.real > ROUNDING * max(abs(worst), SLOW) else None


class Loops(ABC):
    """Loops of one scene, an axis each."""

    bearing_names: tuple[str, ...]  # of the components
    names: tuple[str, ...]  # COMPONENT axis
    rotor: FreeRotor
    speed: float  # rad/s
    highest: float  # rad/s, the last line
    too_weak: Sequence[str] = ()  # bearings that cannot hold the rotor, a line each

    @abstractmethod
    def closed(self, speed: float) -> ClosedLoops:
        """At a speed (rad/s)."""

    def shown(self, speed: float, closed: ClosedLoops) -> np.ndarray:
        """Poles (1/s) of the loops closed at a speed (rad/s) that have the frequency of what swings."""
        return closed.poles

    @abstractmethod
    def swing(self, speed: float, omega: float, force: np.ndarray) -> np.ndarray:
        """Complex amplitudes of the closed loops' states at a speed (rad/s), settled.

        force: on the rotor's coordinates (places,), or several (places, n), by exp(j omega t), omega in
        rad/s.
        """


@dataclass(frozen=True)
class Controlled:
    """A magnetic bearing, and its two axes among the channels of its controller."""

    name: str
    axes: tuple[LinearActuator, LinearActuator]
    current_factor: float  # N/A, by which its actuator takes forces
    angle: float  # rad, of its first axis
    controller: str
    first: int  # channel of its first axis, from 0
    by_sensor: bool

    @property
    def load(self) -> float:
        """What it carries at rest, N."""
        return math.hypot(*(axis.load for axis in self.axes))

    @property
    def directions(self) -> np.ndarray:
        """Of both axes (2, 2)."""
        c, s = math.cos(self.angle), math.sin(self.angle)
        return np.array([[c, s], [-s, c]])


class Held(NamedTuple):
    """A plant over a period, or its rates."""

    A: np.ndarray  # per state
    B: np.ndarray  # per control current that acts at its begin
    soon: np.ndarray | None = None  # per control current that acts from the first tick in it on; None: none


class Unbalance(NamedTuple):
    """Amplitudes under a rotor's unbalance, by axis."""

    control: np.ndarray  # (axes,), A
    fluxes: list[np.ndarray]  # of the coils that carry a current, V s

    def of(self, axis: int) -> tuple[float, list[float]]:
        """Of an axis, from 0."""
        return float(self.control[axis]), list(map(float, self.fluxes[axis]))


class Sampled(Loops):
    """Actuators with controllers: of the project's own, whose law is known, or of others, measured."""

    def __init__(self, scene: Scene) -> None:
        with opened(scene, in_process=True, listening=False) as system:
            system.initialise()
            self.bearings = tuple(controlled_bearings(scene, system))
            weak = [(b.name, one) for b in self.bearings for one in b.axes if not one.holds]
            self.too_weak = list(dict.fromkeys(f"{name}: {next(one.shortfalls())}" for name, one in weak))
            self.tick = _period(scene, system, self.bearings)
            self.period = _law_period(system, self.bearings, self.tick)
            laws = known_laws(scene, system, self.bearings)
        self.laws: _Laws = laws or measured_laws(scene, self.bearings, self.period)
        self.law = self.laws.state_space
        names = [b.name for b in self.bearings]
        self.bearing_names = tuple(names)
        self.rotor = free_rotor(scene, names, [b.by_sensor for b in self.bearings])
        self.names = tuple(f"{b.name}.axis[{k}]" for b in self.bearings for k in (1, 2))
        self.left_out = [name for _, name in scene.control if name not in names]
        self.speed, self.highest = self.rotor.speed, 0.99 * math.pi / self.period
        self._actuators = [one for bearing in self.bearings for one in bearing.axes]
        ends = 2 * self.rotor.places + np.cumsum([0, *(one.states for one in self._actuators)])
        self._places = [slice(*ends[k : k + 2]) for k in range(len(self.names))]  # of the axes' states
        self._ahead: tuple[float, Held] | None = None  # last speed, and `_held` there
        self._sees = np.zeros((len(self.names), ends[-1]))  # signals per state
        for axis, place in enumerate(self._places):
            self._sees[axis, place.start + SIGNAL] = self._actuators[axis].sensing.gain

    @cached_property
    def journal_axes(self) -> np.ndarray:
        """Displacement of the journals along the axes per coordinate of the rotor (axes, places)."""
        rotor = self.rotor
        pairs = [(b, d) for b, bearing in enumerate(self.bearings) for d in bearing.directions]
        return np.array([rotor.along(rotor.acts[b], direction) for b, direction in pairs])

    def plant(self, speed: float, sampled: bool) -> tuple[Held, np.ndarray]:
        """At a speed (rad/s), from control currents (A) to signals (m), all loops open; C."""
        return self._held(speed) if sampled else Held(*self._plant(speed)), self._sees

    def _plant(self, speed: float) -> tuple[np.ndarray, np.ndarray]:
        """Rates per state, and per control current."""
        rotor, places = self.rotor, self.rotor.places
        size = self._places[-1].stop
        a, b = np.zeros((size, size)), np.zeros((size, len(self.names)))
        a[: 2 * places, : 2 * places] = rotor.rates(speed)
        for axis, place in enumerate(self._places):
            direction, one = self.bearings[axis // 2].directions[axis % 2], self._actuators[axis]
            acts = self.journal_axes[axis]
            sees = rotor.along(rotor.sees[axis // 2], direction)
            a[place, place] = one.rates
            a[place, :places] = np.outer(one.moved, acts)
            a[place.start + SIGNAL, :places] = one.sensing.bandwidth * sees
            a[places : 2 * places, place] = np.outer(acts, one.force)
            b[place, axis] = one.driven
        return a, b

    def _held(self, speed: float) -> Held:
        """The plant from a sample that is used to the next, control currents held."""
        if self._ahead is None or self._ahead[0] != speed:
            a, b = self._plant(speed)
            n, m = b.shape
            whole = np.zeros((n + m, n + m))
            whole[:n, :n], whole[:n, n:] = a, b
            ahead = expm(whole * self.tick)[:n]
            held = Held(ahead[:, :n], ahead[:, n:])
            if self.period > self.tick:
                more = expm(whole * (self.period - self.tick))[:n]
                held = Held(more[:, :n] @ held.A, more[:, :n] @ held.B, more[:, n:])
            self._ahead = speed, held
        return self._ahead[1]

    def closed(self, speed: float) -> ClosedLoops:
        a, b, soon = self._held(speed)
        law = self.laws.at(speed)
        n, m, k = len(a), len(self.names), len(law.A)
        delays = self.laws.delay
        size = n + k + m * delays
        closed = np.zeros((size, size), law.A.dtype)
        into, seen = np.zeros((size, m), law.A.dtype), np.zeros((m, size))
        closed[:n, :n] = a
        closed[:n, n + k : n + k + m] = b  # the oldest set points act
        closed[n : n + k, n : n + k], closed[size - m :, n : n + k] = law.A, law.C
        for d in range(delays - 1):
            rows = slice(n + k + m * d, n + k + m * (d + 1))
            closed[rows, n + k + m * (d + 1) : n + k + m * (d + 2)] = np.eye(m)
        into[n : n + k], into[size - m :], seen[:, :n] = -law.B, -law.D, self._sees
        if soon is not None and delays == 1:  # the answer to this very sample
            closed[:n, n : n + k], into[:n] = soon @ law.C, -soon @ law.D
        elif soon is not None:
            closed[:n, n + k + m : n + k + 2 * m] = soon
        return ClosedLoops(closed + into @ seen, into, seen, self.period)

    def shown(self, speed: float, closed: ClosedLoops) -> np.ndarray:
        """As of all `Loops`: samples show modes above half their frequency as slow ones, left out here.

        The loops hardly move such a mode: its pole is the one nearest to the plant's. One that grows stays.
        """
        free = np.linalg.eigvals(self._plant(speed)[0])
        fast = np.exp(self.period * free[np.abs(free.imag) > math.pi / self.period])
        fast = fast[np.abs(fast) > LASTING]
        apart = np.abs(fast[:, None] - np.exp(self.period * closed.poles))
        nearest = linear_sum_assignment(apart)[1]
        return np.delete(closed.poles, [k for k in nearest if growing(closed.poles[k : k + 1]) is None])

    def swing(self, speed: float, omega: float, force: np.ndarray) -> np.ndarray:
        """As of all `Loops`, at the ticks."""
        closed, (a, _) = self.closed(speed), self._plant(speed)
        held = self._held(speed).A
        n, places, z = len(a), self.rotor.places, np.exp(1j * omega * self.period)
        driven = np.zeros((n, *force.shape[1:]), complex)
        driven[places : 2 * places] = force
        steady = np.zeros((len(closed.A), *force.shape[1:]), complex)  # tick to tick, as the plant alone
        steady[:n] = (z * np.eye(n) - held) @ np.linalg.solve(1j * omega * np.eye(n) - a, driven)
        return np.linalg.solve(z * np.eye(len(closed.A)) - closed.A, steady)

    def control(self, state: np.ndarray) -> np.ndarray:
        """Amplitudes of the control currents (axes,) that act, of a state of the closed loops, A."""
        first = self._places[-1].stop + len(self.law.A)
        return state[first : first + len(self.names)]

    def electrical(self, state: np.ndarray) -> list[tuple[np.ndarray, np.ndarray]]:
        """Of each axis, amplitudes of its coils' currents (A) and voltages (V) right after a tick."""
        found = list[tuple[np.ndarray, np.ndarray]]()
        for axis, (one, control) in enumerate(zip(self._actuators, self.control(state), strict=True)):
            u = self.journal_axes[axis] @ state[: self.rotor.places]
            found.append(one.electrical(state[self._places[axis]], u, control))
        return found

    def unbalance(self, speed: float) -> Unbalance:
        """How far it swings currents and flux linkages at a speed (rad/s)."""
        state = self.swing(speed, speed, self.rotor.turning(speed))
        fluxes = [
            np.abs(state[place][SIGNAL + 1 :][: len(one.coils)])
            for place, one in zip(self._places, self._actuators, strict=True)
        ]
        return Unbalance(np.abs(self.control(state)), fluxes)


class _Laws(ABC):
    """The laws by which the controllers answer the axes' samples."""

    delay: int  # samples from one to the set points that act by it, but for what a law itself delays
    remarks: Sequence[str] = ()  # what is to be said of them, a line each

    @property
    @abstractmethod
    def state_space(self) -> StateSpace:
        """From the axes' measurements to their control currents, at the scene's speed."""

    def at(self, speed: float) -> StateSpace:
        """The same at a speed (rad/s); most laws are the same at all."""
        return self.state_space


@dataclass(frozen=True)
class StateSpace:
    """x+ = A x + B m, i = C x + D m."""

    A: np.ndarray
    B: np.ndarray  # (states, axes)
    C: np.ndarray  # (axes, states)
    D: np.ndarray

    @property
    def matrices(self) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """A, B, C, D."""
        return self.A, self.B, self.C, self.D

    def answer(self, z: np.ndarray) -> np.ndarray:
        """C (z - A)^-1 B + D at points (n,): (n, axes, axes)."""
        eye = np.eye(len(self.A))
        return np.array([self.C @ np.linalg.solve(one * eye - self.A, self.B) + self.D for one in z])


@dataclass(frozen=True)
class KnownLaws(_Laws):
    """All channels, and how axes are mixed into them."""

    channels: tuple[LinearLaw, ...]  # in the order of the axes
    mixed: np.ndarray  # channels per axes (axes, axes)
    delay: int  # samples

    @property
    def state_space(self) -> StateSpace:
        back = np.linalg.inv(self.mixed)
        a = np.asarray(block_diag(*(one.A for one in self.channels)))
        b = np.asarray(block_diag(*(one.B[:, None] for one in self.channels))) @ self.mixed
        c = back @ np.asarray(block_diag(*(one.C[None, :] for one in self.channels)))
        return StateSpace(a, b, c, back @ np.diag([one.D for one in self.channels]) @ self.mixed)


@dataclass(frozen=True)
class MeasuredLaws(_Laws):
    """Of controllers of which only the answers are known; their delays are within what was measured."""

    laws: Sequence[MeasuredLaw | StateSpace]  # by controller
    order: np.ndarray  # of the axes, among all that the controllers have
    currents: np.ndarray  # A, of each axis, for one of what its controller gives: 1, or 1/k_i for a force
    delay: int = 1  # samples; an answer acts from the next tick on

    @property
    def state_space(self) -> StateSpace:
        a, b, c, d = (np.asarray(block_diag(*(getattr(law, part) for law in self.laws))) for part in "ABCD")
        of_force = self.currents[:, None]
        return StateSpace(
            a, b[:, self.order], of_force * c[self.order], of_force * d[np.ix_(self.order, self.order)]
        )


@dataclass(frozen=True)
class _FileLaws(_Laws):
    """Of controllers by files."""

    controllers: tuple[tuple[Any, list[int]], ...]  # the model's constants, and its axes, each
    order: np.ndarray  # as of `MeasuredLaws`
    currents: np.ndarray  # as of `MeasuredLaws`
    delay: int  # samples
    speed: float  # rad/s, the scene's
    remarks: tuple[str, ...]

    @property
    def state_space(self) -> StateSpace:
        return self.at(self.speed)

    def at(self, speed: float) -> StateSpace:
        """At a speed (rad/s)."""
        laws = [StateSpace(*law_of_axes(d, speed, axes)) for d, axes in self.controllers]
        return MeasuredLaws(laws, self.order, self.currents).state_space


def _in_order(bearings: Sequence[Controlled]) -> tuple[dict[str, list[int]], np.ndarray]:
    """Axes by controller, and where among all of them each axis of the bearings is."""
    axes = [(b.controller, b.first + k) for b in bearings for k in range(2)]
    by_name = {name: sorted(k for one, k in axes if one == name) for name, _ in axes}
    controlled = [(name, k) for name, found in by_name.items() for k in found]
    return by_name, np.array([controlled.index(axis) for axis in axes])


def measured_laws(scene: Scene, bearings: tuple[Controlled, ...], period: float) -> MeasuredLaws:
    """Of the controllers, in a system that has not run; for the axes in the bearings' order."""
    axes = [(b.controller, b.first + k) for b in bearings for k in range(2)]
    by_name, order = _in_order(bearings)
    with opened(scene, in_process=True, listening=False) as system:
        forces = [int(system.value(f"{b.name}.{COMMAND}")) for b in bearings for _ in range(2)]
        kinds = {axis: list(SET_POINTS)[force] for axis, force in zip(axes, forces, strict=True)}
        laws = tuple(
            measure(system.components[name], [kinds[name, k] for k in found], period)
            for name, found in by_name.items()
        )
    factors = np.array([b.current_factor for b in bearings for _ in range(2)])
    return MeasuredLaws(laws, order, np.where(forces, 1.0 / factors, 1.0))


def controlled_bearings(scene: Scene, system: System) -> list[Controlled]:
    """The magnetic bearings that have a controller."""
    found: list[Controlled] = []
    used: dict[str, int] = {}
    for controller, name in scene.control:
        if scene.components[name].fmu == AXIAL:
            used[controller] = used.get(controller, 0) + 1
            continue
        if scene.components[name].fmu != ACTUATOR:
            raise TouchdownError(
                f"{name} of scene {scene.name} is {scene.components[name].fmu}, whose linear equations are "
                f"not known; they are of {ACTUATOR}"
            )

        def value(variable: str, name: str = name) -> float:
            return system.value(f"{name}.{variable}")

        found.append(
            Controlled(
                name,
                (LinearActuator.of(value, 1), LinearActuator.of(value, 2)),
                value("current_factor"),
                value("magnet.angle"),
                controller,
                used.get(controller, 0),
                value("sensing.at") == SENSOR,
            )
        )
        used[controller] = found[-1].first + 2
    if not found:
        raise TouchdownError(
            f"scene {scene.name} controls no bearing across its shaft; {AXIAL} is not looked at"
        )
    return found


def _period(scene: Scene, system: System, bearings: tuple[Controlled, ...]) -> float:
    """From sample to sample (s), of all."""
    periods = {system.value(f"{b.name}.sample_time") for b in bearings}
    if len(periods) > 1 or 0.0 in periods:
        raise TouchdownError(
            f"scene {scene.name}: its magnetic bearings must sample after the same time; sample_time is "
            f"{', '.join(f'{period:g} s' for period in sorted(periods))}"
        )
    return periods.pop()


def _law_period(system: System, bearings: tuple[Controlled, ...], tick: float) -> float:
    """From sample to sample (s) of all controllers, of bearings that sample every `tick` (s)."""
    periods = dict[str, float]()
    for name in dict.fromkeys(b.controller for b in bearings):
        periods[name], d = tick, constants(system.components[name])
        if d is not None:
            periods[name] = float(d["sample_time"])
        elif f"{name}.clock" in system and system.value(f"{name}.clock"):
            periods[name] = system.value(f"{name}.sample_time")
    several = round(next(iter(periods.values())) / tick)
    if not all(math.isclose(period, several * tick, rel_tol=SAME) for period in periods.values()):
        every = ", ".join(f"{name} every {period:g} s" for name, period in periods.items())
        raise TouchdownError(
            f"controllers sample by clocks of their own ({every}), magnetic bearings every {tick:g} s; "
            "such a loop is not known. Give all controllers the bearings' sample time or one multiple of it"
        )
    return several * tick


def _laws(system: System, bearings: tuple[Controlled, ...], period: float) -> KnownLaws:
    """Of the controllers, for the axes in the bearings' order."""
    axes = [(b.controller, b.first + k) for b in bearings for k in range(2)]
    channels, mixed = list[LinearLaw](), np.eye(len(axes))
    for row, (controller, axis) in enumerate(axes):

        def value(variable: str, controller: str = controller) -> float:
            return system.value(f"{controller}.{variable}")

        channels.append(LinearLaw.of(value, axis + 1, period))
        partner = (controller, (axis + 2) % 4)
        if value("structure") and partner not in axes:
            raise TouchdownError(
                f"{controller}.structure takes its axes for translation and tilt, and it controls one "
                "bearing; its loop is not known"
            )
        if value("structure"):
            mixed[row, row] = 0.5 if axis < 2 else -0.5
            mixed[row, axes.index(partner)] = 0.5
    return KnownLaws(tuple(channels), mixed, _delay(system, bearings))


def _delay(system: System, bearings: Sequence[Controlled]) -> int:
    """Of all controllers, samples."""
    delays = {1 + int(system.value(f"{b.controller}.delay")) for b in bearings}
    if len(delays) > 1:
        raise TouchdownError("controllers of different delay are not looked at together; set their delay")
    return delays.pop()


def constants(component: Component) -> Any:
    """Of a controller by a file, the model's; None of another."""
    if isinstance(component, InProcessComponent) and component.instance.model.memory is MEMORY:
        return component.instance.memory["d"][0].copy()
    return None


def known_laws(scene: Scene, system: System, bearings: tuple[Controlled, ...]) -> _Laws | None:
    """Of the controllers, in a system that is initialised; None where they are to be measured."""
    names = {b.controller for b in bearings}
    if all(scene.components[name].fmu == CONTROLLER for name in names):
        return _laws(system, bearings, _law_period(system, bearings, _period(scene, system, bearings)))
    by_name, order = _in_order(bearings)
    found: dict[str, Any] = {}  # constants of the models
    for name in by_name:
        d = constants(system.components[name])
        if d is not None:
            found[name] = d
    if len(found) < len(by_name):
        for name, d in found.items():
            if d["speeds"] > 1:
                raise TouchdownError(f"{name} has a law at several speeds; give all controllers by files")
        return None
    currents = [1.0 / b.current_factor if found[b.controller]["force"] else 1.0 for b in bearings]
    speed = system.value(f"{bearings[0].controller}.speed")
    laws = tuple((found[name], axes) for name, axes in by_name.items())
    remarks = tuple(line for name, d in found.items() for line in _remarks(name, d))
    return _FileLaws(laws, order, np.repeat(currents, 2), _delay(system, bearings), speed, remarks)


def _remarks(name: str, d: Any) -> Iterator[str]:
    """What is to be said of the law of a controller by a file; d: the model's constants."""
    law = d["law"]
    if law["unstable"]:
        yield f"{name}: its law is unstable by itself"
    if law["deviation"]:
        yield (
            f"{name}: C(z) is up to {100.0 * law['deviation']:.3g} % off C(s), at {HZ * law['at']:.4g} Hz, "
            f"of frequencies up to {UP_TO / d['sample_time']:.4g} Hz"
        )


class _Continuous(Loops):
    """Magnetic bearings with a law of their own: stiffness and damping, with or without a lag."""

    def __init__(self, scene: Scene) -> None:
        names = [name for name, spec in scene.components.items() if spec.fmu == LAW]
        with opened(scene, in_process=True, listening=False) as system:
            keys = ("stiffness", "damping", "bandwidth", "sensed")
            settings = [[system.value(f"{name}.{key}") for key in keys] for name in names]
        self.laws, self.bearing_names = np.array(settings)[:, :3], tuple(names)
        self.rotor: FreeRotor = free_rotor(scene, names, [one[3] == SENSOR for one in settings])
        self.names = tuple(f"{name} {axis}" for name in names for axis in "xy")
        self.speed, self.highest = self.rotor.speed, HIGHEST
        n, across = self.rotor.along, np.eye(2)
        self._acts = np.array([n(shape, d) for shape in self.rotor.acts for d in across])
        self._sees = np.array([n(shape, d) for shape in self.rotor.sees for d in across])

    def closed(self, speed: float) -> ClosedLoops:
        """Cut where a law asks for its force, which shows the same as at its sensor."""
        places, m = self.rotor.places, len(self.names)
        k, c, w = np.repeat(self.laws, 2, axis=0).T
        lags = np.flatnonzero(w > 0.0)
        size = 2 * places + len(lags)
        a, into, asked = np.zeros((size, size)), np.zeros((size, m)), np.zeros((m, size))
        a[: 2 * places, : 2 * places] = self.rotor.rates(speed)
        asked[:, :places], asked[:, places : 2 * places] = (
            -k[:, None] * self._sees,
            -c[:, None] * self._sees,
        )
        into[places : 2 * places] = self._acts.T
        for row, axis in enumerate(lags, 2 * places):
            a[places : 2 * places, row], into[places : 2 * places, axis] = self._acts[axis], 0.0
            a[row, row], into[row, axis] = -w[axis], w[axis]
        return ClosedLoops(a + into @ asked, into, asked, 0.0)

    def swing(self, speed: float, omega: float, force: np.ndarray) -> np.ndarray:
        a = self.closed(speed).A
        driven = np.zeros((len(a), *force.shape[1:]), complex)
        driven[self.rotor.places : 2 * self.rotor.places] = force
        return np.linalg.solve(1j * omega * np.eye(len(a)) - a, driven)


def shortfalls(bearings: Sequence[Controlled], swings: Unbalance | None) -> Iterator[str]:
    """What the limits of bearings do not allow, with their names; swings: by the unbalance."""
    found: dict[str, list[str]] = {}  # axes by what is said of them
    for k, one in enumerate(one for bearing in bearings for one in bearing.axes):
        for line in one.shortfalls(*(swings.of(k) if swings else (0.0, []))):
            found.setdefault(line, []).append(f"{bearings[k // 2].name}.axis[{k % 2 + 1}]")
    yield from (f"{', '.join(names)}: {line}" for line, names in found.items())


def loops_of(scene: Scene) -> Loops:
    """Of a scene with magnetic bearings. Raises TouchdownError where it has none whose loop is known."""
    if scene.control:
        for name in (name for pair in scene.control for name in pair):
            if name not in scene.components:
                raise TouchdownError(f"control: there is no component {name} in scene {scene.name}")
        return Sampled(scene)
    if any(spec.fmu == LAW for spec in scene.components.values()):
        return _Continuous(scene)
    raise TouchdownError(
        f"scene {scene.name} has no magnetic bearing ({LAW}, {ACTUATOR}) whose loop is known"
    )
