"""Moving pictures of a drop: what moves at which moment, and the film drawn from it.

Time goes slowly through the first impact and faster through what follows. Displacements are drawn
`magnified`, so that the clearance is seen; a journal that touches is drawn touching. Angles are
counter-clockwise, lengths in m and forces in N as everywhere.
"""

from __future__ import annotations

import json
import math
import shutil
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib import animation
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import EllipseCollection, LineCollection
from matplotlib.figure import Figure
from matplotlib.patches import Annulus, Circle

from ..master.common.errors import TouchdownError, one_of
from ..master.common.files import writing_to
from ..master.common.text import RPM
from ..master.coupling.connections import Attachment, housing_port
from ..master.results.capture import captures
from ..master.results.recording import NotRecordedError
from ..modelkit.kernel.writing import make_folder, replacing_by_name
from .elevation import (
    BODY,
    CORE,
    DRAWN_CLEARANCE,
    EDGE,
    FORCE,
    SLEEVE,
    Elevation,
    ElevationPanel,
    elevation,
)
from .figures.style import BLUE, ORANGE, PURPLE
from .layout import Absent
from .series import at_times, largest_about
from .subject import Subject

FRAMES_PER_S = 25  # frames a second
LEAD_TIME = 0.02  # s before the first contact with which a film begins at most
TIME_STRETCHES = ((100.0, -0.001), (850.0, 0.006), (18.0, 0.4))
"""Of a film: how many times slower it goes, and up to when of the run (s from the first contact)."""
FORCE_ARROW = 0.5  # of the journal's radius: the arrow of the largest force
ORBITING = ("speed.cage", "speed.orbit")  # m/s, of the balls' middles, the first that there is
DECIMALS = 4  # decimals on a page, of lengths over the journal's radius and of angles


@dataclass(frozen=True)
class Shape:
    """A bearing as drawn (m)."""

    title: str
    journal: float  # radius
    clearance: float
    magnified: float
    pitch: float = 0.0  # radius; 0: a bushing
    ball: float = 0.0  # radius
    caged: bool = False

    @property
    def bore(self) -> float:
        """Radius of the bore, with the clearance as drawn."""
        return self.journal + self.magnified * self.clearance

    @property
    def beyond(self) -> float:
        """How much further out all that is around the bore is drawn than it lies."""
        return (self.magnified - 1.0) * self.clearance


@dataclass(frozen=True)
class Motion:
    """Motion in one bearing, frame by frame; of shape (frames,) but for `balls`."""

    shape: Shape
    time: np.ndarray  # s
    journal: np.ndarray  # (frames, 3): x, y (m) from the housing's middle, angle (rad)
    ring: np.ndarray  # likewise
    balls: np.ndarray  # (frames, balls): angular positions (rad)
    force: np.ndarray  # (frames, 2): of the bearing on the journal (N), the largest about a frame
    speeds: np.ndarray  # (frames, 2): rotor, inner ring (rad/s)
    slower: np.ndarray  # how many times slower than it was
    stages: tuple[tuple[float, str], ...] = ()  # from when on (s) which words stand with it, in order
    side: Elevation | None = None  # where a shoulder of the rotor can land on it

    @property
    def largest_force(self) -> float:
        """Of the film (N)."""
        return float(np.max(np.hypot(*self.force.T), initial=0.0))

    def stage(self, frame: int) -> str:
        """The words that stand with a frame; "" before the first."""
        return next((words for since, words in reversed(self.stages) if since <= self.time[frame]), "")

    def for_page(self) -> str:
        """JSON for the page's script; lengths over the journal's radius, forces over the largest."""
        s, unit = self.shape, self.shape.journal
        moved = np.array([s.magnified / unit, s.magnified / unit, 1.0])
        values = {
            "title": s.title,
            "rate": FRAMES_PER_S,
            "bore": s.bore / unit,
            "pitch": (s.pitch + s.beyond) / unit if s.pitch else 0.0,
            "ball": s.ball / unit,
            "caged": s.caged,
            "magnified": s.magnified,
            "largest": self.largest_force,
            "push": FORCE_ARROW,
            "time": [round(1e3 * float(t), 3) for t in self.time],
            "slower": [round(float(v), 1) for v in self.slower],
            "journal": _rounded(self.journal * moved),
            "ring": _rounded(self.ring * moved),
            "balls": _rounded(self.balls[:, :1]),
            "count": self.balls.shape[1],
            "force": _rounded(self.force / (self.largest_force or 1.0)),
            "stages": [[round(1e3 * since, 3), words] for since, words in self.stages],
            "rpm": np.round(RPM * self.speeds).astype(int).tolist(),
            "side": self.side and self.side.for_page(),
        }
        return json.dumps(values, separators=(",", ":")).replace("<", "\\u003c")


