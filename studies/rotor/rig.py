"""A bearing alone on a rig that moves its journal as asked and reads its force.

The rig finds stiffness and damping, the nearest linear law, and the force on a journal that goes round
pressed. The bearing is stepped as in a run, through the variables of the contract, so that a foreign
bearing is measured as one of the project's own. Its housing stands still.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ...master.common.errors import TouchdownError
from ...master.components.component import FORCE, MOUNTED, POSITION, Component
from ...rotor.modal.supported import dynamic_stiffness

GROWN = "gaps.clearance"  # m, a bearing's own at present
SHAKE_AMPLITUDE = 1e-6  # m
MIN_LAG = 1e-7  # s; a shorter lag is taken as 0
LAGLESS_MISFIT = 1e-3  # misfit of a law without a lag that needs none
ROUNDING = 1e-6  # of the stiffness, what measuring may add


@dataclass(frozen=True)
class Response:
    """Dynamic stiffness of a bearing by frequency."""

    frequencies: np.ndarray  # (F,), Hz
    stiffness: np.ndarray  # (F, 2, 2), complex, N/m; rows: the force's directions, columns: the motion's

    @property
    def real(self) -> np.ndarray:
        """Stiffness in each direction by frequency (F, 2), N/m."""
        return np.real(np.diagonal(self.stiffness, axis1=1, axis2=2))

    @property
    def damping(self) -> np.ndarray:
        """Damping in each direction by frequency (F, 2), N s/m."""
        return np.imag(np.diagonal(self.stiffness, axis1=1, axis2=2)) / (
            2.0 * math.pi * self.frequencies[:, None]
        )


@dataclass(frozen=True)
class _Law:
    """(1 + lag s) force = -(stiffness + damping s) motion, fitted to a response."""

    stiffness: np.ndarray  # (2, 2), N/m
    damping: np.ndarray  # (2, 2), N s/m
    lag: float  # s
    misfit: float  # the largest deviation, over the largest dynamic stiffness


@dataclass(frozen=True)
class Answer:
    """The part of a bearing's force that follows one motion."""

    sensed: bool  # the motion that its sensors see; else the journal's
    response: Response
    law: _Law


def answers(rig: Rig, sensors: bool) -> tuple[Answer, ...]:
    """A bearing's answers to swings about its place: of its journal, of its sensors; none without a force.

    sensors: whether it has any beside the journal. By its sensors is what it answers beyond its answer to
    the journal alone.
    """
    whole = _response(rig, True)
    if whole is None:
        return ()
    if not sensors:
        return (_answer(False, whole),)
    alone = _response(rig, False)
    if alone is None:
        return (_answer(True, whole),)
    rest = Response(whole.frequencies, whole.stiffness - alone.stiffness)
    size, by_journal, by_sensor = (np.max(np.abs(r.stiffness), axis=(1, 2)) for r in (whole, alone, rest))
    if np.all(by_journal <= ROUNDING * size):
        return (_answer(True, whole),)
    if np.all(by_sensor <= (rig.sagitta() + ROUNDING) * size):
        return (_answer(False, whole),)
    return _answer(False, alone), _answer(True, rest)


def _answer(sensed: bool, found: Response) -> Answer:
    return Answer(sensed, found, fitted(found))


def _response(rig: Rig, sensed: bool) -> Response | None:
    """The response of a bearing to swings that its sensors see or do not; None where it gives no force."""
    frequencies = rig.frequencies
    columns = np.empty((len(frequencies), 2, 2), complex)  # frequency, motion, force
    for k in reversed(range(len(frequencies))):  # a short swing says whether there is a force
        columns[k] = [
            rig.dynamic_stiffness(frequencies[k], axis, SHAKE_AMPLITUDE, sensed=sensed)
            for axis in np.eye(2)
        ]
        if SHAKE_AMPLITUDE * np.max(np.abs(columns[k])) <= NO_FORCE:
            return None
    return Response(frequencies, columns.transpose(0, 2, 1))


