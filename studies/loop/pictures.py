"""Pictures and tables of a scene's loops."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ...master.common.files import make_writable
from ...master.common.text import HZ, RPM
from ...modelkit.kernel.writing import replacing, write
from ...reports.figures.style import COLOURS, FAINT, GREY, save, sheet
from .linear_loops import Sampled
from .margins import WORST, ZONES
from .measured_response import Measured
from .over_speed import Found, damping_ratio
from .response import ZONES as VIBRATION_ZONES
from .response import UnbalanceResponse
from .transfer import Answers

if TYPE_CHECKING:
    import pandas

WIDTH, HEIGHT = 9.0, 4.0  # inch
STYLES = ("-", "--", ":", "-.")
LEAST_DB = -40.0  # of |S|, drawn
SPEEDS = 40  # of the Campbell diagram
SHOWN = 2  # bending modes of it
DAMPED = 0.5  # damping ratio from which poles are all of one colour


def write_loops(found: Found, folder: Path) -> None:
    """Write pictures and tables of the loops into `folder`, which is made."""
    make_writable(folder)
    for name, draw in _pictures(found):
        figure = sheet(WIDTH, HEIGHT)
        draw(figure)
        save(figure, folder / f"{name}.png", dpi=110)
    tables = {"answers": _answers(found), "unbalance": found.unbalance and found.unbalance.to_pandas()}
    for name, table in tables.items():
        if table is not None:
            write(folder / f"{name}.csv", table.to_csv())
    if isinstance(found.loops, Sampled):
        parts = {"plant": found.plant, "sampled_plant": found.sampled_plant, "controller": found.controller}
        matrices = {f"{name}.{key}": getattr(one, key) for name, one in parts.items() for key in "ABCD"}
        about: dict[str, Any] = {"axes": found.loops.names, "sample_time": found.sampled_plant.dt}
        with replacing(folder / "loops.npz") as file:
            np.savez(file, **about, **matrices)


def _answers(found: Found) -> pandas.DataFrame | None:
    """Those of the linear loops; where they were measured, also at those lines, with those beside."""
    import pandas

    if found.answers is None or found.measured is None:
        return found.answers and found.answers.to_pandas()
    both = [one.to_pandas() for one in (found.answers, found.measured.linear)]
    linear = pandas.concat(both).sort_index()
    linear = linear[~linear.index.duplicated()]
    return linear.join(found.measured.answers.to_pandas().add_prefix("measured "))


def _pictures(found: Found) -> Iterator[tuple[str, Callable[[Figure], None]]]:
    yield "amb-margins", lambda figure: _sensitivity(figure, found)
    yield "campbell", lambda figure: _campbell(figure, found)
    if (answers := found.answers) is not None:
        yield "bode", lambda figure: _bode(figure, answers, found.measured)
        yield "nyquist", lambda figure: _nyquist(figure, answers)
    if (response := found.unbalance) is not None and np.isfinite(response.orbits).any():
        yield "unbalance", lambda figure: _unbalance(figure, response)


def _style(axis: int) -> dict[str, Any]:
    """Of an axis: a colour for its bearing, a line for its direction."""
    return {"color": COLOURS[axis // 2 % len(COLOURS)], "ls": STYLES[axis % 2], "lw": 1.2}


def _dots(axis: int) -> dict[str, Any]:
    """Of what was measured at an axis."""
    return {**_style(axis), "ls": "", "marker": "o", "ms": 2.5}


def _label(axes: Axes, x: str, y: str, title: str = "") -> None:
    axes.set_xlabel(x)
    axes.set_ylabel(y)
    axes.set_title(title)
    axes.grid(color=FAINT, lw=0.5)


def _decibels(values: np.ndarray) -> np.ndarray:
    return 20.0 * np.log10(np.maximum(np.abs(values), 1e-300))


def _sensitivity(figure: Figure, found: Found) -> None:
    """|S| of every loop over the frequency with the zones, and its peak over the speed."""
    left, right = figure.subplots(1, 2, width_ratios=(2, 1))
    nominal = found.own
    for k, name in enumerate(found.loops.names):
        size = np.abs(nominal.values[:, k]) if nominal.margins else np.full(len(nominal.omega), np.nan)
        left.semilogx(HZ * nominal.omega, _decibels(size), label=name, **_style(k))
        if found.measured is not None:
            answers = found.measured.answers
            left.semilogx(HZ * answers.omega, _decibels(answers.values["S"][:, k]), **_dots(k))
        stable = [at_speed for at_speed in found.speeds if at_speed.margins]
        speeds = [RPM * at_speed.speed for at_speed in stable]
        peaks = [20 * math.log10(at_speed.margins[k].peak) for at_speed in stable]
        right.plot(speeds, peaks, marker="o", ms=3, **_style(k))
    for axes in (left, right):
        levels = [(20.0 * math.log10(limit), name) for limit, name in ZONES]
        _zones(axes, levels)
        axes.set_ylim(LEAST_DB if axes is left else 0, 18)
    stability = ", dots: measured" if found.measured else "" if nominal.margins else ", unstable"
    _label(left, "frequency [Hz]", "|S| [dB]",
           f"{found.scene.title}, {RPM * nominal.speed:.0f} rpm{stability}")  # fmt: skip
    _label(right, "speed [rpm]", "max |S| [dB]")
    left.legend(fontsize=7)


def _zones(axes: Axes, levels: list[tuple[float, str]]) -> None:
    """Lines at the upper limits of zones."""
    names = [name for _, name in levels] + [WORST]
    for (level, _), below, above in zip(levels, names, names[1:], strict=False):
        axes.axhline(level, color=GREY, lw=0.6)
        place = axes.get_yaxis_transform()
        axes.text(0.01, level, f"{below} | {above}", fontsize=6, transform=place, va="bottom")


def _campbell(figure: Figure, found: Found) -> None:
    """Frequencies of the closed loops' poles over the speed, coloured by their damping ratio."""
    axes = figure.subplots()
    highest = max(1.5 * abs(found.loops.speed), *(abs(one.speed) for one in found.speeds))
    bending = [mode.free.imag for mode in found.own.bending[:SHOWN]]
    top = HZ * max(3.0 * highest, 2.0 * math.pi * 100.0, *(1.15 * free for free in bending))
    dots = list[tuple[float, float, float]]()
    for speed in np.linspace(0.0, highest, SPEEDS):
        signed = math.copysign(speed, found.loops.speed)
        poles = found.loops.shown(signed, found.loops.closed(signed))
        upper = (pole for pole in map(complex, poles) if 0.0 < HZ * pole.imag < top)
        dots += [(RPM * speed, HZ * pole.imag, damping_ratio(pole)) for pole in upper]
    x, y, damping = np.array(dots).reshape(-1, 3).T
    drawn = axes.scatter(x, y, c=np.clip(damping, 0.0, DAMPED), s=9, cmap="viridis", vmin=0.0, vmax=DAMPED)
    grows = damping < 0.0
    if grows.any():
        axes.scatter(x[grows], y[grows], s=28, facecolors="none", edgecolors=COLOURS[1], label="grows")
    axes.plot([0.0, RPM * highest], [0.0, HZ * highest], color=GREY, lw=0.8, label="as fast as the rotor")
    axes.set_ylim(0.0, top)
    figure.colorbar(drawn, ax=axes, label="damping ratio [1]")
    axes.legend(fontsize=7, loc="upper left")
    _label(axes, "speed [rpm]", "frequency [Hz]",
           f"{found.scene.title}: poles of the closed loops\n{found.left_out}".rstrip())  # fmt: skip


