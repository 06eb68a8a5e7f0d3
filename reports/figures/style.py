"""One look for all pictures: colours, sizes, and lines thinned for drawing.

Everyone can tell the colours apart, on light and on dark ground. They are those of Okabe and Ito (Color
Universal Design, 2008), and a grey. On dark ground each has a lighter one in its place; greys keep their
distance from the ground.
"""

from __future__ import annotations

import colorsys
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import numpy as np
from matplotlib import rc_context
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.collections import Collection
from matplotlib.colors import to_hex, to_rgba
from matplotlib.figure import Figure, FigureBase
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.rcsetup import cycler
from matplotlib.text import Annotation, Text

from ...master.results.recording import Recording
from ...modelkit.kernel.writing import replacing

BLUE, ORANGE, GREEN, PURPLE, GREY = "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#666666"
SKY, YELLOW, BLACK, WHITE = "#56b4e9", "#e69f00", "#000000", "#ffffff"
RED = "#a5260b"  # of what must not be
COLOURS = (BLUE, ORANGE, GREEN, PURPLE, GREY)

DARK = "#16191d"  # the dark ground
LIGHT_INK = "#e8eaed"  # text and axes on it
ON_DARK: Mapping[str, str] = {
    BLUE: SKY,
    ORANGE: "#f0803c",
    GREEN: "#2fc79b",
    PURPLE: "#dd9fc2",
    GREY: "#7a7f85",
    RED: "#ff9d85",
    SKY: "#9bd3f5",
    YELLOW: "#f5c451",
    BLACK: LIGHT_INK,
    WHITE: DARK,
}
"""Of a colour on light ground the one on dark ground."""


MARGIN = 0.1  # inch around a figure's panels, for labels at their ends
EDGE, FAINT = "#808080", "#dddddd"
RC_PARAMETERS: dict[Any, Any] = {
    "figure.facecolor": WHITE,
    "savefig.facecolor": "auto",
    "axes.facecolor": WHITE,
    "axes.edgecolor": EDGE,
    "axes.labelcolor": BLACK,
    "axes.linewidth": 0.8,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.titlesize": "medium",
    "axes.prop_cycle": cycler(color=COLOURS),
    "figure.titlesize": "large",
    "font.size": 10.0,
    "grid.color": FAINT,
    "grid.linewidth": 0.5,
    "legend.fontsize": "small",
    "legend.frameon": True,
    "legend.framealpha": 0.85,
    "legend.edgecolor": "none",
    "legend.facecolor": WHITE,
    "text.color": BLACK,
    "xtick.color": EDGE,
    "ytick.color": EDGE,
    "xtick.labelcolor": BLACK,
    "ytick.labelcolor": BLACK,
}


@contextmanager
def styled() -> Iterator[None]:
    """Figures and axes made meanwhile have the look of the project's pictures, not the user's own."""
    with rc_context(RC_PARAMETERS):
        yield


def _roomy() -> ConstrainedLayoutEngine:
    """The layout of all figures: panels make room for their labels."""
    return ConstrainedLayoutEngine(w_pad=MARGIN, h_pad=0.5 * MARGIN)


class Sheet(Figure):
    """A figure whose title is the user's words: a dollar sign in it begins no formula."""

    def suptitle(self, t: str, **kwargs: Any) -> Text:
        return super().suptitle(t, **{"parse_math": False, **kwargs})


def sheet(width: float = 6.4, height: float = 4.8) -> Figure:
    """An empty figure (inch) for a file: no window shows it."""
    return Sheet(figsize=(width, height), layout=_roomy())


def save(figure: Figure, path: Path, dpi: float | Literal["figure"] = "figure") -> Path:
    """Write a figure as a PNG; returns its path. Raises OSError."""
    with replacing(path) as file:
        figure.savefig(file, dpi=dpi, format="png")
    return path


def drawable(figure: FigureBase | None) -> FigureBase:
    """`figure`, or a new one of pyplot's, which a notebook or a window shows."""
    if figure is not None:
        return figure
    from matplotlib import pyplot  # looks for a display: only where one may be wanted

    return pyplot.figure(FigureClass=Sheet, layout=_roomy())


def sized(figure: FigureBase, width: float, height: float) -> FigureBase:
    """`figure` made as large as its panels want it (inch); part of another one, it keeps its size."""
    if isinstance(figure, Figure):
        figure.set_size_inches(width, height)
    return figure


