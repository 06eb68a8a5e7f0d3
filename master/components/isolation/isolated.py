"""A component that is an FMU in a separate process.

A macro step crosses once: inputs stay on the board until the next request, and the outputs come
with the step. An FMU that ends its process, crashes or hangs is a TouchdownError like any other failure.
"""

from __future__ import annotations

import os
import signal
import socket
import subprocess
import weakref
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from itertools import count
from multiprocessing.connection import Connection, Pipe
from pathlib import Path
from typing import Any

import numpy as np

from ...common.errors import TouchdownError
from ...common.pool import cores, ending_of, start_module
from ...scene.run_spec import CALL_TIMEOUT
from ..component import Setting
from ..fmu import ArchivedFmu
from .shared_memory import CUT_OFF, SPIN_S, Ask, Board, CrossingSide, GoneError, Word, board_size

HOST = "touchdown.master.components.isolation.fmu_process"
START_TIMEOUT_S = 120.0  # s that it may take to come up
CORES = cores()
REAP_TIMEOUT_S = 5.0  # s that the end of a process which is gone may take

_running: weakref.WeakSet[_Worker] = weakref.WeakSet()


class _LostError(Exception):
    """The process does not answer any more; the message says what happened, after "its FMU"."""

    remedy = ""


class _LateError(_LostError):
    """It did not answer in time."""

    remedy = "; call_timeout says how long it may take"


class _Worker:
    """A process that hosts one FMU."""

    def __init__(self, variables: int, call_timeout: float) -> None:
        self._call_timeout = call_timeout  # s, for each request
        memory = os.memfd_create("touchdown")
        os.ftruncate(memory, board_size(variables))
        self.board = Board(memory, variables)
        ours, theirs = socket.socketpair()
        self._connection, other = Pipe()
        handles = memory, theirs.fileno(), other.fileno()
        self._process = start_module(
            *(HOST, variables, *handles),
            stdin=subprocess.DEVNULL,
            stdout=2,  # where errors go
            pass_fds=handles,
            start_new_session=True,
        )
        self._side = CrossingSide(self.board, ours, self._process)
        os.close(memory)
        theirs.close()
        other.close()
        self._finish = weakref.finalize(self, _end, self._process, ours, self._connection)
        _running.add(self)
        self._wait(START_TIMEOUT_S)

    def ask(self, what: Ask, argument: int = 0, pushed: bool = False) -> None:
        """Send a request, and wait until it is done.

        Raises TouchdownError where the FMU refuses, and LostError where the process does not answer.
        """
        self._post(what, argument, pushed)
        self._wait(self._call_timeout)

    def call(self, name: str, *arguments: Any, pushed: bool = False) -> None:
        """Call a method of the host. Raises as `ask` does."""
        self._post(Ask.CALL, 0, pushed)
        with suppress(OSError):  # it is gone, and `_wait` says how
            self._connection.send((name, arguments))
        self._wait(self._call_timeout)

    def answer(self) -> Any:
        """The result of the method that was called last."""
        return self._connection.recv()

    def end(self) -> None:
        """End the process at once."""
        self._finish()
        _running.discard(self)

    def _post(self, what: Ask, argument: int, pushed: bool) -> None:
        words = self.board.words
        words[Word.WHAT], words[Word.ARGUMENT], words[Word.PUSHED] = what, argument, pushed
        words[Word.SPIN] = int(1e6 * SPIN_S) if len(_running) < CORES else 0
        self._side.post()

    def _wait(self, limit: float) -> None:
        try:
            self._side.wait(SPIN_S if CORES > 1 else 0.0, limit)
        except TimeoutError:
            self.end()
            raise _LateError(f"did not answer within {limit:g} s") from None
        except GoneError:
            raise _LostError(self._how_it_ended()) from None
        except BaseException:  # a late reply would pass for the reply to another request
            self.end()
            raise
        if self.board.words[Word.FAILED]:
            raise TouchdownError(self._connection.recv())

    def _how_it_ended(self) -> str:
        try:
            status = self._process.wait(REAP_TIMEOUT_S)
        except subprocess.TimeoutExpired:
            status = CUT_OFF
        finally:
            self.end()
        if status == CUT_OFF:
            return "closed files that it did not open"
        return f"ended its process with status {status}" if status >= 0 else ending_of(status)


