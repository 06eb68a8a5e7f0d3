"""What goes between problems and masters: the run that is asked for, and the motion that comes back."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np

from touchdown.master.scene.scene import Scene

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


class Problem(Protocol):
    """A system to run, and how far a motion is from what it should be."""

    @property
    def title(self) -> str:
        """What a table says above it."""
        ...

    @property
    def watched(self) -> tuple[str, ...]:
        """COMPONENT.VARIABLE that a motion's rows have."""
        ...

    @property
    def bonds(self) -> tuple[Bond, ...]:
        """For masters that must be told; none where they cannot be."""
        ...

    @property
    def tried(self) -> Tried:
        """What masters are asked for."""
        ...

    @property
    def packed(self) -> str:
        """Scheme that the FMUs are set to for tools that step all of them at once."""
        ...

    @property
    def ways(self) -> Mapping[str, Mapping[str, object]]:
        """Ways of this project's master, as [run] of a scene has them, by title."""
        ...

    def scene(self, run: Mapping[str, object]) -> Scene:
        """The system, to be run as [run] of a scene says."""
        ...

    def error(self, motion: Motion) -> float:
        """Largest (m); infinite where the run ended early."""
        ...

    def energy(self, motion: Motion) -> float | None:
        """Made over what there was; None where variables do not tell it."""
        ...

    def damped(self, step: float) -> Problem | None:
        """The same as one that comes to rest, run long enough to see it at macro steps of `step` (s)."""
        ...

    def rests(self, motion: Motion) -> bool:
        """Whether it does."""
        ...


class Master(Protocol):
    """One way of one tool."""

    @property
    def title(self) -> str:
        """The tool, and what is chosen of it."""
        ...

    @property
    def own(self) -> bool:
        """Whether it is this project's."""
        ...

    def settings(self, problem: Problem) -> list[Setting]:
        """What is tried, coarsest first."""
        ...

    def at(self, step: float) -> Setting | None:
        """To work at macro steps of `step` (s); None for what has a tolerance instead."""
        ...

    def run(self, problem: Problem, setting: Setting) -> Motion:
        """Raises UnableError where it cannot."""
        ...
