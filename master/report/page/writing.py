"""The report of a run as one page that needs nothing beside it."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup, escape

from touchdown.fmus.version import VERSION
from touchdown.master.common.errors import TouchdownError
from touchdown.master.common.files import replacing, writing_to
from touchdown.master.report.chapters.summary import headline
from touchdown.master.report.contents import CHAPTERS, section
from touchdown.master.report.facts.subject import Subject
from touchdown.master.report.page.blocks import Section
from touchdown.master.results.result import Result
from touchdown.master.scene.titles import amended

HERE = Path(__file__).parent
TEMPLATES, ASSETS = HERE / "templates", HERE / "assets"
PAGE = "report.html"
SUFFIXES = (".html", ".htm")
ORDER = "Chapters 2 to 15 follow the order of the scope of ISO 14839-5:2022 (touchdown bearings)."
_CODE = re.compile(r"`([^`]+)`")


@dataclass(frozen=True)
class Page:
    """What the page's template prints."""

    kind: str
    title: str
    headline: str
    made: str  # when and with what
    sections: Sequence[Section]
    about: str  # what to know of its order


def report_on(result: Result) -> Page:
    """The report of a run."""
    subject = Subject(result)
    return Page(
        kind="Report on a rotor drop",
        title=amended(result.scene.title, _changes(subject)),
        headline=headline(subject),
        made=made_now(f"Scene {result.scene.name}"),
        sections=[section(chapter, subject) for chapter in CHAPTERS],
        about=ORDER,
    )


def _changes(subject: Subject) -> list[str]:
    """What was set beside the scene, which its title may deny."""
    components = subject.run.system.components
    return subject.result.scene.changes(
        lambda name, key: found.unit if (found := components[name].variables.get(key)) else None
    )


def made_now(of: str) -> str:
    """Of what a page is, when it was made, and with what."""
    when = datetime.now().astimezone().strftime("%Y-%m-%d %H:%M %Z")
    return f"{of}, report of {when} by touchdown-cosim {VERSION}."


def make_room(path: Path) -> None:
    """Make the folder of a page at `path`. Raises TouchdownError where there can be no page."""
    if path.is_dir():
        raise TouchdownError(f"{path} is a folder; give -o the name of a file, such as {path / PAGE}")
    if path.suffix.lower() not in SUFFIXES:
        raise TouchdownError(
            f"{path.name} is no name of a page; give -o one that ends in .html (--pdf prints beside it)"
        )
    with writing_to(path.parent):
        path.parent.mkdir(parents=True, exist_ok=True)


def write_page(page: Page, path: Path) -> Path:
    """Write a page whole; returns its path. Raises TouchdownError where it cannot be written."""
    text = rendered(page)
    with writing_to(path.parent), replacing(path) as part:
        part.write_text(text, encoding="utf-8")
    return path


def marked(text: str) -> Markup:
    """Text with what stands between backquotes as code."""
    return Markup(_CODE.sub(r"<code>\1</code>", str(escape(text))))


def rendered(page: Page) -> str:
    """A page as HTML, scripts and styles inside."""
    environment = Environment(
        loader=FileSystemLoader([TEMPLATES, ASSETS]),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters["marked"] = marked
    return environment.get_template("page.html").render(page=page)
