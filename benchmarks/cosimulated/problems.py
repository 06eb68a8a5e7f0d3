"""The problems: systems of two FMUs of validation/body.c, and a drop on the project's own FMUs."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import ClassVar

import numpy as np
from drops import FREE, Fall

from touchdown.master.scene.scene import Scene
from touchdown.master.scene.schemes import SCHEMES
from touchdown.validation import bodies

Bond = tuple[tuple[str, str, str], tuple[str, str, str]]  # component, output and input, of both sides


class UnableError(Exception):
    """A master cannot do a case; says why."""


@dataclass(frozen=True)
class Setting:
    """How finely a master is to work: the one figure that a user would turn."""

    label: str  # with its unit
    run: Mapping[str, object]  # [run] of the scene
    options: Mapping[str, object] = field(default_factory=dict)  # of another tool


@dataclass
class Motion:
    """What a run gave."""

    rows: np.ndarray  # (steps, watched): a problem's variables after every step of the master
    calls: int  # doSteps of all FMUs, those that were taken back, too
    ended: str = ""  # why it ended early


@dataclass(frozen=True)
class Tried:
    """What is asked of masters, coarsest first."""

    steps: tuple[float, ...]  # macro steps (s)
    divided: float  # macro step (s) that a tolerance divides
    metres: tuple[float, ...]  # tolerances of a macro step (m)
    joules: tuple[float, ...]  # tolerances of its energy (J)


UNSTOPPED = {"stop_residual": 1e9}  # what makes energy is to be seen


@dataclass(frozen=True)
class Coupled(ABC):
    """Two bodies, one of which gives force. Errors are told at the time that the FMUs have lived."""

    fmu: Path
    duration: float  # s

    title: ClassVar[str]
    giver: ClassVar[str]
    taker: ClassVar[str]
    tried: ClassVar[Tried]
    packed: ClassVar[str] = "jacobi-hold"
    ways: ClassVar[Mapping[str, Mapping[str, object]]] = {
        "hold": {"scheme": "hold", **UNSTOPPED},
        "jacobi-hold": {"scheme": "jacobi-hold", **UNSTOPPED},
        "smooth": {"bonds": "smooth", **UNSTOPPED},
        "contact": {"bonds": "contact", **UNSTOPPED},
        "iterated": {"scheme": "iterated"},
        "halving": {"scheme": "halving"},
    }

    @property
    def watched(self) -> tuple[str, ...]:
        """Motion of both, and the time."""
        motion = (f"{name}.{what}" for name in (self.giver, self.taker) for what in "xv")
        return (*motion, f"{self.giver}.elapsed")

    @property
    def bonds(self) -> tuple[Bond, ...]:
        """The one there is."""
        return (((self.taker, "v", "f_in"), (self.giver, "f", "v2")),)

    @abstractmethod
    def parts(self) -> Mapping[str, bodies.Settings]:
        """The bodies."""

    @abstractmethod
    def exact(self, times: np.ndarray) -> np.ndarray:
        """(x, v) of giver and taker at `times` (s), a row each."""

    @abstractmethod
    def stored(self, states: np.ndarray) -> np.ndarray:
        """Energy (J) of such rows."""

    def scene(self, run: Mapping[str, object]) -> Scene:
        """The system, to be run as [run] of a scene says."""
        return bodies.scene(self.fmu, self.parts(), self.wires(), run={"duration": self.duration, **run})

    def wires(self) -> Sequence[object]:
        """Force there, motion back."""
        a, b = self.giver, self.taker
        return [f"{a}.f", f"{b}.f_in"], [f"{b}.x", f"{a}.x2"], [f"{b}.v", f"{a}.v2"]

    def error(self, motion: Motion) -> float:
        """Of the positions."""
        if motion.ended:
            return float("inf")
        off = motion.rows[:, :4] - self.exact(motion.rows[:, 4])
        return float(np.max(np.abs(off[:, ::2])))

    def energy(self, motion: Motion) -> float | None:
        """What there is at the end beyond what there should be, over what there was."""
        start, end = self.exact(np.array([0.0, motion.rows[-1, 4]]))
        full, due, found = self.stored(np.array([start, end, motion.rows[-1, :4]]))
        return float((found - due) / full)

    def damped(self, step: float) -> Coupled | None:
        """None where nothing damps it."""
        return None

    def rests(self, motion: Motion) -> bool:
        """Whether the energy is less in the run's second half than in its first."""
        first, second = np.array_split(self.stored(motion.rows[:, :4]), 2)
        if motion.ended or not np.all(np.isfinite(second)):
            return False
        return float(np.max(second)) < float(np.max(first))


