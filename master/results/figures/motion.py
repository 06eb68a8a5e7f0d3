"""Where the bodies of a touchdown bearing go, and how fast they turn."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import FigureBase

from touchdown.master.coupling.connections import Attachment
from touchdown.master.coupling.simulation import zero_of
from touchdown.master.results.ending import Finished, Readable, housing_port
from touchdown.master.results.figures.style import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    ORANGE,
    PURPLE,
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
from touchdown.master.results.summary import RPM, relative_orbit

UM = 1e6
SPEEDS = (  # in the order they are drawn: what varies most first
    Curve("hardest.speed", "hardest-hit ball, spin", GREY),
    Curve("speed.cage", "cage", BLUE),
    Curve("speed.orbit", "balls, mean orbit", GREEN, 1.8),  # often hidden by the next
    Curve("speed.ball", "balls, mean spin", PURPLE),
    Curve("speed.ring", "inner race / 2", ORANGE),
    Curve("speed.rotor", "rotor / 2, at the race", BLACK),
)
SPUN_UP = 1.5  # times the ring's first synchronism: here the zoom on the spin-up ends


@dataclass(frozen=True)
class Track:
    """The orbit of a body [µm]."""

    label: str
    colour: str
    x: np.ndarray
    y: np.ndarray


def paths(figure: FigureBase, run: Finished, a: Attachment) -> list[Axes]:
    """Rotor in the clearance circle, its contact from near, and the orbits of rings and cage [µm]."""
    system, recording = run.system, run.recording
    cage, rings = _cage(recording, a), _rings(system, recording, a)
    panels = [("rings", rings)] if rings else []
    panels += [("cage in front of the rings", [*rings, *cage])] if cage else []
    rows, columns = (1, 2 + len(panels)) if len(panels) < 2 else (2, 2)
    sized(figure, 5.2 * columns, 0.4 + 5.0 * rows)
    whole, near, *others = figure.subplots(rows, columns).flat
    draw_orbit(whole, run, a)
    _draw_landing(near, run, a)
    for axes, (title, tracks) in zip(others, panels, strict=True):
        for track in tracks:
            axes.plot(track.x, track.y, color=track.colour, lw=0.5, label=track.label)
        axes.set_title(title)
        axes.set_aspect("equal", adjustable="datalim")
        axes.legend(loc="upper right")
    for axes in others:
        axes.set_xlabel("x [µm]")
        axes.set_ylabel("y [µm]")
    figure.suptitle(run.scene.title)
    return [whole, near, *others]


def speeds(figure: FigureBase, run: Finished, a: Attachment) -> list[Axes]:
    """Circumferential speeds while the ring is spun up, from then on, and at last (Figs 25, 26)."""
    recording = run.recording
    time = recording.time
    spun_up = SPUN_UP * _sync(run, a)
    spans = zooms(time, spun_up)
    curves = present(recording, a.bearing, SPEEDS)
    values = {c.label: recording[f"{a.bearing}.{c.variable}"] for c in curves}
    settled = time >= spun_up
    sized(figure, max(9.0, 1.0 + 5.5 * len(spans)), 5.6)
    row = list(figure.subplots(1, len(spans), squeeze=False)[0])
    for axes, span in zip(row, spans, strict=True):
        part = within(time, span)
        for c in curves:
            shown = thinned(time[part], values[c.label][part])
            axes.plot(*shown, color=c.colour, lw=c.width, label=c.label)
        whole = span == (beginning(time), float(time[-1]))
        zoomed = whole and int(np.sum(settled)) > 1
        if zoomed:
            _zoom(axes, [v[settled] for v in values.values()])
        axes.set_title(_title(span, spans, whole, zoomed))
        axes.set_xlim(*span)
        axes.set_xlabel(TIME)
        axes.set_ylabel("circumferential speed [m/s]")
        axes.ticklabel_format(useOffset=False)
    handles, labels = row[0].get_legend_handles_labels()
    columns = min(len(curves), 3 * len(spans))
    figure.legend(handles[::-1], labels[::-1], loc="outside lower center", ncols=columns)
    figure.suptitle(run.scene.title)
    return row


def distance(figure: FigureBase, run: Finished, a: Attachment) -> Axes:
    """How far the journal is from the bearing's middle [µm], beside the clearance."""
    recording = run.recording
    axes = sized(figure, 9, 4).subplots()
    radius = UM * np.hypot(*relative_orbit(run.system, a, recording))
    axes.plot(*thinned(recording.time, radius), color=BLUE, lw=0.6, label="journal")
    clearance = UM * run.system.value(f"{a.bearing}.clearance")
    axes.axhline(clearance, ls="--", color=GREY, lw=1, label="clearance")
    axes.set_ylabel("distance from the middle [µm]")
    return _over_time(axes, run)


