"""Comparisons by name, declared in cases.toml: figures of others, ours beside them, and verdicts."""

from __future__ import annotations

import inspect
import tomllib
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from enum import Enum
from functools import cache
from importlib import import_module
from numbers import Real
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from ..master.common.errors import TouchdownError, one_of

if TYPE_CHECKING:
    import numpy as np
    from matplotlib.figure import Figure

    Line = tuple[Sequence[float] | np.ndarray, Sequence[float] | np.ndarray]  # x, y


class Kind(Enum):
    """Where the figure beside ours is from."""

    CLOSED_FORM = "closed form"
    PROGRAM = "other program"
    COMPUTATION = "published computation"
    MEASUREMENT = "measurement"
    DISSERTATION = "dissertation"


class Verdict(Enum):
    """The verdict on a row."""

    AGREES = "agrees"
    KNOWN = "differs, known"
    DIFFERS = "differs"
    OPEN = "no value to compare"


OTHER_TABLES = {"figures", "studies", "absent", "texts", "pages"}  # of cases.toml, beside those of modules
KNOWN_WITHIN = 1.0 / 3.0  # a row with a reason why it differs must stay within this
Value = float | tuple[float, float] | str  # a number, smallest and largest, words


class UnavailableError(TouchdownError):
    """A case needs what is not on this machine; the text says what."""


@dataclass(frozen=True)
class Row:
    """One quantity, as others state it and as it comes out here.

    unit: of numbers, as printed; theirs: None where it is in a picture alone; ours: None where it did
    not happen. A number agrees with a number within `tolerance` (relative; None: that of its case), and
    with a range inside it; of words `holds` says whether they agree. why: what a deviation hinges on, or
    what the value assumes.

    >>> Row("mass", "kg", 3.3, 3.31, 0.05).conclusion
    'agrees'
    >>> Row("mass", "kg", 3.3, 4.0, 0.05, "another rotor").conclusion
    'differs: another rotor'
    """

    quantity: str
    unit: str
    theirs: Value | None
    ours: Value | None
    tolerance: float | None = None
    why: str = ""
    holds: bool | None = None

    @property
    def deviation(self) -> float | None:
        """Of ours, over theirs; None where they are not both numbers, or theirs is 0."""
        if isinstance(self.theirs, Real) and isinstance(self.ours, Real) and self.theirs:
            return float(self.ours) / float(self.theirs) - 1.0
        return None

    @property
    def agrees(self) -> bool | None:
        """Whether they agree; None where there is nothing to compare."""
        if self.theirs is None or self.ours is None or self.holds is not None:
            return None if self.theirs is None else bool(self.holds)
        if isinstance(self.theirs, tuple) and not isinstance(self.ours, str):
            low, high = self.ours if isinstance(self.ours, tuple) else (self.ours, self.ours)
            return self.theirs[0] <= low and high <= self.theirs[1]
        if self.deviation is None:
            return self.theirs == self.ours
        return abs(self.deviation) <= (self.tolerance or 0.0)

    @property
    def verdict(self) -> Verdict:
        """The verdict; a value that is not a number, or did not happen, differs."""
        if self.agrees is None or self.agrees:
            return Verdict.AGREES if self.agrees else Verdict.OPEN
        return Verdict.KNOWN if self.why and self._near else Verdict.DIFFERS

    @property
    def _near(self) -> bool:
        """Whether ours is outside theirs by no more than KNOWN_WITHIN of it; words always are."""
        if self.theirs is None or self.ours is None:
            return False
        if isinstance(self.theirs, str) or isinstance(self.ours, str):
            return self.holds is not None or type(self.theirs) is type(self.ours)
        low, high = self.theirs if isinstance(self.theirs, tuple) else (self.theirs, self.theirs)
        least, most = self.ours if isinstance(self.ours, tuple) else (self.ours, self.ours)
        beyond = (low - least, low), (most - high, high)
        return all(excess <= 0.0 or excess <= KNOWN_WITHIN * abs(end) for excess, end in beyond)

    @property
    def conclusion(self) -> str:
        """The verdict in words, with the reason."""
        if self.agrees:
            return f"agrees; {self.why}" if self.why else "agrees"
        if self.agrees is None:
            return f"{Verdict.OPEN.value}: {self.why or 'the dissertation has it in its picture alone'}"
        return f"differs: {self.why or 'unexplained'}"


class Found(NamedTuple):
    """What a case gives: rows, a picture, what is assumed, and lines of a table of its own."""

    rows: Sequence[Row]
    figure: Figure | None = None
    notes: Sequence[str] = ()
    lines: Sequence[str] = ()


