"""A step repeated until both sides agree: for bearings that cannot carry a model of the bodies.

The bearing gets the motion of journal and housing as a parabola through both ends of the step; the bodies
take the step under the load it hands over, which gives another end; the whole is taken back and repeated
with that end, by Aitken's relaxation, until it stays. What the bearing knows of the bodies' masses is
taken from it, so nothing but motion and load crosses, and any FMU whose state can be saved will do.

Stiff contacts on light bodies make the repetition diverge beyond some macro step. Such a step is divided;
where that does not help either, the run stops and says so.
"""

from __future__ import annotations

from collections.abc import Container, Sequence
from dataclasses import dataclass

import numpy as np

from ...common.errors import TouchdownError
from ...components.component import DIRECTIONS, GAINS, TILT
from ...scene.run_spec import RunSpec
from ..system import System
from .stepper import Checkpoint, Stepper, require_states

MAX_REPETITIONS = 16  # repetitions of a step
MAX_HALVINGS = 8  # halvings of a macro step
TINY = 1e-300
TILT_LEVER = 0.1  # m, at which a tilt counts beside displacements: about that of a rotor's bearing


@dataclass(frozen=True)
class _Channels:
    """Places in a bearing's inputs, one of each for every direction in which its bodies move."""

    position: np.ndarray
    velocity: np.ndarray
    acceleration: np.ndarray
    spin: np.ndarray
    spin_acceleration: np.ndarray
    gains: np.ndarray  # what it would know of the bodies' masses
    levers: np.ndarray  # of each position: 1, or of a tilt what it counts beside displacements (m)

    @property
    def prescribed(self) -> np.ndarray:
        """Inputs that carry the prescribed motion."""
        return np.concatenate([self.acceleration, self.spin_acceleration])

    def motion(self, start: np.ndarray, end: np.ndarray, step: float) -> np.ndarray:
        """Accelerations (m/s2, rad/s2) that lead from the inputs `start` to those in `end`."""
        moved = end[self.position] - start[self.position] - step * start[self.velocity]
        return np.concatenate([2.0 * moved / step**2, (end[self.spin] - start[self.spin]) / step])


