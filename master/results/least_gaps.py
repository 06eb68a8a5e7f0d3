"""The gaps around a rotor along a run, and how often it touched there.

Between recorded times the way is a cubic of places and velocities, where velocities were recorded.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..quantities import Owner, Summary, enter, owned, values_of
from ..scene.gaps import RotorGap
from ..scene.scene import Scene
from .recording import NotRecordedError, Recording

RATES = {"x": "vx", "y": "vy", "z": "vz", "rx": "wx", "ry": "wy"}
PARTS = 8  # of an interval between recorded times, in which the way is looked at


@dataclass(frozen=True)
class _Left:
    """The size of a gap over time."""

    gap: RotorGap
    time: np.ndarray  # s from the scene's zero, as recorded, (n,)
    left: np.ndarray  # m, (n,); below 0 the rotor would be in the stator

    def since(self, time: float) -> _Left:
        """The same from a time (s) on; all of it where the run ends before."""
        later = self.time >= time
        return _Left(self.gap, self.time[later], self.left[later]) if later.any() else self

    @property
    def least(self) -> int:
        """Where in time it is least."""
        return int(np.argmin(self.left))

    @property
    def touches(self) -> int:
        """How often the rotor comes to the stator."""
        closed = self.left <= 0.0
        return int(closed[0]) + int(np.count_nonzero(closed[1:] & ~closed[:-1]))


def left_of(gap: RotorGap, recording: Recording) -> _Left:
    """The size of `gap` over time. Raises NotRecordedError where its place was not recorded."""
    time, ways = recording.time, [_way(gap, axis, recording) for axis in gap.motions]
    places = [place for place, _ in ways]
    if len(time) > 1 and all(speed is not None for _, speed in ways):
        between = np.linspace(0.0, 1.0, PARTS, endpoint=False)
        places = [_cubic(time, place, speed, between) for place, speed in ways if speed is not None]
        time = np.append((time[:-1, None] + np.diff(time)[:, None] * between).ravel(), time[-1])
    first, *others = places
    if gap.axial is None:
        return _Left(gap, time, gap.size - np.hypot(first, *others))
    tilted = (gap.radius or 0.0) * np.hypot(*others) if others else 0.0  # closes it at its radius
    return _Left(gap, time, gap.size - np.abs(first) - tilted)


def _way(gap: RotorGap, axis: str, recording: Recording) -> tuple[np.ndarray, np.ndarray | None]:
    """Place (m, rad) and velocity of the rotor against a stator that does not tilt; None: not recorded."""
    ports = [port for port in (gap.at, gap.stator) if port and (port == gap.at or axis in "xyz")]
    names = [f"{port}.{RATES[axis]}" for port in ports]
    place, *moved = (recording[f"{port}.{axis}"] for port in ports)
    place = place - sum(moved)
    if not all(name in recording for name in names):
        return place, None
    speed, *moving = (recording[name] for name in names)
    return place, speed - sum(moving)


def _cubic(time: np.ndarray, place: np.ndarray, speed: np.ndarray, between: np.ndarray) -> np.ndarray:
    """Hermite's cubic in all intervals, at `between` (0 to 1) in each, and the last place."""
    h, s = np.diff(time)[:, None], between[None, :]
    r = 1.0 - s
    begin, end = place[:-1, None], place[1:, None]
    way = r * r * ((1.0 + 2.0 * s) * begin + s * h * speed[:-1, None])
    way = way + s * s * ((3.0 - 2.0 * s) * end - r * h * speed[1:, None])
    return np.append(way.ravel(), place[-1])


def add_gaps(summary: Summary, scene: Scene, recording: Recording) -> None:
    """Add each gap from the scene's zero on, and the least of all; nothing without gaps.

    Recorded times count from there already. A place that was not recorded leaves None, also of the least.
    """
    found: list[_Left] = []
    for gap in scene.gaps:
        try:
            one = left_of(gap, recording).since(0.0)
        except NotRecordedError:
            enter(summary, {"least": None}, Owner.GAP, gap.name)
            continue
        found.append(one)
        time = float(one.time[one.least])
        ports = (gap.at, *(port for _, port in scene.attach if port.split(".")[0] == gap.at.split(".")[0]))
        spins = [recording[spin] for port in ports if (spin := f"{port}.omega") in recording]
        speed = float(np.interp(time, recording.time, spins[0])) if spins else None
        touching = one.left <= 0.0
        values = {
            "least": float(one.left[one.least]),
            "least_time": time,
            "least_rotor_speed": speed,
            "touches": one.touches,
            "closed_time": float(one.time[touching.argmax()]) if touching.any() else None,  # None: never
        }
        enter(summary, values, Owner.GAP, gap.name)
    if len(found) < len(scene.gaps):
        enter(summary, {"least_gap": None})
    elif found:
        least = min(found, key=lambda one: float(one.left.min()))
        enter(summary, {"least_gap": float(least.left.min()), "least_gap_at": least.gap.name})


def unforced(scene: Scene, summary: Mapping[str, Any]) -> Iterator[tuple[float, str]]:
    """Of gaps that closed without a force when they did (s), and that in words."""
    times = values_of(summary, "closed_time", Owner.GAP)
    for gap in scene.gaps:
        if not gap.acts and (time := times.get(gap.name)) is not None:
            yield time, f"{gap.name} is rubbed, where no force acts in this run"


def closed(scene: Scene, summary: Mapping[str, Any]) -> list[str]:
    """Lines on gaps that the rotor closed."""
    lines: list[str] = []
    for gap in scene.gaps:
        found = owned(summary, Owner.GAP)[gap.name]
        if found["least"] is None:
            lines.append(f"gap {gap.name}: {gap.at} was not recorded; see run.record")
        elif (touches := found["touches"]) > 0:
            times = "once" if touches == 1 else f"{touches} times"
            lines.append(
                f"gap {gap.name} ({1e3 * gap.size:g} mm at {gap.at}) is closed {times}: the rotor goes "
                f"{-1e6 * found['least']:.3g} um beyond it. {_acts(gap)}"
            )
    return lines


def _acts(gap: RotorGap) -> str:
    """The effect of a gap that is closed, in words."""
    if gap.acts:
        return f"It acts as the bushing {gap.key}, which has its forces and its heat"
    does = "; one does where the gap has a journal_radius" if gap.axial is None else ""
    return f"No force acts there in this run{does}"
