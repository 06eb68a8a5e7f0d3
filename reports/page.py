"""A report as one page that needs nothing beside it, or as PDF."""

from __future__ import annotations

import os
import shutil
import subprocess
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from datetime import datetime
from pathlib import Path
from typing import Any

from ..fmus.version import VERSION
from ..master.common.errors import TouchdownError
from ..master.common.files import writing_to
from ..master.results.result import Result
from ..master.scene.scene import amended
from ..modelkit.kernel.writing import make_folder, replacing_by_name, write
from .contents import CHAPTERS, SHORT, section
from .layout import Data, Section, rendered
from .numbers import spelt
from .subject import Subject

BROWSERS = (
    "chromium",
    "chromium-browser",
    "google-chrome",
    "google-chrome-stable",
    "chrome",
    "microsoft-edge",
)
BROWSER_FLAGS = (  # a browser that opens one file and asks for nothing
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
    """The option that Chromium needs when it runs as root: no sandbox."""
    return ("--no-sandbox",) if hasattr(os, "geteuid") and os.geteuid() == 0 else ()


def print_page(page: Path, path: Path) -> Path:
    """Print a page into the PDF at `path`; returns it. Raises TouchdownError where that fails."""
    command = browser()
    with (
        tempfile.TemporaryDirectory(prefix="touchdown_print_", ignore_cleanup_errors=True) as folder,
        writing_to(path.parent),
        replacing_by_name(path) as temporary,
    ):
        done = _run(
            [
                command,
                *BROWSER_FLAGS,
                *alone(),
                f"--user-data-dir={folder}/profile",
                "--no-pdf-header-footer",
                f"--print-to-pdf={temporary}",
                page.resolve().as_uri(),
            ]
        )
        if not temporary.is_file():
            lines = done.stderr.strip().splitlines() or [f"exit status {done.returncode}"]
            raise TouchdownError(f"{command} printed no PDF of {page}: {lines[-1]}")
    return path


def _run(command: list[str]) -> subprocess.CompletedProcess[str]:
    try:
        return subprocess.run(command, capture_output=True, text=True, timeout=TIMEOUT, check=False)
    except (OSError, subprocess.TimeoutExpired) as error:
        raise TouchdownError(f"{command[0]} printed no PDF: {error}") from None


PAGE, SHORT_PAGE = "report.html", "report-short.html"
SUFFIXES = (".html", ".htm")
COMPUTATION = (".modes", ".interface.tolerance", ".micro_step")  # settings that no title contradicts
ORDER = "Chapters 2 to 15 follow the order of the scope of ISO 14839-5:2022 (touchdown bearings)."


@dataclass(frozen=True)
class Page:
    """The contents of a page's template."""

    kind: str
    title: str
    headline: str
    made: str  # when and with what
    sections: Sequence[Section] = ()
    about: str = ""  # what to know of its order
    document: Mapping[str, str] = field(default_factory=dict[str, str])  # of the scene, for the cover
    short: bool = False
    template: str = "page.html"
    data: Data = field(default_factory=Data)  # what else the template names


def report_on(result: Result, short: bool = False) -> Page:
    """The report of a run; `short`: in about four pages."""
    subject = Subject(result)
    kind = f"Report on a rotor drop{', short form' if short else ''}"
    sections = [section(chapter, subject) for chapter in (SHORT if short else CHAPTERS)]
    return headed(subject, kind, sections=sections, about="" if short else ORDER, short=short)


def headed(subject: Subject, kind: str, **contents: Any) -> Page:
    """A page on a run with what stands at its head."""
    scene, headline = subject.result.scene, spelt(subject.result.headline)
    title, made = amended(scene.title, _changes(subject)), made_now(f"Scene {scene.name}")
    return Page(kind, title, headline, made, document=vars(scene.document), **contents)


def _changes(subject: Subject) -> list[str]:
    """The settings beside the scene, which its title may contradict, but for those of the computation."""
    components = subject.run.system.components
    changes = subject.result.scene.changes(
        lambda name, key: found.unit if (found := components[name].variables.get(key)) else None
    )
    return [one for one in changes if not one.partition(" = ")[0].endswith(COMPUTATION)]


def made_now(subject: str) -> str:
    """Of what a page is, when it was made, and with what."""
    when = datetime.now().astimezone().strftime("%Y-%m-%d %H:%M %Z")
    return f"{subject}, page of {when} by touchdown-cosim {VERSION}."


def make_room(path: Path, name: str = PAGE) -> None:
    """Make the folder of a page at `path`. Raises TouchdownError where there can be no page.

    name: of such a page.
    """
    if path.is_dir():
        raise TouchdownError(f"{path} is a folder; give -o the name of a file, such as {path / name}")
    if path.suffix.lower() not in SUFFIXES:
        raise TouchdownError(
            f"{path.name} is not a page's name; give -o one that ends in .html (report --pdf prints it)"
        )
    with writing_to(path.parent):
        make_folder(path.parent)


def write_page(page: Page, path: Path) -> Path:
    """Write a page whole; returns its path. Raises TouchdownError where it cannot be written."""
    text = rendered(page.template, {"page": page})
    with writing_to(path.parent):
        return write(path, text)
