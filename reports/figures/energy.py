"""Where the energy of a run is."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import FigureBase

from ...master.common.text import joined
from ...master.results.final_state import Finished
from ...master.results.summary import energy_total
from .style import BLACK, BLUE, COLOURS, SKY, TIME, WIDTH, YELLOW, calm, sized, thinned

PALETTE = (*COLOURS, BLACK, SKY, YELLOW)  # one per component
MARKS = "osD^vP*X<"  # likewise; as many as are prime to the colours, so that pairs repeat late
STYLES = {"kinetic": "-", "potential": "--", "dissipated": ":"}
MIN_DRAWN_CHANGE = 1e-3  # of the largest change; less is named, not drawn
NOTHING = 1e-6  # of the largest change: the balance is drawn no larger
MAX_NAMES = 22  # in a column of the legend
MAX_SMALL = 4  # of what changes little, named above the panel
MARK_SPACING = 0.12  # of the panel's diagonal, between two marks of a curve


def energy(figure: FigureBase, run: Finished) -> list[Axes]:
    """Where the energy is: what fell, what went into rings and balls, what became heat; and the balance.

    Colour and mark tell components apart, also where their curves coincide; the style of the line, kinds of
    energy. What changes by less than MIN_DRAWN_CHANGE of the largest is named above the panel.
    """
    system, recording = run.system, run.recording
    flows, check = sized(figure, 15, 5.5).subplots(1, 2)
    changes = {
        (name, kind): recording[f"{name}.energy.{kind}"] - recording[f"{name}.energy.{kind}"][0]
        for name in system.components
        for kind in STYLES
        if f"{name}.energy.{kind}" in recording
    }
    _draw(flows, recording.time, changes)
    flows.set_ylabel("change since the start [J]")
    total = energy_total(system, recording)
    assert total is not None
    check.plot(*thinned(recording.time, total - total[0]), color=BLUE, lw=WIDTH, label="sum of all")
    calm(check, changes.values(), NOTHING)
    check.set_ylabel("energy balance [J]")
    check.set_title("sum of all energies: zero where nothing is lost or made")
    for axes in (flows, check):
        axes.set_xlabel(TIME)
    figure.suptitle(run.scene.title)
    return [flows, check]


def _draw(axes: Axes, time: np.ndarray, changes: Mapping[tuple[str, str], np.ndarray]) -> None:
    """Curves of the `changes` (J), by component and kind, with their legend."""
    size = {key: float(np.max(np.abs(change))) for key, change in changes.items()}
    least = MIN_DRAWN_CHANGE * max(size.values(), default=0.0)
    names = list(dict.fromkeys(name for name, _ in changes))
    for i, (name, kind) in enumerate(changes):
        if size[name, kind] > least:
            number = names.index(name)
            axes.plot(
                *thinned(time, changes[name, kind]),
                STYLES[kind],
                color=PALETTE[number % len(PALETTE)],
                marker=MARKS[number % len(MARKS)],
                markevery=(
                    MARK_SPACING * ((0.38 * i) % 1.0),
                    MARK_SPACING,
                ),  # beside each other where curves coincide
                markersize=4,
                lw=WIDTH,
                label=f"{name} {kind}",
            )
    _name(axes)
    small = [f"{name} {kind}" for name, kind in changes if 0.0 < size[name, kind] <= least]
    if small:
        axes.set_title(f"below {least:.1g} J: {joined(small, most=MAX_SMALL)}", fontsize="x-small")


def _name(axes: Axes) -> None:
    """The legend to the right of the panel, in the order in which the curves end there."""
    lines = sorted(axes.lines, key=lambda line: -float(np.asarray(line.get_ydata())[-1]))
    if lines:
        columns = 1 + (len(lines) - 1) // MAX_NAMES
        beside = {"loc": "center left", "bbox_to_anchor": (1.01, 0.5), "frameon": False}
        axes.legend(handles=lines, ncols=columns, **beside)
