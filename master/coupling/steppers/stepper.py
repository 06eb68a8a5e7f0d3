"""What every sequence is: something that takes a whole system through a macro step."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from typing import ClassVar

from touchdown.master.coupling.bonds.crossing import Crossing
from touchdown.master.coupling.system import System
from touchdown.master.scene.run_spec import RunSpec


class Stepper(ABC):
    """Steps an initialised system: a sequence of calls to its components.

    One of your own is a subclass of this, or of one of the project's; `register_scheme` gives it a name.

    >>> from touchdown.master.coupling.steppers.gauss_seidel import GaussSeidel
    >>> class Counting(GaussSeidel):
    ...     count = 0
    ...     def step(self, number, time, step):
    ...         super().step(number, time, step)
    ...         self.count += 1
    ...     @property
    ...     def figures(self):
    ...         return {"steps_counted": self.count}
    >>> scheme = touchdown.Scheme(
    ...     name="counting", title="interface, steps counted", order=3, slopes=True, modes=True,
    ...     error_order=3, bears=1.0, sequence="counting",
    ... )
    >>> touchdown.register_scheme(scheme, Counting)
    >>> scene = touchdown.load("disk-caged-simplified").set({"run.duration": "1 ms"})
    >>> touchdown.run(scene.set({"run.scheme": "counting"}), in_process=True).summary["steps_counted"]
    60
    """

    in_one: ClassVar[bool] = False  # whether each component takes a macro step once, and in one
    any_step: ClassVar[bool] = False  # whether its steps may be of another length than those before
    any_moment: ClassVar[bool] = False  # whether they may be so without being told ahead (`expect`)

    def __init__(self, system: System, run: RunSpec) -> None:
        self.system = system
        self.run = run

    @abstractmethod
    def step(self, number: int, time: float, step: float) -> None:
        """Take macro step `number` (from 0), from `time` by `step` (s).

        Raises TouchdownError where a component, or the coupling, cannot go on. One of your own calls, for
        each name in self.system.order, self.system.feed(name), then step(time, step) and pull() of
        self.system.components[name]; or it extends a step of the project's, such as GaussSeidel's.
        """
        raise NotImplementedError(f"{type(self).__name__} must say how it steps")

    def expect(self, step: float) -> None:  # noqa: B027 - most have nothing to do
        """The steps to come are of `step` (s)."""

    def follow(self) -> None:  # noqa: B027 - most have nothing to do
        """Components were retired: find what is used where it now stands."""

    @property
    def crossings(self) -> Sequence[Crossing]:
        """The bonds that it steps as such."""
        return ()

    def memory(self) -> object:
        """What it knows of steps that are over, for `recall`; None: nothing."""
        return None

    def recall(self, memory: object) -> None:  # noqa: B027 - most know nothing
        """Go back to what it knew."""

    @property
    def figures(self) -> dict[str, float]:
        """What it has to say of itself for the summary, named with units."""
        return {}
