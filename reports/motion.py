"""What moves at which moment of a drop, for films and for pages.

Time goes slowly through the first impact and faster through what follows. Displacements are drawn
`magnified`, so that the clearance is seen; a journal that touches is drawn touching. Angles are
counter-clockwise, lengths in m and forces in N as everywhere.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..master.common.text import RPM, joined
from ..master.coupling.connections import Attachment, housing_port
from ..master.results.capture import captures
from ..master.results.recording import NotRecordedError
from .elevation import DRAWN_CLEARANCE, Elevation, elevation
from .layout import Absent, Data
from .numbers import digits
from .series import at_times, largest_about, packed
from .subject import Subject
from .timeline import OF_SEAT

FRAMES_PER_S = 25  # frames a second
LEAD_TIME = 0.02  # s before the first contact with which a film begins at most
TIME_STRETCHES = ((100.0, -0.001), (850.0, 0.006), (18.0, 0.4))
"""Of a film: how many times slower it goes, and up to when of the run (s from the first contact)."""
FORCE_ARROW = 0.5  # of the journal's radius: the arrow of the largest force
ORBITING = ("speed.cage", "speed.orbit")  # m/s, of the balls' middles, the first that there is
STATES = (  # of a seat that go on from their moments
    *("ring_sync_time", "play_used_up_time", "clearance_closed_time", "runaway_time", "seized_time"),
    *("ring_stop_time", "settling_time"),
)

Pace = tuple[tuple[float, float], ...]
"""How many times slower than it was it goes, and up to when (s), in order."""


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
    pace: Pace
    longest: float = 1.0  # N, force of the longest arrow
    stages: tuple[tuple[float, str], ...] = ()  # from when on (s) which words stand with it, in order
    side: Elevation | None = None  # where a shoulder of the rotor can land on it

    @property
    def largest_force(self) -> float:
        """Of all frames (N), also on faces."""
        across = float(np.max(np.hypot(*self.force.T), initial=0.0))
        return across if self.side is None else max(across, self.side.largest_force)

    def scaled(self, longest: float) -> Motion:
        """The same with arrows of which the `longest` is such a force (N)."""
        side = self.side and replace(self.side, longest=longest)
        return replace(self, longest=longest, side=side)

    def slower(self, frame: int) -> float:
        """How many times slower than it was a frame goes by."""
        return next((factor for factor, end in self.pace if self.time[frame] < end), self.pace[-1][0])

    def stage(self, frame: int) -> str:
        """The words that stand with a frame; "" before the first."""
        return next((words for since, words in reversed(self.stages) if since <= self.time[frame]), "")

    def for_page(self) -> Mapping[str, object]:
        """The data for the page's script; lengths over the journal's radius, forces over the largest."""
        s, unit = self.shape, self.shape.journal
        moved = np.array([s.magnified / unit, s.magnified / unit, 1.0])
        return {
            "title": s.title,
            "bore": s.bore / unit,
            "pitch": (s.pitch + s.beyond) / unit if s.pitch else 0.0,
            "ball": s.ball / unit,
            "caged": s.caged,
            "largest": self.longest,
            "push": FORCE_ARROW,
            "journal": packed(self.journal * moved),
            "ring": packed(self.ring * moved),
            "balls": packed(self.balls[:, :1]),
            "count": self.balls.shape[1],
            "force": packed(self.force / self.longest),
            "rpm": packed(RPM * self.speeds),
            "stages": self.stages,
            "side": self.side and self.side.for_page(),
        }


def moving(shown: Sequence[Motion], begin: float | None = None) -> Data:
    """What a page's template and script are told of motions that share their frames.

    begin: s, from where it is played; None: from the first frame.
    """
    first = shown[0]
    values = {
        "time": packed(first.time, "<f8"),
        "begin": float(first.time[0]) if begin is None else begin,
        "pace": first.pace,
        "seats": [one.for_page() for one in shown],
    }
    return {
        "data": json.dumps(values, separators=(",", ":")).replace("<", "\\u003c"),
        "across": _times(m.shape.magnified for m in shown),
        "along": _times(m.side.magnified[1] for m in shown if m.side is not None),
    }


def _times(factors: Iterable[float]) -> str:
    """'20 times and 30 times'."""
    return joined(list(dict.fromkeys(f"{digits(factor, 2)} times" for factor in factors)))


def motions(
    subject: Subject, frames: tuple[np.ndarray, Pace] | None = None
) -> tuple[list[Motion], list[str]]:
    """The motion at the seats that can be drawn, and the reasons why the others cannot.

    frames: their times (s) and pace; None: those of a film. Raises Absent where a film has none.
    """
    shown, lacking = [], []
    chosen = frames or _film(subject)
    for a in subject.seats:
        try:
            shown.append(_motion(subject, a, *chosen))
        except (Absent, NotRecordedError) as error:
            lacking.append(str(error))
    longest = max((one.largest_force for one in shown), default=0.0) or 1.0
    return [one.scaled(longest) for one in shown], list(dict.fromkeys(lacking))


def _motion(subject: Subject, a: Attachment, time: np.ndarray, pace: Pace) -> Motion:
    """The motion at a seat. Raises Absent where it is unknown."""
    shape = _shape(subject, a)
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
        pace,
        stages=tuple(sorted(_stages(subject, a))),
        side=elevation(subject, a, time, shape.magnified),
    )


def _stages(subject: Subject, a: Attachment) -> Iterator[tuple[float, str]]:
    """Since when (s) which state of the ring, whirl or levitation there is at the seat."""
    seat = subject.seat(a)
    for key in STATES:
        if (since := seat.get(key)) is not None:
            yield since, OF_SEAT[key][0]
    for whirl in seat.get("whirl_episodes") or ():
        yield whirl["start"], f"{whirl['direction']} whirl"
        if not whirl["goes_on"]:
            yield whirl["end"], "whirl over"
    if found := captures(subject.summary).get(subject.name(a)):
        command = subject.summary["capture_command_time"]
        yield command, "to be levitated"
        if found.after is not None:
            yield command + found.after, "captured"


def _film(subject: Subject) -> tuple[np.ndarray, Pace]:
    """Times of the run (s) at which a film has its frames, and its pace. Raises Absent: nothing touches."""
    if subject.first_contact is None:
        raise Absent("nothing touched.")
    time = subject.run.recording.time
    start = max(float(time[0]), subject.first_contact - LEAD_TIME)
    times, pace = [], []
    for factor, after in TIME_STRETCHES:
        end = min(float(time[-1]), subject.first_contact + after)
        if end > start:
            count = math.ceil(factor * (end - start) * FRAMES_PER_S)
            times.append(np.linspace(start, end, count, endpoint=False))
            pace.append((factor, end))
            start = end
    return np.concatenate(times), tuple(pace)


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
