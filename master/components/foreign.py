"""A component that is an FMU of others': what it does to the process is undone, what it gives checked."""

from __future__ import annotations

import os
from collections.abc import Callable, Generator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import replace
from pathlib import Path

import numpy as np

from touchdown.master.common.errors import TouchdownError
from touchdown.master.components.component import ByFunctions, Call
from touchdown.master.components.fmu import FmuComponent, untold


class ForeignFmu(FmuComponent):
    """An FMU of others' that is stepped in this process.

    The working directory is put back after every call but those of a step, and at the end. Raises
    TouchdownError where an exchanged output is no finite number after initialisation.
    """

    def __init__(
        self,
        name: str,
        path: Path,
        cache: Path,
        origin: str = "",
        told: Callable[[str], object] = untold,
    ) -> None:
        self._given: Sequence[str] = ()
        self._reached = 0.0  # s
        self._home = os.open(".", os.O_RDONLY)  # a path would lead nowhere where the folder was removed
        try:
            with self._at_home():
                super().__init__(name, path, cache, origin, told)
        except BaseException:
            self._leave_home()
            raise

    def set(self, values: Mapping[str, float]) -> None:
        with self._at_home():
            super().set(values)

    def bind(self, inputs: Sequence[str], outputs: np.ndarray, names: Sequence[str]) -> None:
        super().bind(inputs, outputs, names)
        self._given = names

    def enter(self, start_time: float) -> None:
        with self._at_home():
            super().enter(start_time)

    def exit(self) -> None:
        with self._at_home():
            super().exit()

    def step(self, time: float, step: float) -> None:
        super().step(time, step)
        self._reached = time + step

    def pull(self) -> None:
        super().pull()
        # the sum tells for less; during initialisation outputs may lack what they follow from
        if self._stepping and not np.isfinite(self.outputs.sum()):
            self._refuse_what_is_no_number()

    def by_address(self) -> ByFunctions:
        return replace(super().by_address(), checked=True)

    def refuse(self, call: Call, status: int, time: float, step: float) -> None:
        self._reached = time + step
        super().refuse(call, status, time, step)
        self._refuse_what_is_no_number()  # the FMU itself had nothing against going on

    def close(self) -> str:
        if not self._open:
            return ""
        try:
            with self._at_home():
                return super().close()
        finally:
            self._leave_home()

    def _refuse_what_is_no_number(self) -> None:
        wrong = [
            f"{name} = {value}"
            for name, value in zip(self._given, self.outputs, strict=True)
            if not np.isfinite(value)
        ]
        if wrong:
            self._stepping = False
            raise TouchdownError(
                f"component {self.name}: its FMU gives {', '.join(wrong)} at t = {self._reached:.9g} s"
            )

    @contextmanager
    def _at_home(self) -> Generator[None]:
        try:
            yield
        finally:
            with suppress(OSError):  # an FMU may close files that are not its own
                os.fchdir(self._home)

    def _leave_home(self) -> None:
        with suppress(OSError):
            os.close(self._home)
