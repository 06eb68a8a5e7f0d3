"""Several runs in one picture each of forces, orbits and gaps, a colour for every run."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from functools import partial
from itertools import cycle
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ...master.common.text import UM
from ...master.coupling.connections import Attachment
from ...master.results.final_state import Finished
from ...master.results.least_gaps import left_of
from ...master.results.recording import NotRecordedError
from ...master.results.summary import relative_orbit, seat_name, touchdown_seats
from ...master.scene.gaps import RotorGap
from .motion import MAX_ORBIT_POINTS, draw_clearance
from .style import COLOURS, TIME, WIDTH, beginning, sheet, styled, thinned

Runs = Mapping[str, Finished]  # by what each is called
Places = Callable[[Finished], Mapping[str, Any]]  # where a run shows something, by the words of a title
Draw = Callable[..., None]  # on axes, a run at a place


def overlays(runs: Runs) -> Iterator[tuple[str, Callable[[], Figure]]]:
    """The name of each picture's file, and what draws it; only what at least one of the runs has."""
    for name, places, draw, size in (
        ("force", _seats, _force, (9.0, 3.0)),
        ("orbit", _seats, _orbit, (5.6, 6.0)),
        ("gaps", lambda run: {gap.name: gap for gap in run.scene.gaps}, _gap, (9.0, 3.0)),
    ):
        titles = list(dict.fromkeys(title for run in runs.values() for title in places(run)))
        if titles:
            yield f"{name}.png", partial(_drawn, runs, titles, places, draw, size)


def _drawn(runs: Runs, titles: list[str], places: Places, draw: Draw, size: tuple[float, float]) -> Figure:
    """Panels of a size (inch), one for each title: wide ones below each other, others side by side."""
    rows, columns = (len(titles), 1) if size[0] > size[1] else (1, len(titles))
    with styled():
        figure = sheet(columns * size[0], 0.5 + rows * size[1])
        panels = figure.subplots(rows, columns, squeeze=False)
        for axes, title in zip(panels.flat, titles, strict=True):
            axes.set_title(title)
            for (label, run), colour in zip(runs.items(), cycle(COLOURS), strict=False):
                with suppress(NotRecordedError):
                    if title in (there := places(run)):
                        draw(axes, run, there[title], color=colour, label=label, lw=WIDTH)
        drawn = [axes.get_legend_handles_labels() for axes in panels.flat]
        handles = {label: one for pair in drawn for one, label in zip(*pair, strict=True)}
        figure.legend(handles.values(), handles, loc="outside upper center", ncols=len(handles))
    return figure


def _seats(run: Finished) -> dict[str, Attachment]:
    seats = touchdown_seats(run.system)
    recorded = [a for a in seats if f"{a.bearing}.contact.force" in run.recording]
    return {f"{seat_name(a, seats)} ({a.bearing})": a for a in recorded}


def _force(axes: Axes, run: Finished, a: Attachment, **line: Any) -> None:
    axes.plot(*thinned(run.recording.time, run.recording[f"{a.bearing}.contact.force"]), **line)
    _over_time(axes, run, "contact force [N]")


def _gap(axes: Axes, run: Finished, gap: RotorGap, **line: Any) -> None:
    found = left_of(gap, run.recording)
    axes.plot(*thinned(found.time, UM * found.left), **line)
    _over_time(axes, run, "gap left [µm]")


def _over_time(axes: Axes, run: Finished, what: str) -> None:
    axes.set_xlim(left=beginning(run.recording.time))
    axes.set_xlabel(TIME)
    axes.set_ylabel(what)


def _orbit(axes: Axes, run: Finished, a: Attachment, **line: Any) -> None:
    x, y = (UM * values for values in relative_orbit(run.system, a, run.recording))
    stride = -(-len(x) // MAX_ORBIT_POINTS)
    axes.plot(x[::stride], y[::stride], **line)
    draw_clearance(axes, run, a, (0.0, 0.0), line["color"])
    axes.set_aspect("equal", adjustable="datalim")
    axes.set_xlabel("x against the housing [µm]")
    axes.set_ylabel("y against the housing [µm]")