WIDTH = 0.8  # pt, of a line
MAX_POINTS = 20_000  # drawn per line; peaks are kept
LAST_ZOOM_S = 0.05  # s, the last zoom of a run
TIME = "time from the shutdown [s]"


@dataclass(frozen=True)
class Curve:
    """One variable of a bearing, and how it is drawn."""

    variable: str
    label: str
    colour: str
    width: float = WIDTH


def present(recording: Recording, bearing: str, curves: tuple[Curve, ...]) -> list[Curve]:
    """The `curves` that the recording has for `bearing`."""
    return [c for c in curves if f"{bearing}.{c.variable}" in recording]


def beginning(time: np.ndarray) -> float:
    """Where pictures start (s): at the shutdown, or with the run where it began later or ended before."""
    return max(0.0, float(time[0])) if time[-1] > 0.0 else float(time[0])


def zooms(time: np.ndarray, first: float) -> list[tuple[float, float]]:
    """The run from its beginning to `first`, all of it, and its end (s); none of them twice."""
    start, end = beginning(time), float(time[-1])
    spans = [(start, min(first, end)), (start, end), (max(start, end - LAST_ZOOM_S), end)]
    return list(dict.fromkeys(spans))


def thinned(x: np.ndarray, y: np.ndarray, most: int = MAX_POINTS) -> tuple[np.ndarray, np.ndarray]:
    """At most `most` points of a line (n,): each stretch's smallest and largest value."""
    if len(x) <= most:
        return x, y
    size = -(-len(x) // (most // 2))
    count = len(x) // size
    blocks = y[: count * size].reshape(count, size)
    index = np.sort(np.stack([blocks.argmin(1), blocks.argmax(1)], 1), axis=1)
    index = (index + np.arange(count)[:, None] * size).ravel()
    return x[index], y[index]


BLOCKS, DENSE = 300, 16  # of a curve that is too dense to be seen; values in each that make it so
SWINGS = 60.0  # times all that it spans: how far its values go in all


def draw_dense(axes: Axes, time: np.ndarray, values: np.ndarray, colour: str, label: str = "") -> None:
    """A curve; where its swings would make a blot, what it lies between instead."""
    swings = float(np.abs(np.diff(values)).sum()) > SWINGS * float(np.ptp(values) if len(values) else 0.0)
    if len(time) < DENSE * BLOCKS or not swings:
        axes.plot(*thinned(time, values), color=colour, lw=WIDTH, label=label)
        return
    edges = np.linspace(0, len(time), BLOCKS + 1).astype(int)
    middle = time[(edges[:-1] + edges[1:]) // 2]
    low, high = (extreme.reduceat(values, edges[:-1]) for extreme in (np.minimum, np.maximum))
    axes.fill_between(middle, low, high, color=colour, alpha=0.3, lw=0, label=f"_{label}, between")
    axes.plot(middle, high, color=colour, lw=0.7 * WIDTH, label=label)
    axes.plot(middle, low, color=colour, lw=0.7 * WIDTH, label=f"_{label}, least")


CALM = 0.02  # of all that a curve spans in the run: less is drawn no larger


def calm(axes: Axes, whole: Iterable[np.ndarray], share: float = CALM) -> None:
    """Let an axis span no less than a small part of what its curves, (n,) each, span in the `whole` run."""
    curves = [values for values in whole if len(values)]
    least = share * max((float(np.ptp(values)) for values in curves), default=0.0)
    low, high = axes.get_ylim()
    if high - low < least:
        bottom = 0.5 * (low + high - least)
        if min(float(values.min()) for values in curves) >= 0.0:  # nor does it show what cannot be
            bottom = max(bottom, -0.05 * least)
        axes.set_ylim(bottom, bottom + least)


LETTER = 0.068  # inch, of small text


def label_width(text: str) -> float:
    """Of small text with lines (inch), with room beside it."""
    return LETTER * (2 + max(map(len, text.split("\n"))))


def apart(
    places: Sequence[float] | np.ndarray, widths: Sequence[float], low: float, high: float
) -> np.ndarray:
    """Where labels of some widths stand, near their `places` (ascending) and not over each other.

    They stay between `low` and `high` where there is room for all.
    """
    if not len(places):
        return np.zeros(0)
    half = 0.5 * np.asarray(widths)
    offset = np.concatenate([[0.0], np.cumsum(half[1:] + half[:-1])])
    free = np.asarray(places) - offset
    moved = 0.5 * (np.maximum.accumulate(free) + np.minimum.accumulate(free[::-1])[::-1])
    first = low + half[0]
    return np.clip(moved, first, max(first, high - half[-1] - offset[-1])) + offset


def key_beside(axes: Axes, *args: Any) -> None:
    """The legend to the right of a panel, where no curve is."""
    beside: dict[str, Any] = {"loc": "center left", "bbox_to_anchor": (1.01, 0.5), "frameon": False}
    axes.legend(*args, **beside)


def key_below(axes: Axes, columns: int = 3) -> None:
    """The legend below a panel and its labels."""
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.14), ncols=columns, frameon=False)