def _rounded(values: np.ndarray) -> list[list[float]]:
    return np.round(values, DECIMALS).tolist()


def motions(subject: Subject) -> tuple[list[Motion], list[str]]:
    """The motion at the seats that can be drawn, and the reasons why the others cannot."""
    shown, lacking = [], []
    for a in subject.seats:
        try:
            shown.append(_motion(subject, a))
        except (Absent, NotRecordedError) as error:
            lacking.append(str(error))
    return shown, list(dict.fromkeys(lacking))


def _motion(subject: Subject, a: Attachment) -> Motion:
    """The motion at a seat. Raises Absent where it is unknown."""
    shape = _shape(subject, a)
    time, slower = _frames(subject)
    rows = subject.run.recording.time
    column = subject.run.recording.__getitem__
    body, port = a.body_end, housing_port(subject.run.system, a.bearing)
    middle = [column(f"{port}.{axis}") if port else np.zeros(len(rows)) for axis in "xy"]
    place = [column(body.full(axis)) - m for axis, m in zip("xy", middle, strict=True)]
    spin = column(body.full("omega"))
    turning = subject.values(a, "ring.omega") if subject.has(a, "ring.omega") else np.zeros(len(rows))
    ring = [column(f"{a.bearing}.ring.{axis}") - m for axis, m in zip("xy", middle, strict=True)] if (
        subject.has(a, "ring.x")
    ) else [np.zeros(len(rows))] * 2  # fmt: skip
    return Motion(
        shape,
        time,
        at_times(time, rows, *place, _turned(rows, spin)),
        at_times(time, rows, *ring, _turned(rows, turning)),
        _balls(subject, a, time),
        _forces(subject, a, time),
        at_times(time, rows, spin, turning),
        slower,
        _stages(subject, a),
        elevation(subject, a, time, shape.magnified),
    )


def _stages(subject: Subject, a: Attachment) -> tuple[tuple[float, str], ...]:
    """Since when the rotor is to be levitated again, and since when it is captured at the seat."""
    found = captures(subject.summary).get(subject.name(a))
    if found is None:
        return ()
    command = subject.summary["capture_command_time"]
    asked = (command, "to be levitated")
    return (asked,) if found.after is None else (asked, (command + found.after, "captured"))


def _frames(subject: Subject) -> tuple[np.ndarray, np.ndarray]:
    """Times of the run (s) at which a film has its frames, and how many times slower it goes there.

    Raises Absent where nothing touches.
    """
    if subject.first_contact is None:
        raise Absent("nothing touched.")
    time = subject.run.recording.time
    start = max(float(time[0]), subject.first_contact - LEAD_TIME)
    times, slower = [], []
    for factor, after in TIME_STRETCHES:
        end = min(float(time[-1]), subject.first_contact + after)
        if end > start:
            count = math.ceil(factor * (end - start) * FRAMES_PER_S)
            times.append(np.linspace(start, end, count, endpoint=False))
            slower.append(np.full(count, factor))
            start = end
    return np.concatenate(times), np.concatenate(slower)


