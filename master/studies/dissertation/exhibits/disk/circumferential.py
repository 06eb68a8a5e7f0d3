"""Circumferential speeds as the source draws them: all are equal where nothing slips (4.2)."""

from __future__ import annotations

from matplotlib.axes import Axes
from matplotlib.figure import FigureBase

from touchdown.master.coupling.connections import Attachment
from touchdown.master.results.ending import Finished
from touchdown.master.results.figures.style import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    ORANGE,
    PURPLE,
    TIME,
    Curve,
    present,
    thinned,
    within,
)

SPEEDS = (  # in the order they are drawn: what varies most first
    Curve("hardest.speed", "hardest-hit ball, spin", GREY),
    Curve("speed.cage", "cage", BLUE),
    Curve("speed.orbit", "balls, mean orbit", GREEN, 1.8),  # often hidden by the next
    Curve("speed.ball", "balls, mean spin", PURPLE),
    Curve("speed.ring", "inner race / 2", ORANGE),
    Curve("speed.rotor", "rotor / 2, at the race", BLACK),
)
Span = tuple[float, float]


def circumferential(
    figure: FigureBase, run: Finished, a: Attachment, spans: tuple[Span, ...], once_spun_up: Span
) -> list[Axes]:
    """Speeds of all bodies [m/s] over the `spans` (s), the second one between the source's limits (m/s)."""
    time = run.recording.time
    curves = present(run.recording, a.bearing, SPEEDS)
    row = list(figure.subplots(1, len(spans)))
    for axes, span in zip(row, spans, strict=True):
        part = within(time, span)
        for c in curves:
            values = run.recording[f"{a.bearing}.{c.variable}"][part]
            axes.plot(*thinned(time[part], values), color=c.colour, lw=c.width, label=c.label)
        axes.set_xlim(*span)
        axes.set_xlabel(TIME)
        axes.ticklabel_format(useOffset=False)
    row[0].set_ylabel("circumferential speed [m/s]")
    _between(row[1], once_spun_up)
    handles, labels = row[0].get_legend_handles_labels()
    figure.legend(handles[::-1], labels[::-1], loc="outside lower center", ncols=len(labels))
    figure.suptitle(run.scene.title)
    return row


def _between(axes: Axes, limits: Span) -> None:
    """The source's limits in a panel a little wider than they."""
    axes.set_title(f"the source's view: {limits[0]:g} to {limits[1]:g} m/s")
    for limit in limits:
        axes.axhline(limit, color=GREY, ls="--", lw=0.8)
    low, high = limits
    axes.set_ylim(low - 0.05 * (high - low), high + 0.2 * (high - low))
