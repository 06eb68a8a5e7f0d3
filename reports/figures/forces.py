"""Contact forces over time, and which balls are pressed at the end."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import FigureBase
from matplotlib.lines import Line2D
from matplotlib.patches import Circle

from ...master.common.text import MM
from ...master.coupling.connections import Attachment, housing_port
from ...master.coupling.loop.span import origin_of, zero_of
from ...master.results.final_state import Finished, ReadableSystem
from ...master.results.recording import Recording
from ...master.results.summary import is_estimated
from .style import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    ORANGE,
    PURPLE,
    TIME,
    Curve,
    beginning,
    calm,
    draw_dense,
    key_beside,
    present,
    sized,
    within,
    zooms,
)

FIRST_ZOOM_S = 0.5  # s, the first zoom
IMPACT_S = 5e-3  # s, the inset from the first touch on
INSET = (0.5, 0.4, 0.48, 0.48)  # of the panel: left, bottom, width, height
MOST_ROOM = 2.0  # times a panel's height, for its inset
LABELS = 0.06  # of the panel: the inset's numbers
MIN_INSET_VALUES = 10  # recorded values that make an inset
HARDEST = "hardest.ball"
NORMAL, TANGENTIAL = ORANGE, GREEN


@dataclass(frozen=True)
class _Row:
    """Forces that share an axis."""

    label: str
    curves: tuple[Curve, ...]


ROTOR = _Row("rotor on ring", (Curve("contact.force", "normal", BLUE),))
LOADED = _Row("most loaded ball", (Curve("balls.force", "normal", NORMAL),))
NEIGHBOURS = _Row("ball on next ball", (Curve("neighbours.force", "normal, largest", PURPLE),))
PEAKS = {"contact.force": "contact.peak_force", "balls.force": "balls.peak_force"}  # the largest until then


def true_peak(recording: Recording, bearing: str, variable: str) -> tuple[int, float] | None:
    """The recorded row after which a force was never larger, and its peak (N), also between rows."""
    name = f"{bearing}.{PEAKS.get(variable)}"
    if name not in recording or not (peaks := recording[name])[-1] > 0.0:
        return None
    return int(np.argmax(peaks >= peaks[-1])), float(peaks[-1])


def forces(figure: FigureBase, run: Finished, a: Attachment) -> list[Axes]:
    """Forces of the rotor, and of the ball hit hardest where it is known (Figs 30-33)."""
    recording = run.recording
    chosen = _rows(recording, a)
    rows = [(r.label, c) for r in chosen if (c := present(recording, a.bearing, r.curves))]
    time = recording.time
    spans = zooms(time, FIRST_ZOOM_S)
    sized(figure, max(9.0, 1.0 + 5.5 * len(spans)), 1.0 + 2.5 * len(rows))
    grid = figure.subplots(len(rows), len(spans), squeeze=False, sharex="col")
    for row, (label, curves) in zip(grid, rows, strict=True):
        values = [recording[f"{a.bearing}.{c.variable}"] for c in curves]
        for axes, span in zip(row, spans, strict=True):
            part = within(time, span)
            for c, v in zip(curves, values, strict=True):
                draw_dense(axes, time[part], v[part], c.colour, c.label)
                _mark_peak(axes, recording, a, c, span)
            axes.set_xlim(*span)
            axes.ticklabel_format(useOffset=False)
            calm(axes, values)
        row[0].set_ylabel(f"{label} [N]")
        pairs = [zip(*axes.get_legend_handles_labels(), strict=True) for axes in row]
        known = {label: handle for panel in pairs for handle, label in panel}
        key_beside(row[-1], known.values(), known)
    touched = run.system.value(f"{a.bearing}.contact.first_time")  # -1: never
    first = touched - zero_of(run.scene, run.system)
    if touched != -1.0 and within(time, (first, first + IMPACT_S)).sum() > MIN_INSET_VALUES:
        for row, (_, curves) in zip(grid, rows, strict=True):
            shown = [(c, recording[f"{a.bearing}.{c.variable}"]) for c in curves]
            _first_impact(row[0], time, shown, first)
    whole = beginning(time), float(time[-1])
    for head, foot, span in zip(grid[0], grid[-1], spans, strict=True):
        head.set_title("whole run" if span == whole else f"{round(span[0], 9):g} s to {span[1]:g} s")
        foot.set_xlabel(TIME)
    peak = run.system.value(f"{a.bearing}.contact.peak_force")
    by = ", estimated from means over macro steps" if is_estimated(run.system, a) else ""
    said = f"{a.bearing}: largest contact force {peak:.1f} N{by}{_which(recording, a)}"
    figure.suptitle(f"{run.scene.title}\n{said}")
    return list(grid.flat)


def _mark_peak(
    axes: Axes, recording: Recording, a: Attachment, curve: Curve, span: tuple[float, float]
) -> None:
    """A dot at the largest force of the run, which may lie between recorded values."""
    if (found := true_peak(recording, a.bearing, curve.variable)) is None:
        return
    time = float(recording.time[found[0]])
    if span[0] <= time <= span[1]:
        label = f"largest, {found[1]:.{4 if found[1] < 1e4 else 6}g} N"
        axes.plot([time], [found[1]], "o", color=curve.colour, ms=4, label=label)


def _first_impact(
    axes: Axes, time: np.ndarray, shown: list[tuple[Curve, np.ndarray]], first: float
) -> None:
    """The first impact in an inset; `axes` make room for it, or have none where forces grow after it."""
    part = within(time, (first - 0.1 * IMPACT_S, first + IMPACT_S))
    left, right = axes.get_xlim()
    below = within(time, (left + (INSET[0] - LABELS) * (right - left), right))
    highest = max((float(np.max(values[below])) for _, values in shown if below.any()), default=0.0)
    top, needed = axes.get_ylim()[1], highest / (INSET[1] - 2.0 * LABELS)
    if needed > MOST_ROOM * top:
        return
    axes.set_ylim(top=max(top, needed))
    inset = axes.inset_axes(INSET)
    for c, values in shown:
        inset.plot(1e3 * (time[part] - first), values[part], color=c.colour, lw=c.width)
    inset.set_xlim(-100.0 * IMPACT_S, 1e3 * IMPACT_S)
    inset.tick_params(labelsize="x-small")
    inset.set_title("first impact, ms from the first touch", fontsize="x-small", pad=2)
    for side in ("top", "right"):
        inset.spines[side].set_visible(True)


def _rows(recording: Recording, a: Attachment) -> list[_Row]:
    if f"{a.bearing}.{HARDEST}" not in recording:
        return [ROTOR, LOADED, NEIGHBOURS]
    side = "ball and cage" if f"{a.bearing}.cage.x" in recording else "ball and neighbours"
    return [ROTOR, _both("ball and inner race", "inner"), _both("ball and outer race", "outer"),
            _both(side, "side")]  # fmt: skip


def _both(label: str, place: str) -> _Row:
    return _Row(
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


DRAWN_DISPLACEMENT = 0.05  # of the pitch radius: about how large the largest displacement is drawn
NEEDED = ("balls.count", "balls.diameter", "balls.pitch_diameter", "ball[1].x", "ball[1].inner", "ring.x")


@dataclass(frozen=True)
class _Ball:
    """A ball at the end of the run: centre from the outer ring's, and what presses it."""

    number: int
    x: float  # m
    y: float  # m
    by_races: bool  # both of them
    by_side: bool  # cage or neighbour


