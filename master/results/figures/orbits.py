"""The orbits at all seats of a scene side by side (Figs 14 and 17)."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import FigureBase

from touchdown.master.coupling.connections import Attachment
from touchdown.master.coupling.loop.span import zero_of
from touchdown.master.results.ending import Finished, housing_port
from touchdown.master.results.figures.style import BLACK, BLUE, GREY, ORANGE, sized
from touchdown.master.results.summary import course_at, relative_orbit, seat_name

UM = 1e6
COLUMNS = 4  # at most
MARGIN = 1.06  # of the largest distance drawn


def orbits(figure: FigureBase, run: Finished, seats: list[Attachment]) -> list[Axes]:
    """Journal at each of `seats` in its clearance circle [µm], all to the same scale.

    The origin is the axis of the magnetic bearings. The circle stands where the housing is at the start,
    so that a misalignment shows; the journal is drawn as it lies to its housing.
    """
    columns = min(len(seats), COLUMNS)
    rows = -(-len(seats) // columns)
    sized(figure, 5.6 * columns, 0.5 + 6.0 * rows)
    panels = list(figure.subplots(rows, columns, squeeze=False).flat)
    reach = max(_draw(axes, run, a, seat_name(a, seats)) for axes, a in zip(panels, seats, strict=False))
    for axes in panels[: len(seats)]:
        axes.set_xlim(-MARGIN * reach, MARGIN * reach)
        axes.set_ylim(-MARGIN * reach, MARGIN * reach)
    for axes in panels[len(seats) :]:
        axes.set_visible(False)
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=len(labels))
    figure.suptitle(run.scene.title)
    return panels[: len(seats)]


def _draw(axes: Axes, run: Finished, a: Attachment, seat: str) -> float:
    """One seat; returns how far from the origin anything lies (µm)."""
    system, recording = run.system, run.recording
    port = housing_port(system, a)
    centre = [UM * float(recording[f"{port}.{axis}"][0]) if port else 0.0 for axis in "xy"]
    x, y = (
        UM * values + middle
        for values, middle in zip(relative_orbit(system, a, recording), centre, strict=True)
    )
    reach = max(float(np.max(np.abs(x))), float(np.max(np.abs(y))))
    if "clearance" in system.components[a.bearing].variables:
        radius = UM * system.value(f"{a.bearing}.clearance")
        angle = np.linspace(0.0, 2.0 * np.pi, 721)
        circle = centre[0] + radius * np.cos(angle), centre[1] + radius * np.sin(angle)
        axes.plot(*circle, "--", color=GREY, lw=1, label="clearance")
        reach = max(reach, *(abs(middle) + radius for middle in centre))
    axes.plot(*centre, "+", color=GREY, ms=9, label="centre of the housing")
    axes.plot(x, y, color=BLUE, lw=0.6, label="rotor")
    axes.plot(0.0, 0.0, "x", color=BLACK, ms=6, label="axis of the magnetic bearings")
    axes.plot(x[-1], y[-1], "o", color=ORANGE, ms=5, label="rotor at the end")
    axes.set_aspect("equal", adjustable="box")
    axes.set_title(f"{seat} ({a.bearing}): {_verdict(run, a)}")
    axes.set_xlabel("x [µm]")
    axes.set_ylabel("y [µm]")
    return reach


def _verdict(run: Finished, a: Attachment) -> str:
    """Whirl in words, with its length and frequency."""
    here = course_at(run.system, a, run.recording, zero_of(run.scene, run.system))
    if here is None:
        return "no clearance, no verdict"
    whirl = here.whirl
    if whirl.frequency is None:
        return here.words
    return f"{here.words}\n{whirl.revolutions:.1f} revolutions at {whirl.frequency:.0f} Hz"
