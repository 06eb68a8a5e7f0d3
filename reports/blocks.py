"""Blocks of a page: a chapter is a list of them, and `templates/blocks.html` has how each looks."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from .series import Chart


class Block:
    """Part of a chapter; the template goes by the name of its class."""

    @property
    def kind(self) -> str:
        return type(self).__name__.lower()


@dataclass(frozen=True)
class Text(Block):
    """A paragraph."""

    text: str


@dataclass(frozen=True)
class Heading(Block):
    """Of a part of a chapter."""

    text: str


@dataclass(frozen=True)
class Points(Block):
    """Short statements under each other."""

    items: Sequence[str]


@dataclass(frozen=True)
class Remark(Block):
    """Something to know before figures are used; `grave`: that may make them wrong."""

    text: str
    grave: bool = False


@dataclass(frozen=True)
class Lacking(Block):
    """A part of a chapter that this run cannot give, and why."""

    what: str
    why: str


@dataclass(frozen=True)
class Tile:
    """A figure that is seen first."""

    label: str
    value: str
    note: str = ""


@dataclass(frozen=True)
class Tiles(Block):
    """Figures that are seen first."""

    tiles: Sequence[Tile]


@dataclass(frozen=True)
class Table(Block):
    """Rows of cells, the first of each being its head; columns from `numbers` on (0: none) are numbers."""

    caption: str
    head: Sequence[str]
    rows: Sequence[Sequence[str]]
    numbers: int = 0


@dataclass(frozen=True)
class Folded(Block):
    """Blocks that are shown on request, and in print."""

    title: str
    blocks: Sequence[Block]


@dataclass(frozen=True)
class Picture(Block):
    """An SVG, what it shows for those who do not see it, and its caption."""

    svg: str
    caption: str
    wide: bool = True


@dataclass(frozen=True)
class Series(Block):
    """Curves over time that can be zoomed; `svg`: the same in print and without scripts."""

    chart: Chart
    svg: str
    caption: str = ""


@dataclass(frozen=True)
class Code(Block):
    """A command to copy."""

    text: str


@dataclass(frozen=True)
class Download(Block):
    """A file inside the page."""

    name: str
    label: str
    media_type: str
    base64: str


@dataclass(frozen=True)
class Motion(Block):
    """A drop that moves: what the script draws (`data`, JSON), and what it is."""

    data: str
    caption: str
