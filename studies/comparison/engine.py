"""The engine of comparisons: variants of a scene against one reference.

A kind of comparison declares its variants and the quantities that they are measured in. What is the same
for all is here: rows, time, table, picture, file, and which row is the cheapest that is good enough.
"""

from __future__ import annotations

import math
import statistics
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from enum import StrEnum
from pathlib import Path
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ...master.common.errors import TouchdownError
from ...master.scene.scene import Scene
from ...master.scene.schemes import SCHEMES
from ...reports.figures.style import BLACK, COLOURS, GREY, sheet
from ..drop.running import wall_time, warm_up
from ..findings import Column, Findings, Record, number, paragraphs, table

MODES = (3, 5, 8, 12, 20)  # per plane, the two rigid ones included
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


@dataclass(frozen=True)
class Quantity:
    """An error or a value that rows may have: how it is headed, shown and written."""

    head: tuple[str, ...]  # of its column for people, with the unit; (): only in the file
    factor: float  # from SI, or from a relative error
    form: str  # of the shown number
    title: str  # of its column in the file, with the unit
    least: float = 0.0  # what a smaller error is drawn as, in SI

    def shown(self, value: float | None) -> str:
        """A value for people; - where there is none."""
        return number(None if value is None else self.factor * value, self.form)


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
    quantities: Mapping[str, Quantity]  # by the keys of `Row.errors` and `Row.values`
    beside: Sequence[Row] = ()  # the reference, and what is no variant of the scene
    reference: Any = None  # as the kind has it
    targets: Mapping[str, float] = field(default_factory=dict)  # errors that are good enough
    floors: Mapping[str, float] = field(default_factory=dict)  # errors below these say nothing
    orders: Mapping[str, Mapping[str, Order | None]] = field(default_factory=dict)  # by curve and quantity
    drawn: Sequence[str] = ()  # quantities of the picture's panels
    notes: Sequence[str] = ()  # lines below the table
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
        """The cheapest row within the targets.

        Ledgers that do not warn go first; of rows that take about the same time the most accurate one.
        """
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
            pictures={f"{self.of}.png": lambda: work_precision(self)} if self.drawn else {},
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
            Column[Row](q.head, lambda row, key=key, q=q: q.shown(_value(row, key)))
            for key, q in self.quantities.items()
            if q.head and any(_value(row, key) is not None for row in rows)
        ]
        if any(row.wall is not None for row in rows):
            columns.append(Column(("wall/", "simulated"), lambda row: number(row.wall, ".3g")))
        if any(row.ratio is not None for row in rows):
            columns.append(Column(("time", "ratio"), lambda row: number(row.ratio, ".2f")))
        head = f"{self.of.removesuffix('s'):<{left}}{'macro step' if stepped else '':>{WIDTH}}".rstrip()
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
            **{quantity.title: _value(row, key) for key, quantity in self.quantities.items()},
            "wall_time_per_simulated_s": row.wall,
            "wall_time_ratio": row.ratio,
            "ledger": row.ledger,
            "failed": row.failed,
            "remark": row.remark,
        }


def _value(row: Row, key: str) -> float | None:
    return row.errors.get(key, row.values.get(key))


def work_precision(comparison: Comparison) -> Figure:
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
        lined = "" if name == MONOLITHIC or len(rows) == 1 else "-" if i < len(COLOURS) else "--"
        style = {"color": COLOURS[i % len(COLOURS)], "marker": MARKERS[i % len(MARKERS)]}
        if name == MONOLITHIC:
            style = {"color": BLACK, "marker": "x"}
        points = [
            (quantity.factor * error, row.wall, row)
            for row in rows
            if row.wall is not None
            and 0.0 < (error := max(abs(row.errors.get(key, 0.0)), quantity.least)) < math.inf
        ]
        if points:
            errors, walls, drawn = zip(*points, strict=True)
            label = name if len(rows) > 1 else None
            axes.plot(errors, walls, ls=lined, lw=1.2, ms=5, label=label, **style)  # type: ignore[arg-type]
            for error, wall, row in zip(errors, walls, drawn, strict=True):
                text = row.name if row.step is None or row.group else f"{1e6 * row.step:g}"
                offset = {"xytext": (4, 3), "textcoords": "offset points"}
                axes.annotate(text, (error, wall), fontsize=7, **offset)  # type: ignore[arg-type]
    if floor := comparison.floors.get(key):
        axes.axvline(quantity.factor * floor, color=GREY, lw=0.8, ls=":")
    if key in comparison.targets:
        axes.axvline(quantity.factor * comparison.targets[key], color=GREY, lw=0.8, ls="--", label="wanted")
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlabel(f"error of {' '.join(quantity.head)}")
    axes.set_ylabel("wall time per simulated s [s]")
    axes.grid(alpha=0.3)


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
    """Times variants: medians of runs, with what a variant compiles done before."""

    def __init__(self, options: Options) -> None:
        self._repeat, self._in_process = options.repeat, options.in_process
        where = "in process" if self._in_process else "through FMUs"
        self.title = f"{where}, median of {self._repeat}"

    def warm_up(self, variant: Variant) -> None:
        """Compile what a variant needs."""
        warm_up(variant.scene, self._in_process, variant.recorded)

    def timed(self, row: Row, variant: Variant) -> Row:
        """The row with the wall time of its variant, or why it failed there."""
        try:
            walls = [self.once(variant) for _ in range(self._repeat)]
        except TouchdownError as error:
            return replace(row, failed=f"while it was timed: {error}")
        return replace(row, wall=statistics.median(walls))

    def against(self, variant: Variant, reference: Variant) -> tuple[Sequence[float], Sequence[float]]:
        """Wall times of both, in turns: a busy machine slows both."""
        self.warm_up(variant)
        pairs = [(self.once(variant), self.once(reference)) for _ in range(self._repeat)]
        mine, others = zip(*pairs, strict=True)
        return mine, others

    def once(self, variant: Variant) -> float:
        """Wall time of one run (s per simulated s)."""
        return wall_time(variant.scene, self._in_process, variant.recorded)
