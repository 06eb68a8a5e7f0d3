"""Pictures of a run."""

from __future__ import annotations

from pathlib import Path

import matplotlib

matplotlib.use("Agg")

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from master.recording import Recording
from master.scene import Scene
from master.summary import energy_total, touchdown_seats
from master.system import Attachment, System

BLUE, ORANGE, GREEN, PURPLE, GREY = "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#666666"
COLOURS = (BLUE, ORANGE, GREEN, PURPLE, GREY)
STYLES = ("-", "--", ":", "-.")  # one per component
MOST_POINTS = 20_000  # drawn per line; peaks are kept
UM = 1e6


def draw_all(scene: Scene, system: System, recording: Recording, folder: Path) -> list[Path]:
    """Draw what the scene is about into `folder`; returns the files."""
    made: list[Path] = []
    seats = touchdown_seats(system)
    for a in seats:
        tail = f"-{a.bearing}" if len(seats) > 1 else ""
        made.append(_save(orbit(scene, system, recording, a), folder / f"orbit{tail}.png"))
        made.append(_save(forces(scene, system, recording, a), folder / f"force{tail}.png"))
        if f"{a.bearing}.speed.ring" in recording:
            made.append(_save(speeds(scene, system, recording, a), folder / f"speeds{tail}.png"))
    if energy_total(system, recording) is not None:
        made.append(_save(energy(scene, system, recording), folder / "energy.png"))
    return made


def orbit(scene: Scene, system: System, recording: Recording, a: Attachment) -> Figure:
    """Rotor in the clearance circle, its contact from near, and the orbit of the ring."""
    figure = Figure(figsize=(15, 5), layout="constrained")
    whole, near, inner = figure.subplots(1, 3)
    x, y = (UM * recording[f"{a.body}.{a.body_port}.{axis}"] for axis in "xy")
    for axes in (whole, near):
        if "clearance" in system.components[a.bearing].variables:
            radius = UM * system.value(f"{a.bearing}.clearance")
            angle = np.linspace(0.0, 2.0 * np.pi, 721)
            axes.plot(
                radius * np.cos(angle), radius * np.sin(angle), "--", color=GREY, lw=1, label="clearance"
            )
        axes.plot(x, y, color=BLUE, lw=0.6, label="rotor")
    whole.set_title("rotor")
    whole.legend(loc="upper right")
    lowest = float(np.min(y))
    near.set_xlim(-100, 100)
    near.set_ylim(lowest - 20, lowest + 180)
    near.set_title("rotor, where it lands")
    if f"{a.bearing}.ring.x" in recording:
        ring_x, ring_y = (UM * recording[f"{a.bearing}.ring.{axis}"] for axis in "xy")
        inner.plot(ring_x, ring_y, color=ORANGE, lw=0.5, label="inner ring")
    if "housing.x" in system.components[a.bearing].variables:
        source = next(
            (c for c in system.connections if (c.target, c.input) == (a.bearing, "housing.x")), None
        )
        if source is not None:
            port = source.output.rpartition(".")[0]
            hx, hy = (UM * recording[f"{source.source}.{port}.{axis}"] for axis in "xy")
            inner.plot(hx, hy, color=GREEN, lw=0.5, label="outer ring")
    inner.set_title("rings")
    if inner.has_data():
        inner.legend(loc="upper right")
    for axes in (whole, near, inner):
        axes.set_xlabel("x [µm]")
        axes.set_ylabel("y [µm]")
        axes.set_aspect("equal", adjustable="datalim" if axes is inner else "box")
    figure.suptitle(scene.title)
    return figure


