"""A rotor in bearings, as text: modes at a speed, damped critical speeds, whether it is stable."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from ...master.common.text import RPM, aligned
from ...rotor.modal.supported import MIN_DAMPING_RATIO, damping_ratios, log_decrements
from ...rotor.modal.whirl_speeds import HeldModes

MAX_LISTED_MODES = 8  # modes
RESTING = "resting"  # on touchdown bearings
CRITICAL_AMPLIFICATION = 2.5  # of the unbalance response, from which API 617 calls a speed critical
PLANAR_LIMIT = 0.1  # of a circle's turning; below, a whirl is told as planar
HEAD = "[Hz]", "[rpm]", "damping ratio", "log decrement", "whirl"


def held_lines(held: HeldModes, title: str) -> Iterator[str]:
    """A table of the modes under `title`, and one of the critical speeds."""
    verdict = "stable" if held.modes.stable else "UNSTABLE"
    if title == RESTING and held.modes.stable:
        verdict += " without friction, whose whirl `touchdown whirl` predicts"
    if held.modes.free:
        verdict += ", but not held everywhere: it may drift"
    yield f"  {title} at {RPM * held.speed:.6g} rpm: {verdict}"
    rows = [["mode", *HEAD, ""]]
    for number, k in enumerate(held.swinging[:MAX_LISTED_MODES], 1):
        grows = "grows" if held.modes.damping_ratios[k] < -MIN_DAMPING_RATIO else ""
        rows.append([str(number), *_cells(complex(held.modes.roots[k]), float(held.modes.sense[k])), grows])
    yield from aligned(rows, "<>>>>><", "  ")
    slow = len(held.modes.roots) - len(held.swinging)
    if slow:
        yield f"  {slow} more are overdamped (damping ratio of 0.95 or more)"
    yield from _falling(held)
    yield ""
    yield from _critical_lines(held)
    yield ""


def whirl_name(sense: float) -> str:
    """Which way a mode turns, in a word."""
    return "planar" if abs(sense) < PLANAR_LIMIT else "forward" if sense > 0.0 else "backward"


def _cells(root: complex, sense: float) -> tuple[str, str, str, str, str]:
    """Under `HEAD`."""
    roots = np.array([root])
    hertz = root.imag / (2.0 * math.pi)
    ratio, decrement = (
        round(float(figure(roots)[0]), 4) + 0.0 for figure in (damping_ratios, log_decrements)
    )
    return f"{hertz:.2f}", f"{60.0 * hertz:.0f}", f"{ratio:.4f}", f"{decrement:.4f}", whirl_name(sense)


def _falling(held: HeldModes) -> Iterator[str]:
    """Lines on motion that grows without a swing, and on the speeds of the diagram at which any grows."""
    if held.modes.pushed_away:
        yield "  it is statically unstable: it is pushed away without a swing"
    rpm, grows = RPM * held.lines.speeds, ~held.lines.stable
    stretches = np.split(np.arange(len(rpm)), np.flatnonzero(np.diff(grows)) + 1)
    ranges = [f"{rpm[one[0]]:.0f} and {rpm[one[-1]]:.0f}" for one in stretches if grows[one].any()]
    if ranges:
        yield f"  it is unstable between {', '.join(ranges)} rpm of the diagram"


def _critical_lines(held: HeldModes) -> Iterator[str]:
    end = RPM * held.lines.speeds[-1]
    if not held.lines.crossings:
        yield f"  no critical speed up to {end:.0f} rpm"
        return
    yield f"  critical speeds up to {end:.0f} rpm: synchronous (1x) crossings of damped whirls"
    rows = [["", *HEAD, "AF"]]
    for number, one in enumerate(held.lines.crossings, 1):
        ratio = float(damping_ratios(np.array([one.root]))[0])
        factor = f"{0.5 / ratio:.3g}" if ratio > MIN_DAMPING_RATIO else "-"
        rows.append([str(number), *_cells(one.root, one.sense), factor])
    yield from aligned(rows, "<>", "  ")
    yield (
        "  AF: amplification factor 1/(2 damping ratio); API 617 calls a speed critical from "
        f"{CRITICAL_AMPLIFICATION:g} on"
    )
    yield "  unbalance excites forward whirls only, where bearings are alike in both directions"
