"""Which part of the drops has which verdict, at each place of a sweep's settings."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum
from typing import Any

from matplotlib.axes import Axes
from matplotlib.patches import Patch, Rectangle

from ...master.common.text import percent
from ...master.results.capture import Fate, fate
from ...master.results.whirl.verdict import (
    CONFIDENCE,
    Share,
    WhirlKind,
    clopper_pearson,
    has_verdict,
    kind_of_whirl,
    worst_whirl,
)
from ...modelkit.errors import require
from ...reports.figures.style import BLACK, BLUE, ORANGE
from .members import Member
from .places import MAX_LABELLED_CELLS, Field, cells, labelled

GREY = "#dddddd"
CELL_FILL = 0.96  # of a cell; the rest parts it from the next
MARGIN = 4.0  # % beyond none and all

Counts = Counter[StrEnum]  # how many drops of each class


@dataclass(frozen=True)
class _Look:
    """How a class of verdicts is drawn; told apart in grey, too."""

    colour: str
    marker: str
    hatch: str = ""


@dataclass(frozen=True)
class _Curve:
    """A part of the drops over one setting."""

    label: str
    classes: frozenset[StrEnum]  # that count
    look: StrEnum
    style: str
    caps: float  # size of the bars' ends: two bars are seen where they are the same


@dataclass(frozen=True)
class _Verdicts:
    """A question to drops, the classes of its answers, and how they are drawn."""

    of: Callable[[Mapping[str, Any]], StrEnum | None]  # of a drop's summary; None: it has no verdict
    looks: Mapping[StrEnum, _Look]  # the gravest last
    curves: Sequence[_Curve]  # the first is told in words
    shares: str  # title, where places stand for several drops
    single: str  # title, where each stands for one
    lacking: str

    def counted(self, members: Sequence[Member]) -> Counts:
        """How many of them have which verdict."""
        return Counter(one for m in members if (one := self.of(m.summary)) is not None)

    def estimate(self, counts: Counts, curve: _Curve | None = None) -> Share:
        """The part that a curve draws, the first where none is given; there must be a drop."""
        classes = (curve or self.curves[0]).classes
        return clopper_pearson(sum(counts[one] for one in classes), counts.total())


def _whirl(summary: Mapping[str, Any]) -> WhirlKind | None:
    return kind_of_whirl(worst_whirl(summary)) if has_verdict(summary) else None


WHIRL = _Verdicts(
    _whirl,
    {
        WhirlKind.SETTLES: _Look(GREY, "o"),
        WhirlKind.TRANSIENT: _Look(BLUE, "s"),
        WhirlKind.SUSTAINED: _Look(ORANGE, "^", "////"),
    },
    (
        _Curve("any whirl", frozenset(WhirlKind) - {WhirlKind.SETTLES}, WhirlKind.TRANSIENT, "-o", 4.0),
        _Curve(
            WhirlKind.SUSTAINED.value, frozenset({WhirlKind.SUSTAINED}), WhirlKind.SUSTAINED, "--^", 2.0
        ),
    ),
    "part of the drops that whirl",
    "whirl of every drop",
    "no drop has a whirl verdict",
)
CAPTURE = _Verdicts(
    fate,
    {
        Fate.CAPTURED: _Look(BLUE, "o"),
        Fate.UNDECIDED: _Look(GREY, "s"),
        Fate.LOST: _Look(ORANGE, "^", "////"),
    },
    (_Curve("captured", frozenset({Fate.CAPTURED}), Fate.CAPTURED, "-o", 4.0),),
    "part of the drops that are captured",
    "capture of every drop",
    "no rotor was asked for again",
)


def parts_map(axes: Axes, field: Field[list[Member]], verdicts: _Verdicts) -> Axes:
    """Verdicts over one setting, or two: parts of the drops, with their confidence intervals.

    Raises TouchdownError where no drop has a verdict.
    """
    spots = {place: verdicts.counted(members) for place, members in field.spots.items()}
    found = Field(field.labels, spots, field.together)
    require(any(found.spots.values()), verdicts.lacking)
    several = any(counts.total() > 1 for counts in found.spots.values())
    if found.is_grid:
        _cells(axes, found, verdicts)
    elif len(found.labels) == 2 or not several:
        _marks(axes, found, verdicts)
    else:
        _curves(axes, found, verdicts)
    labelled(axes, found)
    title = f"{verdicts.shares}, {percent(CONFIDENCE)} interval" if several else verdicts.single
    title += _followed([m for members in field.spots.values() for m in members])
    if found.together:
        title += f"\neach place over {found.together}"
    axes.set_title(title, fontsize="medium")
    return axes


def _followed(members: Sequence[Member]) -> str:
    """Up to when drops were followed: what holds at the end holds at that time."""
    ends = [m.summary["end_time"] for m in members if "end_time" in m.summary]
    if not ends:
        return ""
    reach = dict.fromkeys(f"{end:.3g}" for end in (min(ends), max(ends)))
    return f"; the end is at {' to '.join(reach)} s"


def _cells(axes: Axes, field: Field[Counts], verdicts: _Verdicts) -> None:
    """A cell per place, filled from the left by the parts of its verdicts."""
    labelled = len(field.spots) <= MAX_LABELLED_CELLS
    for x, y, counts in cells(axes, field):
        left = x - 0.5 * CELL_FILL
        for one, look in reversed(list(verdicts.looks.items())):
            width = CELL_FILL * counts[one] / counts.total() if counts.total() else 0.0
            fill = {"facecolor": look.colour, "hatch": look.hatch or None, "edgecolor": "#ffffff80"}
            axes.add_patch(Rectangle((left, y - 0.5 * CELL_FILL), width, CELL_FILL, lw=0, **fill))
            left += width
        if labelled and counts.total() != 1:
            box = {"boxstyle": "round,pad=0.15", "facecolor": "white", "edgecolor": "none", "alpha": 0.85}
            text = _cell_text(counts, verdicts)
            axes.text(x, y, text, ha="center", va="center", fontsize=7, color=BLACK, bbox=box)
    _legend(axes, verdicts)


def _cell_text(counts: Counts, verdicts: _Verdicts) -> str:
    if not counts.total():
        return "no verdict"
    part = verdicts.estimate(counts)
    return f"{100.0 * part.value:.0f} %\n{100.0 * part.low:.0f}–{100.0 * part.high:.0f} %"


def _marks(axes: Axes, field: Field[Counts], verdicts: _Verdicts) -> None:
    """A mark per place, of its gravest verdict; over one setting they stand on a line for each."""
    order = list(verdicts.looks)
    gravest = {place: max(counts, key=order.index, default=None) for place, counts in field.spots.items()}
    for height, (one, look) in enumerate(verdicts.looks.items()):
        places = [place for place, worst in gravest.items() if worst is one]
        xs = [place[0] for place in places]
        ys = [place[1] for place in places] if len(field.labels) == 2 else [height] * len(places)
        axes.scatter(xs, ys, color=look.colour, marker=look.marker, edgecolor=BLACK, lw=0.4)
    if len(field.labels) == 1:
        axes.set_yticks(range(len(order)), [one.value for one in order])
        axes.margins(y=0.3)
    else:
        _legend(axes, verdicts)


def _curves(axes: Axes, field: Field[Counts], verdicts: _Verdicts) -> None:
    """Parts over one setting, with their intervals as bars: bands of several would hide each other."""
    places = [x for x in field.along(0) if field.spots[(x,)].total()]
    for curve in verdicts.curves:
        parts = [verdicts.estimate(field.spots[(x,)], curve) for x in places]
        label = f"{curve.label}, {percent(CONFIDENCE)} interval as a bar"
        values = [100.0 * p.value for p in parts]
        below = [100.0 * (p.value - p.low) for p in parts]
        above = [100.0 * (p.high - p.value) for p in parts]
        colour = verdicts.looks[curve.look].colour
        look = {"fmt": curve.style, "color": colour, "ms": 4, "capsize": curve.caps, "label": label}
        axes.errorbar(places, values, (below, above), **look)
    axes.set_ylim(-MARGIN, 100.0 + MARGIN)  # marks at none and at all are whole
    axes.set_ylabel("part of the drops [%]")
    axes.legend()


def _legend(axes: Axes, verdicts: _Verdicts) -> None:
    patches = [
        Patch(facecolor=look.colour, hatch=look.hatch or None, edgecolor="#ffffff80", label=one.value)
        for one, look in verdicts.looks.items()
    ]
    axes.legend(handles=patches, loc="upper center", bbox_to_anchor=(0.5, -0.14), ncols=3, frameon=False)