@dataclass(frozen=True)
class _Scale:
    """Sizes of the picture, all as they are (m), and the factor on displacements."""

    pitch_radius: float
    ball_radius: float
    factor: float

    def centre(self, ball: _Ball) -> tuple[float, float]:
        """Where a ball is drawn (mm): its distance from the pitch circle by the factor."""
        distance = math.hypot(ball.x, ball.y)
        drawn = self.pitch_radius + self.factor * (distance - self.pitch_radius)
        return MM * drawn * ball.x / distance, MM * drawn * ball.y / distance

    def moved(self, displacement: tuple[float, float]) -> tuple[float, float]:
        """Where the centre of a ring displaced by `displacement` (m) is drawn (mm)."""
        return MM * self.factor * displacement[0], MM * self.factor * displacement[1]


def has_contacts(system: ReadableSystem, a: Attachment) -> bool:
    """Whether the bearing tells of each of its balls."""
    return all(name in system.components[a.bearing].variables for name in NEEDED)


def contacts(figure: FigureBase, run: Finished, a: Attachment) -> list[Axes]:
    """Balls between the races at the end of the run."""
    return [draw_contacts(sized(figure, 8.2, 8.5).subplots(), run, a)]


def draw_contacts(axes: Axes, run: Finished, a: Attachment) -> Axes:
    """Balls between the races at the end of the run, sizes to scale, displacements not (Fig 27)."""
    system, recording = run.system, run.recording
    balls = _balls(system, recording, a)
    ring = _from_outer_ring(system, recording, a, f"{a.bearing}.ring")
    caged = f"{a.bearing}.cage.x" in recording
    cage = _from_outer_ring(system, recording, a, f"{a.bearing}.cage") if caged else None
    scale = _scale(system, a, balls, [ring] if cage is None else [ring, cage])
    _draw_rings(axes, scale, ring, cage)
    for ball in balls:
        _draw_ball(axes, scale, ball)
    if recording.at_end(f"{a.bearing}.contact.force") > 0.0:
        rotor = _from_outer_ring(system, recording, a, a.body_end.title)
        _draw_direction(axes, scale, ring, rotor)
    axes.set_aspect("equal")
    axes.set_xlabel("x [mm]")
    axes.set_ylabel("y [mm]")
    axes.legend(handles=_key(caged), loc="center")
    after = recording.time[-1] - origin_of(run.scene, system)
    pressed = sum(ball.by_races for ball in balls)
    axes.set_title(
        f"{run.scene.title}\n{after:g} s after the shutdown both rings press {pressed} of "
        f"{len(balls)} balls (displacements {scale.factor:g} times as large)"
    )
    return axes


