"""The loops as they are measured on a machine (ISO 14839-3): in the nonlinear run, by multisines.

The scene runs levitated, at its speed. Axis after axis a multisine is added to the sensor's readings, then
a force on the journal at the magnets. All lines stand in whole periods, at odd multiples; a transient is
over once two periods agree. With readings r and currents i of all runs as columns, d what is added,

    S = r/d (an axis by itself)     P = (r - d) i^-1     C = -i r^-1     compliance = displacement/force

Events, unbalance, noise of the sensors, and what else excites the scene are left out, so that nothing else
is at the lines.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from ...master.common.errors import TouchdownError
from ...master.common.text import percent
from ...master.coupling.connections import AXIS, COMMAND, SET_POINTS
from ...master.coupling.observer import Observer, RunState
from ...master.coupling.simulation import opened, simulate
from ...master.coupling.system import System
from ...master.scene.scene import Scene
from ...modelkit.excitation import Lines, next_line
from ...modelkit.kernel import interpret
from .linear_loops import Sampled
from .transfer import Answers, answers

FIRST = 5.0  # Hz, about: the first line
LAST = 0.4  # of the sampling frequency: the last line, at most
RATIO = 1.06  # of a line to the one before, at least
AMPLITUDE = 1e-7  # m, of a line
LOOP = 0.1  # |L| above which plant and loop are compared; below it S tells little of them
REPEATS = 3e-5  # of a line's answer, from one period to the next
PERIODS = 20  # at most
LEFT_OUT = dict.fromkeys(("sensing.noise", "eccentricity", "unbalance_scale"), 0.0)
LEFT_OUT |= dict.fromkeys(("inject.sensed", "inject.set", "inject.force"), 0.0)
LEFT_OUT |= dict.fromkeys(("course.form", "base.course.form"), "none")


@dataclass(frozen=True)
class Measured:
    """What the nonlinear run answers at the lines, beside the linear loops."""

    answers: Answers
    linear: Answers  # at the same lines
    amplitude: float  # m, of each line at the sensors
    force: float  # N, of each line on the journal
    halved: float  # largest relative change of S at half the amplitude, of the axis with the largest S
    remarks: tuple[str, ...]

    def deviation(self, name: str, axis: int) -> float:
        """Largest of an answer (a name of `UNITS`) of an axis, over the linear one at that line.

        Of L and P: of lines with |L| above `LOOP`.
        """
        ours, linear = self.answers.values[name][:, axis], self.linear.values[name][:, axis]
        shown = np.abs(self.linear.values["L"][:, axis]) > (LOOP if name in "LP" else 0.0)
        return float(np.abs(ours / linear - 1.0)[shown].max(initial=0.0))


class _Sampler(Observer):
    """Reads signals at the end of each sample, and ends the run once a period is as the one before."""

    def __init__(
        self, read: Callable[[], np.ndarray], every: int, length: int, alike: Callable[..., bool]
    ) -> None:
        self._read, self._every, self._length, self._alike = read, every, length, alike
        self.rows = list[np.ndarray]()
        self.settled = False

    def stepped(self, state: RunState) -> None:
        if state.done % self._every:
            return
        self.rows.append(self._read())
        n = self._length
        if len(self.rows) % n == 0 and len(self.rows) >= 2 * n:
            self.settled = self._alike(np.array(self.rows[-2 * n : -n]), np.array(self.rows[-n:]))
            if self.settled:
                state.stop("a period is as the one before")

    def due(self, state: RunState) -> int:
        """At the end of the next sample."""
        return (state.done // self._every + 1) * self._every


@dataclass(frozen=True)
class _Bench:
    """A scene that levitates its rotor, and the lines by which it is excited."""

    scene: Scene
    loops: Sampled
    numbers: np.ndarray  # of the lines
    length: int  # samples in a period
    remarks: list[str]

    @classmethod
    def of(cls, scene: Scene, loops: Sampled) -> _Bench:
        """Lines from `FIRST` to `LAST`, and the scene without what is left out."""
        if loops.period > loops.tick:
            raise TouchdownError(
                f"--measure: controllers sample every {loops.period:g} s by their clocks, their bearings "
                f"every {loops.tick:g} s; give them one sample time, or leave --measure out"
            )
        length = round(1.0 / (FIRST * loops.period))
        numbers = [1]
        while (line := interpret(next_line, numbers[-1], Lines(ratio=RATIO, odd=1))) <= LAST * length:
            numbers.append(line)
        every = math.ceil(loops.period / scene.run.macro_step - 1e-9)
        specs = {
            name: replace(spec, set={k: v for k, v in spec.set.items() if not k.startswith("event[")})
            for name, spec in scene.components.items()
        }
        run = replace(
            scene.run, start_time=0.0, macro_step=loops.period / every, until="end",
            duration=PERIODS * length * loops.period, warn_residual=math.inf, stop_residual=math.inf,
        )  # fmt: skip
        calm = replace(scene, components=specs, run=run, zero=None)
        with opened(calm, in_process=True, listening=False) as system:
            pairs = [(f"{one}.{key}", value) for one in specs for key, value in LEFT_OUT.items()]
            known = {name: value for name, value in pairs if name in system and system.value(name)}
        calm = calm.set(known)
        return cls(calm, loops, np.array(numbers), length, [])

    @property
    def omega(self) -> np.ndarray:
        """Of the lines, rad/s."""
        return 2.0 * math.pi * self.numbers / (self.length * self.loops.period)

    def spectra(self, axis: int, kind: str, size: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Readings (m), currents (A), displacements (m) of all axes (lines, axes) over each line injected.

        kind: a size of the bearing's `Injection`, of each line, on an axis from 0.
        """
        bearing, m = self.loops.bearings[axis // 2].name, len(self.loops.names)
        inject: dict[str, float] = {kind: size, "axis": 1 + axis % 2, "lines.frequency": self.omega[0]}
        inject |= {"lines.count": len(self.numbers), "lines.ratio": RATIO, "lines.odd": 1}
        scene = self.scene.set({f"{bearing}.inject.{key}": value for key, value in inject.items()})
        n = np.arange(len(self.numbers))
        injected = size * np.exp(-1j * math.pi * n * (n + 1) / len(n)) * self.length / 2
        answering = axis + (0 if kind == "sensed" else 2 * m)

        def at_lines(rows: np.ndarray) -> np.ndarray:
            return np.fft.rfft(rows, axis=0)[self.numbers] / injected[:, None]

        def alike(before: np.ndarray, now: np.ndarray) -> bool:
            old, new = (at_lines(rows)[:, answering] for rows in (before, now))
            return bool(np.all(np.abs(new - old) <= REPEATS * np.abs(new)))

        with opened(scene, in_process=True, listening=False) as system:
            every = round(self.loops.period / scene.run.macro_step)
            sampler = _Sampler(self._reader(system), every, self.length, alike)
            simulate(scene, system, observers=[sampler]).raise_if_stopped()
            self._judge(system, sampler, axis)
        found = at_lines(np.array(sampler.rows[-self.length :]))
        z = np.exp(1j * self.omega * self.loops.period)[:, None]
        later = z ** (self.loops.laws.delay - 1)  # what the linear loops take for a delay of the plant
        return found[:, :m], found[:, m : 2 * m] * later, found[:, 2 * m :] / z

    def _reader(self, system: System) -> Callable[[], np.ndarray]:
        """Readings (m), currents (A), displacements (m) of all axes at the end of a sample (3 axes,)."""
        sensed, asked, moved, factors = list[str](), list[str](), list[str](), list[float]()
        for bearing in self.loops.bearings:
            command = list(SET_POINTS)[int(system.value(f"{bearing.name}.{COMMAND}"))]
            factors += 2 * [1.0 if command == "set" else 1.0 / bearing.current_factor]
            sensed += [f"{bearing.name}.{AXIS.format(k, 'sensed')}" for k in (1, 2)]
            fed = [f"{bearing.name}.{AXIS.format(k, command)}" for k in (1, 2)]
            asked += [c.source_name for name in fed for c in system.connections if c.target_name == name]
            held = next(a for a in system.attachments if a.bearing == bearing.name and a.on_journal)
            moved += [held.motion("x"), held.motion("y")]
        readers = [system.reader([name]) for name in (*sensed, *asked, *moved)]
        m, along = len(factors), [bearing.directions for bearing in self.loops.bearings]

        def read() -> np.ndarray:
            values = np.concatenate([one() for one in readers])
            values[m : 2 * m] *= factors
            for k, directions in enumerate(along):
                pair = slice(2 * m + 2 * k, 2 * m + 2 * k + 2)
                values[pair] = directions @ values[pair]
            return values

        return read

    def _judge(self, system: System, sampler: _Sampler, axis: int) -> None:
        """Say what kept a run from being linear, or from repeating itself."""
        name = self.loops.names[axis]
        if not sampler.settled:
            self.remarks.append(
                f"excited at {name}, no two of {PERIODS} periods agree to {percent(REPEATS)}"
            )
        for bearing in self.loops.bearing_names:
            for what in ("current", "voltage"):
                if spent := system.value(f"{bearing}.limits.{what}_time"):
                    self.remarks.append(
                        f"excited at {name}, {bearing} was at its {what} limit for {spent:.3g} s"
                    )


def measured_response(scene: Scene, loops: Sampled, amplitude: float = AMPLITUDE) -> Measured:
    """Of stable loops at the scene's speed; amplitude (m): of each line at the sensors."""
    bench = _Bench.of(scene, loops)
    linear = answers(loops, loops.speed, bench.omega)
    force = amplitude / float(np.abs(linear.values["G"]).max())
    axes = range(len(loops.names))
    runs = [bench.spectra(axis, "sensed", amplitude) for axis in axes]
    r, i = (np.stack([run[part] for run in runs], axis=2) for part in (0, 1))
    s = np.diagonal(r, axis1=1, axis2=2)
    swings = [bench.spectra(axis, "force", force)[2][:, axis] for axis in axes]
    values = {
        "L": 1.0 / s - 1.0,
        "S": s,
        "P": np.diagonal((r - np.eye(len(axes))) @ np.linalg.inv(i), axis1=1, axis2=2),
        "C": np.diagonal(-i @ np.linalg.inv(r), axis1=1, axis2=2),
        "G": np.stack(swings, axis=1),
    }
    worst = int(np.argmax(np.abs(s).max(axis=0)))
    again = bench.spectra(worst, "sensed", 0.5 * amplitude)[0][:, worst]
    halved = float(np.abs(again / s[:, worst] - 1.0).max())
    found = Answers(bench.omega, loops.names, values)
    return Measured(found, linear, amplitude, force, halved, tuple(dict.fromkeys(bench.remarks)))
