"""What the command says beside its results: complaints, warnings, and output that does not arrive."""

from __future__ import annotations

import io
import os
import sys
from collections.abc import Iterable, Sequence
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ..studies.findings import Findings

BROKEN_OFF = 130  # exit status: by Ctrl-C


def print_error(text: str) -> None:
    """One line on stderr, from `touchdown`, whatever is quoted in it: what does not print is escaped."""
    shown = "".join(c if c.isprintable() else c.encode("unicode_escape").decode() for c in text)
    with suppress(OSError):  # there is no other place to say it
        print(f"touchdown: {shown}", file=sys.stderr)


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


def report_interrupt() -> int:
    """Say that the user interrupted it; returns the exit status."""
    print_error("interrupted")
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
