"""What maps share: cells in rows and columns, and the labels of their axes."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any, TypeVar

from matplotlib.axes import Axes
from matplotlib.patches import Patch

from touchdown.master.studies.sweep.maps.field import Field

Value = TypeVar("Value")
MOST_TICKS = 12


def cells(axes: Axes, field: Field[Value]) -> Iterator[tuple[int, int, Value]]:
    """Column, row and what is there, for each cell of a grid, whose ticks tell the settings' values."""
    xs, ys = field.along(0), field.along(1)
    axes.set_xlim(-0.5, len(xs) - 0.5)
    axes.set_ylim(-0.5, len(ys) - 0.5)
    axes.set_xticks(*_ticks(xs))
    axes.set_yticks(*_ticks(ys))
    for x, at_x in enumerate(xs):
        for y, at_y in enumerate(ys):
            yield x, y, field.spots[(at_x, at_y)]


def _ticks(values: Sequence[object]) -> tuple[list[int], list[str]]:
    """Places and labels, thinned where they would not fit."""
    every = -(-len(values) // MOST_TICKS)
    places = list(range(0, len(values), every))
    labels = [f"{values[i]:.6g}" if isinstance(values[i], float) else str(values[i]) for i in places]
    return places, labels


def labelled(axes: Axes, field: Field[Any]) -> None:
    """The settings along the axes."""
    axes.set_xlabel(field.labels[0])
    if len(field.labels) == 2:
        axes.set_ylabel(field.labels[1])


def legend_below(axes: Axes, patches: Sequence[Patch]) -> None:
    """A row under the panel."""
    axes.legend(
        handles=list(patches), loc="upper center", bbox_to_anchor=(0.5, -0.14), ncols=3, frameon=False
    )
