"""The picture: error against doSteps, a panel for each problem."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from textwrap import wrap

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import NullFormatter

from cosimulated.comparison import Result

# Okabe and Ito's colours, which the colour-blind tell apart, too; markers tell lines of one colour apart
COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000")
MARKS = "os^vDP*"
ELSEWHERE = "xsv^Dd+"  # of other tools, which have broken lines
ACROSS = 2  # panels in a row
WIDE = 60  # letters of a title


def draw(found: Mapping[str, Sequence[Result]], path: Path) -> None:
    """`found` by the problems' titles; this project's ways have full lines."""
    down = -(-len(found) // ACROSS)
    figure = Figure(figsize=(11.0, 4.4 * down + 1.2), layout="constrained")
    panels = figure.subplots(down, ACROSS, squeeze=False).ravel()
    looks = styles([one for results in found.values() for one in results])
    for axes, (title, results) in zip(panels, found.items(), strict=False):
        _panel(axes, title, results, looks)
    for axes in panels[len(found) :]:
        axes.set_visible(False)
    shown = {
        name: line for axes in panels for line, name in zip(*axes.get_legend_handles_labels(), strict=True)
    }
    handles = [shown[name] for name in looks if name in shown]
    figure.legend(handles=handles, loc="outside lower center", ncols=4, fontsize="small")
    figure.savefig(path, dpi=110)


def styles(results: Sequence[Result]) -> dict[str, dict[str, object]]:
    """How each master is drawn, the same in all panels."""
    looks: dict[str, dict[str, object]] = {}
    for ours in (True, False):
        names = dict.fromkeys(one.master for one in results if one.own == ours)
        for k, name in enumerate(names):
            looks[name] = {
                "color": COLOURS[k % len(COLOURS)],
                "marker": (MARKS if ours else ELSEWHERE)[k % len(MARKS)],
                "linestyle": ("-" if k < len(COLOURS) else "-.") if ours else ":",
                "markerfacecolor": COLOURS[k % len(COLOURS)] if ours else "none",
                "markersize": 5.0 if ours else 5.0 + 1.5 * k,  # equal results lie around each other
            }
    return looks


def _panel(
    axes: Axes, title: str, results: Sequence[Result], looks: Mapping[str, Mapping[str, object]]
) -> None:
    for name in dict.fromkeys(one.master for one in results):
        seen = [one for one in results if one.master == name and np.isfinite(one.error)]
        if seen:
            axes.loglog([one.calls for one in seen], [one.error for one in seen], label=name, **looks[name])
    axes.set_title("\n".join(wrap(title, WIDE)), fontsize="medium")
    axes.set_xlabel("doSteps of all FMUs")
    axes.set_ylabel("largest error [m]")
    axes.grid(True, alpha=0.3)
    axes.xaxis.set_minor_formatter(NullFormatter())