def within(time: np.ndarray, span: tuple[float, float]) -> np.ndarray:
    """Which of the times lie in a span (s)."""
    return (time >= span[0]) & (time <= span[1])


GREY_TOLERANCE = 0.02  # largest difference of a grey's red, green and blue
# Lightness from which a colour is a ground, and what it becomes
GROUND_LIGHTNESS, DARK_GROUND_LIGHTNESS = 0.7, 0.3
MIN_LIGHTNESS = 0.62  # lightness that other colours have at least

Rgba = tuple[float, float, float, float]


def darkened(figure: FigureBase) -> FigureBase:
    """`figure` with the colours for dark ground, changed in place, and returned.

    Colours of the palette get their counterparts in `ON_DARK`, greys keep their distance from the ground,
    pale grounds become dim. To be called once, when all is drawn.
    """
    for artist in figure.findobj():
        _darken(artist)
    return figure


def _dark(colour: Any) -> Rgba:
    """The colour on dark ground that stands for one on light ground, equally transparent."""
    *channels, alpha = to_rgba(colour)
    rgb = channels[0], channels[1], channels[2]
    known = ON_DARK.get(to_hex(rgb))
    if known is not None:
        return to_rgba(known, alpha)
    if max(rgb) - min(rgb) <= GREY_TOLERANCE:
        ends = zip(to_rgba(LIGHT_INK)[:3], to_rgba(DARK)[:3], strict=True)
        red, green, blue = (ink + rgb[0] * (ground - ink) for ink, ground in ends)
        return red, green, blue, alpha
    hue, lightness, saturation = colorsys.rgb_to_hls(*rgb)
    lightness = DARK_GROUND_LIGHTNESS if lightness > GROUND_LIGHTNESS else max(lightness, MIN_LIGHTNESS)
    return *colorsys.hls_to_rgb(hue, lightness, saturation), alpha


def _darken(artist: Artist) -> None:
    """Change one artist's own colours."""
    if isinstance(artist, Line2D):
        marker = _unless_none(artist.get_markerfacecolor()), _unless_none(artist.get_markeredgecolor())
        artist.set_color(_unless_none(artist.get_color()))
        artist.set_markerfacecolor(marker[0])
        artist.set_markeredgecolor(marker[1])
    elif isinstance(artist, Patch):
        edge = _unless_none(artist.get_edgecolor())
        artist.set_facecolor(_unless_none(artist.get_facecolor()))
        artist.set_edgecolor(edge)
    elif isinstance(artist, Collection):
        edges = [_dark(colour) for colour in artist.get_edgecolor()]
        artist.set_facecolor([_dark(colour) for colour in artist.get_facecolor()])
        artist.set_edgecolor(edges)
    elif isinstance(artist, Text):
        artist.set_color(_dark(artist.get_color()))
        if isinstance(artist, Annotation) and artist.arrow_patch is not None:
            _darken(artist.arrow_patch)
    elif isinstance(artist, Axis):  # for ticks to come
        params = artist.get_tick_params()
        chosen: dict[str, Any] = {
            key: _dark(params[key]) for key in ("color", "labelcolor", "grid_color") if key in params
        }
        artist.set_tick_params(**chosen)


def _unless_none(colour: Any) -> Any:
    """`_dark`, but what is not drawn stays so: an artist's own transparency would override the colour's."""
    return "none" if to_rgba(colour)[3] == 0.0 else _dark(colour)