def slowing(figure: FigureBase, run: Finished, a: Attachment) -> Axes:
    """How the rotor's speed falls [rpm]: of a bearing that tells no speeds the only one known."""
    speed = RPM * run.recording[a.motion("omega")]
    axes = sized(figure, 9, 4).subplots()
    axes.plot(*thinned(run.recording.time, speed), color=BLACK, label="rotor")
    axes.ticklabel_format(useOffset=False)
    axes.set_ylabel("speed [rpm]")
    return _over_time(axes, run)


def _over_time(axes: Axes, run: Finished) -> Axes:
    time = run.recording.time
    axes.set_xlim(beginning(time), float(time[-1]))
    axes.set_xlabel(TIME)
    axes.set_title(run.scene.title)
    axes.legend(loc="upper right")
    return axes


def draw_orbit(axes: Axes, run: Finished, a: Attachment) -> Axes:
    """The rotor in its clearance circle [µm]."""
    _draw_orbit(axes, run, a)
    axes.set_title("rotor")
    axes.legend(loc="upper right")
    return axes


def _draw_orbit(axes: Axes, run: Finished, a: Attachment) -> None:
    if "clearance" in run.system.components[a.bearing].variables:
        radius = UM * run.system.value(f"{a.bearing}.clearance")
        angle = np.linspace(0.0, 2.0 * np.pi, 721)
        circle = radius * np.cos(angle), radius * np.sin(angle)
        axes.plot(*circle, "--", color=GREY, lw=1, label="clearance")
    x, y = (UM * run.recording[a.motion(axis)] for axis in "xy")
    axes.plot(x, y, color=BLUE, lw=0.6, label="rotor")
    axes.set_aspect("equal", adjustable="box")
    axes.set_xlabel("x [µm]")
    axes.set_ylabel("y [µm]")


def _draw_landing(axes: Axes, run: Finished, a: Attachment) -> None:
    """The rotor from near, where it is lowest."""
    _draw_orbit(axes, run, a)
    lowest = UM * float(np.min(run.recording[a.motion("y")]))
    axes.set_xlim(-100, 100)
    axes.set_ylim(lowest - 20, lowest + 180)
    axes.set_title("rotor, where it lands")


def _rings(system: Readable, recording: Recording, a: Attachment) -> list[Track]:
    tracks: list[Track] = []
    if f"{a.bearing}.ring.x" in recording:
        x, y = (UM * recording[f"{a.bearing}.ring.{axis}"] for axis in "xy")
        tracks.append(Track("inner ring", ORANGE, x, y))
    port = housing_port(system, a)
    if port is not None:
        x, y = (UM * recording[f"{port}.{axis}"] for axis in "xy")
        tracks.append(Track("outer ring", GREEN, x, y))
    return tracks


def _cage(recording: Recording, a: Attachment) -> list[Track]:
    if f"{a.bearing}.cage.x" not in recording:
        return []
    x, y = (UM * recording[f"{a.bearing}.cage.{axis}"] for axis in "xy")
    return [Track("cage", PURPLE, x, y)]


def _sync(run: Finished, a: Attachment) -> float:
    """When the ring first turned with the rotor (s from the zero); the run's end where it did not."""
    zero = zero_of(run.scene, run.system)
    sync = run.system.value(f"{a.bearing}.ring.sync_time") - zero
    return sync if sync > 0.0 else float(run.recording.time[-1])


def _zoom(axes: Axes, values: list[np.ndarray]) -> None:
    """Limit an axis to the range of `values` and a little more."""
    low, high = min(float(v.min()) for v in values), max(float(v.max()) for v in values)
    if high > low:
        axes.set_ylim(low - 0.05 * (high - low), high + 0.05 * (high - low))


def _title(span: tuple[float, float], spans: list[tuple[float, float]], whole: bool, zoomed: bool) -> str:
    if whole:
        return "whole run, speeds once spun up" if zoomed else "whole run"
    return "spin-up" if span == spans[0] else f"last {1e3 * (span[1] - span[0]):.0f} ms"
