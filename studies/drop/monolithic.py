"""The monolithic reference: the same kernels as one ordinary differential equation.

No macro steps and no interface: bodies and what is inside the bearings form one state, solved by scipy
at a tight tolerance. Two solvers of different kind should agree; where they part, nothing can be
compared any more (impacts amplify every difference).
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from scipy.integrate import solve_ivp

from ...master.common.errors import TouchdownError
from ...master.components.in_process import InProcessComponent
from ...master.coupling.loop.span import zero_of
from ...master.coupling.simulation import open_system
from ...master.coupling.system import System
from ...master.scene.scene import Scene

FIRST_STEP_S = 1e-6
SAME_TIME_S = 1e-12  # times that differ by less are one, told apart by rounding


@dataclass(frozen=True)
class _Solution:
    """Motion at the asked times: series by COMPONENT.VARIABLE, and what it cost."""

    time: np.ndarray  # s, from the scene's zero
    series: dict[str, np.ndarray]
    evaluations: int
    states: dict[str, np.ndarray]  # of each component, one row per time


class Monolith:
    """All components of a scene as one system of equations."""

    def __init__(self, scene: Scene) -> None:
        self.scene = scene
        # no macro steps, so no copies to carry: a bearing without elastic modes has the shortest state
        system = open_system(scene.set({"run.scheme": "hold"}), in_process=True)
        self._twins: dict[str, InProcessComponent] = {}
        for name, component in system.components.items():
            if not isinstance(component, InProcessComponent):
                raise TouchdownError(
                    f"component {name} ({component.origin}) is an FMU; only the project's own models have "
                    "equations to join, and there is no monolithic reference without them"
                )
            self._twins[name] = component
            model, on_journal = component.instance.model, name in {a.bearing for a in system.attachments}
            if model.instant is None if on_journal else model.derivative is None or model.motion is None:
                raise TouchdownError(
                    f"component {name} ({component.origin}) acts in steps and has no equations to join; "
                    "there is no monolithic reference with it"
                )
            if acting := [
                n for n, on in zip(model.effects, component.read(model.effects), strict=True) if on
            ]:
                raise TouchdownError(
                    f"{name}.{acting[0]} acts once a macro step and has no equations to join; set it to "
                    "0 for a monolithic reference"
                )
        self.start, self.zero = system.start, zero_of(scene, system)  # s, on the simulation's clock
        self._switches = _switches(system) | {self.zero}
        system.initialise()
        bearings = {a.bearing for a in system.attachments}
        self._bodies = [n for n in self._twins if n not in bearings]
        self._bearings = [n for n in self._twins if n in bearings]
        self._parts: dict[str, slice] = {}
        start = 0
        for name in (*self._bodies, *self._bearings):
            count = int(self._twins[name].instance.record["n"])
            self._parts[name] = slice(start, start + count)
            start += count
        self._size = start
        self._motion = self._copies(system, self._bodies)
        self._loads = self._copies(system, self._bearings)
        for name in self._bodies:
            self._twins[name].instance.memory["half"] = 0.0
        self._room: dict[str, tuple[np.ndarray, np.ndarray]] = {}
        for name in self._bearings:
            longest = len(self._twins[name].instance.record["q"])
            self._room[name] = np.zeros(longest), np.zeros(longest)
        self.evaluations = 0

    def _copies(self, system, sources) -> list[tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]]:
        """For each pair of components: (source words, where from, target words, where to)."""
        pairs: dict[tuple[str, str], list[tuple[int, int]]] = {}
        for c in system.connections:
            if c.source in sources:
                places = (
                    self._twins[c.source].variable(c.output).reference,
                    self._twins[c.target].variable(c.input).reference,
                )
                pairs.setdefault((c.source, c.target), []).append(places)
        return [
            (
                self._twins[source].instance.words,
                np.array([p[0] for p in places]),
                self._twins[target].instance.words,
                np.array([p[1] for p in places]),
            )
            for (source, target), places in pairs.items()
        ]

    @property
    def moving(self) -> int:
        """Number of states that others depend on: all but quadratures."""
        return int(np.count_nonzero(self._weights()))

    def initial(self) -> np.ndarray:
        """State at the start."""
        parts = [self._twins[n].instance.record["q"][: p.stop - p.start] for n, p in self._parts.items()]
        return np.concatenate(parts)

    def state_of(self, system: System) -> np.ndarray:
        """The present state of another system of the same scene, stepped in process."""
        parts = []
        for name, part in self._parts.items():
            component = system.components[name]
            assert isinstance(component, InProcessComponent)
            parts.append(component.instance.record["q"][: part.stop - part.start])
        return np.concatenate(parts)

    def jacobian(self, t: float, state: np.ndarray) -> np.ndarray:
        """Derivative of the right-hand side by the state, by central differences on the models' scales."""
        weight = self._weights()
        steps = np.where(weight > 0.0, 1e-6 / np.where(weight > 0.0, weight, 1.0), 0.0)
        jacobian = np.zeros((self._size, self._size))
        for i in np.flatnonzero(steps):
            off = np.zeros(self._size)
            off[i] = steps[i]
            jacobian[:, i] = (self.rhs(t, state + off) - self.rhs(t, state - off)) / (2.0 * steps[i])
        return jacobian

    def _weights(self) -> np.ndarray:
        return np.concatenate(
            [self._twins[n].instance.record["weight"][: p.stop - p.start] for n, p in self._parts.items()]
        )

    def rhs(self, t: float, state: np.ndarray, switched: float | None = None) -> np.ndarray:
        """Derivative of the whole state at t (s).

        switched: the time (s) by which it is known what is switched on; None: t.
        """
        self.evaluations += 1
        derivative = np.zeros(self._size)
        self._publish(t, state)
        for source, out, target, into in self._motion:
            target[into] = source[out]
        for name in self._bearings:
            instance, part = self._twins[name].instance, self._parts[name]
            inside, rates = self._room[name]  # as long as the model's own state, which loops may run into
            inside[: part.stop - part.start] = state[part]
            time = t if switched is None else switched
            instance.model.instant(time, inside, rates, instance.words)  # type: ignore[misc]
            derivative[part] = rates[: part.stop - part.start]
        for source, out, target, into in self._loads:
            target[into] = source[out]
        for name in self._bodies:
            instance, part = self._twins[name].instance, self._parts[name]
            instance.model.derivative(0.0, state[part], derivative[part], instance.words)  # type: ignore[misc]
        return derivative

    def _publish(self, t: float, state: np.ndarray) -> None:
        for name in self._bodies:
            instance = self._twins[name].instance
            instance.memory["time"] = t  # a thrust follows it
            instance.model.motion(state[self._parts[name]], instance.words)  # type: ignore[misc]

    def solve(self, times: np.ndarray, watched: list[str], tolerance: float, method: str) -> _Solution:
        """Motion of `watched` (outputs of bodies) at `times` (s from zero), by a scipy `method`.

        `tolerance` is the error over the models' own scales, as in the FMUs' micro-steps.
        """
        weight = self._weights()
        atol = tolerance / np.where(weight > 0.0, weight, np.inf)
        atol[weight == 0.0] = 1e3  # quadratures: nothing depends on them
        state, time = self.initial(), self.start
        self.evaluations = 0
        states: list[np.ndarray] = []
        clock = np.asarray(times) + self.zero
        last = float(clock[-1])
        for end in stretch_ends(self._switches, self.start, last):
            asked = clock[(clock > time) & (clock <= end)]
            middle = 0.5 * (time + end)  # components switch between stretches, not within
            solution = solve_ivp(
                lambda t, y, switch_time=middle: self.rhs(t, y, switch_time),
                (time, end),
                state,
                method=method,
                t_eval=np.append(asked[asked < end], end),
                rtol=3e-14,
                atol=atol,
                first_step=min(FIRST_STEP_S, end - time),
            )
            if not solution.success:
                raise TouchdownError(f"scipy's {method} gave up: {solution.message}")
            states += list(solution.y.T[: len(asked)])
            state, time = solution.y[:, -1], end
        return self._series(np.asarray(times), states, watched)

    def _series(self, times: np.ndarray, states: list[np.ndarray], watched: list[str]) -> _Solution:
        series: dict[str, list[float]] = {name: [] for name in watched}
        for time, state in zip(times, states, strict=True):
            self._publish(time + self.zero, state)
            for name in watched:
                component, _, variable = name.partition(".")
                series[name].append(self._twins[component].read([variable])[0])
        rows = np.array(states)
        parts = {name: rows[:, part] for name, part in self._parts.items()}
        return _Solution(times, {k: np.array(v) for k, v in series.items()}, self.evaluations, parts)


def stretch_ends(switches: Iterable[float], start: float, last: float) -> list[float]:
    """Ends (s) of the stretches between switches from `start` to `last`, in order.

    >>> stretch_ends([0.002, 0.0019999999999999983, 0.001], 0.001, 0.01)
    [0.0019999999999999983, 0.01]
    """
    ends: list[float] = []
    for time in sorted(switches):
        if time - (ends[-1] if ends else start) > SAME_TIME_S and last - time > SAME_TIME_S:
            ends.append(time)
    return [*ends, last]


def _switches(system: System) -> set[float]:
    """Times (s) at which magnetic bearings shut down, amplifiers fail, and a thrust or brake bends."""
    names = re.compile(r"shutdown_time|event\[\d+\]\.time|(thrust|brake)\[\d+\]\.time")
    return {
        system.value(f"{name}.{variable}")
        for name, component in system.components.items()
        for variable in component.variables
        if names.fullmatch(variable)
    }