def fitted(found: Response) -> _Law:
    """The law nearest to a response, every frequency weighing as much; with a lag only if one is there."""
    plain = _least_squares(found, False)
    if plain.misfit <= LAGLESS_MISFIT:
        return plain
    law = _least_squares(found, True)
    return law if law.lag > MIN_LAG else plain


def _least_squares(found: Response, lags: bool) -> _Law:
    """D (1 + i w lag) = K + i w C is linear in K, C and lag."""
    rate = 2.0 * math.pi * found.frequencies
    weight = 1.0 / np.max(np.abs(found.stiffness), axis=(1, 2))
    rows, right = [], []
    for D, w, by in zip(found.stiffness.reshape(-1, 4), rate, weight, strict=True):
        for entry in range(4):
            row = np.zeros(9, complex)
            row[entry], row[4 + entry] = by, 1j * w * by
            row[8] = -1j * w * D[entry] * by if lags else 0.0
            rows.append(row)
            right.append(D[entry] * by)
    system, sides = np.array(rows), np.array(right)
    scale = np.linalg.norm(system, axis=0)
    scale[scale == 0.0] = 1.0
    found_by = np.linalg.lstsq(_split(system) / scale, _split(sides))[0]
    values = found_by / scale
    K, C, lag = values[:4].reshape(2, 2), values[4:8].reshape(2, 2), float(values[8])
    model = dynamic_stiffness(K, C, lag, rate[:, None, None])
    most = np.max(np.abs(found.stiffness))
    misfit = np.max(np.abs(model - found.stiffness)) / most
    return _Law(_cleared(K, most), _cleared(C, most / np.max(rate)), lag, float(misfit))


def _split(values: np.ndarray) -> np.ndarray:
    """Real parts, and below them imaginary ones."""
    return np.concatenate((np.real(values), np.imag(values)))


def _cleared(matrix: np.ndarray, measured: float) -> np.ndarray:
    """Without what measuring adds: directions that are alike are made equal, rounding errors become 0.

    measured: the largest that was, in the unit of `matrix`.
    """
    size = max(measured, np.max(np.abs(matrix)))
    cleared = np.where(np.abs(matrix) > ROUNDING * size, matrix, 0.0)
    if abs(cleared[0, 0] - cleared[1, 1]) <= ROUNDING * size:
        cleared[0, 0] = cleared[1, 1] = 0.5 * (cleared[0, 0] + cleared[1, 1])
    return cleared


FREQUENCIES = (10.0, 40.0, 160.0, 640.0)  # Hz, at which a bearing is shaken
STEPS_PER_PERIOD = 256  # macro steps of a period, of what takes any
# Of what takes only its own; at frequencies for which there are less it is not shaken
MIN_STEPS_PER_PERIOD = 8
MAX_PERIODS = 40  # at most, until one is as the last
# Of a period's answer to the last one's: aimed at, and told all the same
PERIOD_TOLERANCE, PERIOD_LIMIT = 1e-8, 1e-3
NO_FORCE = 1e-9  # N
AT_REST = np.zeros(2)
SPIN = "omega"  # at a journal's port

LOWERING_SPEED = 0.01  # m/s, of a journal that is lowered onto its bearing
MAX_LOWERING = 0.002  # m that it is lowered at most
LOWERING_STEP = 20e-6  # s, macro step of that
# S, until a bearing has come to rest, and over which its force is read
SETTLING_TIME, MEASURING_TIME = 4e-3, 2e-3
MAX_PRESSES = 25  # at most, until the load is met
LOAD_TOLERANCE = 1e-3  # of the load
CIRCLING_STEP = 20e-6  # s, macro step of a journal that goes round
# S, from circle to circle, and until the bearing has got used to one
CLIMBING_TIME, CIRCLING_TIME = 10e-3, 10e-3
SLOPE_SHARE = 0.02  # of the load, by which a pressed journal is moved on for the slope


@dataclass(frozen=True)
class Place:
    """Where everything is before it is moved, (x, y) in m."""

    journal: np.ndarray
    housing: np.ndarray
    sensors: dict[str, np.ndarray]  # by port


