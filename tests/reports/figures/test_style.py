"""Colours that everyone can tell apart, and pictures on dark ground."""

from __future__ import annotations

from itertools import combinations

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib.colors import to_hex, to_rgb, to_rgba
from matplotlib.figure import Figure
from matplotlib.patches import Circle
from matplotlib.text import Text

from touchdown.reports.figures.style import (
    BLACK,
    BLUE,
    COLOURS,
    DARK,
    GREEN,
    GREY,
    ON_DARK,
    ORANGE,
    PURPLE,
    WHITE,
    darkened,
    sheet,
    styled,
)

TOLD_APART = 12.0  # CIE 1976 distance; about 2 can just be seen beside each other
LEGIBLE = 3.0  # contrast of graphics, WCAG 2.1; of text 4.5

# Machado, Oliveira and Fernandes (2009), severity 1, on linear RGB
VISION = {
    "all cones": np.eye(3),
    "deuteranopia": np.array([
        [0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881],
    ]),
    "protanopia": np.array([
        [0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998],
    ]),
}  # fmt: skip
XYZ = np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]])
DAYLIGHT = np.array([0.9505, 1.0, 1.089])
GROUNDS = {"light": (WHITE, COLOURS), "dark": (DARK, tuple(ON_DARK[colour] for colour in COLOURS))}


def linear(colour: object) -> np.ndarray:
    """Of sRGB, its light."""
    rgb = np.array(to_rgb(colour))  # pyright: ignore[reportArgumentType]
    return np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)


def lab(light: np.ndarray) -> np.ndarray:
    """CIE L*a*b* of linear RGB."""
    t = XYZ @ np.clip(light, 0.0, 1.0) / DAYLIGHT
    f = np.where(t > (6.0 / 29.0) ** 3, np.cbrt(t), t / (3.0 * (6.0 / 29.0) ** 2) + 4.0 / 29.0)
    return np.array([116.0 * f[1] - 16.0, 500.0 * (f[0] - f[1]), 200.0 * (f[1] - f[2])])


def contrast(one: object, other: object) -> float:
    """WCAG's, from 1 to 21."""
    bright, dim = sorted((float(XYZ[1] @ linear(c)) for c in (one, other)), reverse=True)
    return (bright + 0.05) / (dim + 0.05)


@pytest.mark.parametrize("ground", GROUNDS)
@pytest.mark.parametrize("vision", VISION)
def test_colours_are_told_apart(vision: str, ground: str) -> None:
    seen = {colour: lab(VISION[vision] @ linear(colour)) for colour in GROUNDS[ground][1]}
    apart = {(a, b): float(np.linalg.norm(seen[a] - seen[b])) for a, b in combinations(seen, 2)}
    assert min(apart.values()) > TOLD_APART, min(apart, key=lambda pair: apart[pair])
    # the measure finds colours that are not: Matplotlib's own red and green
    red, green = (lab(VISION["deuteranopia"] @ linear(colour)) for colour in ("#d62728", "#2ca02c"))
    assert np.linalg.norm(red - green) < TOLD_APART


@pytest.mark.parametrize("ground", GROUNDS)
def test_colours_stand_out_from_their_ground(ground: str) -> None:
    behind, colours = GROUNDS[ground]
    assert min(contrast(colour, behind) for colour in colours) > LEGIBLE
    assert contrast(BLACK if ground == "light" else ON_DARK[BLACK], behind) > 7.0  # of text


def drawn() -> Figure:
    """A figure with what pictures are made of."""
    with styled():
        figure = sheet()
        axes = figure.subplots()
        axes.plot([0.0, 1.0], color=BLUE, marker="o", label="line")
        axes.axhline(0.5, color=BLACK)
        axes.fill_between([0.0, 1.0], [0.0, 0.5], color=GREY, alpha=0.18)
        axes.add_patch(Circle((0.5, 0.5), 0.1, fc="#eeeeee", ec=ORANGE))
        axes.annotate("here", (0.1, 0.1), (0.4, 0.4), arrowprops={"color": GREEN}, color=PURPLE)
        axes.set_title("title")
        axes.legend()
    return figure


def test_a_figure_on_dark_ground_has_the_dark_colours() -> None:
    figure = darkened(drawn())
    (axes,) = figure.axes
    (fill,), (circle,), (note,) = axes.collections, axes.patches, axes.texts
    assert to_hex(figure.get_facecolor()) == to_hex(axes.get_facecolor()) == DARK
    line, level = axes.lines
    assert [to_hex(c) for c in (line.get_color(), line.get_markerfacecolor())] == [ON_DARK[BLUE]] * 2
    assert to_hex(level.get_color()) == to_hex(axes.title.get_color()) == ON_DARK[BLACK]
    assert to_rgba(fill.get_facecolor()[0]) == pytest.approx(to_rgba(ON_DARK[GREY], 0.18))
    assert to_hex(circle.get_edgecolor()) == ON_DARK[ORANGE]
    assert contrast(circle.get_facecolor()[:3], ON_DARK[BLACK]) > 7.0  # text on it can be read
    assert to_hex(note.get_color()) == ON_DARK[PURPLE]
    frame = axes.get_legend().get_frame()
    assert to_hex(frame.get_facecolor()) == DARK
    assert frame.get_edgecolor()[3] == 0.0, "no frame where there was none"
    assert to_hex(note.arrow_patch.get_facecolor()) == ON_DARK[GREEN]


def test_no_text_is_left_dark() -> None:
    """Nor that of ticks that come only when the figure is drawn, and none is lost in its ground."""
    figure = drawn()
    darkened(figure)
    figure.axes[0].set_xlim(0.0, 37.0)
    figure.draw_without_rendering()
    texts = [text for text in figure.findobj(Text) if text.get_text()]
    assert len(texts) > 10
    assert min(contrast(text.get_color(), DARK) for text in texts) > 4.5


def test_the_style_is_the_project_s_own_and_ends_with_it() -> None:
    with mpl.rc_context({"axes.facecolor": "red", "axes.spines.top": True}):
        (axes,) = drawn().axes
        assert to_hex(axes.get_facecolor()) == WHITE
        assert not axes.spines["top"].get_visible()
        assert mpl.rcParams["axes.facecolor"] == "red"
