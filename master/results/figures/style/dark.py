"""A figure that was drawn on light ground, on dark ground."""

from __future__ import annotations

import colorsys
from typing import Any

from matplotlib.artist import Artist
from matplotlib.axis import Axis
from matplotlib.collections import Collection
from matplotlib.colors import to_hex, to_rgba
from matplotlib.figure import FigureBase
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.text import Annotation, Text

from touchdown.master.results.figures.style.palette import DARK, LIGHT_INK, ON_DARK

GREYISH = 0.02  # largest difference of a grey's red, green and blue
PALE, DIM = 0.7, 0.3  # lightness from which a colour is a ground, and what it becomes
BRIGHT = 0.62  # lightness that other colours have at least

Rgba = tuple[float, float, float, float]


def darkened(figure: FigureBase) -> FigureBase:
    """`figure` with the colours for dark ground, changed in place, and returned.

    Colours of the palette get their counterparts in `ON_DARK`, greys keep their distance from the ground,
    pale grounds become dim. To be called once, when all is drawn.
    """
    for artist in figure.findobj():
        _darken(artist)
    return figure


def dark(colour: Any) -> Rgba:
    """The colour on dark ground that stands for one on light ground, as transparent as it is."""
    *channels, alpha = to_rgba(colour)
    rgb = channels[0], channels[1], channels[2]
    known = ON_DARK.get(to_hex(rgb))
    if known is not None:
        return to_rgba(known, alpha)
    if max(rgb) - min(rgb) <= GREYISH:
        ends = zip(to_rgba(LIGHT_INK)[:3], to_rgba(DARK)[:3], strict=True)
        red, green, blue = (ink + rgb[0] * (ground - ink) for ink, ground in ends)
        return red, green, blue, alpha
    hue, lightness, saturation = colorsys.rgb_to_hls(*rgb)
    lightness = DIM if lightness > PALE else max(lightness, BRIGHT)
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
        edges = [dark(colour) for colour in artist.get_edgecolor()]
        artist.set_facecolor([dark(colour) for colour in artist.get_facecolor()])
        artist.set_edgecolor(edges)
    elif isinstance(artist, Text):
        artist.set_color(dark(artist.get_color()))
        if isinstance(artist, Annotation) and artist.arrow_patch is not None:
            _darken(artist.arrow_patch)
    elif isinstance(artist, Axis):  # for ticks to come
        given = artist.get_tick_params()
        chosen: dict[str, Any] = {
            key: dark(given[key]) for key in ("color", "labelcolor", "grid_color") if key in given
        }
        artist.set_tick_params(**chosen)


def _unless_none(colour: Any) -> Any:
    """`dark`, but what is not drawn stays so: an artist's own transparency would override the colour's."""
    return "none" if to_rgba(colour)[3] == 0.0 else dark(colour)
