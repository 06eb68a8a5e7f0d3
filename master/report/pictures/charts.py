"""Charts over time, as a block."""

from __future__ import annotations

from functools import partial

from touchdown.master.report.facts.numbers import digits, listed
from touchdown.master.report.facts.series import Chart
from touchdown.master.report.page.blocks import Series
from touchdown.master.report.pictures.curves import curves
from touchdown.master.report.pictures.svg import inline


def series(chart: Chart, caption: str) -> Series:
    """A chart that can be zoomed, and the same on paper."""
    ranges = [
        f"{line.label} from {digits(float(line.values.min()), 3)} to {digits(float(line.values.max()), 3)}"
        for line in chart.lines
    ]
    alt = f"{chart.title}, {chart.axis}: {listed(ranges)}"
    return Series(chart, inline(partial(curves, chart=chart), chart.name, alt), caption)
