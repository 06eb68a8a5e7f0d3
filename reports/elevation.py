"""A bearing from the side, for films: the rotor's shoulders between the faces of its ring.

Drawn is the plane of y and z. What stands at (y, z) in a body that is moved by (y_c, z_c) and tilted by rx
goes to

    y + m (y_c - rx z)        z + n (z_c + rx y)

with displacements magnified m times across and n times along the shaft, so that gap and clearance are both
seen, and what touches is drawn touching. On an upright machine z points up, on a lying one to the right.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import EllipseCollection
from matplotlib.patches import Polygon

from ..master.coupling.connections import Attachment, housing_port
from .figures.motion import has_faces
from .figures.style import ORANGE
from .series import at_times, largest_about, packed
from .subject import Subject

Corner = tuple[float, float]  # (across, along)
Outline = tuple[Corner, ...]

CORE, SLEEVE, EDGE, FORCE, BODY = "#c8d3dc", "#e6d9bd", "#6f7a84", "#a5260b", "#f5f6f8"
DRAWN_GAP = 0.16  # of the journal's radius: how wide the smaller gap along the shaft is drawn
DRAWN_CLEARANCE = 0.16  # likewise the clearance
COLLAR = 0.3  # of the journal's radius: how thick a shoulder is drawn
BUSHING = 0.6  # likewise, half the width of one, which states none
RACE = 1.35  # of a ball's radius: half the width of a ring around its rows
RIM, GROOVE = 1.35, 0.8  # likewise, from the pitch circle to the outside, and to the shoulders of the rings
ARROW = 0.6  # of the journal's radius: the largest force of a face
SLEEVE_RIM = 1.22  # of the bore's radius: the outside of a bushing
UPRIGHT = math.radians(45.0)  # inclination from which on z is drawn upwards
RESTING = np.zeros(3)


@dataclass(frozen=True)
class _Parts:
    """The parts drawn, as outlines at rest: corners (across, along) over the journal's radius.

    Each half of a ring has its own outline, one above and one below the line of the shaft.
    """

    rotor: Outline
    ring: tuple[Outline, ...]  # moves
    outer: tuple[Outline, ...]  # does not
    balls: tuple[Corner, ...]
    ball: float  # radius; 0: nothing rolls
    reach: tuple[float, float]  # of all that is drawn, across and along


@dataclass(frozen=True)
class Elevation:
    """Motion along the shaft in one bearing, frame by frame."""

    parts: _Parts
    unit: float  # m, the journal's radius
    magnified: tuple[float, float]  # across, along
    upright: bool
    rotor: np.ndarray  # (frames, 3): y, z (m) from the housing's, rx (rad)
    ring: np.ndarray  # likewise
    force: np.ndarray  # (frames,): of the faces on the rotor (N), the largest about a frame, with its sign
    longest: float = 1.0  # N, force of the longest arrow

    @property
    def largest_force(self) -> float:
        """Of the film (N)."""
        return float(np.max(np.abs(self.force), initial=0.0))

    def moved(self, points: Sequence[Corner], motion: np.ndarray) -> np.ndarray:
        """Where points (across, along, over the unit) of a body in `motion` (y, z, rx) are drawn.

        (points, 2): to the right and up, which an upright machine exchanges.
        """
        across, along = np.asarray(points, dtype=float).T
        m, n = self.magnified
        y, z, tilt = motion
        shown = np.stack(
            [across + m * (y / self.unit - tilt * along), along + n * (z / self.unit + tilt * across)]
        )
        return (shown if self.upright else shown[::-1]).T

    def for_page(self) -> dict[str, object]:
        """The data for the page's script; lengths over the journal's radius, forces over the largest."""
        m, n = self.magnified
        scale = np.array([m / self.unit, n / self.unit, 1.0])  # the script magnifies tilt itself
        return {
            "upright": self.upright,
            "unit": self.unit,
            "magnified": [m, n],
            "rotor": _corners([self.parts.rotor])[0],
            "ring": _corners(self.parts.ring),
            "outer": _corners(self.parts.outer),
            "balls": np.round(self.parts.balls, 4).tolist(),
            "ball": round(self.parts.ball, 4),
            "reach": list(self.parts.reach),
            "largest": self.longest,
            "push": ARROW,
            "moves": packed(self.rotor * scale),
            "rings": packed(self.ring * scale),
            "force": packed(self.force / self.longest),
        }


def _corners(outlines: Sequence[Outline]) -> list[list[list[float]]]:
    return [np.round(outline, 4).tolist() for outline in outlines]


def elevation(subject: Subject, a: Attachment, time: np.ndarray, magnified: float) -> Elevation | None:
    """The motion along the shaft at a seat at the frames' `time` (s); None where it has no faces.

    magnified: how many times displacements across are.
    """
    if not has_faces(subject.run, a):
        return None
    recording = subject.run.recording
    parts, along = _parts(subject, a)
    unit = subject.setting(a, "journal_radius") or 1.0
    zero = np.zeros(len(recording.time))
    port = housing_port(subject.run.system, a.bearing)

    def recorded(name: str) -> np.ndarray:
        return recording[name] if name in recording else zero  # noqa: SIM401 (it has no get)

    middle = [recorded(f"{port}.{axis}") if port else zero for axis in "yz"]
    body = [recorded(a.motion(axis)) for axis in ("y", "z", "rx")]
    ring = [recorded(f"{a.bearing}.{name}") for name in ("ring.y", "along.z", "along.rx")]
    if f"{a.bearing}.along.z" not in recording:  # the faces are fixed in the housing
        ring = [*middle, zero]
    rotor, ring = (
        at_times(time, recording.time, moved[0] - middle[0], moved[1] - middle[1], moved[2])
        for moved in (body, ring)
    )
    force = recorded(a.load("fz"))
    force = force[largest_about(time, recording.time, np.abs(force))]
    return Elevation(
        parts,
        unit,
        (magnified, along),
        abs(subject.run.scene.inclination or 0.0) > UPRIGHT,
        rotor,
        ring,
        force,
    )


def _parts(subject: Subject, a: Attachment) -> tuple[_Parts, float]:
    """The parts drawn at a seat, and the factor that magnifies displacements along the shaft."""

    def setting(name: str) -> float:
        return subject.setting(a, name) or 0.0

    unit = setting("journal_radius")
    gaps = {sign: setting(f"shoulder.gap_{side}") for sign, side in ((1.0, "minus"), (-1.0, "plus"))}
    smallest = min(gap for gap in gaps.values() if gap > 0.0)
    along = max(1.0, DRAWN_GAP * unit / smallest)
    ball = 0.5 * setting("balls.diameter") / unit
    beyond = DRAWN_CLEARANCE - setting("clearance") / unit  # all around the bore is drawn further out
    pitch = 0.5 * setting("balls.pitch_diameter") / unit + beyond
    apart = (
        0.5 * setting("row_distance") / unit
        if setting("balls.rows") > 1 and setting("arrangement")
        else 0.0
    )
    half = apart + RACE * ball if ball else BUSHING
    bore = 1.0 + DRAWN_CLEARANCE
    rim = pitch + RIM * ball if ball else SLEEVE_RIM * bore
    inner = _halves(bore, pitch - GROOVE * ball, half) if ball else ()
    outer = _halves(pitch + GROOVE * ball if ball else bore, rim, half)
    rows = (apart, -apart) if apart else (0.0,)
    balls = tuple((side * pitch, row) for side in (1.0, -1.0) for row in rows) if ball else ()
    # its middle radius is that of the faces
    collar = max(2.0 * (setting("shoulder.radius") / unit + beyond) - 1.0, bore + 0.1)
    faces = {side: half + along * gap / unit for side, gap in gaps.items() if gap > 0.0}
    end = max(faces.values()) + 2.0 * COLLAR
    reach = 1.08 * max(rim, collar), end + COLLAR
    return _Parts(_outline(faces, collar, end), inner, outer, balls, ball, reach), along


def _halves(inside: float, outside: float, half: float) -> tuple[Outline, ...]:
    """A ring between two radii, `half` its width either way: its section on both sides of the shaft."""
    return tuple(
        ((side * inside, half), (side * outside, half), (side * outside, -half), (side * inside, -half))
        for side in (1.0, -1.0)
    )


def _outline(faces: dict[float, float], collar: float, end: float) -> Outline:
    """The shaft, from -end to end, with a shoulder of a radius at each of `faces` (side: distance)."""
    upper: list[Corner] = [(1.0, end)]
    for side in (1.0, -1.0):
        if (face := faces.get(side)) is not None:
            near, far = (1.0, side * face), (1.0, side * (face + COLLAR))
            up = [far, (collar, far[1]), (collar, near[1]), near]
            upper += up if side > 0.0 else up[::-1]
    upper.append((1.0, -end))
    return (*upper, *((-across, along) for across, along in reversed(upper)))


class ElevationPanel:
    """A bearing from the side; lengths over the journal's radius."""

    def __init__(self, axes: Axes, side: Elevation, title: str) -> None:
        self._side, parts = side, side.parts
        wide, high = parts.reach if side.upright else parts.reach[::-1]
        reach = 1.15 * max(wide, high)
        axes.set_xlim(-reach, reach)
        axes.set_ylim(-reach, reach)
        for outline in parts.outer:
            fill = CORE if parts.ball else SLEEVE
            axes.add_patch(Polygon(side.moved(outline, RESTING), closed=True, fc=fill, ec=EDGE, lw=0.8))
        self._ring = [Polygon([(0, 0)], closed=True, fc=CORE, ec=EDGE, lw=0.8) for _ in parts.ring]
        self._rotor = Polygon([(0, 0)], closed=True, fc=BODY, ec=ORANGE, lw=1.6)
        for patch in (*self._ring, self._rotor):
            axes.add_patch(patch)
        wide, count = 2.0 * parts.ball, len(parts.balls)
        self._balls = EllipseCollection(
            [wide] * count, [wide] * count, [0.0] * count, units="xy", offsets=np.zeros((count, 2)),
            offset_transform=axes.transData, fc=BODY, ec=EDGE, lw=1.2,
        )  # fmt: skip
        axes.add_collection(self._balls)
        self._arrow = axes.quiver([0], [0], [0], [0], angles="xy", scale_units="xy", scale=1.0,
                                  color=FORCE, width=0.012, zorder=5)  # fmt: skip
        axes.text(0.0, 1.02 * reach, f"{title}, from the side", ha="center", va="bottom", fontsize=10,
                  parse_math=False)  # fmt: skip
        self._told = axes.text(0.0, -1.02 * reach, "", ha="center", va="top", fontsize=9)

    def show(self, frame: int) -> None:
        """Move all to where they are in a frame."""
        side, parts = self._side, self._side.parts
        ring = side.ring[frame]
        for patch, outline in zip(self._ring, parts.ring, strict=True):
            patch.set_xy(side.moved(outline, ring))
        if parts.balls:
            self._balls.set_offsets(side.moved(parts.balls, 0.5 * ring))  # they roll along at half its rate
        self._rotor.set_xy(side.moved(parts.rotor, side.rotor[frame]))
        force = float(side.force[frame])
        push = ARROW * force / side.longest
        start = side.moved([(0.0, 0.0)], side.rotor[frame])
        self._arrow.set_offsets(start)
        self._arrow.set_UVC(*((0.0, push) if side.upright else (push, 0.0)))
        z, ring_z = 1e6 * side.rotor[frame, 1], 1e6 * ring[1]
        moved = f", ring {ring_z:.1f} µm" if parts.ball else ""
        self._told.set_text(f"along the shaft: rotor {z:.0f} µm{moved}, force {abs(force):.0f} N")
