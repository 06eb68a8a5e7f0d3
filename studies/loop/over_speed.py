"""The loops of a scene over the speed."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from scipy import signal
from scipy.optimize import linear_sum_assignment

from ...master.common.errors import TouchdownError
from ...master.common.text import HZ, RPM
from ...master.coupling.simulation import opened
from ...master.results.required import Judged, beside
from ...master.scene.requirements import SENSITIVITY
from ...master.scene.scene import Scene
from .linear_loops import (
    ROUNDING,
    Loops,
    Sampled,
    Unbalance,
    controlled_bearings,
    growing,
    known_laws,
    loops_of,
    shortfalls,
)
from .margins import Margins, margins
from .measured_response import Measured, measured_response
from .response import CLEARANCE, UnbalanceResponse, unbalance_response
from .transfer import Answers, answers, controlled, plant

if TYPE_CHECKING:
    import pandas

SHARES = (0.0, 0.5, 1.0, 1.5)  # of the scene's speed


@dataclass(frozen=True)
class _Bending:
    """A bending mode of the free rotor, and the closed loops' pole that it became."""

    free: complex  # 1/s
    pole: complex  # 1/s


@dataclass(frozen=True)
class AtSpeed:
    """All loops at one speed."""

    speed: float  # rad/s
    omega: np.ndarray  # (n,), rad/s
    values: np.ndarray  # (n, axes), S
    margins: tuple[Margins, ...]  # by axis; none of loops that do not levitate the rotor
    poles: np.ndarray  # 1/s, of a pair the upper one, the least damped first; none that samples cannot show
    bending: tuple[_Bending, ...]
    shown: np.ndarray  # `poles` without modes that samples show as slower ones

    @property
    def unstable(self) -> complex | None:
        """The pole (1/s) that grows fastest, where one does by more than rounding."""
        return growing(self.poles)


def _instability(speed: float, pole: complex) -> str:
    return f"unstable at {RPM * speed:g} rpm: a pole at {pole.real:+.4g} 1/s, {HZ * abs(pole.imag):.4g} Hz"


def damping_ratio(pole: complex) -> float:
    """Of a pole (1/s): 1 of one that does not swing, below zero of one that grows."""
    return -pole.real / abs(pole) if pole else 0.0


@dataclass(frozen=True)
class Found:
    """The loops of a scene over the speed."""

    scene: Scene
    loops: Loops
    speeds: tuple[AtSpeed, ...]
    clearance: float  # m, the smallest of the touchdown bearings; 0: unknown
    measured: Measured | None = None  # in the nonlinear run, at the scene's speed; None: it was not

    @property
    def own(self) -> AtSpeed:
        """At the scene's speed."""
        return min(self.speeds, key=lambda one: abs(one.speed - self.loops.speed))

    @property
    def left_out(self) -> str:
        """What is to be said of poles that are not shown; "": all are."""
        if not isinstance(self.loops, Sampled) or len(self.own.shown) == len(self.own.poles):
            return ""
        half = f"{0.5 / self.loops.period:.4g} Hz"
        return f"modes above half the sampling frequency, {half}, are not shown unless they grow"

    @property
    def faults(self) -> list[str]:
        """Why the loops do not levitate the rotor, a line each: unstable, or too weak for the load."""
        found = [
            _instability(result.speed, pole)
            for result in self.speeds
            if (pole := result.unstable) is not None
        ]
        return [*self.loops.too_weak, *found]

    @property
    def required(self) -> list[Judged]:
        """What the scene requires of the sensitivity, beside the peak up to its speed; None: unstable."""
        ups = [one for one in self.speeds if abs(one.speed) <= abs(self.own.speed)]
        peaks = [max((one.peak for one in up.margins), default=math.inf) for up in ups]
        found = max(peaks) if max(peaks) < math.inf else None
        return [beside(one, found) for one in self.scene.requirements if one.kind == SENSITIVITY]

    @cached_property
    def unbalance(self) -> UnbalanceResponse | None:
        """Orbits, control currents and coil voltages over the speed; None of a balanced rotor."""
        return unbalance_response(self.scene, self.loops)

    @cached_property
    def answers(self) -> Answers | None:
        """Loop gain, sensitivity, plant, controller, compliance at the scene's speed, by axis.

        None of unstable loops, and of magnetic bearings without a controller.
        """
        if not isinstance(self.loops, Sampled) or self.faults:
            return None
        return answers(self.loops, self.own.speed, self.own.omega)

    @property
    def plant(self) -> signal.StateSpace:
        """At the scene's speed, from control currents (A) to signals (m), in continuous time.

        `signal.StateSpace` is scipy's; python-control takes its A, B, C, D. Raises TouchdownError of
        magnetic bearings without a controller.
        """
        return signal.StateSpace(*plant(controlled(self.loops), self.own.speed, sampled=False).matrices)

    @property
    def sampled_plant(self) -> signal.StateSpace:
        """As `plant`, from sample to sample: a control current acts as late as the controllers' does."""
        loops = controlled(self.loops)
        return signal.StateSpace(*plant(loops, self.own.speed, sampled=True).matrices, dt=loops.period)

    @property
    def controller(self) -> signal.StateSpace:
        """From the signals' deviations -y (m) to the control currents (A), from sample to sample.

        Raises TouchdownError as `plant`.
        """
        loops = controlled(self.loops)
        return signal.StateSpace(*loops.law.matrices, dt=loops.period)

    def to_pandas(self) -> pandas.DataFrame:
        """Over the speed (rad/s): the worst loop's largest |S| (nan: unstable), the least damped pole."""
        import pandas

        poles = [result.shown[0] for result in self.speeds]
        columns = {
            "max_S": [
                max((one.peak for one in result.margins), default=math.nan) for result in self.speeds
            ],
            "damping_ratio": list(map(damping_ratio, poles)),
            "frequency_Hz": [HZ * pole.imag for pole in poles],
        }
        return pandas.DataFrame(
            columns, index=pandas.Index([result.speed for result in self.speeds], name="speed")
        )


