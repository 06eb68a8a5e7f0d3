"""Signals that ask for an end, noted and not raised: a run ends in order, between two macro steps."""

from __future__ import annotations

import signal
import threading
import time as clock
from collections.abc import Callable, Generator, Iterable
from contextlib import contextmanager

# From people, batch systems and containers, terminals that close, and people again.
_NAMES = "SIGINT", "SIGTERM", "SIGHUP", "SIGQUIT", "SIGBREAK"  # no system has all of them
ENDING_SIGNALS = tuple(signal.Signals[name] for name in _NAMES if hasattr(signal, name))
SAME_SIGNAL_S = 0.3  # s within which signals are one


class Interrupts:
    """Whether a run was asked to end, and by what."""

    def __init__(self) -> None:
        self._by: signal.Signals | None = None
        self._at = 0.0  # s, when it was

    def is_set(self) -> bool:
        """Whether it was."""
        return self._by is not None

    @property
    def reason(self) -> str:
        """For people: interrupted, or interrupted by SIGTERM."""
        by = "" if self._by in (None, signal.SIGINT) else f" by {self._by.name}"
        return f"interrupted{by}"

    def note(self, number: int, _: object = None) -> None:
        """A signal came. A second Ctrl-C raises KeyboardInterrupt: now, even if that breaks something.

        One that comes with the first is the same one: some launchers pass it on to who has it already.
        """
        if not self.is_set():
            self._by, self._at = signal.Signals(number), clock.monotonic()
        elif number == signal.SIGINT and clock.monotonic() - self._at > SAME_SIGNAL_S:
            raise KeyboardInterrupt


_noted: Interrupts | None = None  # while interrupts are noted; they are the process's, not a run's


@contextmanager
def interrupts_noted() -> Generator[Interrupts]:
    """Note Ctrl-C instead of raising: an exception in the middle of an FMU's call would break the FMU.

    So too SIGTERM, SIGHUP and SIGQUIT, where nothing else handles or ignores them. May be nested; what was
    noted outside is known inside. A second Ctrl-C raises KeyboardInterrupt at once.
    """
    global _noted
    outer = _noted
    if outer is not None or threading.current_thread() is not threading.main_thread():
        yield outer or Interrupts()
        return
    _noted = noted = Interrupts()
    try:
        with _handled(noted.note, (signal.SIGINT, *filter(_free, ENDING_SIGNALS[1:]))):
            yield noted
    finally:
        _noted = None


@contextmanager
def interrupts_ignored() -> Generator[None]:
    """Processes started meanwhile ignore Ctrl-C, but for their runs, which note it and end in order."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    with _handled(signal.SIG_IGN, (signal.SIGINT,)):
        yield


@contextmanager
def signals_as_interrupt() -> Generator[None]:
    """Meanwhile SIGTERM, SIGHUP and SIGQUIT raise KeyboardInterrupt, as Ctrl-C does, unless ignored."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    with _handled(_raise, filter(_free, ENDING_SIGNALS[1:])):
        yield


def _raise(*_: object) -> None:
    raise KeyboardInterrupt


def _free(number: int) -> bool:
    """Whether nothing else handles or ignores a signal (nohup ignores SIGHUP)."""
    return signal.getsignal(number) in (signal.SIG_DFL, _raise)


@contextmanager
def _handled(handler: Callable[..., object] | signal.Handlers, numbers: Iterable[int]) -> Generator[None]:
    before = {number: signal.signal(number, handler) for number in numbers}
    try:
        yield
    finally:
        for number, earlier in before.items():
            signal.signal(number, earlier)
