"""The gaps around a rotor along a run, and how often it touched there.

Between recorded times the way is a cubic of places and velocities, where velocities were recorded.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ..scene.gaps import Gap
from ..scene.scene import Scene
from .recording import NotRecordedError, Recording

PARTS = 8  # of an interval between recorded times, in which the way is looked at
RPM = 60.0 / (2.0 * math.pi)


@dataclass(frozen=True)
class Left:
    """The size of a gap over time."""

    gap: Gap
    time: np.ndarray  # s from the scene's zero, as recorded, (n,)
    left: np.ndarray  # m, (n,); below 0 the rotor would be in the stator

    def since(self, time: float) -> Left:
        """The same from a time (s) on; all of it where the run ends before."""
        later = self.time >= time
        return Left(self.gap, self.time[later], self.left[later]) if later.any() else self

    @property
    def least(self) -> int:
        """Where in time it is least."""
        return int(np.argmin(self.left))

    @property
    def closed_at(self) -> float | None:
        """When (s) the rotor first comes to the stator; None: never."""
        closed = self.left <= 0.0
        return float(self.time[closed.argmax()]) if closed.any() else None

    @property
    def touches(self) -> int:
        """How often the rotor comes to the stator."""
        closed = self.left <= 0.0
        return int(closed[0]) + int(np.count_nonzero(closed[1:] & ~closed[:-1]))


def left_of(gap: Gap, recording: Recording) -> Left:
    """The size of `gap` over time. Raises NotRecordedError where its place was not recorded."""
    time = recording.time
    ways = [_way(gap, axis, recording) for axis in "xy"]
    if len(time) < 2 or any(speed is None for _, speed in ways):
        return Left(gap, time, gap.radial - np.hypot(ways[0][0], ways[1][0]))
    between = np.linspace(0.0, 1.0, PARTS, endpoint=False)
    finer = (time[:-1, None] + np.diff(time)[:, None] * between).ravel()
    x, y = (_cubic(time, place, speed, between) for place, speed in ways if speed is not None)
    finer = np.append(finer, time[-1])
    return Left(gap, finer, gap.radial - np.hypot(x, y))


def _way(gap: Gap, axis: str, recording: Recording) -> tuple[np.ndarray, np.ndarray | None]:
    """Place (m) and velocity (m/s) of the rotor against the stator; None where not recorded."""
    names = [f"{port}.v{axis}" for port in (gap.at, gap.stator) if port]
    place = recording[f"{gap.at}.{axis}"] - (recording[f"{gap.stator}.{axis}"] if gap.stator else 0.0)
    if not all(name in recording for name in names):
        return place, None
    return place, recording[names[0]] - (recording[names[1]] if gap.stator else 0.0)


def _cubic(time: np.ndarray, place: np.ndarray, speed: np.ndarray, between: np.ndarray) -> np.ndarray:
    """Hermite's cubic in all intervals, at `between` (0 to 1) in each, and the last place."""
    h, s = np.diff(time)[:, None], between[None, :]
    r = 1.0 - s
    begin, end = place[:-1, None], place[1:, None]
    way = r * r * ((1.0 + 2.0 * s) * begin + s * h * speed[:-1, None])
    way = way + s * s * ((3.0 - 2.0 * s) * end - r * h * speed[1:, None])
    return np.append(way.ravel(), place[-1])


def gap_figures(scene: Scene, recording: Recording) -> dict[str, object]:
    """Figures of a run from the scene's zero on for each gap, and the least of all; without gaps, none.

    Recorded times count from there already. A place that was not recorded leaves None, also of the least.
    """
    figures: dict[str, object] = {}
    found: list[Left] = []
    for gap in scene.gaps:
        try:
            one = left_of(gap, recording).since(0.0)
        except NotRecordedError:
            figures[f"{gap.key}_least_um"] = None
            continue
        found.append(one)
        key, at = one.gap.key, one.least
        figures[f"{key}_least_um"] = 1e6 * float(one.left[at])
        figures[f"{key}_least_time_s"] = float(one.time[at])
        spin, speed = f"{one.gap.at}.omega", None
        if spin in recording:
            speed = RPM * float(np.interp(one.time[at], recording.time, recording[spin]))
        figures[f"{key}_least_rotor_speed_rpm"] = speed
        figures[f"{key}_touches"] = one.touches
        figures[f"{key}_closed_time_s"] = one.closed_at
    if len(found) < len(scene.gaps):
        figures["least_gap_um"] = None
    elif found:
        least = min(found, key=lambda one: float(one.left.min()))
        figures |= {"least_gap_um": 1e6 * float(least.left.min()), "least_gap_at": least.gap.name}
    return figures


def unforced(scene: Scene, summary: Mapping[str, object]) -> str:
    """A sentence on figures that lack the forces of gaps, which have closed; empty where none do."""
    times = {gap.name: summary.get(f"{gap.key}_closed_time_s") for gap in scene.gaps if not gap.acts}
    since = {name: time for name, time in times.items() if isinstance(time, float)}
    if not since:
        return ""
    gaps = "gap" if len(since) == 1 else "gaps"
    return (
        f"The rotor closes {gaps} {' and '.join(since)} {1e3 * min(since.values()):.4g} ms after the "
        "shutdown, where this run has no force: all figures from then on are without it."
    )


def closed(scene: Scene, summary: Mapping[str, object]) -> list[str]:
    """Lines on gaps that the rotor closed."""
    lines: list[str] = []
    for gap in scene.gaps:
        if summary.get(f"{gap.key}_least_um", 0.0) is None:
            lines.append(f"gap {gap.name}: {gap.at} was not recorded; see run.record")
        touches, least = summary.get(f"{gap.key}_touches"), summary.get(f"{gap.key}_least_um")
        if isinstance(touches, int) and isinstance(least, float) and touches > 0:
            times = "once" if touches == 1 else f"{touches} times"
            lines.append(
                f"gap {gap.name} ({1e3 * gap.radial:g} mm at {gap.at}) is closed {times}: the rotor goes "
                f"{-least:.3g} um beyond it. {_acts(gap)}"
            )
    return lines


def _acts(gap: Gap) -> str:
    """The effect of a gap that is closed, in words."""
    if gap.acts:
        return f"It acts as the bushing {gap.key}, which has its forces and its heat"
    return "No force acts there in this run; one does where the gap has a journal_radius"
