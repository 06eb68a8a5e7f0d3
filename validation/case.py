"""Cases: a figure from elsewhere, ours beside it, how far apart they may be, and why."""

from __future__ import annotations

import importlib
import inspect
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from enum import Enum

import numpy as np


class Kind(Enum):
    """Where the figure beside ours is from."""

    CLOSED_FORM = "closed form"
    PROGRAM = "other program"
    COMPUTATION = "published computation"
    MEASUREMENT = "measurement"


class Verdict(Enum):
    """The verdict on a row."""

    AGREES = "agrees"
    KNOWN = "differs, known"
    DIFFERS = "differs"


KNOWN_WITHIN = 1.0 / 3.0  # a row of which it is known why it differs must stay within this


class UnavailableError(Exception):
    """A case needs what is not on this machine; the text says what."""


@dataclass(frozen=True)
class Row:
    """A figure and ours.

    unit: of both, as it is printed; tolerance: relative, None for that of the case; known: why the row
    lies outside of it, where it does and that is understood or at least looked into.
    """

    quantity: str
    unit: str
    theirs: float
    ours: float
    tolerance: float | None = None
    known: str = ""

    @property
    def deviation(self) -> float:
        """Of ours, over theirs."""
        return self.ours / self.theirs - 1.0 if self.theirs else math.nan


Line = tuple[Sequence[float] | np.ndarray, Sequence[float] | np.ndarray]  # x, y


@dataclass(frozen=True)
class Curves:
    """A picture of a case: their points and our lines, by label; equal: both axes have one scale.

    points: what theirs are, such as "measured".
    """

    x: str
    y: str
    theirs: Line
    ours: Mapping[str, Line]
    points: str
    equal: bool = False


@dataclass(frozen=True)
class Case:
    """A comparison that runs by its name.

    what: is computed, and how; source: the citation; looked_at: whether the figures were read there for
    this case, else they are quoted from memory or from another text; tolerance: relative; why: it is as
    large as that; afterwards: whether it was set with the result known; command: which made the figures
    of another program, with its version and date; cheap: less than a second once its kernels are compiled;
    drawn: gives a picture, where people would rather look.
    """

    name: str
    title: str
    kind: Kind
    what: str
    source: str
    tolerance: float
    why: str
    compute: Callable[[], Sequence[Row]] = field(repr=False)
    looked_at: bool = True
    afterwards: bool = False
    command: str = ""
    cheap: bool = True
    drawn: Callable[[], Curves] | None = field(default=None, repr=False)

    def rows(self) -> list[Row]:
        """The rows, computed. Raises `UnavailableError` where they cannot be."""
        return list(self.compute())

    def verdict(self, row: Row) -> Verdict:
        """The verdict on one of its rows; a value that is not a number differs."""
        allowed = self.tolerance if row.tolerance is None else row.tolerance
        if not math.isfinite(row.deviation):
            return Verdict.DIFFERS
        if abs(row.deviation) <= allowed:
            return Verdict.AGREES
        return Verdict.KNOWN if row.known and abs(row.deviation) <= KNOWN_WITHIN else Verdict.DIFFERS


def case(
    name: str,
    title: str,
    kind: Kind,
    *,
    source: str,
    tolerance: float,
    why: str,
    looked_at: bool = True,
    afterwards: bool = False,
    command: str = "",
    cheap: bool = True,
    drawn: Callable[[], Curves] | None = None,
) -> Callable[[Callable[[], Sequence[Row]]], Case]:
    """Make a case of a function that gives its rows; the function's docstring says what is computed."""

    def make(compute: Callable[[], Sequence[Row]]) -> Case:
        what = " ".join((inspect.getdoc(compute) or "").split())
        origin = (looked_at, afterwards, command)
        return Case(name, title, kind, what, source, tolerance, why, compute, *origin, cheap, drawn)

    return make


MODULES = (  # of cases, in the order of the page
    *("contacts", "mounts", "rings", "statics", "at_speed", "rotors", "rig", "pulled", "loops", "drops"),
    *("coupled", "references"),
)


def cases() -> Mapping[str, Case]:
    """All cases by name."""
    found: dict[str, Case] = {}
    for module in MODULES:
        home = importlib.import_module(f"{__package__}.{module}")
        found |= {one.name: one for one in vars(home).values() if isinstance(one, Case)}
    return found


def computed(one: Case) -> Sequence[Row] | str:
    """The rows of a case, or why there are none."""
    try:
        return one.rows()
    except UnavailableError as why:
        return str(why)
