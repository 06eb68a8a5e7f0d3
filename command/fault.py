"""The last catch: an unforeseen error is one line on the screen, and a log for those who mend it."""

from __future__ import annotations

import os
import platform
import shlex
import tempfile
import traceback
from collections.abc import Sequence
from importlib import metadata

from ..fmus.version import VERSION
from .console import print_error

FAULT = 70  # exit status: a fault of the program's own (EX_SOFTWARE of sysexits.h)


def versions() -> str:
    """The versions that ran, in one line."""
    numba = metadata.version("numba")
    return f"touchdown-cosim {VERSION}, Python {platform.python_version()}, numba {numba}"


def report_fault(error: Exception, arguments: Sequence[str]) -> int:
    """Say that `error` was not foreseen, and where its log is; returns the exit status."""
    what = " ".join(f"{type(error).__name__}: {error}".split())
    print_error(
        f"it failed in a way that was not foreseen ({what[:200]}); please report it, with the version "
        f"(touchdown-cosim {VERSION}) and {_logged(error, arguments)}"
    )
    return FAULT


def _logged(error: Exception, arguments: Sequence[str]) -> str:
    """Where the log is, for people; the log is a temporary file that only the user can read."""
    lines = [
        versions(),
        platform.platform(),
        f"in {os.getcwd()}",
        shlex.join(["touchdown", *arguments]),
        "",
        *traceback.format_exception(error),
    ]
    try:
        number, path = tempfile.mkstemp(prefix="touchdown-fault-", suffix=".log", text=True)
        with open(number, "w", encoding="utf-8", errors="backslashreplace") as log:
            log.write("\n".join(lines))
    except OSError as refused:
        return f"what you did; no log could be written ({refused.strerror})"
    return f"the log {path}"
