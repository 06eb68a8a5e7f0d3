"""Stresses of a flexible rotor: along its axis when they were kept, and over time (Fig 20)."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import FigureBase

from ...master.coupling.loop.span import zero_of
from ...master.quantities import STRESSES
from ...master.results.final_state import Finished, ReadableComponent, ReadableSystem
from ...master.results.stresses import along, kept_instant
from .style import BLUE, GREY, ORANGE, PURPLE, TIME, beginning, draw_dense, key_below, sized

MPA = 1e-6
PLANES = (("x", "horizontal (x)", BLUE), ("y", "vertical (y)", ORANGE))


def has_stress(system: ReadableSystem, name: str) -> bool:
    """Whether component `name` tells where along its axis it had any stress."""
    component = system.components[name]
    return bool(along(component, "position")[0]) and component.read(["stress.peak_bending"])[0] > 0.0


def stress(figure: FigureBase, run: Finished, name: str) -> list[Axes]:
    """Bending and shear stress of rotor `name` [MPa] over its axis [mm] and over time [s].

    Along the axis: both planes at the kept instant, in front of each node's largest resultant of the
    whole run. Over time: the largest resultant anywhere, and the instant that was kept.
    """
    component = run.system.components[name]
    zero = zero_of(run.scene, run.system)
    kept = kept_instant(component)
    grid = sized(figure, 13, 9.6).subplots(2, len(STRESSES), sharex="row")
    for kind, axial, timed in zip(STRESSES, *grid, strict=True):
        draw_along(axial, component, kind, kept is not None)
        _draw_history(timed, run, name, kind, zero)
        if kept is not None:
            timed.axvline(kept - zero, color=GREY, ls="--", lw=1.0, label="instant shown above")
        key_below(timed, 1)
    when = "" if kept is None else f": along the rotor at {kept - zero:.5g} s, and over time"
    figure.suptitle(f"{run.scene.title}\nstresses of {name}{when}")
    return list(grid.flat)


def draw_along(axes: Axes, component: ReadableComponent, kind: str, kept: bool) -> None:
    """Stress of a kind [MPa] along the axis [mm]: both planes at the kept instant, the run's largest."""
    position = 1e3 * np.array(along(component, "position")[1])
    envelope = MPA * np.array(along(component, f"peak_{kind}")[1])
    if len(envelope) == len(position):
        label = "largest resultant of the run, node by node"
        axes.fill_between(position, -envelope, envelope, color=GREY, alpha=0.18, lw=0.0, label=label)
    for axis, plane, colour in PLANES if kept else ():
        values = MPA * np.array(along(component, f"{kind}_{axis}")[1])
        if len(values) == len(position):
            axes.plot(position, values, ".-", color=colour, lw=1.2, ms=5, label=plane)
    axes.axhline(0.0, color=GREY, lw=0.5)
    axes.margins(x=0.01)
    axes.set_xlabel("position along the rotor's axis [mm]")
    axes.set_ylabel(f"{kind} stress [MPa]")
    key_below(axes, 1)


def _draw_history(axes: Axes, run: Finished, name: str, kind: str, zero: float) -> None:
    """Largest stress along the rotor; the peak may lie between two recorded values."""
    component, recording = run.system.components[name], run.recording
    time = recording.time
    if f"{name}.stress.{kind}" in recording:
        shown = time >= beginning(time)
        values = MPA * recording[f"{name}.stress.{kind}"]
        draw_dense(axes, time[shown], values[shown], BLUE, "largest along the rotor")
    names = [f"stress.peak_{kind}{tail}" for tail in ("", "_time", "_node")]
    if all(n in component.variables for n in names):
        peak, peak_time, node = component.read(names)
        label = f"{MPA * peak:.3g} MPa at node {node:.0f}"
        axes.plot([peak_time - zero], [MPA * peak], "o", color=PURPLE, ms=5, label=label)
    axes.set_xlim(beginning(time), float(time[-1]))
    axes.set_ylim(bottom=0.0)
    axes.set_xlabel(TIME)
    axes.set_ylabel(f"{kind} stress [MPa]")