def _shape(subject: Subject, a: Attachment) -> Shape:
    journal, clearance = (subject.setting(a, name) for name in ("journal_radius", "clearance"))
    if journal is None or not clearance or clearance < 0.0:
        raise Absent(f"{a.bearing} states no journal radius and clearance.")
    magnified = max(1.0, DRAWN_CLEARANCE * journal / clearance)
    title = f"{subject.name(a)} ({a.bearing})"
    pitch, ball = (subject.setting(a, f"balls.{d}") for d in ("pitch_diameter", "diameter"))
    if not pitch or not ball:
        return Shape(title, journal, clearance, magnified)
    caged = subject.has(a, "speed.cage") or subject.has(a, "cage.x")
    return Shape(title, journal, clearance, magnified, 0.5 * pitch, 0.5 * ball, caged)


def _turned(time: np.ndarray, speed: np.ndarray) -> np.ndarray:
    """Angle since the start (rad, (rows,)) of what turns with a speed (rad/s)."""
    steps = 0.5 * (speed[1:] + speed[:-1]) * np.diff(time)
    return np.concatenate([[0.0], np.cumsum(steps)])


def _balls(subject: Subject, a: Attachment, time: np.ndarray) -> np.ndarray:
    """Attitude angles, the balls evenly spaced and carried on by their mean orbit."""
    count, pitch = (subject.setting(a, f"balls.{name}") for name in ("count", "pitch_diameter"))
    known = next((name for name in ORBITING if subject.has(a, name)), None)
    if not count or not pitch:
        return np.zeros((len(time), 0))
    rows = subject.run.recording.time
    speed = subject.values(a, known) / (0.5 * pitch) if known else np.zeros(len(rows))
    first = subject.setting(a, "balls.first_angle") or 0.0
    carried = np.interp(time, rows, _turned(rows, speed))
    return first + carried[:, None] + 2.0 * math.pi * np.arange(int(count)) / int(count)


def _forces(subject: Subject, a: Attachment, time: np.ndarray) -> np.ndarray:
    """Of each frame the largest force of those recorded about it."""
    names = [a.load(f"f{axis}") for axis in "xy"]
    if not all(name in subject.run.recording for name in names):
        return np.zeros((len(time), 2))
    force = np.stack([subject.run.recording[name] for name in names], axis=1)
    return force[largest_about(time, subject.run.recording.time, np.hypot(*force.T))]


# Of a bearing's panel, and per inch: an even number of points, as codecs want it
PANEL_INCHES, DOTS_PER_INCH = 4.8, 100
FILM_INCHES, CAPTION_INCHES = 5.8, 0.35  # inch, of a film, and of what is told below the panels
SHOULDER_RATIO = 0.8  # of a ball's radius: where the rings' shoulders are
SUFFIXES = (".mp4", ".gif")
FRAME_STRIDE = {".mp4": 1, ".gif": 2}  # of how many frames one is kept: a GIF is large


def write_film(motions: Sequence[Motion], title: str, path: Path, progress: Callable[[], object]) -> Path:
    """Draw all frames into an .mp4 or .gif; returns it. `progress` is called after each frame.

    Raises TouchdownError where the suffix is another, there is no ffmpeg, or it cannot be written.
    """
    writer = _writer(path.suffix.lower())
    stage = _Stage(motions, title)
    with writing_to(path.parent):
        make_folder(path.parent)
    with (
        writing_to(path.parent),
        replacing_by_name(path) as temporary,
        writer.saving(stage.figure, str(temporary), DOTS_PER_INCH),
    ):
        for frame in film_frames(motions, path.suffix.lower()):
            stage.show(frame)
            writer.grab_frame()
            progress()
    return path


def film_frames(motions: Sequence[Motion], suffix: str) -> range:
    """The frames that a film of that suffix has."""
    return range(0, len(motions[0].time), FRAME_STRIDE[suffix])


def checked_suffix(path: Path) -> None:
    """Raise TouchdownError where a film cannot be made of that name, by suffix or for want of ffmpeg."""
    _writer(path.suffix.lower())


