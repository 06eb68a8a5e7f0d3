"""What the command says beside its results: complaints, warnings, and output that does not arrive."""

from __future__ import annotations

import io
import os
import re
import sys
from collections.abc import Iterable, Sequence
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any, TextIO

if TYPE_CHECKING:
    from ..studies.findings import Findings

BROKEN_OFF = 130  # exit status: by Ctrl-C
MAX_LINE = 4000  # characters
LONG_LINE = re.compile(rf"^(.{{{MAX_LINE}}}).+", re.MULTILINE)


def _escaped(text: str, kept: str = "") -> str:
    """A text as a terminal may get it: what does not print, other than the characters `kept`, is escaped.

    Lines that are longer than any of the command's own are cut.
    """
    shown = (c if c.isprintable() or c in kept else c.encode("unicode_escape").decode() for c in text)
    return LONG_LINE.sub(r"\1...", "".join(shown))


class Escaping:
    """A stream, to stand in for stdout: all that is written to it is `escaped`."""

    def __init__(self, stream: TextIO) -> None:
        self._stream = stream

    def write(self, text: str) -> int:
        """Write it, line ends and tabs as they are."""
        return self._stream.write(_escaped(text, "\n\t"))

    def flush(self) -> None:
        """Have all of it delivered."""
        self._stream.flush()

    def __getattr__(self, name: str) -> Any:
        return getattr(self._stream, name)


def print_error(text: str) -> None:
    """One line on stderr, from `touchdown`, with any text quoted in it."""
    with suppress(OSError):  # there is no other place to say it
        print(f"touchdown: {_escaped(text)}", file=sys.stderr)


def warn(warnings: Iterable[str]) -> None:
    """A line on stderr for each of them."""
    for warning in warnings:
        print_error(f"warning: {warning}")


def show_findings(findings: Findings, folder: Path) -> int:
    """Write what a study reports into a folder and print its lines; returns the exit status."""
    findings.write(folder)
    print("\n".join(findings.lines))
    print(f"results in {folder}")
    return 0


def say_whose_code_runs(files: Sequence[str]) -> None:
    """One line, where FMUs that were given as files are about to run."""
    if files:
        print(f"runs code from files: {', '.join(files)}", flush=True)


def report_interrupt(left: str = "") -> int:
    """Say that the user interrupted it, and what that `left`; returns the exit status."""
    print_error(f"interrupted{left and '; '}{left}")
    return BROKEN_OFF


def show_any_text() -> None:
    """Let what a terminal's encoding has not be shown as escapes, such as \\xb5 for the sign of micro."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")


def flush_error() -> str:
    """Why what was printed did not arrive, or "": a reader may go when it has seen enough."""
    if sys.stdout is None:
        return ""
    try:
        sys.stdout.flush()
    except OSError as error:
        with suppress(OSError), open(os.devnull, "wb") as nowhere:
            os.dup2(nowhere.fileno(), sys.stdout.fileno())  # Python's own try at its end would fail, too
        return "" if isinstance(error, BrokenPipeError) else str(error.strerror)
    return ""
