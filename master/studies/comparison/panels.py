"""Panels of errors, two beside each other."""

from __future__ import annotations

import math

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ...results.figures.style import sheet


def panel_grid(count: int, width: float, height: float, title: str) -> tuple[Figure, list[Axes]]:
    """A figure of `count` panels, each as wide and high as said (inch)."""
    lines = math.ceil(count / 2)
    figure = sheet(2 * width, lines * height)
    figure.suptitle(title)
    panels = list(figure.subplots(lines, 2, squeeze=False).flat)
    for axes in panels[count:]:
        axes.set_axis_off()
    return figure, panels[:count]


def label_errors(axes: Axes, x_label: str, y_label: str) -> None:
    """Labels and a grid; y is logarithmic."""
    axes.set_yscale("log")
    axes.set_xlabel(x_label)
    axes.set_ylabel(y_label)
    axes.grid(alpha=0.3)
