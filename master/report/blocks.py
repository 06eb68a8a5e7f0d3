"""What a page is made of: a chapter is a list of blocks, and `templates/blocks.html` has how each looks."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import ClassVar

from .series import Chart


class Absent(Exception):  # noqa: N818 - no error: a chapter that a run cannot give
    """Why a run cannot give a chapter, in one line."""


@dataclass(frozen=True)
class Text:
    """A paragraph."""

    kind: ClassVar[str] = "text"
    text: str


@dataclass(frozen=True)
class Heading:
    """Of a part of a chapter."""

    kind: ClassVar[str] = "heading"
    text: str


@dataclass(frozen=True)
class Points:
    """Short statements under each other."""

    kind: ClassVar[str] = "points"
    items: Sequence[str]


@dataclass(frozen=True)
class Remark:
    """Something to know before figures are used; `grave`: that may make them wrong."""

    kind: ClassVar[str] = "remark"
    text: str
    grave: bool = False


@dataclass(frozen=True)
class Lacking:
    """A part of a chapter that this run cannot give, and why."""

    kind: ClassVar[str] = "lacking"
    what: str
    why: str


@dataclass(frozen=True)
class Tile:
    """A figure that is seen first."""

    label: str
    value: str
    note: str = ""


@dataclass(frozen=True)
class Tiles:
    """Figures that are seen first."""

    kind: ClassVar[str] = "tiles"
    tiles: Sequence[Tile]


@dataclass(frozen=True)
class Table:
    """Rows of cells, the first of each being its head; columns from `numbers` on (0: none) are numbers."""

    kind: ClassVar[str] = "table"
    caption: str
    head: Sequence[str]
    rows: Sequence[Sequence[str]]
    numbers: int = 0


@dataclass(frozen=True)
class Folded:
    """Blocks that are shown on request, and in print."""

    kind: ClassVar[str] = "folded"
    title: str
    blocks: Sequence[Block]


@dataclass(frozen=True)
class Picture:
    """An SVG, what it shows for those who do not see it, and its caption."""

    kind: ClassVar[str] = "picture"
    svg: str
    caption: str
    wide: bool = True


@dataclass(frozen=True)
class Series:
    """Curves over time that can be zoomed; `svg`: the same in print and without scripts."""

    kind: ClassVar[str] = "series"
    chart: Chart
    svg: str
    caption: str


@dataclass(frozen=True)
class Code:
    """A command to copy."""

    kind: ClassVar[str] = "code"
    text: str


@dataclass(frozen=True)
class Download:
    """A file inside the page."""

    kind: ClassVar[str] = "download"
    name: str
    label: str
    media_type: str
    base64: str


@dataclass(frozen=True)
class Motion:
    """A drop that moves: what the script draws (`data`, JSON), and what it is."""

    kind: ClassVar[str] = "motion"
    data: str
    caption: str


Block = (
    Text
    | Heading
    | Points
    | Remark
    | Lacking
    | Tiles
    | Table
    | Folded
    | Picture
    | Series
    | Code
    | Download
    | Motion
)


@dataclass(frozen=True)
class Section:
    """A chapter as it is printed: its blocks, or in `lacking` why there are none."""

    name: str  # of its anchor
    title: str
    blocks: Sequence[Block] = ()
    lacking: str = ""
    scope: str = field(default="")  # the letter of the standard's scope that it answers to
