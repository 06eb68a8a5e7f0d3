"""Masters: this project's by its schemes; other tools, each in an environment of its own."""

from __future__ import annotations

import json
import os
import subprocess
import tempfile
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import ClassVar

import environments
import numpy as np
from environments import UnavailableError, interpreter, title

from cosimulated.problems import Motion, Problem, Setting, UnableError
from touchdown.master.common.errors import TouchdownError
from touchdown.master.coupling.observer import EveryStep
from touchdown.master.coupling.simulation import opened, simulate
from touchdown.master.interop.ssp.write import write_ssp

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
            return [setting for step in tried.steps if (setting := self.at(step))]
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


DRIVERS = Path(__file__).parent / "drivers"
READERS = Path(environments.__file__).parent  # of packages
TIMEOUT = 900.0  # s


@dataclass(frozen=True)
class Other:
    """A way of a tool; `options` are those of its driver. It is asked for `most` macro steps at most."""

    own: ClassVar[bool] = False
    tool: str
    way: str = ""
    options: Mapping[str, object] = field(default_factory=dict)
    most: int = 1_000_000

    @property
    def title(self) -> str:
        """As on PyPI, and the way."""
        return f"{title(self.tool)}{self.way and f', {self.way}'}"

    def settings(self, problem: Problem) -> list[Setting]:
        """Macro steps."""
        return [self.at(step) for step in problem.tried.steps]

    def at(self, step: float) -> Setting:
        """A macro step."""
        return Setting(f"{1e3 * step:g} ms", {"macro_step": step}, self.options)

    def run(self, problem: Problem, setting: Setting) -> Motion:
        """The package goes in whole."""
        try:
            python = interpreter(self.tool)
        except UnavailableError as reason:
            raise UnableError(str(reason)) from reason
        with tempfile.TemporaryDirectory(prefix="touchdown_") as folder:
            package, answer = Path(folder, "system.ssp"), Path(folder, "answer.npz")
            scene = problem.scene({**setting.run, "scheme": problem.packed})
            steps = scene.run.duration / scene.run.macro_step
            if steps > self.most:
                raise UnableError(f"{steps:.0f} macro steps; it is slow, and asked for {self.most} at most")
            try:
                write_ssp(scene, package, True)
            except TouchdownError as error:
                raise UnableError(str(error)) from error
            self._follow([python, DRIVERS / f"follow_{self.tool}.py", package, answer], problem, setting)
            found = np.load(answer)
            return Motion(found["rows"], int(found["calls"]))

    def _follow(self, command: list[object], problem: Problem, setting: Setting) -> None:
        """Raises UnableError with the last thing that the tool said where it fails."""
        foreign = {k: v for k, v in os.environ.items() if not k.startswith("PYTHON")}
        try:
            done = subprocess.run(
                [*map(str, command), json.dumps(dict(setting.options)), *problem.watched],
                cwd=Path(str(command[2])).parent,
                env=foreign | {"PYTHONPATH": str(READERS)},
                capture_output=True,
                text=True,
                timeout=TIMEOUT,
                check=False,
            )
        except subprocess.TimeoutExpired:
            raise UnableError(f"not done in {TIMEOUT:g} s") from None
        if done.returncode:
            said = (done.stderr.strip() or done.stdout.strip() or "nothing").splitlines()[-1]
            raise UnableError(f"ends with {done.returncode}: {said[-200:]}")


@dataclass(frozen=True)
class Controlled(Other):
    """libcosim's energy-based step control; its figure is the tolerance of a step's energy, absolute and
    relative, and all else as in `ecco`, which stands in the names of libcosimpy's EccoParams."""

    ecco: Mapping[str, float] = field(default_factory=dict)

    def settings(self, problem: Problem) -> list[Setting]:
        """Tolerances."""
        return [self.to(joules, problem) for joules in problem.tried.joules]

    def to(self, joules: float, problem: Problem) -> Setting:
        """Steps up to the problem's longest."""
        longest = problem.tried.divided
        first = min(self.ecco["step_size"], longest)
        tolerances = {"abs_tolerance": joules, "rel_tolerance": joules}
        ecco = {**self.ecco, **tolerances, "step_size": first, "max_step_size": longest}
        return Setting(f"{joules:g} J", {"macro_step": longest}, {"ecco": ecco, "bonds": problem.bonds})

    def at(self, step: float) -> None:
        """It has none of its own."""

    def run(self, problem: Problem, setting: Setting) -> Motion:
        """By power bonds."""
        if not problem.bonds:
            raise UnableError("its power bonds are of a force and a velocity")
        return super().run(problem, setting)


Master = Own | Other