def _writer(suffix: str) -> animation.AbstractMovieWriter:
    if suffix not in SUFFIXES:
        raise TouchdownError(f"a film ends in .mp4 or .gif, not in {suffix!r}; {one_of(suffix, SUFFIXES)}")
    rate = FRAMES_PER_S // FRAME_STRIDE[suffix]
    if suffix == ".gif":
        return animation.PillowWriter(fps=rate)
    import matplotlib as mpl

    mpl.rcParams["animation.ffmpeg_path"] = _ffmpeg()
    return animation.FFMpegWriter(fps=rate, codec="h264", extra_args=["-pix_fmt", "yuv420p"])


def _ffmpeg() -> str:
    """Of the PATH, or of the package imageio-ffmpeg. Raises TouchdownError where there is none."""
    found = shutil.which("ffmpeg")
    if found:
        return found
    try:
        from imageio_ffmpeg import get_ffmpeg_exe

        return get_ffmpeg_exe()
    except (ImportError, RuntimeError):
        raise TouchdownError(
            "an .mp4 takes ffmpeg, and none is on the PATH; install it, or "
            f"`python3 -m pip --python {sys.executable} install imageio-ffmpeg`, or give -o a name that "
            "ends in .gif"
        ) from None


class _Stage:
    """The figure of a film: a panel for each bearing, whose parts are moved from frame to frame."""

    def __init__(self, motions: Sequence[Motion], title: str) -> None:
        count = len(motions) + sum(m.side is not None for m in motions)
        self.figure = Figure(figsize=(PANEL_INCHES * count, FILM_INCHES))
        FigureCanvasAgg(self.figure)
        self.figure.text(0.5, 0.965, title, ha="center", va="center", fontsize=11, parse_math=False)
        self._clock = self.figure.text(0.5, 0.925, "", ha="center", va="center", fontsize=9.5)
        self._motions = motions
        self._panels: list[_Panel | ElevationPanel] = []
        for m in motions:
            self._panels.append(_Panel(self._axes(len(self._panels), count), m))
            if m.side is not None:
                self._panels.append(
                    ElevationPanel(self._axes(len(self._panels), count), m.side, m.shape.title)
                )

    def _axes(self, k: int, count: int) -> Axes:
        axes = self.figure.add_axes(
            (k / count, CAPTION_INCHES / FILM_INCHES, 1.0 / count, (PANEL_INCHES - 0.2) / FILM_INCHES)
        )
        axes.set_axis_off()
        axes.set_aspect("equal")
        return axes

    def show(self, frame: int) -> None:
        """Move all to where they are in a frame."""
        m = self._motions[0]
        self._clock.set_text(
            f"{1e3 * m.time[frame]:.2f} ms after the shutdown, {m.slower[frame]:.0f} times slower"
        )
        for panel in self._panels:
            panel.show(frame)


