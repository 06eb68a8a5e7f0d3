"""A page as PDF, printed by a browser that is there."""

from __future__ import annotations

import os
import shutil
import subprocess
import tempfile
from pathlib import Path

from touchdown.master.common.errors import TouchdownError
from touchdown.master.common.files import replacing, writing_to

BROWSERS = (
    "chromium",
    "chromium-browser",
    "google-chrome",
    "google-chrome-stable",
    "chrome",
    "microsoft-edge",
)
QUIET = (  # a browser that looks at one file and asks nobody anything
    *("--headless", "--disable-gpu", "--no-first-run", "--disable-extensions", "--disable-sync"),
    *("--disable-background-networking", "--disable-component-update", "--disable-default-apps"),
)
TIMEOUT = 120.0  # s


def browser() -> str:
    """The path of a browser that can print. Raises TouchdownError where there is none."""
    for name in BROWSERS:
        found = shutil.which(name)
        if found:
            return found
    raise TouchdownError(
        f"a PDF is printed by Chromium or a browser of its kind, and none of {', '.join(BROWSERS)} is on "
        "the PATH; install one, or open the page in any browser and print it"
    )


def alone() -> tuple[str, ...]:
    """What Chromium asks of root: no sandbox."""
    return ("--no-sandbox",) if os.geteuid() == 0 else ()


def print_page(page: Path, path: Path) -> Path:
    """Print a page into the PDF at `path`; returns it. Raises TouchdownError where that fails."""
    command = browser()
    with (
        tempfile.TemporaryDirectory(prefix="touchdown_print_", ignore_cleanup_errors=True) as own,
        writing_to(path.parent),
        replacing(path) as part,
    ):
        made = Path(own) / "page.pdf"
        done = _run(
            [
                command,
                *QUIET,
                *alone(),
                f"--user-data-dir={own}/profile",
                "--no-pdf-header-footer",
                f"--print-to-pdf={made}",
                page.resolve().as_uri(),
            ]
        )
        if not made.is_file():
            lines = done.stderr.strip().splitlines() or [f"exit status {done.returncode}"]
            raise TouchdownError(f"{command} printed no PDF of {page}: {lines[-1]}")
        shutil.copyfile(made, part)
    return path


def _run(command: list[str]) -> subprocess.CompletedProcess[str]:
    try:
        return subprocess.run(command, capture_output=True, text=True, timeout=TIMEOUT, check=False)
    except (OSError, subprocess.TimeoutExpired) as error:
        raise TouchdownError(f"{command[0]} printed no PDF: {error}") from None
