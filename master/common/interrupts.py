"""Ctrl-C noted, not raised: a run ends in order, between two macro steps."""

from __future__ import annotations

import signal
import threading
from collections.abc import Generator
from contextlib import contextmanager

_noted: threading.Event | None = None  # while interrupts are noted; they are the process's, not a run's


@contextmanager
def interrupts_noted() -> Generator[threading.Event]:
    """Note Ctrl-C instead of raising: an exception in the middle of an FMU's call would break the FMU.

    May be nested; what was noted outside is known inside. A second Ctrl-C raises KeyboardInterrupt at once.
    """
    global _noted
    outer = _noted
    if outer is not None or threading.current_thread() is not threading.main_thread():
        yield outer or threading.Event()
        return
    _noted = noted = threading.Event()

    def note(*_: object) -> None:
        if noted.is_set():  # asked a second time: now, whatever it breaks
            raise KeyboardInterrupt
        noted.set()

    before = signal.signal(signal.SIGINT, note)
    try:
        yield noted
    finally:
        signal.signal(signal.SIGINT, before)
        _noted = None


@contextmanager
def interrupts_ignored() -> Generator[None]:
    """Processes started meanwhile ignore Ctrl-C, but for their runs, which note it and end in order."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)
