"""Which balls are pressed at the end of a run."""

from __future__ import annotations

import math
from dataclasses import dataclass

from matplotlib.axes import Axes
from matplotlib.figure import FigureBase
from matplotlib.lines import Line2D
from matplotlib.patches import Circle

from touchdown.master.coupling.connections import Attachment
from touchdown.master.coupling.loop.span import origin_of
from touchdown.master.results.ending import Finished, Readable, housing_port
from touchdown.master.results.figures.style import BLACK, BLUE, GREEN, GREY, ORANGE, PURPLE, sized
from touchdown.master.results.recording import Recording

MM = 1e3
SHOWN = 0.05  # of the pitch radius: about how large the largest displacement is drawn
NEEDED = ("balls.count", "balls.diameter", "balls.pitch_diameter", "ball[1].x", "ball[1].inner", "ring.x")


@dataclass(frozen=True)
class Ball:
    """A ball at the end of the run: centre from the outer ring's, and what presses it."""

    number: int
    x: float  # m
    y: float  # m
    by_races: bool  # both of them
    by_side: bool  # cage or neighbour


@dataclass(frozen=True)
class Scale:
    """Sizes of the picture, all as they are (m), and the factor on displacements."""

    pitch_radius: float
    ball_radius: float
    factor: float

    def centre(self, ball: Ball) -> tuple[float, float]:
        """Where a ball is drawn (mm): its distance from the pitch circle by the factor."""
        distance = math.hypot(ball.x, ball.y)
        drawn = self.pitch_radius + self.factor * (distance - self.pitch_radius)
        return MM * drawn * ball.x / distance, MM * drawn * ball.y / distance

    def moved(self, at: tuple[float, float]) -> tuple[float, float]:
        """Where the centre of a ring displaced by `at` (m) is drawn (mm)."""
        return MM * self.factor * at[0], MM * self.factor * at[1]


def has_contacts(system: Readable, a: Attachment) -> bool:
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


def _balls(system: Readable, recording: Recording, a: Attachment) -> list[Ball]:
    count = int(system.value(f"{a.bearing}.balls.count"))
    names = [f"{a.bearing}.ball[{number}]" for number in range(1, count + 1)]
    inner, outer, side = (
        [recording.at_end(f"{name}.{what}") > 0.0 for name in names] for what in ("inner", "outer", "side")
    )
    if f"{a.bearing}.neighbours.force" in recording:  # told of with the first of the two
        side = [mine or side[b - 1] for b, mine in enumerate(side)]
    places = [_from_outer_ring(system, recording, a, name) for name in names]
    return [Ball(b + 1, *places[b], inner[b] and outer[b], side[b]) for b in range(count)]


def _from_outer_ring(
    system: Readable, recording: Recording, a: Attachment, port: str
) -> tuple[float, float]:
    """Last position of COMPONENT.PORT from the middle of the outer ring (m)."""
    x, y = (recording.at_end(f"{port}.{axis}") for axis in "xy")
    housing = housing_port(system, a)
    if housing is None:
        return x, y
    return x - recording.at_end(f"{housing}.x"), y - recording.at_end(f"{housing}.y")


def _scale(system: Readable, a: Attachment, balls: list[Ball], moved: list[tuple[float, float]]) -> Scale:
    pitch, ball = (0.5 * system.value(f"{a.bearing}.balls.{d}") for d in ("pitch_diameter", "diameter"))
    off = [abs(math.hypot(b.x, b.y) - pitch) for b in balls] + [math.hypot(*at) for at in moved]
    return Scale(pitch, ball, _round_down(SHOWN * pitch / max(*off, 1e-9)))


def _round_down(value: float) -> float:
    """The next of 1, 2, 5, 10, 20, 50 ... that is not above `value`; at least 1."""
    decade = 10.0 ** math.floor(math.log10(max(value, 1.0)))
    return max(step * decade for step in (1.0, 2.0, 5.0) if step * decade <= max(value, 1.0))


def _draw_rings(
    axes: Axes, scale: Scale, ring: tuple[float, float], cage: tuple[float, float] | None
) -> None:
    inner, outer = scale.pitch_radius - scale.ball_radius, scale.pitch_radius + scale.ball_radius
    axes.add_patch(Circle((0.0, 0.0), MM * outer, fill=False, color=GREEN, lw=1.5))
    axes.add_patch(Circle(scale.moved(ring), MM * inner, fill=False, color=ORANGE, lw=1.5))
    if cage is not None:
        at, radius = scale.moved(cage), MM * scale.pitch_radius
        axes.add_patch(Circle(at, radius, fill=False, color=PURPLE, lw=1.0, ls="--"))
    room = 1.2 * MM * outer
    axes.set_xlim(-room, room)
    axes.set_ylim(-room, room)


def _draw_ball(axes: Axes, scale: Scale, ball: Ball) -> None:
    x, y = scale.centre(ball)
    axes.add_patch(Circle((x, y), MM * scale.ball_radius, fc="#eeeeee", ec=GREY, lw=1.0, zorder=0.5))
    if ball.by_races:
        axes.plot(x, y, "x", color=BLACK, ms=11, mew=2.0)
    if ball.by_side:
        axes.plot(x, y, "s", color=BLUE, ms=16, mew=1.5, mfc="none")
    away = 1.1 * MM * (scale.pitch_radius + scale.ball_radius) / math.hypot(x, y)
    axes.text(away * x, away * y, str(ball.number), ha="center", va="center", color=GREY)


def _draw_direction(
    axes: Axes, scale: Scale, ring: tuple[float, float], rotor: tuple[float, float]
) -> None:
    """An arrow inside the inner race towards where the rotor presses on the ring."""
    dx, dy = rotor[0] - ring[0], rotor[1] - ring[1]
    inner = MM * (scale.pitch_radius - scale.ball_radius) / math.hypot(dx, dy)
    tip, tail = ((part * inner * dx, part * inner * dy) for part in (0.96, 0.72))
    axes.annotate("", xy=tip, xytext=tail, arrowprops={"arrowstyle": "-|>", "color": BLUE, "lw": 1.5})
    axes.text(0.65 * inner * dx, 0.65 * inner * dy, "rotor", ha="center", va="center", color=BLUE)


def _key(caged: bool) -> list[Line2D]:
    """What the markers and circles mean."""
    side = "ball touches the cage" if caged else "ball touches a neighbour"
    made = [
        Line2D([], [], color=GREEN, lw=1.5, label="outer race"),
        Line2D([], [], color=ORANGE, lw=1.5, label="inner race"),
        Line2D([], [], color=BLACK, ls="", marker="x", ms=9, mew=2.0, label="ball pressed by both rings"),
        Line2D([], [], color=BLUE, ls="", marker="s", ms=10, mew=1.5, mfc="none", label=side),
    ]
    if caged:
        made.insert(2, Line2D([], [], color=PURPLE, ls="--", label="middles of the cage's pockets"))
    return made