def loops_in(scene: Scene, speeds: Sequence[float] = (), amplitude: float = 0.0) -> Found:
    """The loops of `scene` at its own speed and at `speeds` (rad/s; none: `SHARES` of its own).

    amplitude (m): of each line at the sensors, by which loops that levitate are measured, too; 0: none are.
    Raises TouchdownError where the scene has no magnetic bearing whose loop is known, or no rotor with it.
    """
    loops = loops_of(scene)
    shares = [share * loops.speed for share in SHARES]
    judged = [0.0, *shares[:-1]] if any(one.kind == SENSITIVITY for one in scene.requirements) else []
    requested = sorted({*(speeds or shares), *judged, loops.speed})
    with opened(scene, in_process=True, listening=False) as system:
        named = {f"{a.bearing}.{CLEARANCE}" for a in system.attachments if a.on_journal}
        rooms = [system.value(name) for name in named if name in system]
    found = Found(scene, loops, tuple(_at(loops, speed) for speed in requested), min(rooms, default=0.0))
    if amplitude == 0.0 or found.faults:
        return found
    return replace(found, measured=measured_response(scene, controlled(loops), amplitude))


def _at(loops: Loops, speed: float) -> AtSpeed:
    closed = loops.closed(speed).balanced()
    omega = closed.lines(loops.highest)
    values = np.diagonal(closed.sensitivity(omega), axis1=1, axis2=2)
    poles, shown = _poles(loops, closed.poles), loops.shown(speed, closed)
    bending = tuple(_bending(loops, speed, shown))
    result = AtSpeed(speed, omega, values, (), poles, bending, _poles(loops, shown))
    if result.unstable is not None or loops.too_weak:
        return result
    found = (margins(closed.one(axis), omega, values[:, axis]) for axis in range(len(loops.names)))
    return replace(result, margins=tuple(found))


def _poles(loops: Loops, poles: np.ndarray) -> np.ndarray:
    """Of these, as `AtSpeed.poles`."""
    upper = (p for p in map(complex, poles) if p.imag >= -ROUNDING * abs(p))
    return np.array(
        sorted((p for p in upper if p.imag <= loops.highest or p.real > 0.0), key=damping_ratio)
    )


def settled(loops: Sampled, speed: float, poles: np.ndarray) -> Unbalance | None:
    """How the unbalance swings the loops at a speed (rad/s); None where they settle to no such swing."""
    if growing(poles) is not None:
        return None
    try:
        return loops.unbalance(speed)
    except np.linalg.LinAlgError:  # an undamped pole right at the speed
        return None


def limit_warnings(scene: Scene) -> list[str]:
    """That a scene's controllers make its magnetic bearings unstable, and what they ask for in vain.

    Of magnets and amplifiers, by bias, static load and, where the controllers' law is known and the loops
    are stable, unbalance; a line each.
    """
    try:
        with opened(scene, in_process=True, listening=False) as system:
            system.initialise()
            bearings = tuple(controlled_bearings(scene, system))
            laws = known_laws(scene, system, bearings)
        if laws is None:
            return list(shortfalls(bearings, None))
        loops = Sampled(scene)
        poles = _poles(loops, loops.closed(loops.speed).balanced().poles)
        grows = growing(poles)
        unstable = [] if grows is None else [_instability(loops.speed, grows)]
        return [*laws.remarks, *unstable, *shortfalls(bearings, settled(loops, loops.speed, poles))]
    except (TouchdownError, np.linalg.LinAlgError):  # of which the run itself tells
        return []


def _bending(loops: Loops, speed: float, poles: np.ndarray) -> list[_Bending]:
    """The free rotor's bending modes, each with a pole of its own, as near to it as can be."""
    free = loops.rotor.bending(speed, loops.highest)
    modes, chosen = linear_sum_assignment(np.abs(free[:, None] - poles))
    return [_Bending(complex(free[k]), complex(poles[p])) for k, p in zip(modes, chosen, strict=True)]
