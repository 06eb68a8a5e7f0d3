"""The process of an FMU: it answers the master's requests on the board, and ends with the master."""

from __future__ import annotations

import os
import signal
import socket
import sys
from collections.abc import Callable, Sequence
from multiprocessing.connection import Connection
from pathlib import Path

import numpy as np

from ...common.errors import TouchdownError
from ...common.pool import die_with_parent
from ..component import Setting
from ..fmu import LoadedFmu
from ..fmu3 import load_fmu
from .shared_memory import CUT_OFF, Ask, Board, CrossingSide, GoneError, Word, padded

NO_TIMEOUT_S = 1e9  # s


class _Host:
    """The FMU, its readers and its saved states."""

    def __init__(self, board: Board) -> None:
        self._words, self._floats, self._board = board.words, board.floats, board
        self._fmu: LoadedFmu | None = None
        self._setting = self._stepping = self._reading = b""  # names of calls, padded
        self._inputs = board.inputs[:0]
        self._fetches: list[Callable[[], np.ndarray]] = []
        self._states: dict[int, object] = {}

    # -- asked for by name --------------------------------------------------------------------------

    def load(self, name: str, path: str, cache: str) -> None:
        """Load the FMU at `path`."""
        self._fmu = load_fmu(name, Path(path), Path(cache), on_call=self._note)
        self._setting, self._stepping, self._reading = map(padded, self._fmu.EXCHANGE)

    def set(self, values: dict[str, Setting]) -> None:
        """Set what can be set before initialisation."""
        self.fmu.set(values)

    def bind(self, inputs: Sequence[str], outputs: Sequence[str]) -> None:
        """Exchange these through the board."""
        self._inputs = self._board.inputs[: len(inputs)]
        self.fmu.bind(inputs, self._board.outputs[: len(outputs)], outputs)

    def reader(self, names: Sequence[str]) -> None:
        """Be ready to read these; readers are numbered in their order."""
        self._fetches.append(self.fmu.reader(names))

    def enter(self, start_time: float, stop_time: float | None) -> None:
        """Enter initialisation."""
        self.fmu.enter(start_time, stop_time)

    def exit(self) -> None:
        """Leave it."""
        self.fmu.exit()

    def to_bytes(self) -> bytes:
        """The FMU's state."""
        return self.fmu.to_bytes()

    def from_bytes(self, state: bytes, tuned: dict[str, Setting]) -> None:
        """Go on from such a one."""
        self.fmu.from_bytes(state, tuned)

    def close(self) -> None:
        """Free the FMU."""
        problem = self.fmu.close()
        if problem:
            raise TouchdownError(problem)

    def warned(self) -> str:
        """A line on the warnings of the FMU."""
        return self.fmu.warned()

    # -- asked for by number ------------------------------------------------------------------------

    def answer(self, connection: Connection) -> None:
        """Answer the request on the board. Raises TouchdownError where the FMU refuses."""
        words = self._words
        if words[Word.PUSHED]:
            self._board.call_bytes[:] = self._setting
            self.fmu.inputs[:] = self._inputs
            self.fmu.push()
        what, argument = words[Word.WHAT], words[Word.ARGUMENT]
        if what == Ask.STEP:
            self._board.call_bytes[:] = self._stepping
            self.fmu.step(self._floats[Word.TIME], self._floats[Word.STEP])
            self._board.call_bytes[:] = self._reading
            self.fmu.pull()
        elif what == Ask.CALL:
            name, arguments = connection.recv()
            said = getattr(self, name)(*arguments)
            if said is not None:
                connection.send(said)
        elif what == Ask.PULL:
            self._board.call_bytes[:] = self._reading
            self.fmu.pull()
        elif what == Ask.FETCH:
            self._board.call_bytes[:] = self._reading
            values = self._fetches[argument]()
            self._board.read[: len(values)] = values
        elif what == Ask.SAVE:
            self._states[argument] = self.fmu.save()
        elif what == Ask.RESTORE:
            self.fmu.restore(self._states[argument])
        elif what == Ask.RELEASE:
            self.fmu.release(self._states.pop(argument))

    @property
    def fmu(self) -> LoadedFmu:
        """The FMU, once it is loaded."""
        assert self._fmu is not None
        return self._fmu

    def _note(self, call: str) -> None:
        self._board.call_bytes[:] = padded(call)


def _main() -> None:
    """Serve the process that started this one: `... VARIABLES MEMORY CALLS TALK`, three of them files."""
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT):
        signal.signal(number, signal.SIG_IGN)  # the master ends in order, and this process with it
    die_with_parent(os.getppid())
    variables, memory, calls, talk = map(int, sys.argv[1:])
    board = Board(memory, variables)
    status = 0
    try:
        with Connection(talk) as connection, socket.socket(fileno=calls) as wake:
            _serve(board, CrossingSide(board, wake), connection)
    except (OSError, EOFError):
        status = CUT_OFF
    os._exit(status)  # skips what an FMU's library would do at the end of the process


def _serve(board: Board, side: CrossingSide, connection: Connection) -> None:
    """Answer requests until the master is gone. The first reply says that this process is up."""
    host, words = _Host(board), board.words
    side.post()
    while True:
        try:
            side.wait(1e-6 * words[Word.SPIN], NO_TIMEOUT_S)
        except GoneError:
            return
        try:
            host.answer(connection)
            words[Word.FAILED] = 0
        except TouchdownError as error:
            words[Word.FAILED] = 1
            connection.send(str(error))
        side.post()


if __name__ == "__main__":
    _main()