def _balls(system: ReadableSystem, recording: Recording, a: Attachment) -> list[_Ball]:
    count = int(system.value(f"{a.bearing}.balls.count"))
    names = [f"{a.bearing}.ball[{number}]" for number in range(1, count + 1)]
    inner, outer, side = (
        [recording.at_end(f"{name}.{what}") > 0.0 for name in names] for what in ("inner", "outer", "side")
    )
    if f"{a.bearing}.neighbours.force" in recording:  # told of with the first of the two
        side = [mine or side[b - 1] for b, mine in enumerate(side)]
    places = [_from_outer_ring(system, recording, a, name) for name in names]
    return [_Ball(b + 1, *places[b], inner[b] and outer[b], side[b]) for b in range(count)]


def _from_outer_ring(
    system: ReadableSystem, recording: Recording, a: Attachment, port: str
) -> tuple[float, float]:
    """Last position of COMPONENT.PORT from the middle of the outer ring (m)."""
    x, y = (recording.at_end(f"{port}.{axis}") for axis in "xy")
    housing = housing_port(system, a.bearing)
    if housing is None:
        return x, y
    return x - recording.at_end(f"{housing}.x"), y - recording.at_end(f"{housing}.y")


def _scale(
    system: ReadableSystem, a: Attachment, balls: list[_Ball], moved: list[tuple[float, float]]
) -> _Scale:
    pitch, ball = (0.5 * system.value(f"{a.bearing}.balls.{d}") for d in ("pitch_diameter", "diameter"))
    off = [abs(math.hypot(b.x, b.y) - pitch) for b in balls] + [math.hypot(*place) for place in moved]
    return _Scale(pitch, ball, _round_down(DRAWN_DISPLACEMENT * pitch / max(*off, 1e-9)))


def _round_down(value: float) -> float:
    """The next of 1, 2, 5, 10, 20, 50 ... that is not above `value`; at least 1."""
    decade = 10.0 ** math.floor(math.log10(max(value, 1.0)))
    return max(step * decade for step in (1.0, 2.0, 5.0) if step * decade <= max(value, 1.0))


def _draw_rings(
    axes: Axes, scale: _Scale, ring: tuple[float, float], cage: tuple[float, float] | None
) -> None:
    inner, outer = scale.pitch_radius - scale.ball_radius, scale.pitch_radius + scale.ball_radius
    axes.add_patch(Circle((0.0, 0.0), MM * outer, fill=False, color=GREEN, lw=1.5))
    axes.add_patch(Circle(scale.moved(ring), MM * inner, fill=False, color=ORANGE, lw=1.5))
    if cage is not None:
        centre, radius = scale.moved(cage), MM * scale.pitch_radius
        axes.add_patch(Circle(centre, radius, fill=False, color=PURPLE, lw=1.0, ls="--"))
    room = 1.2 * MM * outer
    axes.set_xlim(-room, room)
    axes.set_ylim(-room, room)


def _draw_ball(axes: Axes, scale: _Scale, ball: _Ball) -> None:
    x, y = scale.centre(ball)
    axes.add_patch(Circle((x, y), MM * scale.ball_radius, fc="#eeeeee", ec=GREY, lw=1.0, zorder=0.5))
    if ball.by_races:
        axes.plot(x, y, "x", color=BLACK, ms=11, mew=2.0)
    if ball.by_side:
        axes.plot(x, y, "s", color=BLUE, ms=16, mew=1.5, mfc="none")
    away = 1.1 * MM * (scale.pitch_radius + scale.ball_radius) / math.hypot(x, y)
    axes.text(away * x, away * y, str(ball.number), ha="center", va="center", color=GREY)


def _draw_direction(
    axes: Axes, scale: _Scale, ring: tuple[float, float], rotor: tuple[float, float]
) -> None:
    """An arrow inside the inner race towards where the rotor presses on the ring."""
    dx, dy = rotor[0] - ring[0], rotor[1] - ring[1]
    inner = MM * (scale.pitch_radius - scale.ball_radius) / math.hypot(dx, dy)
    tip, tail = ((part * inner * dx, part * inner * dy) for part in (0.96, 0.72))
    axes.annotate("", xy=tip, xytext=tail, arrowprops={"arrowstyle": "-|>", "color": BLUE, "lw": 1.5})
    axes.text(0.65 * inner * dx, 0.65 * inner * dy, "rotor", ha="center", va="center", color=BLUE)


def _key(caged: bool) -> list[Line2D]:
    """The meaning of markers and circles."""
    side = "ball touches the cage" if caged else "ball touches a neighbour"
    handles = [
        Line2D([], [], color=GREEN, lw=1.5, label="outer race"),
        Line2D([], [], color=ORANGE, lw=1.5, label="inner race"),
        Line2D([], [], color=BLACK, ls="", marker="x", ms=9, mew=2.0, label="ball pressed by both rings"),
        Line2D([], [], color=BLUE, ls="", marker="s", ms=10, mew=1.5, mfc="none", label=side),
    ]
    if caged:
        handles.insert(2, Line2D([], [], color=PURPLE, ls="--", label="middles of the cage's pockets"))
    return handles