PANELS = {  # of a Bode plot
    "L": "loop gain L [1]",
    "P": "plant P [m/A]",
    "C": "controller C [A/m]",
    "G": "compliance G [m/N]",
}


def _bode(figure: Figure, answers: Answers, measured: Measured | None) -> None:
    """Gain and phase of loop, plant, controller and compliance, by axis; dots: measured."""
    figure.set_size_inches(1.5 * WIDTH, 1.4 * HEIGHT)
    grid = figure.subplots(2, len(PANELS), sharex=True)
    for column, (name, title) in enumerate(PANELS.items()):
        for k, axis in enumerate(answers.axes):
            values = answers.values[name][:, k]
            grid[0, column].semilogx(HZ * answers.omega, _decibels(values), label=axis, **_style(k))
            phase = np.degrees(np.unwrap(np.angle(values)))
            phase -= 360.0 * round(phase[0] / 360.0)
            grid[1, column].semilogx(HZ * answers.omega, phase, **_style(k))
            if measured is not None:
                ours, linear = (each.values[name][:, k] for each in (measured.answers, measured.linear))
                lines = measured.answers.omega
                grid[0, column].semilogx(HZ * lines, _decibels(ours), **_dots(k))
                beside = np.degrees(np.angle(ours / linear)) + np.interp(lines, answers.omega, phase)
                grid[1, column].semilogx(HZ * lines, beside, **_dots(k))
        _label(grid[0, column], "", "gain [dB]" if column == 0 else "", title)
        _label(grid[1, column], "frequency [Hz]", "phase [deg]" if column == 0 else "")
    grid[0, 0].legend(fontsize=7)


def _nyquist(figure: Figure, answers: Answers) -> None:
    """L of every axis about -1, with the circle in which |S| is above zone A."""
    figure.set_size_inches(0.6 * WIDTH, 0.6 * WIDTH)
    axes = figure.subplots()
    for k, axis in enumerate(answers.axes):
        gain = answers.values["L"][:, k]
        axes.plot(np.real(gain), np.imag(gain), label=axis, **_style(k))
    turns = np.linspace(0.0, 2.0 * math.pi, 200)
    limit = ZONES[0][0]
    axes.plot(
        -1.0 + np.cos(turns) / limit, np.sin(turns) / limit, color=GREY, lw=0.8, label=f"|S| = {limit:g}"
    )
    axes.plot([-1.0], [0.0], "+", color=GREY)
    axes.set(xlim=(-4.0, 2.0), ylim=(-3.0, 3.0), aspect="equal")
    axes.legend(fontsize=7)
    _label(axes, "Re L [1]", "Im L [1]", "loop gain, the other loops closed")


def _unbalance(figure: Figure, response: UnbalanceResponse) -> None:
    """Orbits over the speed, as parts of the room; control currents."""
    left, right = figure.subplots(1, 2)
    speeds = RPM * response.speeds
    for k, place in enumerate(response.places):
        if place.room:
            style = {"color": COLOURS[k % len(COLOURS)], "ls": STYLES[k // len(COLOURS) % 4], "lw": 1.2}
            left.plot(speeds, 100.0 * response.orbits[:, k] / place.room, label=place.name, **style)
    rooms = np.array([place.room or math.inf for place in response.places])
    top = 130.0 * float(np.nanmax(response.orbits / rooms, initial=0.0))
    levels = [(100.0 * limit, name) for limit, name in VIBRATION_ZONES]
    _zones(left, [(level, name) for level, name in levels if level < top])
    left.set_ylim(0.0, top or None)
    left.legend(fontsize=7)
    _label(left, "speed [rpm]", "orbit [% of the room there]", "response to the unbalance")
    for k, axis in enumerate(response.axes):
        right.plot(speeds, response.currents[:, k], label=axis, **_style(k))
    _label(right, "speed [rpm]", "control current [A]")
    if response.axes:
        right.legend(fontsize=7)
    else:
        right.remove()
