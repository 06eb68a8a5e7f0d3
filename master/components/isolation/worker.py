"""The process of an FMU as the master sees it: started, asked, and ended."""

from __future__ import annotations

import json
import os
import socket
import subprocess
import sys
import weakref
from contextlib import suppress
from multiprocessing.connection import Connection, Pipe
from typing import Any

from touchdown.master.common.errors import TouchdownError
from touchdown.master.common.processes.cores import cores
from touchdown.master.common.processes.orphans import search_path
from touchdown.master.common.processes.watched import way_of
from touchdown.master.components.isolation.board import Ask, Board, Word, board_size
from touchdown.master.components.isolation.crossing import CUT_OFF, SPIN, GoneError, Side

HOST = "touchdown.master.components.isolation.host"
_START = "import json, runpy, sys; sys.path[:] = json.loads(sys.argv.pop(1)); " + (
    f"runpy.run_module({HOST!r}, run_name='__main__', alter_sys=False)"
)
UP = 120.0  # s that it may take to come up
CORES = cores()
REAP = 5.0  # s that the end of a process which is gone may take

_running: weakref.WeakSet[Worker] = weakref.WeakSet()


class LostError(Exception):
    """The process does not answer any more; the message says what became of it, after "its FMU"."""

    remedy = ""


class LateError(LostError):
    """It did not answer in time."""

    remedy = "; call_timeout says how long it may take"


class Worker:
    """A process that hosts one FMU."""

    def __init__(self, variables: int, call_timeout: float) -> None:
        self._call_timeout = call_timeout  # s, for each request
        memory = os.memfd_create("touchdown")
        os.ftruncate(memory, board_size(variables))
        self.board = Board(memory, variables)
        ours, theirs = socket.socketpair()
        self._connection, other = Pipe()
        self._side = Side(self.board, ours, master=True)
        self._process = _start(variables, memory, theirs, other)
        os.close(memory)
        theirs.close()
        other.close()
        self._finish = weakref.finalize(self, _end, self._process, ours, self._connection)
        _running.add(self)
        self._wait(UP)

    def ask(self, what: Ask, argument: int = 0, pushed: bool = False) -> None:
        """Ask for something, and wait until it is done.

        Raises TouchdownError where the FMU refuses, and LostError where the process does not answer.
        """
        self._post(what, argument, pushed)
        self._wait(self._call_timeout)

    def call(self, name: str, *arguments: Any, pushed: bool = False) -> None:
        """Have a method of the host called. Raises as `ask` does."""
        self._post(Ask.CALL, 0, pushed)
        with suppress(OSError):  # it is gone, and `_wait` says how
            self._connection.send((name, arguments))
        self._wait(self._call_timeout)

    def end(self) -> None:
        """End the process, whatever it does."""
        self._finish()
        _running.discard(self)

    def _post(self, what: Ask, argument: int, pushed: bool) -> None:
        words = self.board.words
        words[Word.WHAT], words[Word.ARGUMENT], words[Word.PUSHED] = what, argument, pushed
        words[Word.SPIN] = int(1e6 * SPIN) if len(_running) < CORES else 0
        self._side.post()

    def _wait(self, limit: float) -> None:
        try:
            self._side.wait(SPIN if CORES > 1 else 0.0, limit)
        except TimeoutError:
            self.end()
            raise LateError(f"did not answer within {limit:g} s") from None
        except GoneError:
            raise LostError(self._how_it_ended()) from None
        except BaseException:  # what it answers later would be taken for an answer to something else
            self.end()
            raise
        if self.board.words[Word.FAILED]:
            raise TouchdownError(self._connection.recv())

    def _how_it_ended(self) -> str:
        try:
            status = self._process.wait(REAP)
        except subprocess.TimeoutExpired:
            status = CUT_OFF
        finally:
            self.end()
        if status == CUT_OFF:
            return "closed files that are not its own"
        return f"ended its process with status {status}" if status >= 0 else way_of(status)


def _start(variables: int, memory: int, calls: socket.socket, talk: Connection) -> subprocess.Popen[bytes]:
    """Start the host with this process's search path, its output to where errors go."""
    handles = memory, calls.fileno(), talk.fileno()
    return subprocess.Popen(
        [sys.executable, "-c", _START, json.dumps(search_path()), *map(str, (variables, *handles))],
        stdin=subprocess.DEVNULL,
        stdout=2,
        pass_fds=handles,
        start_new_session=True,
    )


def _end(process: subprocess.Popen[bytes], calls: socket.socket, talk: Connection) -> None:
    """End a process and free what is shared with it."""
    process.kill()
    process.wait()
    calls.close()
    talk.close()