class _Panel:
    """A bearing along its axis; lengths over the journal's radius."""

    def __init__(self, axes: Axes, motion: Motion) -> None:
        self._motion = motion
        self._size = size = _Size.of(motion)
        reach = 1.15 * size.outer
        axes.set_xlim(-reach, reach)
        axes.set_ylim(-reach, reach)
        self._ring: list[Circle] = []
        if size.ball:
            self._draw_bearing(axes)
        else:
            axes.add_patch(Annulus((0, 0), size.outer, size.outer - size.bore, fc=SLEEVE, ec=EDGE, lw=0.8))
        self._journal = Circle((0, 0), 1.0, fc=BODY, ec=ORANGE, lw=1.6)
        self._marks = LineCollection([], colors=[ORANGE, BLUE], linewidths=[1.6, 2.4])
        axes.add_patch(self._journal)
        axes.add_collection(self._marks)
        self._arrow = axes.quiver([0], [0], [0], [0], angles="xy", scale_units="xy", scale=1.0,
                                  color=FORCE, width=0.012, zorder=5)  # fmt: skip
        name = motion.shape.title
        axes.text(0.0, 1.02 * reach, name, ha="center", va="bottom", fontsize=10, parse_math=False)
        self._told = axes.text(0.0, -1.02 * reach, "", ha="center", va="top", fontsize=9)

    def _draw_bearing(self, axes: Axes) -> None:
        s = self._size
        groove = s.pitch + SHOULDER_RATIO * s.ball
        axes.add_patch(Annulus((0, 0), s.outer, s.outer - groove, fc=CORE, ec=EDGE, lw=0.8))
        for radius, colour in ((s.shoulder, CORE), (s.bore, "#ffffff")):
            self._ring.append(Circle((0, 0), radius, fc=colour, ec=EDGE, lw=0.8))
            axes.add_patch(self._ring[-1])
        if self._motion.shape.caged:
            axes.add_patch(Circle((0, 0), s.pitch, fc="none", ec=PURPLE, lw=2.0))
        count = self._motion.balls.shape[1]
        width = np.full(count, 2.0 * s.ball)
        edges = [BLUE, *[EDGE] * (count - 1)]
        self._balls = EllipseCollection(
            width, width, np.zeros(count), units="xy", offsets=np.zeros((count, 2)),
            offset_transform=axes.transData, fc=BODY, ec=edges, lw=1.2, zorder=3,
        )  # fmt: skip
        axes.add_collection(self._balls)

    def show(self, frame: int) -> None:
        """Move all to where they are in a frame."""
        m, s = self._motion, self._size
        x, y, angle = m.journal[frame] * s.moved
        self._journal.center = x, y
        lines = [_line(x, y, angle, 0.0, 1.0)]
        if s.ball:
            rx, ry, turned = m.ring[frame] * s.moved
            for circle in self._ring:
                circle.center = rx, ry
            lines.append(_line(rx, ry, turned, s.bore, s.shoulder))
            angles = m.balls[frame]
            self._balls.set_offsets(s.pitch * np.stack([np.cos(angles), np.sin(angles)], axis=1))
        self._marks.set_segments(lines)
        self._push(frame, x, y)

    def _push(self, frame: int, x: float, y: float) -> None:
        """The arrow of the force, and what is told below."""
        m = self._motion
        force = m.force[frame]
        size = float(np.hypot(*force))
        direction = force / size if size else np.zeros(2)
        self._arrow.set_offsets([[x - direction[0], y - direction[1]]])
        self._arrow.set_UVC(*(FORCE_ARROW * size / (m.largest_force or 1.0) * direction))
        rpm = RPM * m.speeds[frame]
        ring = f", ring {rpm[1]:.0f} rpm" if self._size.ball else ""
        stage = f", {m.stage(frame)}" if m.stage(frame) else ""
        self._told.set_text(f"rotor {rpm[0]:.0f} rpm{ring}, force {size:.0f} N{stage}")


@dataclass(frozen=True)
class _Size:
    """Of what is drawn, over the journal's radius."""

    bore: float
    pitch: float
    ball: float  # 0: nothing rolls
    moved: np.ndarray  # what x, y (m) and angle are multiplied by

    @classmethod
    def of(cls, motion: Motion) -> _Size:
        s = motion.shape
        moved = np.array([s.magnified / s.journal, s.magnified / s.journal, 1.0])
        pitch = (s.pitch + s.beyond) / s.journal if s.pitch else 0.0
        return cls(s.bore / s.journal, pitch, s.ball / s.journal, moved)

    @property
    def shoulder(self) -> float:
        """Of the inner ring."""
        return self.pitch - SHOULDER_RATIO * self.ball

    @property
    def outer(self) -> float:
        """Of all that is drawn."""
        return self.pitch + 1.35 * self.ball if self.ball else 1.22 * self.bore


def _line(x: float, y: float, angle: float, start: float, end: float) -> list[tuple[float, float]]:
    """From one distance of a centre to another, in a direction."""
    c, s = math.cos(angle), math.sin(angle)
    return [(x + start * c, y + start * s), (x + end * c, y + end * s)]
