"""Verdicts round the circle of phases: a ring for every choice of steps."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from matplotlib.projections.polar import PolarAxes

from touchdown.master.results.figures.style import BLACK, GREY, sheet
from touchdown.master.results.whirl.told import kind
from touchdown.master.studies.sweep.maps.whirl import COLOURS
from touchdown.master.studies.verdict.circle import Circle
from touchdown.master.studies.verdict.phases import gaps
from touchdown.master.studies.verdict.study import Study

INNERMOST = 1.0  # radius, in rings


def circles(study: Study) -> Figure:
    """Each phase that was run is a dot; its ring has the colour of its verdict half the way to the next."""
    figure = sheet(7.5, 7.5)
    axes = figure.add_subplot(projection="polar")
    assert isinstance(axes, PolarAxes)
    for ring, circle in enumerate(study.circles):
        _ring(axes, circle, INNERMOST + ring)
    outermost = INNERMOST + len(study.circles)
    axes.plot([np.radians(study.phase)] * 2, [0.0, outermost], color=GREY, ls="--", lw=1)
    axes.set_ylim(0.0, outermost)
    axes.set_yticks([])
    axes.grid(visible=False)
    patches = [Patch(color=colour, label=name.value) for name, colour in COLOURS.items()]
    line = axes.plot([], [], color=GREY, ls="--", lw=1, label="the scene's own phase")
    figure.legend(handles=[*patches, *line], loc="outside lower center", ncols=4)
    inwards = " | ".join(circle.title for circle in study.circles)
    title = f"{study.scene.title}\nphases of the unbalance, from the inmost ring: {inwards}"
    figure.suptitle(title, wrap=True)
    return figure


def _ring(axes: PolarAxes, circle: Circle, inner: float) -> None:
    for phase, before, after in gaps(circle.verdicts):
        begin, width = np.radians(phase - 0.5 * before), np.radians(0.5 * (before + after))
        colour = COLOURS[kind(circle.verdicts[phase])]
        axes.bar(begin, 0.9, width=width, bottom=inner, align="edge", color=colour, lw=0)
        axes.plot(np.radians(phase), inner + 0.45, ".", color=BLACK, ms=3)
