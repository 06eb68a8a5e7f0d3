"""The picture: what scenes cost by each way, and how cost grows."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from speeds.growth import Grown
from speeds.scenes import WAYS, Cost

REAL_TIME = 1.0  # s per simulated s


def draw(costs: list[Cost], grown: list[Grown], path: Path) -> None:
    """Scenes on the left, growth on the right."""
    figure = Figure(figsize=(12.0, 2.5 + 0.28 * max(len(costs), 12)), layout="constrained")
    left, right = figure.subplots(1, 2)
    _scenes(left, costs)
    _growth(right, grown)
    figure.savefig(path, dpi=110)


def _scenes(axes: Axes, costs: list[Cost]) -> None:
    shown = [way for way in WAYS if way in costs[0].ways]
    rows = np.arange(len(costs))
    height = 0.8 / len(shown)
    for k, way in enumerate(shown):
        spreads = [cost.ways[way] for cost in costs]
        middle = np.array([s.median for s in spreads])
        off = [middle - [s.least for s in spreads], [s.most for s in spreads] - middle]
        axes.barh(
            rows + (k + 0.5) * height - 0.4, middle, height, xerr=off, label=way, error_kw={"lw": 0.8}
        )
    axes.axvline(REAL_TIME, color="0.6", lw=0.8)
    axes.set_yticks(rows, [cost.scene.name for cost in costs])
    axes.invert_yaxis()
    axes.set_xscale("log")
    axes.set_xlabel("wall time per simulated time [s/s]")
    axes.legend()


def _growth(axes: Axes, grown: list[Grown]) -> None:
    for one in grown:
        sizes = np.array(one.sizes) / one.sizes[0]
        costs = np.array([cost.median for cost in one.costs])
        axes.loglog(sizes, costs / costs[0], "o-", label=f"{one.what}: {one.power:.2f}")
    axes.set_xlabel("size, over the smallest one")
    axes.set_ylabel("cost, over that of the smallest one")
    axes.legend(title="grows with, exponent")
