"""A rotor in bearings: table and Campbell diagram."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import FigureBase

from ....rotor.modal.supported import DAMPED, damping_ratios, log_decrements
from ....rotor.modal.whirl_speeds import Held
from ...results.figures.style import BLACK, BLUE, GREEN, GREY, ORANGE, PURPLE, sized

RPM = 60.0 / (2.0 * math.pi)
TOLD = 8  # modes
PLANAR = 0.1  # of a circle's turning; below, a whirl is told as planar
HEAD = f"{'[Hz]':>12}  {'[rpm]':>10}  {'damping ratio':>14}  {'log decrement':>14}  {'whirl':>10}"


def held_lines(held: Held, title: str) -> Iterator[str]:
    """A table of the modes under `title`, and one of the critical speeds."""
    verdict = "stable" if held.whirl.stable else "UNSTABLE"
    if held.whirl.free:
        verdict += ", but not held everywhere: it may drift"
    yield f"  {title} at {RPM * held.speed:.6g} rpm: {verdict}"
    yield f"  {'mode':<10}{HEAD}"
    for number, k in enumerate(held.swinging[:TOLD], 1):
        root = complex(held.whirl.roots[k])
        grows = "  grows" if held.whirl.damping_ratios[k] < -DAMPED else ""
        yield f"  {number:<10}{_row(root, float(held.whirl.sense[k]))}{grows}"
    slow = len(held.whirl.roots) - len(held.swinging)
    if slow:
        yield f"  {slow} more hardly swing (damping ratio of 0.95 or more)"
    yield from _falling(held)
    yield ""
    yield from _critical_lines(held)
    yield ""


def whirl_name(sense: float) -> str:
    """Which way a mode turns, in a word."""
    return "planar" if abs(sense) < PLANAR else "forward" if sense > 0.0 else "backward"


def _row(root: complex, sense: float) -> str:
    roots = np.array([root])
    hertz = root.imag / (2.0 * math.pi)
    ratio, decrement = (round(float(told(roots)[0]), 4) + 0.0 for told in (damping_ratios, log_decrements))
    return f"{hertz:12.2f}  {60.0 * hertz:10.0f}  {ratio:14.4f}  {decrement:14.4f}  {whirl_name(sense):>10}"


def _falling(held: Held) -> Iterator[str]:
    """What grows without a swing, and at which of the diagram's speeds anything grows."""
    if held.whirl.pushed_away:
        yield "  it is pushed away from where it stands, without a swing"
    ranges = [
        f"{rpm[0]:.0f} and {rpm[-1]:.0f}" for rpm in _stretches(RPM * held.lines.speeds, ~held.lines.stable)
    ]
    if ranges:
        yield f"  something grows between {', '.join(ranges)} rpm of the diagram"


def _stretches(values: np.ndarray, where: np.ndarray) -> list[np.ndarray]:
    """Runs of neighbouring `values` for which `where` holds."""
    runs = np.split(np.arange(len(values)), np.flatnonzero(np.diff(where)) + 1)
    return [values[run] for run in runs if len(run) and where[run[0]]]


def _critical_lines(held: Held) -> Iterator[str]:
    end = RPM * held.lines.speeds[-1]
    if not held.lines.crossings:
        yield f"  no critical speed up to {end:.0f} rpm"
        return
    yield f"  critical speeds up to {end:.0f} rpm, where a damped whirl is as fast as the spin"
    yield f"  {'':<10}{HEAD}"
    for number, one in enumerate(held.lines.crossings, 1):
        yield f"  {number:<10}{_row(one.root, one.sense)}"


REACH = 1.15  # of the highest line that counts: the end of the scale
BEYOND = 2.5  # times the highest speed: lines from there on are not followed by the scale
LOOKS = (  # of each sense: name, marker, colour
    ("forward", "^", BLUE),
    ("backward", "v", ORANGE),
    ("planar", "o", GREEN),
)
EVERY = 2  # speeds, of the markers


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
    axes.set_ylim(0.0, REACH * float(top))
    axes.set_ylabel("damped whirl frequency [Hz]")
    damping.axhline(0.0, color=BLACK, lw=0.6)
    damping.set_ylabel("damping ratio [1]")
    damping.set_xlabel("rotor speed [rpm]")
    figure.legend(*axes.get_legend_handles_labels(), loc="outside right upper", fontsize="small")
    figure.suptitle(title)
    return [axes, damping]


def _shown(held: Held, hertz: np.ndarray) -> np.ndarray:
    """The lines that are drawn: those that begin below `BEYOND` times the highest speed, or the lowest."""
    limit = BEYOND * held.lines.speeds[-1] / (2.0 * math.pi)
    slow = hertz[: max(1, len(hertz) // 4)]  # where whirls of a mode have not parted
    lowest = np.nanmin(np.where(np.isnan(slow), np.inf, slow), axis=0)
    return np.flatnonzero((lowest < limit) | (np.argsort(np.argsort(lowest)) < 4))


def _marks(panel: Axes, held: Held, values: np.ndarray, shown: np.ndarray) -> None:
    """Markers of the lines `shown`, by sense, and of what grows."""
    places, sense = np.broadcast_to(RPM * held.lines.speeds[:, None], values.shape), held.lines.sense
    turns = {
        "forward": sense >= PLANAR, "backward": sense <= -PLANAR, "planar": np.abs(sense) < PLANAR,
    }  # fmt: skip
    for name, marker, colour in LOOKS:
        there = turns[name][::EVERY, shown]
        if there.any():
            x, y = (array[::EVERY, shown][there] for array in (places, values))
            panel.plot(x, y, marker, color=colour, ms=4, mew=0.0, ls="none", label=name)
    growing = (damping_ratios(held.lines.roots) < -DAMPED)[:, shown]
    if growing.any():
        x, y = (array[:, shown][growing] for array in (places, values))
        panel.plot(x, y, "x", color=PURPLE, ms=7, mew=1.6, ls="none", label="grows: unstable")


def _draw_critical(axes: Axes, held: Held) -> None:
    """Circles where a line crosses the spin, in the colour of its whirl; their speeds are in the legend."""
    for one in held.lines.crossings:
        speed, name = RPM * one.speed, whirl_name(one.sense)
        colour = next(colour for known, _, colour in LOOKS if known == name)
        label = f"critical, {name}:\n{speed:.0f} rpm, {speed / 60.0:.1f} Hz"
        axes.plot(speed, speed / 60.0, "o", mfc="none", mec=colour, ms=9, mew=1.3, ls="none", label=label)
