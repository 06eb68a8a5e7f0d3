"""A drop as a film."""

from __future__ import annotations

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
from ..modelkit.kernel.writing import make_folder, replacing_by_name
from .elevation import BODY, CORE, EDGE, FORCE, SLEEVE, ElevationPanel
from .figures.style import BLUE, ORANGE, PURPLE
from .motion import FORCE_ARROW, FRAMES_PER_S, Motion

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
            f"{1e3 * m.time[frame]:.2f} ms after the shutdown, {m.slower(frame):.0f} times slower"
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
        self._arrow.set_UVC(*(FORCE_ARROW * size / m.longest * direction))
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
