"""Verdicts counted over phases of the unbalance, beside the source's, which are of one drop each."""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib.figure import Figure

from touchdown.master.results.figures.orbits import orbits
from touchdown.master.results.figures.style import sheet
from touchdown.master.results.result import Result
from touchdown.master.studies.dissertation.exhibits.drops import finished, seats_of, whirling
from touchdown.master.studies.dissertation.exhibits.exhibit import Row

SETTLES, WHIRLS = "settles", "whirls"
EDGE = "which phases whirl is decided by little; `touchdown verdict` finds the edges"


def verdict_row(what: str, source: str, runs: Sequence[Result], why: str = EDGE) -> Row:
    """The source's SETTLES or WHIRLS beside how many of `runs` whirl; it agrees where all do as it says.

    A single drop, as the source has, tells of no phase but its own: where some runs do otherwise the
    phases that the source says nothing of decide, and `why` says so.
    """
    count, every = whirling(runs), len(runs)
    like = count if source == WHIRLS else every - count
    told = "" if like == every else f"so at {like} of {every} phases; {why}" if like > 0 else why
    return Row(what, source, f"{count} of {every} whirl", holds=like == every, why=told)


def orbit_sheets(runs: Sequence[Result], columns: int) -> Figure:
    """The orbits at both seats of each run, one run beside or below the other."""
    rows = -(-len(runs) // columns)
    figure = sheet(11.4 * columns, 6.7 * rows)
    parts = figure.subfigures(rows, columns, squeeze=False).flat
    for part, run in zip(parts, runs, strict=False):
        orbits(part, finished(run), seats_of(run))
    return figure
