"""Charts and pictures as SVG inside a page."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from io import StringIO
from typing import Any
from xml.etree import ElementTree

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ..master.common.text import joined
from .figures.style import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    ORANGE,
    PURPLE,
    RED,
    TIME,
    apart,
    beginning,
    draw_dense,
    label_width,
    sheet,
    sized,
    within,
)
from .numbers import digits_of
from .series import Chart

SVG = "http://www.w3.org/2000/svg"
LINK = "http://www.w3.org/1999/xlink"
FONT, WIDE_FONT = 9.5, 12.5  # pt
STYLE: dict[Any, Any] = {
    "svg.fonttype": "none",  # text stays text
    "svg.hashsalt": "touchdown",  # the same picture has the same names inside
    "axes.titlesize": "medium",
    "figure.titlesize": "medium",
    "legend.framealpha": 0.75,
    "legend.edgecolor": GREY,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "path.simplify_threshold": 0.5,  # px, of lines with thousands of points
    "agg.path.chunksize": 0,
    "savefig.dpi": 150,  # of what is drawn in dots
}
PAGE_COLOURS = {  # colour of a picture: word of the page's style
    BLACK: "ink",
    "#ffffff": "paper",
    BLUE: "blue",
    ORANGE: "orange",
    GREEN: "green",
    PURPLE: "purple",
    GREY: "grey",
    RED: "alarm",
    "#c8d3dc": "core",  # of drawn machines
    "#e6d9bd": "sleeve",
    "#ece3d0": "sleeve",
    "#b3c6b1": "disc",
    "#7f8a93": "edge",
    "#b0b0b0": "line",  # matplotlib's grid
    "#cccccc": "line",  # and frame of legends
}
_COLOUR = re.compile(r"#[0-9a-f]{6}\b")
_LONG = re.compile(r"(-?\d+\.\d{2})\d+")
_FONT = re.compile(r"font: ([\d.]+)px [^;]*")
_REFERENCE = re.compile(r"url\(#([^)]+)\)")


def inline(
    draw: Callable[[Figure], object], name: str, alt: str, wide: bool = False, themed: bool = True
) -> str:
    """The drawing of `draw` on an empty figure, as an SVG element for a page.

    name: what begins the ids inside, one for each picture of a page; alt: what it shows, in words;
    wide: it is drawn wider than a page, which shows it smaller, so that its text has to be larger;
    themed: its colours follow the page's, or else it stays as drawn, on white.
    """
    written = StringIO()
    with mpl.rc_context({**STYLE, "font.size": WIDE_FONT if wide else FONT}):
        figure = sheet()
        figure.patch.set_visible(not themed)
        draw(figure)
        if title := figure.get_suptitle():  # its first line is the run's, which the page has already
            figure.suptitle(title.partition("\n")[2])
        for axes in figure.axes:
            axes.patch.set_visible(False)
        figure.savefig(written, format="svg", metadata={"Date": None, "Creator": None})
    text = written.getvalue()
    root = ElementTree.fromstring(text[text.index("<svg") :])
    if themed:
        for element in root.iter():
            _themed(element)
    return _for_page(root, name, alt)


def _for_page(root: ElementTree.Element, name: str, alt: str) -> str:
    ElementTree.register_namespace("", SVG)
    ElementTree.register_namespace("xlink", LINK)
    for part in [*root.findall(f"{{{SVG}}}metadata"), *root.findall(f"{{{SVG}}}defs")]:
        if part.tag.endswith("metadata") or part.find(f"{{{SVG}}}style") is not None:
            root.remove(part)
    used = _used(root)
    for element in root.iter():
        _renamed(element, used, name)
        _plain(element)
    width = root.attrib.pop("width")
    root.attrib.pop("height")
    root.set("role", "img")
    root.set("aria-label", alt)
    root.set("style", f"max-width: {float(width.removesuffix('pt')) * 4.0 / 3.0:.0f}px")
    return ElementTree.tostring(root, encoding="unicode")


def _used(root: ElementTree.Element) -> set[str]:
    """Ids that something inside refers to."""
    found: set[str] = set()
    for element in root.iter():
        for key, value in element.attrib.items():
            found |= set(_REFERENCE.findall(value))
            if key == f"{{{LINK}}}href":
                found.add(value.removeprefix("#"))
    return found


def _renamed(element: ElementTree.Element, used: set[str], name: str) -> None:
    """Ids that begin with `name` where they are referred to, and none elsewhere."""
    element_id = element.attrib.pop("id", None)
    if element_id in used:
        element.set("id", f"{name}-{element_id}")
    for key, value in element.attrib.items():
        if key == f"{{{LINK}}}href" and value.startswith("#"):
            element.set(key, f"#{name}-{value[1:]}")
        elif "url(#" in value:
            element.set(key, _REFERENCE.sub(rf"url(#{name}-\1)", value))


def _plain(element: ElementTree.Element) -> None:
    """Coordinates of two decimals, and text in the page's font."""
    if "d" in element.attrib:
        element.set("d", _LONG.sub(r"\1", element.get("d", "")).replace("\n", ""))
    if "style" in element.attrib:
        element.set("style", _FONT.sub(r"font-size: \1px", element.get("style", "")))


