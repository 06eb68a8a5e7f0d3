"""Orbits of the journal in its bearings, to one scale."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from touchdown.master.results.figures.style import BLACK, BLUE, GREY, ORANGE, sized

MOST_COLUMNS = 3
REACH = 1.08  # of the largest distance drawn
UM = 1e6
MOST = 12_000  # points of an orbit


@dataclass(frozen=True)
class Orbit:
    """A journal's way about the middle of its housing (m)."""

    title: str
    x: np.ndarray  # (rows,)
    y: np.ndarray
    landing: np.ndarray  # which rows are of the first impact
    clearance: float | None
    middle: tuple[float, float] = (
        0.0,
        0.0,
    )  # of the housing at the start, from the magnetic bearings' axis


def orbits(figure: Figure, shown: list[Orbit]) -> None:
    """Orbits side by side [µm]; the first impact in another colour, a dot at the end."""
    columns = min(len(shown), MOST_COLUMNS)
    rows = -(-len(shown) // columns)
    side = 4.5 if columns < MOST_COLUMNS else 3.1
    panels = sized(figure, side * columns, (side + 0.1) * rows).subplots(rows, columns, squeeze=False)
    reach = UM * max(_reach(orbit) for orbit in shown)
    for axes, orbit in zip(panels.flat, shown, strict=False):
        _draw(axes, orbit)
        axes.set_xlim(-REACH * reach, REACH * reach)
        axes.set_ylim(-REACH * reach, REACH * reach)
    for axes in list(panels.flat)[len(shown) :]:
        axes.set_visible(False)


def _reach(orbit: Orbit) -> float:
    """How far anything lies from the origin (m)."""
    x, y = orbit.middle
    most = max(float(np.max(np.abs(orbit.x + x))), float(np.max(np.abs(orbit.y + y))))
    return max(most, max(abs(x), abs(y)) + (orbit.clearance or 0.0))


def _draw(axes: Axes, orbit: Orbit) -> None:
    x0, y0 = (UM * value for value in orbit.middle)
    if orbit.clearance is not None:
        angle = np.linspace(0.0, 2.0 * np.pi, 361)
        radius = UM * orbit.clearance
        axes.plot(x0 + radius * np.cos(angle), y0 + radius * np.sin(angle), "--", color=GREY, lw=1.0)
    stride = -(-len(orbit.x) // MOST)
    x, y = x0 + UM * orbit.x, y0 + UM * orbit.y
    axes.plot(x[::stride], y[::stride], color=BLUE, lw=0.6)
    axes.plot(x[orbit.landing], y[orbit.landing], color=ORANGE, lw=1.3)
    axes.plot(0.0, 0.0, "x", color=BLACK, ms=6)
    axes.plot(x[-1], y[-1], "o", color=BLACK, ms=4)
    axes.set_aspect("equal", adjustable="box")
    axes.grid(alpha=0.4, lw=0.5)
    axes.set_title(orbit.title)
    axes.set_xlabel("x [µm]")
    axes.set_ylabel("y [µm]")
