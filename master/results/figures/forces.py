"""Contact forces in a touchdown bearing over time."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import FigureBase

from touchdown.master.coupling.connections import Attachment
from touchdown.master.coupling.loop.span import zero_of
from touchdown.master.results.ending import Finished
from touchdown.master.results.figures.style import (
    BLUE,
    GREEN,
    ORANGE,
    TIME,
    Curve,
    beginning,
    present,
    sized,
    thinned,
    within,
    zooms,
)
from touchdown.master.results.recording import Recording
from touchdown.master.results.summary import is_heard

FIRST = 0.5  # s, the first zoom
IMPACT = 5e-3  # s, the inset from the first touch on
INSET = (0.5, 0.4, 0.48, 0.48)  # of the panel: left, bottom, width, height
LABELS = 0.06  # of the panel: the inset's numbers
FEWEST = 10  # recorded values that make an inset
HARDEST = "hardest.ball"
NORMAL, TANGENTIAL = ORANGE, GREEN


@dataclass(frozen=True)
class Row:
    """Forces that share an axis."""

    label: str
    curves: tuple[Curve, ...]


ROTOR = Row("rotor on ring", (Curve("contact.force", "normal", BLUE),))
LOADED = Row("most loaded ball", (Curve("balls.force", "normal", NORMAL),))
NEIGHBOURS = Row("ball on next ball", (Curve("neighbours.force", "normal, largest", NORMAL),))


def forces(figure: FigureBase, run: Finished, a: Attachment) -> list[Axes]:
    """Forces of the rotor, and of the ball hit hardest where it is known (Figs 30-33)."""
    recording = run.recording
    chosen = _rows(recording, a)
    rows = [(r.label, c) for r in chosen if (c := present(recording, a.bearing, r.curves))]
    time = recording.time
    spans = zooms(time, FIRST)
    sized(figure, max(9.0, 1.0 + 5.5 * len(spans)), 1.0 + 2.5 * len(rows))
    grid = figure.subplots(len(rows), len(spans), squeeze=False, sharex="col")
    for row, (label, curves) in zip(grid, rows, strict=True):
        values = [recording[f"{a.bearing}.{c.variable}"] for c in curves]
        for axes, span in zip(row, spans, strict=True):
            part = within(time, span)
            for c, v in zip(curves, values, strict=True):
                axes.plot(*thinned(time[part], v[part]), color=c.colour, lw=c.width, label=c.label)
            axes.set_xlim(*span)
            axes.ticklabel_format(useOffset=False)
        row[0].set_ylabel(f"{label} [N]")
        if len(curves) > 1:
            row[-1].legend(loc="upper right")
    first = first_contact(run, a)
    if first is not None and within(time, (first, first + IMPACT)).sum() > FEWEST:
        for row, (_, curves) in zip(grid, rows, strict=True):
            shown = [(c, recording[f"{a.bearing}.{c.variable}"]) for c in curves]
            _first_impact(row[0], time, shown, first)
    _label_columns(grid[0], grid[-1], spans, (beginning(time), float(time[-1])))
    peak = run.system.value(f"{a.bearing}.contact.peak_force")
    by = ", heard from means over macro steps" if is_heard(run.system, a) else ""
    figure.suptitle(f"{run.scene.title}\nlargest contact force {peak:.1f} N{by}{_which(recording, a)}")
    return list(grid.flat)


def first_contact(run: Finished, a: Attachment) -> float | None:
    """When the journal first touched (s from the scene's zero); None where it never did."""
    touched = run.system.value(f"{a.bearing}.contact.first_time")
    return None if touched == -1.0 else touched - zero_of(run.scene, run.system)


def _first_impact(
    axes: Axes, time: np.ndarray, shown: list[tuple[Curve, np.ndarray]], first: float
) -> None:
    """The first impact in an inset; `axes` make room for it where the forces have not died down."""
    part = within(time, (first - 0.1 * IMPACT, first + IMPACT))
    inset = axes.inset_axes(INSET)
    for c, values in shown:
        inset.plot(1e3 * (time[part] - first), values[part], color=c.colour, lw=c.width)
    inset.set_xlim(-100.0 * IMPACT, 1e3 * IMPACT)
    inset.tick_params(labelsize="x-small")
    inset.set_title("first impact, ms from the first touch", fontsize="x-small", pad=2)
    for side in ("top", "right"):
        inset.spines[side].set_visible(True)
    left, right = axes.get_xlim()
    below = within(time, (left + (INSET[0] - LABELS) * (right - left), right))
    highest = max((float(np.max(values[below])) for _, values in shown if below.any()), default=0.0)
    axes.set_ylim(top=max(axes.get_ylim()[1], highest / (INSET[1] - 2.0 * LABELS)))


def _rows(recording: Recording, a: Attachment) -> list[Row]:
    if f"{a.bearing}.{HARDEST}" not in recording:
        return [ROTOR, LOADED, NEIGHBOURS]
    side = "ball and cage" if f"{a.bearing}.cage.x" in recording else "ball and neighbours"
    return [ROTOR, _both("ball and inner race", "inner"), _both("ball and outer race", "outer"),
            _both(side, "side")]  # fmt: skip


def _both(label: str, place: str) -> Row:
    return Row(
        label,
        (
            Curve(f"hardest.{place}_normal", "normal", NORMAL),
            Curve(f"hardest.{place}_tangential", "tangential", TANGENTIAL),
        ),
    )


def _which(recording: Recording, a: Attachment) -> str:
    """Which ball the rows are about, where they are about one."""
    name = f"{a.bearing}.{HARDEST}"
    if name not in recording or recording[name][-1] == 0:
        return ""
    return f"; the ball is number {recording[name][-1]:.0f}, the one hit hardest"


def _label_columns(
    top: list[Axes], bottom: list[Axes], spans: list[tuple[float, float]], whole: tuple[float, float]
) -> None:
    for head, foot, span in zip(top, bottom, spans, strict=True):
        head.set_title("whole run" if span == whole else f"{round(span[0], 9):g} s to {span[1]:g} s")
        foot.set_xlabel(TIME)
