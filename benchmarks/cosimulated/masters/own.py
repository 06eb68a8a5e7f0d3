"""This project's master, by its schemes."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from cosimulated.runs import Motion, Problem, Setting, UnableError
from touchdown.master.common.errors import TouchdownError
from touchdown.master.coupling.observer import EveryStep
from touchdown.master.coupling.simulation import opened, simulate

DIVIDING = "halving"


@dataclass(frozen=True)
class Own:
    """A way, as [run] of a scene has it."""

    own: ClassVar[bool] = True
    way: str
    run_table: Mapping[str, object]

    @property
    def title(self) -> str:
        """The way alone."""
        return self.way

    def settings(self, problem: Problem) -> list[Setting]:
        """Macro steps, or tolerances."""
        tried = problem.tried
        if self.run_table.get("scheme") != DIVIDING:
            return [self.at(step) for step in tried.steps if self.at(step)]
        longest = {"macro_step": tried.divided}
        return [Setting(f"{metres:g} m", {**longest, "tolerance": metres}) for metres in tried.metres]

    def at(self, step: float) -> Setting | None:
        """None for what is divided to a tolerance."""
        if self.run_table.get("scheme") == DIVIDING:
            return None
        return Setting(f"{1e3 * step:g} ms", {"macro_step": step})

    def run(self, problem: Problem, setting: Setting) -> Motion:
        """Counts all steps, also those that are taken back."""
        scene = problem.scene({**setting.run, **self.run_table})
        rows: list[list[float]] = []
        calls = 0
        try:
            with opened(scene) as system:
                for component in system.components.values():

                    def counted(
                        time: float, step: float, take: Callable[[float, float], None] = component.step
                    ) -> None:
                        nonlocal calls
                        calls += 1
                        take(time, step)

                    component.step = counted  # type: ignore[method-assign]
                names = problem.watched
                watch = EveryStep(lambda now: rows.append([system.value(name) for name in names]))
                outcome = simulate(scene, system, observers=[watch])
        except TouchdownError as error:
            raise UnableError(str(error)) from error
        return Motion(np.array(rows), calls, outcome.reason)