def speeds(scene: Scene, system: System, recording: Recording, a: Attachment) -> Figure:
    """Circumferential speeds while the ring is spun up, and from its synchronism on (Figs 25, 26)."""
    figure = Figure(figsize=(13, 5), layout="constrained")
    first, rest = figure.subplots(1, 2)
    time = recording.time
    labels = {
        "rotor": "rotor / 2, at the race",
        "ring": "inner race / 2",
        "cage": "cage",
        "orbit": "balls, mean orbit",
        "ball": "balls, mean spin",
    }
    lines = [
        (label, recording[f"{a.bearing}.speed.{name}"])
        for name, label in labels.items()
        if f"{a.bearing}.speed.{name}" in recording
    ]
    zero = system.value(scene.zero) if scene.zero else 0.0
    sync = max(system.value(f"{a.bearing}.ring.sync_time") - zero, 0.0) or float(time[-1])
    spin_up = (time >= 0.0) & (time <= 1.5 * sync)
    afterwards = time >= min(1.2 * sync, 0.5 * time[-1])
    for axes, part in ((first, spin_up), (rest, afterwards)):
        for (label, values), colour in zip(lines, COLOURS, strict=False):
            _line(axes, time[part], values[part], colour, label)
        axes.set_xlabel("time from the shutdown [s]")
        axes.set_ylabel("circumferential speed [m/s]")
    first.set_title("spin-up")
    rest.set_title("afterwards")
    first.legend()
    figure.suptitle(scene.title)
    return figure


def forces(scene: Scene, system: System, recording: Recording, a: Attachment) -> Figure:
    """Contact force of the rotor, and the largest ball force, at the landing, at first and at last."""
    figure = Figure(figsize=(15, 7), layout="constrained")
    rows = [("contact.force", "rotor on ring [N]", BLUE), ("balls.force", "most loaded ball [N]", ORANGE)]
    rows = [row for row in rows if f"{a.bearing}.{row[0]}" in recording]
    grid = figure.subplots(len(rows), 3, squeeze=False)
    time = recording.time
    end = float(time[-1])
    spans = ((0.0, min(0.05, end)), (0.0, end), (max(0.0, end - 0.05), end))
    for row, (name, label, colour) in zip(grid, rows, strict=True):
        values = recording[f"{a.bearing}.{name}"]
        for axes, (start, stop) in zip(row, spans, strict=True):
            part = (time >= start) & (time <= stop)
            _line(axes, time[part], values[part], colour, label)
            axes.set_xlabel("time from the shutdown [s]")
            axes.set_ylabel(label)
    peak = system.value(f"{a.bearing}.contact.peak_force")
    figure.suptitle(f"{scene.title}: largest contact force {peak:.1f} N")
    return figure


def energy(scene: Scene, system: System, recording: Recording) -> Figure:
    """Where the energy is: what fell, what went into rings and balls, what became heat; and the balance."""
    figure = Figure(figsize=(13, 5), layout="constrained")
    flows, check = figure.subplots(1, 2)
    time = recording.time
    for name, style in zip(system.components, STYLES * 4, strict=False):
        variables = ("energy.kinetic", "energy.potential", "energy.dissipated")
        for variable, colour in zip(variables, COLOURS, strict=False):
            if f"{name}.{variable}" in recording:
                values = recording[f"{name}.{variable}"]
                change = values - values[0]
                if np.any(change):
                    label = f"{name} {variable.partition('.')[2]}"
                    _line(flows, time, change, colour, label, style)
    flows.set_ylabel("change since the start [J]")
    flows.legend(fontsize="small")
    total = energy_total(system, recording)
    assert total is not None
    _line(check, time, total - total[0], BLUE, "sum of all")
    check.set_ylabel("energy balance [J]")
    check.set_title("sum of all energies: zero where nothing is lost or made")
    for axes in (flows, check):
        axes.set_xlabel("time from the shutdown [s]")
    figure.suptitle(scene.title)
    return figure


def _line(axes: Axes, x: np.ndarray, y: np.ndarray, colour: str, label: str, style: str = "-") -> None:
    """A line of at most MOST_POINTS points that keeps each stretch's smallest and largest value."""
    if len(x) > MOST_POINTS:
        size = -(-len(x) // (MOST_POINTS // 2))
        count = len(x) // size
        blocks = y[: count * size].reshape(count, size)
        index = np.sort(np.stack([blocks.argmin(1), blocks.argmax(1)], 1), axis=1)
        index = (index + np.arange(count)[:, None] * size).ravel()
        x, y = x[index], y[index]
    axes.plot(x, y, style, color=colour, lw=0.8, label=label)


def _save(figure: Figure, path: Path) -> Path:
    figure.savefig(path, dpi=110)
    return path
