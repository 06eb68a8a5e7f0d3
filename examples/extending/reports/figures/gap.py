"""How far the journal is from the bore over time."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import FigureBase

from ...master.coupling.connections import Attachment
from ...master.results.final_state import Finished
from .style import BLUE, TIME, WIDTH, sized, thinned


def gap(figure: FigureBase, run: Finished, a: Attachment) -> Axes:
    """Clearance less the journal's distance from the middle [µm]; below 0 it is pressed in."""
    x, y = (run.recording[a.motion(axis)] for axis in "xy")
    axes = sized(figure, 9, 4).subplots()
    clearance = run.system.value(f"{a.bearing}.clearance")
    width = 1e6 * (clearance - np.hypot(x, y))
    axes.plot(*thinned(run.recording.time, width), color=BLUE, lw=WIDTH, label=a.bearing)
    axes.set_xlabel(TIME)
    axes.set_ylabel("gap [µm]")
    axes.set_title(run.scene.title)
    return axes