class Iterated(Stepper):
    """Repeats each step until the bodies' ends stay."""

    KEPT = ("_guess", "_steps", "_repeated", "_deepest")

    def __init__(self, system: System, run: RunSpec) -> None:
        super().__init__(system, run)
        require_states(system, run.scheme.name)
        self._steps = self._repeated = self._deepest = 0
        for a in system.attachments:
            gains = map(a.bearing_end.own, GAINS)
            bearing = system.components[a.bearing]
            bearing.set({name: 0.0 for name in gains if name in bearing.variables})
        self.follow()

    def follow(self) -> None:
        system = self.system
        bearings = dict.fromkeys(a.bearing for a in system.attachments if a.bearing in system.order)
        self._channels = {name: _channels(system, name) for name in bearings}
        self._bodies = [name for name in system.order if name not in bearings]
        moving = [c.levers for c in self._channels.values()]
        turning = [np.zeros(len(c.spin)) for c in self._channels.values()]
        pairs = [part for pair in zip(moving, turning, strict=True) for part in pair]
        # 1: a displacement, 0: a rotation about the shaft, between: a tilt
        self._moves = np.concatenate([np.zeros(0), *pairs])
        self._guess = np.zeros(len(self._moves))

    def step(self, number: int, time: float, step: float) -> None:
        self._advance(time, step, 0)

    def _advance(self, time: float, step: float, level: int) -> None:
        self._deepest = max(self._deepest, level)
        with self._checkpoint() as before:
            change = self._converge(before, time, step)
            if change <= self.run.tolerance:
                return
            if level == MAX_HALVINGS:
                raise TouchdownError(
                    f"scheme iterated does not converge at t = {time:.9g} s, where a step of {step:g} s "
                    f"repeated {MAX_REPETITIONS} times still moves the bodies by {change:.2g} m; take a "
                    "smaller macro step, or a scheme in which bearings carry the bodies (interface)"
                )
            before.restore()
        self._advance(time, 0.5 * step, level + 1)
        self._advance(time + 0.5 * step, 0.5 * step, level + 1)

    def _checkpoint(self) -> Checkpoint:
        return Checkpoint(self.system)

    def _converge(self, before: Checkpoint, time: float, step: float) -> float:
        """Repeat the step from the motion of the last one; returns what the last repetition changed (m)."""
        self._steps += 1
        relaxation, last, change = 1.0, np.zeros(0), np.inf
        guess = self._guess
        for repetition in range(MAX_REPETITIONS):
            if repetition:
                before.restore()
            off = self._take(before.signals, guess, time, step) - guess
            self._repeated += 1
            change = 0.5 * step**2 * float(np.max(np.abs(off * self._moves), initial=0.0))
            if change <= self.run.tolerance or not np.isfinite(change):
                break
            if repetition:
                turn = (off - last) * self._moves
                relaxation *= -float(last @ turn) / max(float(turn @ turn), TINY)
            guess, last = guess + relaxation * off, off
        self._guess = guess if np.isfinite(change) else np.zeros(len(guess))
        return change

    def _take(self, start: np.ndarray, guess: np.ndarray, time: float, step: float) -> np.ndarray:
        """The step under the motion `guess` (m/s2 per channel); returns the motion that came of it."""
        system, input_maps, used = self.system, self.system.input_maps, 0
        for name, channels in self._channels.items():
            component = system.components[name]
            system.take_inputs(name)
            count = len(channels.prescribed)
            component.inputs[channels.prescribed] = guess[used : used + count]
            component.inputs[channels.gains] = 0.0
            used += count
            component.push()
            component.step(time, step)
            component.pull()
        for name in self._bodies:
            system.feed(name)
            system.components[name].step(time, step)
            system.components[name].pull()
        came = [
            channels.motion(input_maps[name].of(start), input_maps[name].of(system.signals), step)
            for name, channels in self._channels.items()
        ]
        return np.concatenate([np.zeros(0), *came])

    @property
    def figures(self) -> dict[str, float]:
        return {
            "repetitions_per_step": self._repeated / max(self._steps, 1),
            "shortest_macro_step": self.run.macro_step / 2**self._deepest,
        }


def _channels(system: System, bearing: str) -> _Channels:
    """All directions in which a bearing takes position, velocity and acceleration of a body.

    Raises TouchdownError where it takes the position and nothing that could be prescribed with it.
    """
    inputs = {name: place for place, name in enumerate(system.input_maps[bearing].inputs)}
    linear: list[list[int]] = []
    levers: list[float] = []
    angular: list[list[int]] = []
    gains: list[int] = []
    ports = dict.fromkeys(a.bearing_end for a in system.attachments if a.bearing == bearing)
    for port in ports:
        for way in DIRECTIONS:
            names = [port.own(name) for name in (way.place, way.rate, way.acceleration)]
            if names[0] in inputs:
                _require_all(names, inputs, bearing)
                linear.append([inputs[name] for name in names])
                levers.append(TILT_LEVER if way.place in TILT else 1.0)
        turn = [port.own(name) for name in ("omega", "alpha_free")]
        if all(name in inputs for name in turn):
            angular.append([inputs[name] for name in turn])
        gains += [inputs[name] for name in map(port.own, GAINS) if name in inputs]
    position, velocity, acceleration = np.array(linear, dtype=np.intp).reshape(-1, 3).T
    spin, spin_acceleration = np.array(angular, dtype=np.intp).reshape(-1, 2).T
    known = np.array(gains, dtype=np.intp)
    counting = np.array(levers)
    return _Channels(position, velocity, acceleration, spin, spin_acceleration, known, counting)


def _require_all(names: Sequence[str], inputs: Container[str], bearing: str) -> None:
    lacking = [name for name in names if name not in inputs]
    if lacking:
        raise TouchdownError(
            f"scheme iterated prescribes motion to {bearing}, which does not take {lacking[0]}; "
            "choose another scheme, such as velocity"
        )
