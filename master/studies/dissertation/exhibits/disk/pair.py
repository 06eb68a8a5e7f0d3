"""The drops of section 4.3: of the same disk on the detailed and the simplified model of a bearing."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from matplotlib.figure import Figure, FigureBase

from touchdown.master.coupling.connections import Attachment
from touchdown.master.results.ending import Finished
from touchdown.master.results.figures.style import sheet
from touchdown.master.results.result import Result
from touchdown.master.scene.file import load_scene
from touchdown.master.studies.dissertation.bearings import SCENES
from touchdown.master.studies.dissertation.exhibits.drops import Drops, finished, seats_of

CAGELESS, CAGED = "cageless", "caged"
SWINGS = "28 Hz is that of small swings: the wider a pendulum swings, the slower"
NEAR_HZ = 1.0 / 28.0  # 1 Hz of the pendulum's 28
LAST = 0.05  # s, the source's closest view of the end


class Pair(NamedTuple):
    """Both models' drops of the same bearing."""

    detailed: Result
    simplified: Result


def pair(drops: Drops, cage: str) -> Pair:
    """The drops on a bearing, CAGED or CAGELESS."""
    detailed, simplified = drops.of([load_scene(SCENES[f"{cage} {kind}"]) for kind in Pair._fields])
    return Pair(detailed, simplified)


def column(run: Result, variable: str) -> np.ndarray:
    """Recorded values of a variable of its bearing."""
    return run.recording[f"{seats_of(run)[0].bearing}.{variable}"]


def ending_part(run: Result, length: float = LAST) -> np.ndarray:
    """Which recorded values are of the last `length` (s)."""
    time = run.recording.time
    return time >= time[-1] - length


def stacked(
    runs: Pair,
    draw: Callable[[FigureBase, Finished, Attachment], object],
    width: float,
    heights: tuple[float, float],
) -> Figure:
    """A figure with the picture of the detailed model above that of the simplified one; inch."""
    figure = sheet(width, sum(heights))
    parts = figure.subfigures(2, 1, squeeze=False, height_ratios=heights).flat
    for part, run in zip(parts, runs, strict=True):
        draw(part, finished(run), seats_of(run)[0])
    return figure
