"""The closed loops: magnetic bearings with controllers, sampled, or with their own law, in continuous time.

Sampled: between ticks the plant is integrated exactly with the control currents held; what a controller
makes of a sample acts from the next tick on. All controllers must have the same time between samples.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from scipy.linalg import block_diag, expm

from ....bearings.magnetic.linear import SIGNAL, LinearActuator, LinearLaw
from ...common.errors import TouchdownError
from ...coupling.connections import COMMAND, SET_POINTS
from ...coupling.simulation import opened
from ...coupling.system import System
from ...scene.scene import Scene
from .measured import MeasuredLaw, measure
from .plant import FreeRotor, free_rotor

ACTUATOR = "amb_actuator"  # models, by their FMUs' names
CONTROLLER = "amb_controller"
LAW = "amb"
SENSOR = 1.0  # of sensing.at and sensed
LOWEST = 2.0 * math.pi  # rad/s, lowest line
HIGHEST = 2.0 * math.pi * 1e4  # rad/s, where nothing is sampled
LINES = 1500


class Loops(ABC):
    """Loops of one scene, an axis each."""

    names: tuple[str, ...]  # COMPONENT axis
    speed: float  # rad/s
    highest: float  # rad/s, the last line

    @abstractmethod
    def sensitivity(self, omega: float, speed: float) -> np.ndarray:
        """S at the sensors, all loops closed (axes, axes)."""

    @abstractmethod
    def poles(self, speed: float) -> np.ndarray:
        """Of all closed loops, 1/s."""

    @property
    def lines(self) -> np.ndarray:
        """Angular frequencies (rad/s) that show every peak of a machine."""
        return np.geomspace(LOWEST, self.highest, LINES)


@dataclass(frozen=True)
class Controlled:
    """A magnetic bearing, and its two axes among the channels of its controller."""

    name: str
    actuator: LinearActuator
    angle: float  # rad, of its first axis
    controller: str
    first: int  # channel of its first axis, from 0
    load: float  # N, that it carries at rest
    by_sensor: bool

    @property
    def directions(self) -> np.ndarray:
        """Of both axes (2, 2)."""
        c, s = math.cos(self.angle), math.sin(self.angle)
        return np.array([[c, s], [-s, c]])


class Sampled(Loops):
    """Actuators with controllers: of the project's own, whose law is known, or of others, measured."""

    def __init__(self, scene: Scene) -> None:
        with opened(scene, in_process=True, listening=False) as system:
            system.initialise()
            self.bearings = tuple(_controlled(scene, system))
            self.period = _period(scene, system, self.bearings)
            known = all(scene.components[b.controller].fmu == CONTROLLER for b in self.bearings)
            laws = _laws(system, self.bearings, self.period) if known else None
        self.laws: Laws = laws or measured_laws(scene, self.bearings, self.period)
        names = [b.name for b in self.bearings]
        self.rotor = free_rotor(scene, names, [b.by_sensor for b in self.bearings])
        self.names = tuple(f"{b.name}.axis[{k}]" for b in self.bearings for k in (1, 2))
        self.speed, self.highest = self.rotor.speed, 0.99 * math.pi / self.period
        self._discrete: dict[float, tuple[np.ndarray, np.ndarray]] = {}
        self._sees = self._signal_rows()

    def _signal_rows(self) -> np.ndarray:
        """Signals per state (axes, states)."""
        rows = np.zeros((len(self.names), self._places[-1].stop))
        for axis, own in enumerate(self._places):
            rows[axis, own.start + SIGNAL] = self.bearings[axis // 2].actuator.gain
        return rows

    @property
    def _places(self) -> list[slice]:
        """Of the axes' states, behind the rotor's."""
        first, found = 2 * self.rotor.places, list[slice]()
        for axis in range(len(self.names)):
            states = self.bearings[axis // 2].actuator.states
            found.append(slice(first, first + states))
            first += states
        return found

    def _plant(self, speed: float) -> tuple[np.ndarray, np.ndarray]:
        """Rates per state, and per control current."""
        rotor, places = self.rotor, self.rotor.places
        size = self._places[-1].stop
        a, b = np.zeros((size, size)), np.zeros((size, len(self.names)))
        a[: 2 * places, : 2 * places] = rotor.rates(speed)
        for axis, own in enumerate(self._places):
            held = self.bearings[axis // 2]
            direction, one = held.directions[axis % 2], held.actuator
            acts = rotor.along(rotor.acts[axis // 2], direction)
            sees = rotor.along(rotor.sees[axis // 2], direction)
            a[own, own] = one.rates
            a[own, :places] = np.outer(one.moved, acts)
            a[own.start + SIGNAL, :places] = one.sensor * sees
            a[places : 2 * places, own] = np.outer(acts, one.force)
            b[own, axis] = one.driven
        return a, b

    def _held(self, speed: float) -> tuple[np.ndarray, np.ndarray]:
        """The plant from tick to tick, control currents held."""
        if speed not in self._discrete:
            a, b = self._plant(speed)
            n, m = b.shape
            whole = np.zeros((n + m, n + m))
            whole[:n, :n], whole[:n, n:] = a, b
            ahead = expm(whole * self.period)
            self._discrete[speed] = ahead[:n, :n], ahead[:n, n:]
        return self._discrete[speed]

    def sensitivity(self, omega: float, speed: float) -> np.ndarray:
        a, b = self._held(speed)
        z = complex(math.cos(omega * self.period), math.sin(omega * self.period))
        plant = self._sees @ np.linalg.solve(z * np.eye(len(a)) - a, b)
        control = self.laws.response(z)
        return np.linalg.inv(np.eye(len(self.names)) + plant @ control / z)

    def poles(self, speed: float) -> np.ndarray:
        a, b = self._held(speed)
        law = self.laws.state_space
        n, m, k = len(a), len(self.names), len(law.A)
        delays = self.laws.delay
        size = n + k + m * delays
        closed = np.zeros((size, size), law.A.dtype)
        closed[:n, :n] = a
        closed[:n, n + k : n + k + m] = b  # the oldest set points act
        closed[n : n + k, :n], closed[n : n + k, n : n + k] = -law.B @ self._sees, law.A
        for d in range(delays - 1):
            rows = slice(n + k + m * d, n + k + m * (d + 1))
            closed[rows, n + k + m * (d + 1) : n + k + m * (d + 2)] = np.eye(m)
        closed[size - m :, :n], closed[size - m :, n : n + k] = -law.D @ self._sees, law.C
        found = np.linalg.eigvals(closed).astype(complex)
        return np.log(found[np.abs(found) > 1e-9]) / self.period


class Laws(Protocol):
    """The laws by which the controllers answer the axes' samples."""

    @property
    def delay(self) -> int:
        """Samples from one to the set points that act by it, but for what `whole` itself delays."""
        ...

    @property
    def state_space(self) -> StateSpace:
        """From the axes' measurements to their control currents."""
        ...

    def response(self, z: complex) -> np.ndarray:
        """C(z) of the axes (axes, axes), delays beyond the first included."""
        ...


@dataclass(frozen=True)
class StateSpace:
    """x+ = A x + B m, i = C x + D m."""

    A: np.ndarray
    B: np.ndarray  # (states, axes)
    C: np.ndarray  # (axes, states)
    D: np.ndarray


@dataclass(frozen=True)
class KnownLaws:
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

    def response(self, z: complex) -> np.ndarray:
        own = np.diag([one.response(z) for one in self.channels])
        return np.linalg.inv(self.mixed) @ own @ self.mixed / z ** (self.delay - 1)


@dataclass(frozen=True)
class MeasuredLaws:
    """Of controllers of which only the answers are known; their delays are within what was measured."""

    laws: tuple[MeasuredLaw, ...]  # by controller
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

    def response(self, z: complex) -> np.ndarray:
        own = np.asarray(block_diag(*(law.response(z) for law in self.laws)))
        return self.currents[:, None] * own[np.ix_(self.order, self.order)]


def measured_laws(scene: Scene, bearings: tuple[Controlled, ...], period: float) -> MeasuredLaws:
    """Of the controllers, in a system that has not run; for the axes in the bearings' order."""
    axes = [(b.controller, b.first + k) for b in bearings for k in range(2)]
    names = list(dict.fromkeys(name for name, _ in axes))
    controlled = sorted(axes, key=lambda axis: (names.index(axis[0]), axis[1]))  # as the laws have them
    with opened(scene, in_process=True, listening=False) as system:
        forces = [int(system.value(f"{b.name}.{COMMAND}")) for b in bearings for _ in range(2)]
        kinds = {axis: list(SET_POINTS)[force] for axis, force in zip(axes, forces, strict=True)}
        laws = tuple(
            measure(system.components[name], [kinds[one] for one in controlled if one[0] == name], period)
            for name in names
        )
    factors = np.array([b.actuator.current_factor for b in bearings for _ in range(2)])
    order = np.array([controlled.index(axis) for axis in axes])
    return MeasuredLaws(laws, order, np.where(forces, 1.0 / factors, 1.0))


def _controlled(scene: Scene, system: System) -> list[Controlled]:
    """The magnetic bearings that have a controller."""
    found: list[Controlled] = []
    used: dict[str, int] = {}
    for controller, name in scene.control:
        if scene.components[name].fmu != ACTUATOR:
            raise TouchdownError(
                f"{name} of scene {scene.name} is {scene.components[name].fmu}, whose linear equations are "
                f"not known; they are of {ACTUATOR}"
            )

        def value(variable: str, name: str = name) -> float:
            return system.value(f"{name}.{variable}")

        angle = value("magnet.angle")
        hold = value("axis[1].hold"), value("axis[2].hold")
        upwards = math.sin(angle) * hold[0] + math.cos(angle) * hold[1]
        found.append(
            Controlled(
                name,
                LinearActuator.of(value),
                angle,
                controller,
                used.get(controller, 0),
                abs(upwards * value("current_factor")),
                value("sensing.at") == SENSOR,
            )
        )
        used[controller] = found[-1].first + 2
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


def _laws(system: System, bearings: tuple[Controlled, ...], period: float) -> KnownLaws:
    """Of the controllers, for the axes in the bearings' order."""
    axes = [(b.controller, b.first + k) for b in bearings for k in range(2)]
    channels, mixed = list[LinearLaw](), np.eye(len(axes))
    delays = {1 + int(system.value(f"{b.controller}.delay")) for b in bearings}
    for b in bearings:
        own = system.value(f"{b.controller}.sample_time")
        if system.value(f"{b.controller}.clock") and not math.isclose(own, period, rel_tol=1e-9):
            raise TouchdownError(
                f"{b.controller} samples by its own clock every {own:g} s, and {b.name}.sample_time is "
                f"{period:g} s; its loop is not known. Set {b.controller}.clock = tick"
            )
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
    if len(delays) > 1:
        raise TouchdownError("controllers of different delay are not looked at together; set their delay")
    return KnownLaws(tuple(channels), mixed, delays.pop())


class Continuous(Loops):
    """Magnetic bearings with a law of their own: stiffness and damping, with or without a lag."""

    def __init__(self, scene: Scene) -> None:
        names = [name for name, spec in scene.components.items() if spec.fmu == LAW]
        with opened(scene, in_process=True, listening=False) as system:
            keys = ("stiffness", "damping", "bandwidth", "sensed")
            given = [[system.value(f"{name}.{key}") for key in keys] for name in names]
        self.laws = np.array(given)[:, :3]
        self.rotor: FreeRotor = free_rotor(scene, names, [one[3] == SENSOR for one in given])
        self.names = tuple(f"{name} {axis}" for name in names for axis in "xy")
        self.speed, self.highest = self.rotor.speed, HIGHEST
        n, across = self.rotor.along, np.eye(2)
        self._acts = np.array([n(shape, d) for shape in self.rotor.acts for d in across])
        self._sees = np.array([n(shape, d) for shape in self.rotor.sees for d in across])

    def sensitivity(self, omega: float, speed: float) -> np.ndarray:
        s, places = 1j * omega, self.rotor.places
        rates = self.rotor.rates(speed)[places:]
        dynamic = s * s * np.eye(places) - rates[:, :places] - s * rates[:, places:]
        plant = self._sees @ np.linalg.solve(dynamic, self._acts.T)
        k, c, w = np.repeat(self.laws, 2, axis=0).T
        lag = np.divide(s, w, out=np.zeros(len(w), complex), where=w > 0.0)
        return np.linalg.inv(np.eye(len(self.names)) + plant @ np.diag((k + s * c) / (1.0 + lag)))

    def poles(self, speed: float) -> np.ndarray:
        places, m = self.rotor.places, len(self.names)
        k, c, w = np.repeat(self.laws, 2, axis=0).T
        a = np.zeros((2 * places + m, 2 * places + m))
        a[: 2 * places, : 2 * places] = self.rotor.rates(speed)
        for axis in range(m):
            asked = -np.concatenate((k[axis] * self._sees[axis], c[axis] * self._sees[axis]))
            if w[axis] > 0.0:
                a[places : 2 * places, 2 * places + axis] = self._acts[axis]
                a[2 * places + axis, : 2 * places] = w[axis] * asked
                a[2 * places + axis, 2 * places + axis] = -w[axis]
            else:
                a[places : 2 * places, : 2 * places] += np.outer(self._acts[axis], asked)
        kept = [*range(2 * places), *(2 * places + axis for axis in range(m) if w[axis] > 0.0)]
        return np.linalg.eigvals(a[np.ix_(kept, kept)])


def loops_of(scene: Scene) -> Loops:
    """Of a scene with magnetic bearings. Raises TouchdownError where it has none whose loop is known."""
    if scene.control:
        for name in (name for pair in scene.control for name in pair):
            if name not in scene.components:
                raise TouchdownError(f"control: there is no component {name} in scene {scene.name}")
        return Sampled(scene)
    if any(spec.fmu == LAW for spec in scene.components.values()):
        return Continuous(scene)
    raise TouchdownError(
        f"scene {scene.name} has no magnetic bearing ({LAW}, {ACTUATOR}) whose loop is known"
    )
