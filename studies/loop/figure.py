"""|S| of every loop over the frequency with the zones, and its peak over the speed."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from ...reports.figures.style import COLOURS, FAINT, GREY, save, sheet
from .margins import WORST, ZONES
from .over_speed import HZ, RPM, Found

WIDTH, HEIGHT = 9.0, 4.0  # inch
STYLES = ("-", "--", ":", "-.")


def draw(found: Found, path: Path) -> None:
    """Both panels, at `path`."""
    figure = sheet(WIDTH, HEIGHT)
    left, right = figure.subplots(1, 2, width_ratios=(2, 1))
    own = found.own
    for k, name in enumerate(found.loops.names):
        style = {"color": COLOURS[k // 2 % len(COLOURS)], "ls": STYLES[k % 2], "lw": 1.2}
        size = np.abs(own.values[:, k]) if own.margins else np.full(len(own.omega), np.nan)
        left.semilogx(HZ * own.omega, 20 * np.log10(np.maximum(size, 1e-12)), label=name, **style)
        stable = [at for at in found.speeds if at.margins]
        speeds = [RPM * at.speed for at in stable]
        peaks = [20 * math.log10(at.margins[k].peak) for at in stable]
        right.plot(speeds, peaks, marker="o", ms=3, **style)
    names = [name for _, name in ZONES] + [WORST]
    for axes in (left, right):
        for (limit, _), below, above in zip(ZONES, names, names[1:], strict=False):
            level = 20 * math.log10(limit)
            axes.axhline(level, color=GREY, lw=0.6)
            place = axes.get_yaxis_transform()
            axes.text(0.01, level, f"{below} | {above}", fontsize=6, transform=place, va="bottom")
        axes.grid(color=FAINT, lw=0.5)
        axes.set_ylim(-40 if axes is left else 0, 18)
    left.set_xlabel("frequency [Hz]")
    left.set_ylabel("|S| [dB]")
    left.set_title(f"{found.scene.title}, {RPM * own.speed:.0f} rpm{'' if own.margins else ', unstable'}")
    left.legend(fontsize=7)
    right.set_xlabel("speed [rpm]")
    right.set_ylabel("max |S| [dB]")
    save(figure, path, dpi=110)
