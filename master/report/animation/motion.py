"""What moves in a drop, moment by moment: slowly through the first impact, faster through what follows.

Displacements are drawn `magnified`, so that the clearance is seen; a journal that touches is drawn
touching. Angles are counter-clockwise, m and N as everywhere.
"""

from __future__ import annotations

import json
import math
from dataclasses import dataclass

import numpy as np

from touchdown.master.coupling.connections import Attachment
from touchdown.master.report.facts.subject import Subject
from touchdown.master.report.page.blocks import Absent
from touchdown.master.results.ending import housing_port
from touchdown.master.results.recording import NotRecordedError

RATE = 25  # frames a second
FALL = 0.02  # s before the first contact with which a film begins at most
STRETCHES = ((100.0, -0.001), (850.0, 0.006), (18.0, 0.4))
"""Of a film: how many times slower it goes, and up to when of the run (s from the first contact)."""
VISIBLE = 0.16  # of the journal's radius: how large a clearance is drawn
PUSH = 0.5  # of the journal's radius: the arrow of the largest force
ORBITING = ("speed.cage", "speed.orbit")  # m/s, of the balls' middles, the first that there is
ROUND = 4  # decimals on a page, of lengths over the journal's radius and of angles


@dataclass(frozen=True)
class Shape:
    """A bearing as it is drawn (m)."""

    title: str
    journal: float  # radius
    clearance: float
    magnified: float
    pitch: float = 0.0  # radius; 0: a bushing
    ball: float = 0.0  # radius
    caged: bool = False

    @property
    def bore(self) -> float:
        """Radius of the bore, the clearance as it is drawn."""
        return self.journal + self.magnified * self.clearance

    @property
    def beyond(self) -> float:
        """How much further out all that is around the bore is drawn than it lies."""
        return (self.magnified - 1.0) * self.clearance


@dataclass(frozen=True)
class Motion:
    """What moves in one bearing, frame by frame; of shape (frames,) but for `balls`."""

    shape: Shape
    time: np.ndarray  # s
    journal: np.ndarray  # (frames, 3): x, y (m) from the housing's middle, angle (rad)
    ring: np.ndarray  # likewise
    balls: np.ndarray  # (frames, balls): attitude angles (rad)
    force: np.ndarray  # (frames, 2): of the bearing on the journal (N), the largest about a frame
    speeds: np.ndarray  # (frames, 2): rotor, inner ring (rad/s)
    slower: np.ndarray  # how many times slower than it was

    @property
    def largest_force(self) -> float:
        """Of the film (N)."""
        return float(np.max(np.hypot(*self.force.T), initial=0.0))

    def for_page(self) -> str:
        """JSON for the page's script; lengths over the journal's radius, forces over the largest."""
        s, unit = self.shape, self.shape.journal
        moved = np.array([s.magnified / unit, s.magnified / unit, 1.0])
        values = {
            "title": s.title,
            "rate": RATE,
            "bore": s.bore / unit,
            "pitch": (s.pitch + s.beyond) / unit if s.pitch else 0.0,
            "ball": s.ball / unit,
            "caged": s.caged,
            "magnified": s.magnified,
            "largest": self.largest_force,
            "push": PUSH,
            "time": [round(1e3 * float(t), 3) for t in self.time],
            "slower": [round(float(v), 1) for v in self.slower],
            "journal": _rounded(self.journal * moved),
            "ring": _rounded(self.ring * moved),
            "balls": _rounded(self.balls[:, :1]),
            "count": self.balls.shape[1],
            "force": _rounded(self.force / (self.largest_force or 1.0)),
            "rpm": np.round(self.speeds * 30.0 / math.pi).astype(int).tolist(),
        }
        return json.dumps(values, separators=(",", ":")).replace("<", "\\u003c")


def _rounded(values: np.ndarray) -> list[list[float]]:
    return np.round(values, ROUND).tolist()


def motions(subject: Subject) -> tuple[list[Motion], list[str]]:
    """What moves at the seats that can be drawn, and why the others cannot."""
    shown, lacking = [], []
    for a in subject.seats:
        try:
            shown.append(motion(subject, a))
        except (Absent, NotRecordedError) as error:
            lacking.append(str(error))
    return shown, list(dict.fromkeys(lacking))


def motion(subject: Subject, a: Attachment) -> Motion:
    """What moves at a seat. Raises Absent where that cannot be told."""
    shape = _shape(subject, a)
    time, slower = frames(subject)
    rows = subject.run.recording.time
    column = subject.run.recording.__getitem__
    body, port = a.body_end, housing_port(subject.run.system, a)
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
        _at(time, rows, *place, _turned(rows, spin)),
        _at(time, rows, *ring, _turned(rows, turning)),
        _balls(subject, a, time),
        _forces(subject, a, time),
        _at(time, rows, spin, turning),
        slower,
    )


def frames(subject: Subject) -> tuple[np.ndarray, np.ndarray]:
    """Times of the run (s) at which a film has its frames, and how many times slower it goes there.

    Raises Absent where nothing touches.
    """
    if subject.first_contact is None:
        raise Absent("nothing touched.")
    time = subject.run.recording.time
    start = max(float(time[0]), subject.first_contact - FALL)
    times, slower = [], []
    for factor, after in STRETCHES:
        end = min(float(time[-1]), subject.first_contact + after)
        if end > start:
            count = math.ceil(factor * (end - start) * RATE)
            times.append(np.linspace(start, end, count, endpoint=False))
            slower.append(np.full(count, factor))
            start = end
    return np.concatenate(times), np.concatenate(slower)


def _shape(subject: Subject, a: Attachment) -> Shape:
    journal, clearance = (subject.setting(a, name) for name in ("journal_radius", "clearance"))
    if journal is None or not clearance or clearance < 0.0:
        raise Absent(f"{a.bearing} states no journal radius and clearance.")
    magnified = max(1.0, VISIBLE * journal / clearance)
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


def _at(time: np.ndarray, rows: np.ndarray, *values: np.ndarray) -> np.ndarray:
    """Recorded values, each (rows,), at other times: (len(time), len(values))."""
    return np.stack([np.interp(time, rows, column) for column in values], axis=1)


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
    rows = subject.run.recording.time
    edges = np.concatenate([[time[0]], 0.5 * (time[1:] + time[:-1]), [time[-1]]])
    first = np.searchsorted(rows, edges[:-1])
    last = np.maximum(np.searchsorted(rows, edges[1:]), first + 1)
    size = np.hypot(*force.T)
    chosen = [min(f + int(np.argmax(size[f:e])), len(rows) - 1) if f < len(rows) else len(rows) - 1
              for f, e in zip(first.tolist(), last.tolist(), strict=True)]  # fmt: skip
    return force[chosen]