RATE = 1000.0  # rad/s, at which it would swing on the spring
GRAVITY, HEIGHT = 9.81, 1e-3  # m/s2, m
SPEED = (2.0 * GRAVITY * HEIGHT) ** 0.5  # m/s, at the spring
FALL = SPEED / GRAVITY  # s
CONTACT = (np.pi + 2.0 * np.arctan(GRAVITY / (RATE * SPEED))) / RATE  # s
PERIOD = 2.0 * FALL + CONTACT  # s


@dataclass(frozen=True)
class Bounce(Coupled):
    """A ball of 1 kg that falls by 1 mm, twenty times, on an undamped one-sided spring of 1e6 N/m.

    The ground gives force, the ball takes it.
    """

    duration: float = 20.0 * PERIOD

    title = "Ball on an undamped one-sided spring, 20 bounces; in 1 ms it would swing on it by 1 rad"
    giver, taker = "s1", "s2"
    tried = Tried((1e-3, 3e-4, 1e-4), 1e-3, (1e-6, 1e-8, 1e-10), (1e-2, 1e-3, 1e-4))

    def parts(self) -> Mapping[str, bodies.Settings]:
        """Ground and ball."""
        return bodies.bounce(RATE)

    def exact(self, times: np.ndarray) -> np.ndarray:
        """By pieces: fall, swing, rise."""
        t = np.mod(times, PERIOD)
        swing = RATE * np.clip(t - FALL, 0.0, CONTACT)
        sag = GRAVITY / RATE**2
        pressed = sag * (np.cos(swing) - 1.0) - SPEED / RATE * np.sin(swing)
        leaving = -RATE * sag * np.sin(swing) - SPEED * np.cos(swing)
        up, down = t < FALL, t > FALL + CONTACT
        away = np.where(up, t, t - PERIOD)  # from the highest place
        free = up | down
        x = np.where(free, HEIGHT - 0.5 * GRAVITY * away**2, pressed)
        v = np.where(free, -GRAVITY * away, leaving)
        return np.stack([0.0 * x, 0.0 * v, x, v], axis=1)

    def stored(self, states: np.ndarray) -> np.ndarray:
        """In motion, height and spring."""
        _, _, x, v = states.T
        return 0.5 * v**2 + GRAVITY * x + 0.5 * (RATE * np.minimum(x, 0.0)) ** 2

    def energy(self, motion: Motion) -> float:
        """The largest change there is on the way."""
        change = self.stored(motion.rows[:, :4]) / (GRAVITY * HEIGHT) - 1.0
        return float(change[np.argmax(np.abs(change))])


RISE = 0.1  # m


@dataclass(frozen=True)
class Car(Coupled):
    """A quarter car: 400 and 40 kg, 15 000 N/m and 1000 N s/m between them, 150 000 N/m to a road that
    rises by 0.1 m at t = 0. The chassis gives force, the wheel takes it.
    """

    duration: float = 2.0

    title = "Quarter car over a step of 0.1 m, 2 s"
    giver, taker = "chassis", "wheel"
    tried = Tried(
        (8e-3, 4e-3, 2e-3, 1e-3, 5e-4, 2e-4), 8e-3, (1e-5, 1e-7, 1e-9), (1.0, 0.1, 1e-2, 1e-3, 1e-4)
    )

    def parts(self) -> Mapping[str, bodies.Settings]:
        """Chassis and wheel."""
        return bodies.CAR

    def exact(self, times: np.ndarray) -> np.ndarray:
        """By its eigenvalues."""
        return bodies.exact_car(times)

    def stored(self, states: np.ndarray) -> np.ndarray:
        """In motion and in springs, over what it comes to."""
        chassis, chassis_v, wheel, wheel_v = states.T
        moving = 400.0 * chassis_v**2 + 40.0 * wheel_v**2
        return 0.5 * (moving + 15000.0 * (chassis - wheel) ** 2 + 150000.0 * (wheel - RISE) ** 2)

    def energy(self, motion: Motion) -> float:
        """The largest difference there is on the way: at the end nothing is left."""
        full, *due = self.stored(self.exact(np.append(0.0, motion.rows[:, 4])))
        change = (self.stored(motion.rows[:, :4]) - due) / full
        return float(change[np.argmax(np.abs(change))])


DAMPING = 0.01  # N s/m, where the masses are to come to rest


