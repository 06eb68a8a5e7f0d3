"""The engine of comparisons: variants of a scene against one reference.

A kind of comparison declares its variants and the quantities that they are measured in. What is the same
for all is here: rows, time, table, picture, file, and which row is the cheapest that is good enough.
"""

from __future__ import annotations

import math
import tempfile
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from enum import StrEnum
from pathlib import Path
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ...master.common.errors import TouchdownError
from ...master.coupling.loop.span import brief
from ...master.coupling.simulation import Outcome, opened, simulate
from ...master.scene.scene import Scene
from ...master.scene.schemes import SCHEMES
from ...reports.figures.style import BLACK, COLOURS, GREY, sheet
from ..findings import Column, Findings, Record, number, paragraphs, table

MODES = (3, 5, 8, 12, 20)  # per plane, the two rigid ones included
BEARINGS = ("simplified_caged", "simplified_cageless", "detailed_caged", "detailed_cageless")
TARGET_ERROR_M = 1e-7
SAME_TIME_FACTOR = 1.2  # times the least wall time: as good as the same
MONOLITHIC = "monolithic"
MARKERS = "osD^v<>ph*"
WIDTH = 12  # of the table's columns


@dataclass(frozen=True)
class Options:
    """Options of a comparison; each kind takes some of them."""

    schemes: Sequence[str] = tuple(SCHEMES)
    macro_steps: Sequence[float] = ()  # s; none: those of the kind
    duration: float | None = None  # s from the first contact; None: that of the kind
    wanted: float = TARGET_ERROR_M  # m, error of the journal that is good enough
    repeat: int = 3  # runs that are timed
    timed: float | None = None  # s, their duration from the scene's zero; None: as what is compared
    modes: Sequence[int] = MODES
    cases: Sequence[str] = ()  # of stability, by name
    bearings: Sequence[str] = BEARINGS  # models of the project, or names in the catalogue
    jobs: int = 2
    in_process: bool = False


@dataclass(frozen=True)
class Variant:
    """A scene that differs from the reference in one thing."""

    name: str
    scene: Scene
    step: float | None = None  # s, its macro step, where the comparison is over macro steps
    recorded: bool = True


class Alarm(StrEnum):
    """The alarm of the ledger by the scene's thresholds."""

    NONE = ""
    WARNS = "warns"
    STOPS = "stops"


@dataclass(frozen=True)
class Row:
    """A variant against the reference: errors by quantity, where known, in SI or relative."""

    name: str
    step: float | None = None  # s, its macro step; None: the scene's own, or none at all
    errors: Mapping[str, float] = field(default_factory=dict)
    wall: float | None = None  # s per simulated s
    ledger: Alarm = Alarm.NONE
    failed: str = ""  # why there are no errors
    ratio: float | None = None  # of wall time to the reference's, of runs one after the other
    group: str = ""  # rows of a curve; "": those of its name
    values: Mapping[str, float] = field(default_factory=dict)  # by quantity, of the variant itself
    remark: str = ""

    def found(self, key: str) -> float | None:
        """An error, a value or a cost; None where it has none."""
        return {"wall": self.wall, "ratio": self.ratio, **self.values, **self.errors}.get(key)


@dataclass(frozen=True)
class Measure:
    """An error or a value that rows may have: how it is written, headed and shown."""

    title: str  # of its column in the file, with the unit
    head: tuple[str, ...] = ()  # of its column for people, with the unit; (): only in the file
    factor: float = 1.0  # from SI, or from a relative error
    form: str = ""  # of the shown number
    least: float = 0.0  # what a smaller error is drawn as, in SI

    def shown(self, value: float | None) -> str:
        """A value for people; - where there is none."""
        return number(None if value is None else self.factor * value, self.form)


COSTS = {  # of any row
    "wall": Measure("wall_time_per_simulated_s", ("wall/", "simulated"), 1.0, ".3g"),
    "ratio": Measure("wall_time_ratio", ("time", "ratio"), 1.0, ".2f"),
}


@dataclass(frozen=True)
class Order:
    """Slope of log error over log step, and the steps (s) it was fitted to."""

    value: float
    steps: tuple[float, ...]


