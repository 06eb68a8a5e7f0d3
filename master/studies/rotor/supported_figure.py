"""Campbell diagram of a rotor in bearings."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import FigureBase

from ....rotor.modal.supported import MIN_DAMPING_RATIO, damping_ratios
from ....rotor.modal.whirl_speeds import Held
from ...results.figures.style import BLACK, BLUE, GREEN, GREY, ORANGE, PURPLE, sized
from .supported import PLANAR_LIMIT, RPM, whirl_name

SCALE_MARGIN = 1.15  # of the highest line that counts: the end of the scale
MAX_SPEED_RATIO = 2.5  # times the highest speed: lines from there on are not followed by the scale
SENSE_STYLES = (  # of each sense: name, marker, colour
    ("forward", "^", BLUE),
    ("backward", "v", ORANGE),
    ("planar", "o", GREEN),
)
MARKER_STRIDE = 2  # speeds, of the markers


def held_campbell(figure: FigureBase, held: Held, title: str) -> list[Axes]:
    """Damped whirl frequencies [Hz] over speed [rpm] above the damping ratios [1], critical speeds marked.

    Forward, backward and planar whirl differ in marker and colour; what grows is crossed out. Grey: the
    speed that the modes are told at.
    """
    axes, damping = sized(figure, 9.0, 8.0).subplots(2, 1, sharex=True, height_ratios=(2.2, 1.0))
    speeds = RPM * held.lines.speeds
    hertz = np.imag(held.lines.roots) / (2.0 * math.pi)
    shown = _shown(held, hertz)
    for panel, values in ((axes, hertz), (damping, damping_ratios(held.lines.roots))):
        panel.plot(speeds, values[:, shown], color=GREY, lw=0.7, zorder=1)
        _marks(panel, held, values, shown)
    axes.plot(speeds, speeds / 60.0, ":", color=BLACK, lw=1.2, label="1x, once per turn")
    axes.plot([], [], color=GREY, lw=0.8, label=f"{RPM * held.speed:.5g} rpm")
    _draw_critical(axes, held)
    for panel in (axes, damping):
        panel.axvline(RPM * held.speed, color=GREY, lw=0.8, zorder=0)
    axes.set_xlim(0.0, float(speeds[-1]))
    top = np.nanmax(hertz[:, shown], initial=float(speeds[-1]) / 60.0)
    axes.set_ylim(0.0, SCALE_MARGIN * float(top))
    axes.set_ylabel("damped whirl frequency [Hz]")
    damping.axhline(0.0, color=BLACK, lw=0.6)
    damping.set_ylabel("damping ratio [1]")
    damping.set_xlabel("rotor speed [rpm]")
    figure.legend(*axes.get_legend_handles_labels(), loc="outside right upper", fontsize="small")
    figure.suptitle(title)
    return [axes, damping]


def _shown(held: Held, hertz: np.ndarray) -> np.ndarray:
    """Lines to draw: those that begin below MAX_SPEED_RATIO times the highest speed, or the lowest."""
    limit = MAX_SPEED_RATIO * held.lines.speeds[-1] / (2.0 * math.pi)
    slow = hertz[: max(1, len(hertz) // 4)]  # where whirls of a mode have not parted
    lowest = np.nanmin(np.where(np.isnan(slow), np.inf, slow), axis=0)
    return np.flatnonzero((lowest < limit) | (np.argsort(np.argsort(lowest)) < 4))


def _marks(panel: Axes, held: Held, values: np.ndarray, shown: np.ndarray) -> None:
    """Markers of the lines `shown`, by sense, and of what grows."""
    places, sense = np.broadcast_to(RPM * held.lines.speeds[:, None], values.shape), held.lines.sense
    turns = {
        "forward": sense >= PLANAR_LIMIT,
        "backward": sense <= -PLANAR_LIMIT,
        "planar": np.abs(sense) < PLANAR_LIMIT,
    }
    for name, marker, colour in SENSE_STYLES:
        there = turns[name][::MARKER_STRIDE, shown]
        if there.any():
            x, y = (array[::MARKER_STRIDE, shown][there] for array in (places, values))
            panel.plot(x, y, marker, color=colour, ms=4, mew=0.0, ls="none", label=name)
    growing = (damping_ratios(held.lines.roots) < -MIN_DAMPING_RATIO)[:, shown]
    if growing.any():
        x, y = (array[:, shown][growing] for array in (places, values))
        panel.plot(x, y, "x", color=PURPLE, ms=7, mew=1.6, ls="none", label="grows: unstable")


def _draw_critical(axes: Axes, held: Held) -> None:
    """Circles where a line crosses the spin, in the colour of its whirl; their speeds are in the legend."""
    for one in held.lines.crossings:
        speed, name = RPM * one.speed, whirl_name(one.sense)
        colour = next(colour for known, _, colour in SENSE_STYLES if known == name)
        label = f"critical, {name}:\n{speed:.0f} rpm, {speed / 60.0:.1f} Hz"
        axes.plot(speed, speed / 60.0, "o", mfc="none", mec=colour, ms=9, mew=1.3, ls="none", label=label)