def _end(process: subprocess.Popen[bytes], calls: socket.socket, talk: Connection) -> None:
    """End a process with all that it started, and free the memory shared with it."""
    with suppress(ProcessLookupError):
        os.killpg(process.pid, signal.SIGKILL)  # it leads a session, so that the group is its own
    process.wait()
    calls.close()
    talk.close()


class IsolatedFmu(ArchivedFmu):
    """An FMU that is stepped in a separate process; each call may take `call_timeout` (s)."""

    def __init__(self, name: str, path: Path, cache: Path, call_timeout: float = CALL_TIMEOUT) -> None:
        if not hasattr(os, "memfd_create"):
            raise TouchdownError(
                f"{path} cannot run in a process of its own on this system; isolate = false in "
                f"[components.{name}] trusts it, and runs it in this one"
            )
        super().__init__(name, path, cache, "")
        self._call_timeout = call_timeout
        self._time = 0.0  # s, of the last step's beginning
        self._lost = ""  # how the process ended
        self._warned = ""  # what the FMU warned of, once it is closed
        self._pushed = False  # whether inputs wait on the board
        self._fresh = False  # whether the board has the outputs of now
        self._readers: dict[tuple[str, ...], int] = {}
        self._numbers = count()
        try:
            self._worker = _Worker(len(self.variables), call_timeout)
        except _LostError as error:
            raise TouchdownError(f"cannot start a process for {path} as {name}: it {error}") from None
        self._in, self._out = self._worker.board.inputs[:0], self._worker.board.outputs[:0]
        try:
            self._call("load", name, str(path.absolute()), str(cache.absolute()))
        except TouchdownError as error:
            self._worker.end()
            lost = f"cannot load {self.path} as {self.name}: its FMU {self._lost}" if self._lost else ""
            raise TouchdownError(lost or str(error)) from None

    def second(self) -> IsolatedFmu:
        second = IsolatedFmu(f"{self.name} (witness)", self.path, self._cache, self._call_timeout)
        second.rename(self._own)
        return second

    # -- values --------------------------------------------------------------------------------------

    def set(self, values: Mapping[str, Setting]) -> None:
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
        place = {name: i for i, name in enumerate(known)}
        places = np.array([place[name] for name in names], dtype=np.intp)
        values = np.zeros(len(names))

        def fetch() -> np.ndarray:
            self._ask(Ask.FETCH, number)
            values[:] = board[places]
            return values

        return fetch

    def _own_names(self, names: Sequence[str]) -> list[str]:
        return [self.own_name(self.variable(name).name) for name in names]

    # -- life cycle ----------------------------------------------------------------------------------

    def enter(self, start_time: float, stop_time: float | None = None) -> None:
        self._time = start_time
        self._call("enter", start_time, stop_time)

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

    def to_bytes(self) -> bytes:
        self._call("to_bytes")
        return bytes(self._worker.answer())

    def from_bytes(self, state: bytes, tuned: Mapping[str, Setting]) -> None:
        self._call("from_bytes", state, {self.own_name(name): value for name, value in tuned.items()})

    def close(self) -> str:
        if self._lost:
            return ""
        try:
            self._call("close")
        except TouchdownError as error:
            return str(error)
        finally:
            self._warned = self.warned()
            self._lost = self._lost or "is closed"
            self._worker.end()
        return ""

    def warned(self) -> str:
        if not self._lost:
            with suppress(TouchdownError):
                self._call("warned")
                return str(self._worker.answer())
        return self._warned

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
        except _LostError as error:
            self._lost = f"{error} in {self._worker.board.call} at t = {self._time:.9g} s{error.remedy}"
            raise TouchdownError(self._sentence()) from None
        except KeyboardInterrupt:
            self._lost = "was interrupted"
            raise

    def _sentence(self) -> str:
        return f"component {self.name}: its FMU {self._lost}"