@dataclass(frozen=True)
class Comparison:
    """Rows of variants, and what they are measured against."""

    of: str  # the kind
    title: str
    about: Sequence[str]  # lines on what is compared with what
    rows: Sequence[Row]
    quantities: Mapping[str, Measure]  # by the keys of `Row.errors` and `Row.values`
    beside: Sequence[Row] = ()  # the reference, and rows that are not variants of the scene
    reference: Any = None  # as the kind has it
    targets: Mapping[str, float] = field(default_factory=dict)  # errors that are good enough
    floors: Mapping[str, float] = field(default_factory=dict)  # errors below these say nothing
    orders: Mapping[str, Mapping[str, Order | None]] = field(default_factory=dict)  # by curve and quantity
    drawn: Sequence[str] = ()  # quantities of the picture's panels
    notes: Sequence[str] = ()  # lines below the table
    row_is: str = ""  # head above the rows' names; "": the kind, in the singular
    advise: Callable[[Comparison], Sequence[str]] = lambda comparison: ()
    tabulated: bool = True  # whether its lines have the table of rows
    tables: Mapping[str, Sequence[Record]] = field(default_factory=dict)  # further ones, by file
    warnings: Sequence[str] = ()  # what makes the errors doubtful
    incomplete: str = ""  # what failed of it
    interrupted: bool = False

    def within(self, rows: Iterable[Row]) -> list[Row]:
        """Those with a wall time whose errors are within all targets, the fastest first."""
        good = [
            row
            for row in rows
            if row.wall and all(abs(row.errors.get(k, math.inf)) <= t for k, t in self.targets.items())
        ]
        return sorted(good, key=lambda row: row.wall or math.inf)

    def recommended(self) -> Row | None:
        """The cheapest row within the targets; ledgers that do not warn go first."""
        quiet = self.cheapest([row for row in self.rows if row.ledger is Alarm.NONE])
        return quiet or self.cheapest([row for row in self.rows if row.ledger is not Alarm.STOPS])

    def cheapest(self, rows: Iterable[Row]) -> Row | None:
        """The one with the least wall time; of those up to SAME_TIME_FACTOR above it the most accurate."""
        good, key = self.within(rows), next(iter(self.targets))
        near = [row for row in good if (row.wall or 0.0) <= SAME_TIME_FACTOR * (good[0].wall or 0.0)]
        return min(near, key=lambda row: abs(row.errors[key]), default=None)

    @property
    def lines(self) -> list[str]:
        """The comparison for people: what is compared, table, notes and advice."""
        parts = (self.about, self._table() if self.tabulated else (), self.notes, self.advise(self))
        return paragraphs(*filter(None, parts))

    def findings(self) -> Findings:
        """Its lines, and its files: OF.csv with all rows, and OF.png."""
        records = [self._record(row) for row in (*self.rows, *self.beside)]
        return Findings(
            self.lines,
            tables={f"{self.of}.csv": records, **self.tables},
            pictures={f"{self.of}.png": lambda: _work_precision(self)} if self.drawn else {},
            dots_per_inch=110,
        )

    def write(self, folder: str | Path) -> None:
        """Its files into `folder`, which exists. Raises TouchdownError where they cannot be written."""
        self.findings().write(Path(folder))

    def _table(self) -> list[str]:
        rows = [*self.rows, *self.beside]
        left = max((len(row.name) for row in rows), default=0) + 2
        stepped = any(row.step for row in rows)

        def label(row: Row) -> str:
            step = row.group if row.step is None else f"{1e6 * row.step:g} us"
            return f"{row.name:<{left}}{step:>{WIDTH}}" if stepped else row.name

        columns = [
            Column[Row](one.head, lambda row, key=key, one=one: one.shown(row.found(key)))
            for key, one in {**self.quantities, **COSTS}.items()
            if one.head and any(row.found(key) is not None for row in rows)
        ]
        head = self.row_is or self.of.removesuffix("s")
        head = f"{head:<{left}}{'macro step' if stepped else '':>{WIDTH}}".rstrip()
        return table(
            Column((head, ""), label),
            columns,
            rows,
            instead=lambda row: row.failed,
            behind=lambda row: f"ledger {row.ledger}" if row.ledger else row.remark,
            width=WIDTH,
        )

    def _record(self, row: Row) -> Record:
        """A row in SI, or relative, and in full precision."""
        return {
            "variant": row.name,
            "group": row.group,
            "macro_step_s": row.step,
            **{one.title: row.found(key) for key, one in {**self.quantities, **COSTS}.items()},
            "ledger": row.ledger,
            "failed": row.failed,
            "remark": row.remark,
        }