@dataclass(frozen=True)
class Oscillator(Coupled):
    """Two masses of 1 kg on springs of 10, 100 and 1000 N/m, shot at each other with 100 m/s.

    `damping`: of each of the three springs (N s/m).
    """

    duration: float = 10.0
    damping: float = 0.0

    title = "Two masses on springs, undamped, 10 s"
    giver, taker = "s1", "s2"
    tried = Tried((1e-2, 3e-3, 1e-3), 1e-2, (1e-4, 1e-6, 1e-8), (1e2, 1e1, 1.0))

    def parts(self) -> Mapping[str, bodies.Settings]:
        """The masses."""
        return bodies.oscillator(self.damping)

    def exact(self, times: np.ndarray) -> np.ndarray:
        """By its eigenvalues."""
        return bodies.exact_oscillator(times, self.damping)

    def stored(self, states: np.ndarray) -> np.ndarray:
        """In motion and in springs."""
        return bodies.energy(states)

    def damped(self, step: float) -> Oscillator | None:
        """Over 2000 macro steps, or over 40 s."""
        return replace(self, damping=DAMPING, duration=max(2000.0 * step, 40.0))


@dataclass(frozen=True)
class PositionAlone(Oscillator):
    """The velocity does not come back."""

    title = "The same, only the position comes back"
    tried = Tried((1e-2, 1e-3), 1e-2, (1e-4, 1e-6), ())

    def wires(self) -> Sequence[object]:
        """Without the velocity."""
        return list(super().wires())[:2]

    @property
    def bonds(self) -> tuple[Bond, ...]:
        """No power is exchanged by name."""
        return ()

    def damped(self, step: float) -> None:
        """Not asked again."""


@dataclass(frozen=True)
class VelocityAlone(Oscillator):
    """The position does not come back: the giver integrates the velocity."""

    title = "The same, only the velocity comes back"
    tried = Tried((1e-2, 1e-3), 1e-2, (1e-4, 1e-6), (1e1, 1e-1))

    def parts(self) -> Mapping[str, bodies.Settings]:
        """The giver follows."""
        giver, taker = super().parts().values()
        return {self.giver: {**giver, "follows": 1.0}, self.taker: taker}

    def wires(self) -> Sequence[object]:
        """Without the position."""
        return list(super().wires())[::2]

    def damped(self, step: float) -> None:
        """Not asked again."""


FINE = {"run.macro_step": 5e-7, "run.scheme": "interface"}


@dataclass(frozen=True)
class Drop:
    """The rigid disk on a simplified caged bearing, by four of the project's own FMUs.

    Nothing holds it from t = 0 on: a tool whose first step has no loads runs the same drop, too. Another
    tool gets the FMUs as they lead by one macro step. Its error is that of the journal just after the first
    impact.
    """

    title = "Disk falls onto a touchdown bearing, 9 ms; error of the journal at the end"
    tried = Tried(
        (6e-5, 3e-5, 1.5e-5, 5e-6), 6e-5, (1e-7, 1e-9, 1e-11), (1e-3, 1e-5, 1e-7)
    )  # parts of 9 ms
    bonds: tuple[Bond, ...] = tuple(
        ((body, f"{seat}.v{axis}", f"{seat}.f{axis}"), ("bearing", f"{port}.f{axis}", f"{port}.v{axis}"))
        for body, seat, port in (("rotor", "A", "journal"), ("housing", "seat", "housing"))
        for axis in "xy"
    )
    packed = "jacobi-lead"

    @cached_property
    def fall(self) -> Fall:
        """As other tools' tests have it."""
        return FREE["disk, free"]()

    @property
    def ways(self) -> Mapping[str, Mapping[str, object]]:
        """All schemes."""
        unstopped = {"stop_residual": 1e9}
        return {name: {"scheme": name, **unstopped} for name in SCHEMES}

    @property
    def watched(self) -> tuple[str, ...]:
        """Places and forces."""
        return tuple(self.fall.wanted)

    @cached_property
    def exact(self) -> dict[str, float]:
        """By macro steps of 0.5 us."""
        return Fall(self.fall.scene.set(FINE), self.fall.journals, self.fall.bearings).ours()[0]

    def scene(self, run: Mapping[str, object]) -> Scene:
        """The drop, to be run as [run] of a scene says."""
        return self.fall.scene.set({f"run.{key}": value for key, value in run.items()})

    def error(self, motion: Motion) -> float:
        """Of the journal, at the end."""
        if motion.ended:
            return float("inf")
        found = dict(zip(self.watched, motion.rows[-1], strict=True))
        return 1e-6 * self.fall.error(found, self.exact).journal

    def energy(self, motion: Motion) -> None:
        """The FMUs do not tell it alone."""

    def damped(self, step: float) -> None:
        """Nothing comes to rest in 9 ms."""

    def rests(self, motion: Motion) -> bool:
        """Never asked."""
        raise NotImplementedError


Problem = Coupled | Drop
