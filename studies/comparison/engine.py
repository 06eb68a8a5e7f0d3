"""The engine of comparisons: variants of a scene, each run and held against one reference.

A comparison declares its variants and the quantities that they differ in, and measures each variant
(`measure_all`); the rows that result are shown and written by its quantities.
"""

from __future__ import annotations

import statistics
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from enum import StrEnum

from ...master.common.errors import TouchdownError
from ...master.scene.scene import Scene
from ..drop.running import wall_time, warm_up
from ..findings import Column, Record, number

Begin = Callable[[str], object]  # told what begins


def begin_silently(what: str) -> None:
    """Tell no one."""


@dataclass(frozen=True)
class Variant:
    """A scene that differs from the reference in one thing."""

    name: str
    scene: Scene
    step: float | None = None  # s, its macro step, where the comparison is over macro steps
    recorded: bool = True

    @property
    def title(self) -> str:
        """For people."""
        return self.name if self.step is None else f"{self.name} at {1e6 * self.step:g} us"


class Alarm(StrEnum):
    """The alarm of the ledger by the scene's thresholds."""

    NONE = ""
    WARNS = "warns"
    STOPS = "stops"


@dataclass(frozen=True)
class Row:
    """A variant against the reference: errors by quantity, where known, in SI or relative."""

    name: str
    step: float | None = None  # s; None: the scene's own, or none at all
    errors: Mapping[str, float] = field(default_factory=dict)
    wall: float | None = None  # s per simulated s
    ledger: Alarm = Alarm.NONE
    failed: str = ""  # why there are no errors
    ratio: float | None = None  # of wall time to the reference's, of runs one after the other


@dataclass(frozen=True)
class Quantity:
    """An error that rows may have: how it is headed, shown and written."""

    head: tuple[str, str]  # of its column for people, with the unit
    factor: float  # from SI, or from a relative error
    form: str  # of the shown number
    title: str  # of its column in the file, with the unit

    def shown(self, error: float | None) -> str:
        """An error for people; - where there is none."""
        return number(None if error is None else self.factor * error, self.form)


WALL_TIME = Column[Row](("wall/", "simulated"), lambda row: number(row.wall, ".3g"))


def error_columns(quantities: Mapping[str, Quantity]) -> list[Column[Row]]:
    """Columns of a table for people, by the keys of `Row.errors`."""
    return [
        Column[Row](quantity.head, lambda row, key=key, q=quantity: q.shown(row.errors.get(key)))
        for key, quantity in quantities.items()
    ]


def error_cells(row: Row, quantities: Mapping[str, Quantity]) -> Record:
    """Errors of a row in SI, or relative, and in full precision."""
    return {quantity.title: row.errors.get(key) for key, quantity in quantities.items()}


def measure_all(
    variants: Iterable[Variant], measure: Callable[[Variant], Row], begin: Begin = begin_silently
) -> list[Row]:
    """A row for each variant; one that cannot run says why, and the others go on."""
    rows = []
    for variant in variants:
        begin(variant.title)
        try:
            rows.append(measure(variant))
        except TouchdownError as error:
            rows.append(Row(variant.name, variant.step, failed=str(error)))
    return rows


def cheapest(rows: Iterable[Row], same_time_factor: float) -> Row | None:
    """The row with the least wall time; of those up to `same_time_factor` above it the most accurate."""
    timed = [(row.wall, row) for row in rows if row.wall]
    least = min((wall for wall, _ in timed), default=0.0)
    near = [row for wall, row in timed if wall <= same_time_factor * least]
    return min(near, key=lambda row: row.errors["position"], default=None)


class Stopwatch:
    """Times variants: medians of `repeat` runs, with what a variant compiles done before."""

    def __init__(self, repeat: int, in_process: bool) -> None:
        self._repeat, self._in_process = repeat, in_process

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