def _work_precision(comparison: Comparison) -> Figure:
    """Panels of wall time against error by quantity; labels are macro steps or names."""
    lines = math.ceil(len(comparison.drawn) / 2)
    figure = sheet(13.0, 5.0 * lines)
    figure.suptitle(comparison.title)
    panels = list(figure.subplots(lines, min(2, len(comparison.drawn)), squeeze=False).flat)
    for axes in panels[len(comparison.drawn) :]:
        axes.set_axis_off()
    curves: dict[str, list[Row]] = {}
    for row in (*comparison.rows, *comparison.beside):
        curves.setdefault(row.group or row.name, []).append(row)
    for axes, key in zip(panels, comparison.drawn, strict=False):
        _panel(axes, comparison, key, curves)
    if panels[0].get_legend_handles_labels()[1]:
        panels[0].legend(fontsize=8)
    return figure


def _panel(axes: Axes, comparison: Comparison, key: str, curves: Mapping[str, Sequence[Row]]) -> None:
    quantity = comparison.quantities[key]
    for i, (name, rows) in enumerate(curves.items()):
        colour, marker = COLOURS[i % len(COLOURS)], MARKERS[i % len(MARKERS)]
        line = "" if len(rows) == 1 else "-" if i < len(COLOURS) else "--"
        if name == MONOLITHIC:
            colour, marker, line = BLACK, "x", ""
        points = [
            (quantity.factor * error, row.wall, row)
            for row in rows
            if row.wall is not None
            and 0.0 < (error := max(abs(row.errors.get(key, 0.0)), quantity.least)) < math.inf
        ]
        if points:
            errors, walls, _ = zip(*points, strict=True)
            label = name if len(rows) > 1 else None
            axes.plot(errors, walls, ls=line, lw=1.2, ms=5, color=colour, marker=marker, label=label)
        for error, wall, row in points:
            text = row.name if row.step is None or row.group else f"{1e6 * row.step:g}"
            axes.annotate(text, (error, wall), (4, 3), textcoords="offset points", fontsize=7)
    if floor := comparison.floors.get(key):
        axes.axvline(quantity.factor * floor, color=GREY, lw=0.8, ls=":")
    if key in comparison.targets:
        axes.axvline(quantity.factor * comparison.targets[key], color=GREY, lw=0.8, ls="--", label="wanted")
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlabel(f"error of {' '.join(quantity.head)}")
    axes.set_ylabel("wall time per simulated s [s]")
    axes.grid(alpha=0.3)


def relative(value: float, exact: float) -> float:
    """Relative error; not a number where there is nothing to relate to."""
    return value / exact - 1.0 if exact != 0.0 else math.nan


def measure_all(
    variants: Iterable[Variant], measure: Callable[[Variant], Row], done: Callable[[], object]
) -> list[Row]:
    """A row for each variant; one that cannot run says why, and the others go on."""
    rows = []
    for variant in variants:
        try:
            rows.append(measure(variant))
        except TouchdownError as error:
            rows.append(Row(variant.name, variant.step, failed=str(error)))
        done()
    return rows


class Stopwatch:
    """Times variants, with what a variant compiles done before."""

    def __init__(self, options: Options) -> None:
        self._repeat, self._in_process = options.repeat, options.in_process
        where = "in process" if self._in_process else "through FMUs"
        self.title = f"{where}, median of {self._repeat}"

    def warm_up(self, variant: Variant) -> None:
        """Take two macro steps, which compile what it needs; a run that stops there is not refused."""
        self._run(variant, steps=2).raise_if_interrupted()

    def in_turns(self, *variants: Variant) -> list[tuple[float, ...]]:
        """Wall times of each (s per simulated s); they run in turns, as a busy machine slows all.

        Raises TouchdownError where one stops by itself.
        """
        return list(zip(*([self._wall(v) for v in variants] for _ in range(self._repeat)), strict=True))

    def _wall(self, variant: Variant) -> float:
        outcome = self._run(variant)
        outcome.raise_if_stopped()
        return outcome.wall_time / outcome.simulated

    def _run(self, variant: Variant, steps: int | None = None) -> Outcome:
        with tempfile.TemporaryDirectory() as folder, opened(variant.scene, self._in_process) as system:
            run = variant.scene if steps is None else brief(variant.scene, system, steps)
            return simulate(run, system, Path(folder) / "result.h5" if variant.recorded else None)
