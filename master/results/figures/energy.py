"""Where the energy of a run is."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import FigureBase

from touchdown.master.results.ending import Finished
from touchdown.master.results.figures.style import BLUE, COLOURS, TIME, WIDTH, sized, thinned
from touchdown.master.results.summary import energy_total

STYLES = ("-", "--", ":", "-.")  # one per component


def energy(figure: FigureBase, run: Finished) -> list[Axes]:
    """Where the energy is: what fell, what went into rings and balls, what became heat; and the balance."""
    system, recording = run.system, run.recording
    flows, check = sized(figure, 13, 5).subplots(1, 2)
    time = recording.time
    for name, style in zip(system.components, STYLES * 4, strict=False):
        variables = ("energy.kinetic", "energy.potential", "energy.dissipated")
        for variable, colour in zip(variables, COLOURS, strict=False):
            if f"{name}.{variable}" in recording:
                values = recording[f"{name}.{variable}"]
                change = values - values[0]
                if np.any(change):
                    label = f"{name} {variable.partition('.')[2]}"
                    flows.plot(*thinned(time, change), style, color=colour, lw=WIDTH, label=label)
    flows.set_ylabel("change since the start [J]")
    flows.legend(fontsize="small")
    total = energy_total(system, recording)
    assert total is not None
    check.plot(*thinned(time, total - total[0]), color=BLUE, lw=WIDTH, label="sum of all")
    check.set_ylabel("energy balance [J]")
    check.set_title("sum of all energies: zero where nothing is lost or made")
    for axes in (flows, check):
        axes.set_xlabel(TIME)
    figure.suptitle(run.scene.title)
    return [flows, check]
