"""A component that is an FMU of others': what it does to the process is undone, what it gives checked."""

from __future__ import annotations

import os
from collections.abc import Callable, Generator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import replace
from pathlib import Path

import numpy as np

from ..common.errors import TouchdownError
from .component import ByFunctions, Call, InMemory
from .description import fmi_version
from .fmu import FmuComponent, LoadedFmu, ignore_call
from .fmu3 import Fmu3Component


class _Foreign(LoadedFmu):
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
        on_call: Callable[[str], object] = ignore_call,
    ) -> None:
        self._exchanged: Sequence[str] = ()
        self._stepped_to = 0.0  # s
        self._home = os.open(".", os.O_RDONLY)  # a path would lead nowhere where the folder was removed
        try:
            with self._at_home():
                super().__init__(name, path, cache, origin, on_call)
        except BaseException:
            self._leave_home()
            raise

    def set(self, values: Mapping[str, float]) -> None:
        with self._at_home():
            super().set(values)

    def bind(self, inputs: Sequence[str], outputs: np.ndarray, names: Sequence[str]) -> None:
        super().bind(inputs, outputs, names)
        self._exchanged = names

    def enter(self, start_time: float) -> None:
        with self._at_home():
            super().enter(start_time)

    def exit(self) -> None:
        with self._at_home():
            super().exit()

    def step(self, time: float, step: float) -> None:
        super().step(time, step)
        self._stepped_to = time + step

    def pull(self) -> None:
        super().pull()
        # the sum tells for less; during initialisation outputs may lack what they follow from
        if self._stepping and not np.isfinite(self.outputs.sum()):
            self._refuse_what_is_no_number()

    def by_address(self) -> InMemory | ByFunctions | None:
        found = super().by_address()
        return replace(found, checked=True, any_thread=False) if isinstance(found, ByFunctions) else found

    def refuse(self, call: Call, status: int, time: float, step: float) -> None:
        self._stepped_to = time + step
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
            for name, value in zip(self._exchanged, self.outputs, strict=True)
            if not np.isfinite(value)
        ]
        if wrong:
            self._stepping = False
            raise TouchdownError(
                f"component {self.name}: its FMU gives {', '.join(wrong)} at t = {self._stepped_to:.9g} s"
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


class ForeignFmu(_Foreign, FmuComponent):
    """One of FMI 2.0."""


class ForeignFmu3(_Foreign, Fmu3Component):
    """One of FMI 3.0."""


def foreign_fmu(
    name: str, path: Path, cache: Path, origin: str = "", on_call: Callable[[str], object] = ignore_call
) -> LoadedFmu:
    """The FMU at `path`, of whatever version. Raises TouchdownError where it cannot be loaded."""
    kind = ForeignFmu3 if fmi_version(path, cache).startswith("3.") else ForeignFmu
    return kind(name, path, cache, origin, on_call)
