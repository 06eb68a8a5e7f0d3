"""Processes that do not outlive the one that started them, and import what it imports."""

from __future__ import annotations

import ctypes
import os
import signal
import sys
import threading
from multiprocessing import connection, parent_process

SCRIPT_NAME = "slavemodule.txt"  # in an FMU's resources: which script it runs
SET_DEATH_SIGNAL = 1  # PR_SET_PDEATHSIG of prctl(2)
ORPHANED = 1  # exit status that nobody is left to read


def search_path() -> list[str]:
    """Where a process that is started imports from: where this one does, but for what FMUs have added.

    An FMU of pythonfmu puts its resources first, in which there is a pythonfmu of its version, and none of
    the libraries that building another FMU takes.
    """
    return [folder for folder in sys.path if not os.path.isfile(os.path.join(folder, SCRIPT_NAME))]


def die_with_parent(parent: int) -> None:
    """End this process as soon as process `parent`, which started it, is gone.

    By the kernel where that can be asked for; else, for processes of multiprocessing, by a thread, which
    waits for what is running to give Python a turn.
    """
    if sys.platform.startswith("linux"):
        ctypes.CDLL(None).prctl(SET_DEATH_SIGNAL, signal.SIGKILL, 0, 0, 0)
        if os.getppid() != parent:  # it was gone before the kernel was asked
            os._exit(ORPHANED)
    else:
        watch_parent()


def watch_parent() -> None:
    """End this process from a thread of its own when the process that started it is gone."""
    parent = parent_process()
    if parent is None:
        return

    def wait() -> None:
        connection.wait([parent.sentinel])
        os._exit(ORPHANED)

    threading.Thread(target=wait, daemon=True).start()