def _themed(element: ElementTree.Element) -> None:
    """Colours as words of the page's style; what has none is black in SVG, and the page's ink here."""
    tag, style = element.tag.rpartition("}")[2], element.get("style", "")
    if (tag == "text" and "fill" not in style) or (
        tag == "use" and "stroke" in style and "fill" not in style
    ):
        style += "; fill: #000000"
    style = _COLOUR.sub(lambda m: f"var(--{PAGE_COLOURS[m[0]]})" if m[0] in PAGE_COLOURS else m[0], style)
    if style:
        element.set("style", style)


COLOUR_NAMES = {
    "blue": BLUE,
    "orange": ORANGE,
    "green": GREEN,
    "purple": PURPLE,
    "grey": GREY,
    "ink": BLACK,
}
WIDTH, WHOLE_INCHES = 0.9, 5.2  # pt; inch, of the panel of a whole run


def _curves(figure: Figure, chart: Chart) -> None:
    """All of the chart, and beside it the first impact."""
    whole = (beginning(chart.time), float(chart.time[-1]))
    spans = [whole] if chart.impact is None else [chart.impact, whole]
    ratios = [1.0] if len(spans) == 1 else [1.0, 1.8]
    panels = sized(figure, 9.4, 3.1).subplots(1, len(spans), squeeze=False, width_ratios=ratios)[0]
    for axes, span in zip(panels, spans, strict=True):
        for line in chart.lines:
            shown = within(chart.time, span)
            shown &= np.isfinite(line.values)
            points, colour = (chart.time[shown], line.values[shown]), COLOUR_NAMES[line.colour]
            if line.dot:
                axes.plot(*points, "o", color=colour, ms=4, label=line.label)
            else:
                draw_dense(axes, *points, colour, line.label)
        axes.set_xlim(*span)
        _name_events(axes, sorted(one for one in chart.events if span[0] <= one[0] <= span[1]))
        axes.set_xlabel(TIME)
        axes.grid(alpha=0.4, lw=0.5)
        axes.ticklabel_format(useOffset=False)
    panels[0].set_ylabel(chart.axis)
    if len(spans) > 1:
        for axes, what in zip(panels, ("first impact", "whole run"), strict=True):
            axes.set_title(what, pad=34 if chart.events else None)
    if len(chart.lines) > 1:
        key = {"loc": "outside upper right", "ncols": min(len(chart.lines), 6), "frameon": False}
        figure.legend(*panels[-1].get_legend_handles_labels(), fontsize="small", **key)


def _name_events(axes: Axes, events: Sequence[tuple[float, str]]) -> None:
    """Lines at times (s, ascending), and above the panel what happened then."""
    names = [textwrap.fill(what, 10) for _, what in events]
    low, high = axes.get_xlim()
    widths = [label_width(name) * (high - low) / WHOLE_INCHES for name in names]
    moved = apart([time for time, _ in events], widths, low, high)
    line = {"arrowstyle": "-", "color": GREY, "lw": 0.5}
    for (time, _), name, x in zip(events, names, moved, strict=True):
        axes.axvline(time, color=BLACK, lw=WIDTH, ls="--")
        place = axes.get_xaxis_transform()
        axes.annotate(name, (time, 1.0), (x, 1.06), xycoords=place, textcoords=place, ha="center",
                      va="bottom", fontsize="x-small", arrowprops=line)  # fmt: skip


@dataclass(frozen=True)
class Series:
    """Curves over time that can be zoomed; `svg`: the same in print and without scripts."""

    chart: Chart
    svg: str


def series(chart: Chart) -> Series:
    """A chart that can be zoomed, and the same on paper."""
    ranges = [
        f"{line.label} from {' to '.join(digits_of((np.nanmin(line.values), np.nanmax(line.values))))}"
        for line in chart.lines
    ]
    ranges += [f"{what} at {time:.3g} s" for time, what in chart.events]
    alt = f"{chart.title}, {chart.axis}: {joined(ranges)}"
    return Series(chart, inline(partial(_curves, chart=chart), chart.name, alt))