@dataclass(frozen=True)
class Case:
    """A comparison that runs by its name.

    source: the citation; looked_at: whether the figures were read there for this case, else they are quoted
    from memory or from another text; tolerance: relative; why: it is as large as that; afterwards: whether
    it was set with the result known; command: which made the figures of another program, with its version
    and date; cheap: less than a second once its kernels are compiled; function: by default that of the
    case's name, which takes `arguments`.
    """

    name: str
    module: str
    title: str
    kind: Kind = Kind.CLOSED_FORM
    source: str = ""
    tolerance: float = 0.05
    why: str = ""
    looked_at: bool = True
    afterwards: bool = False
    command: str = ""
    cheap: bool = True
    function: str = ""
    arguments: tuple[str, ...] = ()

    @property
    def heading(self) -> str:
        """Its name, or as the dissertation calls it."""
        return _heading(self.name) if self.kind is Kind.DISSERTATION else self.name

    @property
    def label(self) -> str:
        """Its title, with where its figures are from if that is not the dissertation."""
        return self.title if self.kind is Kind.DISSERTATION else f"{self.title} ({self.kind.value})"

    @property
    def stem(self) -> str:
        """Of its files: hertz-impact, fig_25, table_7."""
        return self.heading.lower().replace(" ", "_")

    @property
    def compute(self) -> Callable[..., Sequence[Row] | Found]:
        """Its function."""
        module = import_module(f"{__package__}.{self.module}")
        return getattr(module, self.function or self.stem.replace("-", "_"))

    @property
    def what(self) -> str:
        """What is computed, and how: its function's docstring."""
        return " ".join((inspect.getdoc(self.compute) or "").split())

    def found(self, *drops: object) -> Found:
        """Compute it; the dissertation's take the `Drops` they run. Raises TouchdownError where one stops,
        `UnavailableError` where something is missing.
        """
        result = self.compute(*drops, *self.arguments)
        found = result if isinstance(result, Found) else Found(result)
        whole = {"tolerance": self.tolerance}
        rows = [replace(row, **whole) if row.tolerance is None else row for row in found.rows]
        return found._replace(rows=rows)


def curves(
    x: str, y: str, points: tuple[str, Line], lines: Mapping[str, Line], *, equal: bool = False
) -> Figure:
    """A picture: points of others, with what they are, our lines by label; equal: axes have one scale."""
    from ..reports.figures.style import sheet

    figure = sheet(8.0, 5.5)
    axes = figure.subplots()
    for label, line in lines.items():
        axes.plot(*line, lw=1.2, label=label)
    axes.plot(*points[1], "k.", ms=5, label=points[0])
    axes.set(xlabel=x, ylabel=y)
    if equal:
        axes.set_aspect("equal")
    figure.legend(fontsize=8, loc="outside lower center", ncols=2)
    return figure


Results = Mapping[Case, Found | TouchdownError]


@cache
def declared() -> Mapping[str, Any]:
    """The tables of cases.toml."""
    return tomllib.loads(Path(__file__).with_name("cases.toml").read_text(encoding="utf-8"))


@cache
def cases() -> Mapping[str, Case]:
    """All cases but the dissertation's, in the order of the page."""
    short = declared()["texts"]

    def made(name: str, module: str, entry: Mapping[str, Any]) -> Case:
        texts = {key: v.format(**short).format(**short) for key, v in entry.items() if isinstance(v, str)}
        kind = Kind(entry.get("kind", Kind.CLOSED_FORM.value))
        arguments = tuple(entry.get("arguments", ()))
        return Case(name, module, **{**entry, **texts, "kind": kind, "arguments": arguments})

    modules = {name: table for name, table in declared().items() if name not in OTHER_TABLES}
    return {name: made(name, module, e) for module, table in modules.items() for name, e in table.items()}


@cache
def figures(*, studies: bool = False) -> Mapping[str, Case]:
    """The dissertation's figures and tables that the models give; studies: larger ones as well."""
    tables = declared()["figures"] | (declared()["studies"] if studies else {})
    return {
        name: Case(name, f"dissertation.{module}", title, Kind.DISSERTATION)
        for name, (module, title) in tables.items()
    }


def _heading(name: str) -> str:
    """As the dissertation calls a figure or table."""
    if not name[-1].isdigit():
        return name.capitalize()
    return f"Table {name.removeprefix('table')}" if name.startswith("table") else f"Fig {name}"


def find_case(name: str) -> Case:
    """The case of that name. Raises TouchdownError where there is none."""
    if name not in cases():
        raise TouchdownError(f"unknown case {name}; {one_of(name, list(cases()))}")
    return cases()[name]


def find_figure(name: str) -> Case:
    """The figure or table of that name; "Fig 25" and "table_7" are understood.

    Raises TouchdownError for one that the models do not give, with the reason.
    """
    short = name.lower()
    for part in ("figure", "fig", ".", "_", "-", " "):
        short = short.replace(part, "")
    known = figures(studies=True)
    if short in known:
        return known[short]
    if short in (absent := declared()["absent"]):
        raise TouchdownError(f"figure {short} is {absent[short]}; `touchdown figure` lists those there are")
    raise TouchdownError(f"the dissertation has no figure {name}; {one_of(short, known)}")


def make(case: Case, *drops: object, dark: bool = False) -> Found:
    """A case, computed and drawn; dark: on a dark ground. Raises TouchdownError as `Case.found` does."""
    from ..reports.figures.style import darkened, styled

    with styled():
        found = case.found(*drops)
    if dark and found.figure is not None:
        darkened(found.figure)
    return found


def make_all(
    cases: Iterable[Case], *drops: object, dark: bool = False, done: Callable[[], object] = bool
) -> Results:
    """What each gives, or why nothing; done: called after each. Drops are run once."""
    results: dict[Case, Found | TouchdownError] = {}
    for case in cases:
        try:
            results[case] = make(case, *drops, dark=dark)
        except TouchdownError as error:
            results[case] = error
        done()
    return results
