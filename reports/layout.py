"""Templates of pages, and sections: what a function tells of a subject, laid out by a template."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup, escape

from ..master.results.recording import NotRecordedError

FOLDER = Path(__file__).parent
CODE = re.compile(r"`([^`]+)`")
Data = dict[str, Any]  # what a template names: texts, rows of cells, charts, pictures, truth values


class Absent(Exception):  # noqa: N818 - no error: a chapter that a run cannot give
    """Why a run cannot give a chapter, in one line."""


@dataclass(frozen=True)
class Section:
    """A chapter as printed: HTML, or in `lacking` why there is none."""

    name: str  # of its anchor
    title: str
    html: str = ""
    lacking: str = ""


def laid_out(name: str, title: str, folder: str, tell: Callable[[], Data]) -> Section:
    """A chapter by the template `NAME.html` in a folder of templates, of what `tell` returns."""
    try:
        return Section(name, title, rendered(f"{folder}/{name}.html", tell()))
    except Absent as absent:
        return Section(name, title, lacking=str(absent))
    except NotRecordedError as error:
        return Section(name, title, lacking=f"{error}.")


ENVIRONMENT = Environment(
    loader=FileSystemLoader([FOLDER / "templates", FOLDER / "assets"]),
    autoescape=True,
    undefined=StrictUndefined,
    trim_blocks=True,
    lstrip_blocks=True,
)
# what stands between backquotes as code
ENVIRONMENT.filters["marked"] = lambda text: Markup(CODE.sub(r"<code>\1</code>", str(escape(text))))


def rendered(template: str, data: Data) -> Markup:
    """A template, filled in."""
    return Markup(ENVIRONMENT.get_template(template).render(data))
