"""A component that is an FMU in a process of its own.

A macro step crosses once: inputs are left on the board until something is asked for, and the outputs come
with the step. An FMU that ends its process, crashes or hangs is a TouchdownError like any other failure.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from itertools import count
from pathlib import Path
from typing import Any

import numpy as np

from touchdown.master.common.errors import TouchdownError
from touchdown.master.components.fmu import CALLS, ArchivedFmu
from touchdown.master.components.fmu3 import CALLS as CALLS_3
from touchdown.master.components.isolation.board import Ask, Word
from touchdown.master.components.isolation.worker import LostError, Worker
from touchdown.master.scene.run_spec import CALL_TIMEOUT


class IsolatedFmu(ArchivedFmu):
    """An FMU that is stepped in a process of its own; `call_timeout` (s) is what each call may take."""

    def __init__(
        self, name: str, path: Path, cache: Path, origin: str = "", call_timeout: float = CALL_TIMEOUT
    ) -> None:
        super().__init__(name, path, cache, origin)
        self._call_timeout = call_timeout
        self._time = 0.0  # s, of the last step's beginning
        self._lost = ""  # what became of the process
        self._pushed = False  # whether inputs wait on the board
        self._fresh = False  # whether the board has the outputs of now
        self._readers: dict[tuple[str, ...], int] = {}
        self._numbers = count()
        try:
            self._worker = Worker(len(self.variables), call_timeout)
        except LostError as error:
            raise TouchdownError(f"cannot start a process for {path} as {name}: it {error}") from None
        self._in, self._out = self._worker.board.inputs[:0], self._worker.board.outputs[:0]
        try:
            self._call("load", name, str(path.absolute()), str(cache.absolute()), origin)
        except TouchdownError as error:
            self._worker.end()
            raise TouchdownError(self._loading(str(error))) from None

    def second(self) -> IsolatedFmu:
        name = f"{self.name} (witness)"
        second = IsolatedFmu(name, self.path, self._cache, self._own_origin, self._call_timeout)
        second.rename(self._own)
        return second

    # -- values --------------------------------------------------------------------------------------

    def set(self, values: Mapping[str, float]) -> None:
        self._call("set", {self.own_name(name): value for name, value in values.items()})

    def bind(self, inputs: Sequence[str], outputs: np.ndarray, names: Sequence[str]) -> None:
        self.inputs = np.zeros(len(inputs))
        self.outputs = outputs
        self._in = self._worker.board.inputs[: len(inputs)]
        self._out = self._worker.board.outputs[: len(names)]
        self._call("bind", self._own_names(inputs), self._own_names(names))

    def push(self) -> None:
        self._in[:] = self.inputs
        self._pushed, self._fresh = True, False

    def pull(self) -> None:
        if not self._fresh:
            self._ask(Ask.PULL)
            self._fresh = True
        self.outputs[:] = self._out

    def reader(self, names: Sequence[str]) -> Callable[[], np.ndarray]:
        known = tuple(dict.fromkeys(names))
        if known not in self._readers:
            self._call("reader", self._own_names(known))
            self._readers[known] = len(self._readers)
        number, board = self._readers[known], self._worker.board.read[: len(known)]
        places = np.array([known.index(name) for name in names], dtype=np.intp)
        values = np.zeros(len(names))

        def fetch() -> np.ndarray:
            self._ask(Ask.FETCH, number)
            values[:] = board[places]
            return values

        return fetch

    def _own_names(self, names: Sequence[str]) -> list[str]:
        return [self.own_name(self.variable(name).name) for name in names]

    # -- life cycle ----------------------------------------------------------------------------------

    def enter(self, start_time: float) -> None:
        self._time = start_time
        self._call("enter", start_time)

    def exit(self) -> None:
        self._call("exit")

    def step(self, time: float, step: float) -> None:
        self._time = time
        floats = self._worker.board.floats
        floats[Word.TIME], floats[Word.STEP] = time, step
        self._ask(Ask.STEP)
        self._fresh = True

    def save(self) -> object:
        number = next(self._numbers)
        self._ask(Ask.SAVE, number)
        return number

    def restore(self, state: object) -> None:
        assert isinstance(state, int)
        self._ask(Ask.RESTORE, state)
        self._fresh = False

    def release(self, state: object) -> None:
        assert isinstance(state, int)
        if not self._lost:
            self._ask(Ask.RELEASE, state)

    def close(self) -> str:
        if self._lost:
            return ""
        try:
            self._call("close")
        except TouchdownError as error:
            return str(error)
        finally:
            self._lost = self._lost or "is closed"
            self._worker.end()
        return ""

    # -- crossing ------------------------------------------------------------------------------------

    def _ask(self, what: Ask, argument: int = 0) -> None:
        self._attempt(self._worker.ask, what, argument)

    def _call(self, name: str, *arguments: Any) -> None:
        self._attempt(self._worker.call, name, *arguments)
        self._fresh = False

    def _attempt(self, request: Callable[..., None], *arguments: Any) -> None:
        """Make a request, inputs that wait first. Raises TouchdownError where it fails."""
        if self._lost:
            raise TouchdownError(self._sentence())
        pushed, self._pushed = self._pushed, False
        try:
            request(*arguments, pushed=pushed)
        except LostError as error:
            calls = CALLS_3 if self.description.fmiVersion.startswith("3.") else CALLS
            call = calls[self._worker.board.words[Word.AT]]
            self._lost = f"{error} in {call} at t = {self._time:.9g} s{error.remedy}"
            raise TouchdownError(self._sentence()) from None
        except KeyboardInterrupt:
            self._lost = "was interrupted"
            raise

    def _sentence(self) -> str:
        return f"component {self.name}: its FMU {self._lost}"

    def _loading(self, said: str) -> str:
        """What the host said of loading, or, where it did not come to that, what became of it."""
        if not self._lost:
            return said
        return f"cannot load {self.path} as {self.name}: its FMU {self._lost}"
