"""Processes that run foreign code: they are watched, and end with the process that started them.

Foreign code may end the process it runs in, with any status, before anything was written; no handler of
that process outlives `_exit`. So the command splits before it loads such code: the copy goes on, and the
process that the shell started waits for it and passes its status on, which is 0 only where the copy said so
at its end.
"""

from __future__ import annotations

import math
import os
import signal
import sys
import threading
import time as clock
from contextlib import suppress
from typing import NoReturn

from ...modelkit.kernel.cache_folder import leave
from .errors import STOPPED
from .pool import die_with_parent, way_of

_PASSED_ON = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT)
_BY_KERNEL = 0x80  # si_code: from the terminal, which reaches the copy, too

GRACE_S = 60.0  # in which what runs may end in order: kernels that are being compiled take half of it

_allowed = False  # whether this process is a command's, which may split
_report: int | None = None  # file that the copy writes its status to


def allow_watching() -> None:
    """Let this process split when `watch` is called; a user's script must not."""
    global _allowed
    _allowed = True


def watch(what: str) -> None:
    """Go on in a copy of this process, which this one watches; `what` is blamed where it ends untimely.

    Does nothing in a copy, where it was not allowed, or beside other threads.
    """
    global _allowed, _report
    if not _allowed or threading.active_count() > 1:
        return
    _allowed = False
    sys.stdout.flush()
    sys.stderr.flush()
    read, write = os.pipe()
    parent = os.getpid()
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {*_PASSED_ON, signal.SIGCHLD})
    copy = os.fork()
    if copy:
        os.close(write)
        _stay_behind(copy, read, what)
    os.close(read)
    die_with_parent(parent)
    signal.pthread_sigmask(signal.SIG_SETMASK, before)
    _report = write


def end(status: int) -> int:
    """The exit status of the command; in a copy, report it and end, whatever libraries do at their end."""
    if _report is None:
        return status
    for stream in (sys.stdout, sys.stderr):
        with suppress(OSError):  # nobody reads it any more
            stream.flush()
    with suppress(OSError):  # nobody waits any more
        os.write(_report, bytes([status]))
    leave()
    os._exit(status)


def _next_signal(deadline: float) -> signal.struct_siginfo | None:
    """The next signal that the watching process waits for; None: there was none until the deadline (s)."""
    awaited = {*_PASSED_ON, signal.SIGCHLD}
    if math.isinf(deadline):
        return signal.sigwaitinfo(awaited)
    return signal.sigtimedwait(awaited, max(deadline - clock.monotonic(), 0.0))


def _stay_behind(copy: int, report: int, what: str) -> NoReturn:
    """Wait for the copy, pass signals on to it, and end as it did.

    One that was told to end, and hangs in others' code, which no handler in Python interrupts, is ended by
    SIGKILL after GRACE_S.
    """
    deadline = math.inf
    while True:
        got = _next_signal(deadline)
        if got is None:
            os.kill(copy, signal.SIGKILL)
            sys.stderr.write(f"touchdown: the process did not end within {GRACE_S:g} s of being told to\n")
            deadline = math.inf
        elif got.si_signo != signal.SIGCHLD:
            if got.si_code != _BY_KERNEL:
                os.kill(copy, got.si_signo)
            if got.si_signo != signal.SIGINT:  # Ctrl-C may be repeated by who sent it
                deadline = min(deadline, clock.monotonic() + GRACE_S)
        ended, how = os.waitpid(copy, os.WNOHANG)
        if ended:
            break
    leave()
    os.set_blocking(report, False)  # a process that the FMU started may hold the other end
    report_byte = b""
    with suppress(BlockingIOError):
        report_byte = os.read(report, 1)
    if report_byte:
        os._exit(report_byte[0])
    code = os.waitstatus_to_exitcode(how)
    sys.stderr.write(f"touchdown: the process {way_of(code)} before its work was done; {what}\n")
    sys.stderr.flush()
    os._exit(128 - code if code < 0 else STOPPED)