@dataclass(frozen=True)
class Pressed:
    """A journal lying on its bearing under a load, downwards."""

    depth: float  # m, from the middle of the bearing
    across: float  # N/m, stiffness to the side, once the bearing has come to rest
    along: float  # N/m, vertically
    damping: float  # N s/m, vertically


class _Circled(NamedTuple):
    """A bearing whose journal goes round in a circle, in the mean of a turn."""

    force: complex  # N, on the journal: outwards, and along the circle as the imaginary part
    watched: float


class Rig:
    """Moves the journal of a bearing, and what senses it; all forces are those on the journal, N."""

    def __init__(
        self, component: Component, port: str, place: Place, macro_step: float, watched: str = ""
    ) -> None:
        """`component` is loaded and set, not initialised; macro_step: s, for what takes no other.

        watched: a variable that `circled` looks at.
        """
        self._component, self._place, self._port = component, place, port
        self._own_step = None if component.any_step else macro_step
        self.spin = 0.0  # rad/s, of the journal, counter-clockwise
        names = [f"{port}.{SPIN}"] + [
            f"{one}.{name}" for one in (port, *place.sensors, MOUNTED) for axis in POSITION
            for name in (axis, f"v{axis}", f"a{axis}_free")
        ]  # fmt: skip
        taken = [name for name in names if name in component.variables]
        self._inputs = [_input(name) for name in taken]
        named = [f"{port}.{f}" for f in FORCE] + [watched] * (watched in component.variables)
        self._outputs = np.zeros(len(named))
        self._force = self._outputs[:2]
        component.bind(taken, self._outputs, named)
        self._time = 0.0
        component.enter(0.0)
        self._set(AT_REST, AT_REST, AT_REST, True)
        component.pull()
        component.exit()

    @property
    def frequencies(self) -> np.ndarray:
        """At which it is shaken (F,), Hz: whole macro steps to a period. Raises TouchdownError for none."""
        if self._own_step is None:
            return np.array(FREQUENCIES)
        counts = np.array([round(1.0 / (f * self._own_step)) for f in FREQUENCIES])
        counts = counts[counts >= MIN_STEPS_PER_PERIOD]
        if not len(counts):
            raise TouchdownError(
                f"{self._component.name} takes steps of {self._own_step:g} s, too long to be shaken at "
                f"{FREQUENCIES[0]:g} Hz; set a shorter run.macro_step"
            )
        return 1.0 / (counts * self._own_step)

    def sagitta(self) -> np.ndarray:
        """Of a swing, what a chord leaves out that lasts a macro step (F,), by frequency."""
        steps = np.array([self._step_of(1.0 / (STEPS_PER_PERIOD * f)) for f in self.frequencies])
        return (2.0 * math.pi * self.frequencies * steps) ** 2 / 8.0

    def dynamic_stiffness(
        self,
        frequency: float,
        direction: np.ndarray,
        amplitude: float,
        about: np.ndarray = AT_REST,
        alike: float = PERIOD_TOLERANCE,
        sensed: bool = True,
    ) -> np.ndarray:
        """Force against the motion over it (2,), complex, N/m, in a swing (m) along `direction` (2,).

        frequency: Hz, one of `frequencies`; alike: of two periods' answers, over their size; sensed: by its
        sensors, too. Raises TouchdownError where answers do not become `PERIOD_LIMIT` alike.
        """
        step = self._step_of(1.0 / (STEPS_PER_PERIOD * frequency))
        count = round(1.0 / (frequency * step))
        omega = 2.0 * math.pi / (count * step)
        turn = np.exp(1j * omega * step * np.arange(count + 1))
        way, rate = amplitude * np.real(turn), -amplitude * omega * np.imag(turn)
        if not sensed:  # along its chords: beside it what its sensors see goes on in straight lines
            rate = np.append(np.diff(way) / step, 0.0)
        bend = 2.0 * (np.diff(way) - step * rate[:-1]) / step**2  # parabolas that end where the swing does
        middle = np.conj(turn[:-1]) * np.exp(-0.5j * omega * step) / np.sinc(1.0 / count)
        last = np.full(2, np.nan + 0j)
        for _ in range(MAX_PERIODS):
            forces = np.empty((count, 2))
            for k in range(count):
                forces[k] = self._take(
                    about + way[k] * direction, rate[k] * direction, bend[k] * direction, step, sensed
                )
            answer = -2.0 / count * (middle @ forces) / amplitude
            apart = np.max(np.abs(answer - last))
            if apart <= alike * np.max(np.abs(answer)) + NO_FORCE / amplitude:
                return answer
            last = answer
        if apart <= PERIOD_LIMIT * np.max(np.abs(answer)):
            return answer
        raise TouchdownError(
            f"{self._component.name}: its force does not follow a swing of {amplitude:.3g} m at "
            f"{frequency:g} Hz; the bearing is not linear there"
        )

    def pressed(self, load: float) -> Pressed | None:
        """The journal, without spin, lowered until the bearing carries `load` (N); None: it sinks on."""
        self.spin = 0.0
        depth = self._lowered(load)
        if depth is None:
            return None
        depth, slope = self._met(load, depth)
        move, down = SLOPE_SHARE * load / slope, self._below(depth)
        side, up = np.eye(2)
        across, along = (self._slope(down, move * axis) for axis in (side, up))
        self._listen(down)
        highest = self.frequencies[-2:]
        swings = [self.dynamic_stiffness(f, up, move, down, PERIOD_LIMIT)[1] for f in highest]
        rates = 2.0 * math.pi * highest
        return Pressed(float(depth), across, along, float(np.mean(np.imag(swings) / rates)))

    def circled(self, radii: Sequence[float], omega: float, clearance: float) -> list[_Circled]:
        """The response of the bearing to a journal on circles about its middle, one after the other.

        radii: m, from one on which it does not touch, and which is not told; omega: rad/s,
        counter-clockwise; clearance: m, by which the radii were chosen. Where the bearing's own has grown
        by spin or heat, a circle is wider by as much. The journal goes from circle to circle along a
        spiral, with the speed that this has: what is pressed without having been moved would hold no
        energy.
        """
        count = max(
            MIN_STEPS_PER_PERIOD, round(2.0 * math.pi / (abs(omega) * self._step_of(CIRCLING_STEP)))
        )
        step = 2.0 * math.pi / (abs(omega) * count)
        if self._own_step is not None:
            step = self._own_step
        wait, climb = (max(1, round(time / step)) for time in (CIRCLING_TIME, CLIMBING_TIME))
        grown = [GROWN] if GROWN in self._component.variables else []
        found, angle, inner = list[_Circled](), 0.0, radii[0]
        for radius in radii[1:]:
            outer = radius + sum(self._component.read(grown)) - clearance * len(grown)
            rate = (outer - inner) / (climb * step)
            for k in range(climb):
                self._mean_force(inner + k * step * rate, rate, angle, omega, step)
                angle += omega * step
            for _ in range(wait):
                self._mean_force(outer, 0.0, angle, omega, step)
                angle += omega * step
            forces = np.empty((count, 2), complex)
            for k in range(count):
                forces[k] = self._mean_force(outer, 0.0, angle, omega, step), self._outputs[-1]
                angle += omega * step
            force, watched = forces[:, 0].mean(), float(np.real(forces[:, 1]).mean())
            found.append(_Circled(complex(force), watched))
            inner = outer
        return found

    def _mean_force(self, radius: float, rate: float, angle: float, omega: float, step: float) -> complex:
        """Mean force over a step (s) on the journal: outwards, and along the circle as the imaginary part.

        It starts at an `angle` (rad) on a `radius` (m) that grows at `rate` (m/s).
        """
        out = np.array([math.cos(angle), math.sin(angle)])
        along = np.array([-out[1], out[0]])
        bend = 2.0 * rate * omega * along - radius * omega**2 * out
        middle = self._place.housing - self._place.journal
        force = self._take(middle + radius * out, rate * out + radius * omega * along, bend, step)
        half = 0.5 * omega * step  # from the start to the middle; a mean over the turn is less by its sinc
        return complex(*force) * np.exp(-1j * (angle + half)) * half / math.sin(half)

    def _slope(self, off: np.ndarray, move: np.ndarray) -> float:
        """Stiffness (N/m) at rest about `off` (2,), by central differences over `move` (2,), m."""
        ahead, back = (self._listen(off + sign * move) for sign in (1.0, -1.0))
        return float((back - ahead) @ move / (2.0 * move @ move))

    def _lowered(self, load: float) -> float | None:
        """How deep (m) the journal is once the bearing first carries `load`."""
        step = self._step_of(LOWERING_STEP)
        rate = np.array([0.0, -LOWERING_SPEED])
        for k in range(round(MAX_LOWERING / (LOWERING_SPEED * step))):
            if self._take(self._below(k * step * LOWERING_SPEED), rate, AT_REST, step)[1] > load:
                return (k + 1) * step * LOWERING_SPEED
        return None

    def _met(self, load: float, depth: float) -> tuple[float, float]:
        """The depth (m) at which the bearing, come to rest, carries `load`, and the force's slope (N/m)."""
        force = self._listen(self._below(depth))[1]
        other, slope = depth - 0.25 * self._step_of(LOWERING_STEP) * LOWERING_SPEED, 0.0
        for _ in range(MAX_PRESSES):
            there = self._listen(self._below(other))[1]
            if (
                slope == 0.0 or abs(there - force) > SLOPE_SHARE * load
            ):  # nearer, what is left of rattling would tell
                slope = (there - force) / (other - depth)
            if not slope > 0.0:
                break
            depth, force = other, there
            if abs(load - force) <= LOAD_TOLERANCE * load:
                return depth, slope
            other = depth + (load - force) / slope
        raise TouchdownError(
            f"{self._component.name} does not settle under its load of {load:.4g} N: {force:.4g} N at "
            f"{1e6 * depth:.4g} um below the middle"
        )

    def _below(self, depth: float) -> np.ndarray:
        """How far a journal `depth` (m) below the middle of the bearing is off its place (2,)."""
        return self._place.housing - self._place.journal - [0.0, depth]

    def _listen(self, off: np.ndarray) -> np.ndarray:
        """Mean force (2,) once the journal has stood `off` (2,) its place (m) for a while."""
        step = self._step_of(LOWERING_STEP)
        for _ in range(round(SETTLING_TIME / step)):
            self._take(off, AT_REST, AT_REST, step)
        response = [
            self._take(off, AT_REST, AT_REST, step) for _ in range(max(1, round(MEASURING_TIME / step)))
        ]
        return np.mean(response, axis=0)

    def _step_of(self, requested: float) -> float:
        """The macro step to take (s)."""
        return self._own_step or requested

    def _take(
        self, off: np.ndarray, rate: np.ndarray, bend: np.ndarray, step: float, sensed: bool = True
    ) -> np.ndarray:
        """Mean force (2,) over a macro step that begins `off` (m) with `rate` (m/s) and `bend` (m/s2)."""
        self._set(off, rate, bend, sensed)
        self._component.step(self._time, step)
        self._time += step
        self._component.pull()
        return self._force.copy()

    def _set(self, off: np.ndarray, rate: np.ndarray, bend: np.ndarray, sensed: bool) -> None:
        """Hand the motion over."""
        moving = {self._port: (self._place.journal + off, rate, bend)}
        moving[MOUNTED] = self._place.housing, AT_REST, AT_REST
        for sensor, place in self._place.sensors.items():
            moving[sensor] = (place + off, rate, bend) if sensed else (place, AT_REST, AT_REST)
        for i, asked in enumerate(self._inputs):
            self._component.inputs[i] = self.spin if asked is None else moving[asked[0]][asked[1]][asked[2]]
        self._component.push()


def _input(name: str) -> tuple[str, int, int] | None:
    """Port, derivative and axis that an input takes; None: it is the spin."""
    port, _, variable = name.rpartition(".")
    if variable == SPIN:
        return None
    order = {"x": 0, "y": 0, "v": 1, "a": 2}[variable[0]]
    return port, order, POSITION.index(variable.removesuffix("_free")[-1])
