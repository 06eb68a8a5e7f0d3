"""Which drops of rotor I whirl, by speed and misalignment, beside Fig 14 of the source.

Whether a rotor whirls is decided by little, the phase of its unbalance for one: so what is counted is the
part of all phases that whirls, over phases that resolve the windows.
"""

from __future__ import annotations

import statistics
from collections.abc import Mapping, Sequence
from pathlib import Path

from ...master.common.progress import Progress
from ...master.scene.file import load_scene
from ..sweep.tasks import Running
from ..verdict.report import findings, newtons, percent, reach, whirls_in_words
from ..verdict.study import Circle, Plan, strays, study_verdict, whirling_share, windows

SEATS = ("A", "B")
NO_LIMIT = {"run.stop_residual": 1000.0}  # of what is turned over: never, so that every drop counts
PHASE = "rotor.unbalance_angle"


def phases(members: int) -> dict[str, list[str]]:
    """The ensemble: unbalance phases around the circle."""
    return {PHASE: [f"{360.0 * i / members:g} deg" for i in range(members)]}


def numbers(figures: Sequence[Mapping[str, object]], key: str) -> list[float]:
    """A figure of the drops that have it."""
    return [float(v) for f in figures if isinstance(v := f.get(key), (int, float))]


def spread(values: Sequence[float]) -> str:
    """Median, smallest and largest; a dash where there is none."""
    if not values:
        return "-"
    return f"{statistics.median(values):.3g} ({min(values):.3g} to {max(values):.3g})"


SPEEDS = (9000, 18000)  # rpm
SOURCE = {  # misalignment of each bearing [um]: the source's verdict
    0: "settles",
    75: "settles",
    150: "settles",
    225: "whirls",
}
DURATION = 0.5  # s


def whirling_drops(plan: Plan, folder: Path, jobs: int, progress: Progress) -> list[str]:
    """Shares and windows of phases that whirl at both speeds for each misalignment; files in `folder`."""
    lines = [f"{'rpm':>6} {'misalignment':>14}  {'source':<9} phases that whirl; largest force; windows"]
    for speed in SPEEDS:
        for offset, source in SOURCE.items():
            name = f"rotor1-{speed}" + (f"-{offset}um" if offset else "")
            scene = load_scene(name).set({"run.duration": DURATION})
            study = study_verdict(scene, plan, folder / name, Running(jobs, in_process=True), progress)
            findings(study).write(folder / name)
            if study.interrupted:
                raise KeyboardInterrupt
            (circle,) = study.circles
            lines.append(f"{speed:>6} {f'+-{offset} um':>14}  {source:<9} {_line_end(circle)}")
            lines += [f"{'':>33}{phase:g} deg failed: {why}" for phase, why in circle.failed.items()]
    return lines


def _line_end(circle: Circle) -> str:
    """A line's end: how much whirls, how hard, where and how."""
    verdicts = circle.verdicts
    if not verdicts:
        return "no run gave a verdict"
    force = circle.largest_force()
    parts = [percent(whirling_share(verdicts)), "-" if force is None else newtons(force)]
    for window in windows(verdicts):
        parts.append(f"{reach(window)}: {whirls_in_words(verdicts, window)}")
    if alone := strays(verdicts):
        parts.append(f"{len(alone)} strays")
    return "; ".join(parts)
