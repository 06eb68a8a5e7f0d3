"""What is left of the gaps around the rotor."""

from __future__ import annotations

from matplotlib.axes import Axes
from matplotlib.figure import FigureBase

from ..final_state import Finished
from ..gaps import left_of
from .style import COLOURS, GREY, TIME, WIDTH, sized, thinned


def gaps_left(figure: FigureBase, run: Finished) -> Axes:
    """Each gap of the scene over time [µm]; at 0 the rotor touches the stator."""
    axes = sized(figure, 9, 4.5).subplots()
    for number, gap in enumerate(run.scene.gaps):
        found = left_of(gap, run.recording)
        label = f"{gap.name}, {1e3 * gap.radial:g} mm"
        colour = COLOURS[number % len(COLOURS)]
        axes.plot(*thinned(found.time, 1e6 * found.left), color=colour, lw=WIDTH, label=label)
    axes.axhline(0.0, color=GREY, lw=1)
    axes.set_xlabel(TIME)
    axes.set_ylabel("gap left [µm]")
    axes.set_title(f"{run.scene.title}\nrotor against stator")
    axes.legend()
    return axes
