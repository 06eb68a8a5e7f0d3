"""A sweep as pictures over one or two of its settings."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Generic, TypeVar

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Patch, Rectangle

from ...common.errors import TouchdownError, one_of, several
from ...common.files import writing_to
from ...results.figures.style import BLACK, BLUE, ORANGE
from ...results.whirl.evidence import ANGLE
from ...results.whirl.verdict import CONFIDENCE, Kind, Share, clopper_pearson, has_verdict, kind, whirling
from .definition import Definition
from .members import Member
from .report import column as column_of
from .report import largest

Place = tuple[Any, ...]  # values of the axes: numbers in the unit of their labels, or words
Value = TypeVar("Value")


@dataclass(frozen=True)
class Field(Generic[Value]):
    """Something at places: members, or what comes of them."""

    labels: tuple[str, ...]  # of the axes, with their units
    spots: dict[Place, Value]
    together: str  # what else varies, in words, or ""

    def along(self, axis: int) -> list[Any]:
        """The values on an axis, numbers in their order, words in that of the members."""
        values = list(dict.fromkeys(place[axis] for place in self.spots))
        numbers = [value for value in values if isinstance(value, float)]
        return list(sorted(numbers)) if len(numbers) == len(values) else values

    @property
    def is_grid(self) -> bool:
        """Whether every value of one axis stands beside every one of the other."""
        counts = [len(self.along(axis)) for axis in range(len(self.labels))]
        return len(counts) == 2 and len(self.spots) == counts[0] * counts[1] > max(counts)


def refuse_axes(over: Sequence[str], varying: Sequence[str]) -> None:
    """Raise TouchdownError where a map cannot be drawn `over` these settings; none may be named."""
    for name in over:
        if name not in varying:
            raise TouchdownError(f"a map over {name}: it does not vary; {one_of(name, varying)}")
    if len(over) > 2:
        raise TouchdownError(f"a map over {', '.join(over)}: it has two axes; name one setting or two")


def field(
    definition: Definition, members: Sequence[Member], over: Sequence[str] = ()
) -> Field[list[Member]]:
    """Members by the settings `over` which a map is drawn, one or two.

    None named: the first two that vary, the phase of an unbalance only where nothing else does: a map
    shows what holds over phases. Members that were not run or failed are left out. Raises TouchdownError
    where a setting does not vary, or there are none.
    """
    given = {
        column.name: [definition.points[member.number - 1][place] for member in members]
        for place, column in enumerate(definition.columns)
    }
    varying = [name for name, values in given.items() if len(set(map(str, values))) > 1]
    phases = [c.name for c in definition.columns if all(name.endswith(f".{ANGLE}") for name in c.settings)]
    refuse_axes(over, varying)
    axes = list(over) or [name for name in varying if name not in phases][:2] or varying[:1]
    if not axes:
        raise TouchdownError("no setting varies; a map needs one or two that do")
    columns = [column_of(name, given[name]) for name in axes]
    spots: dict[Place, list[Member]] = {}
    for i, member in enumerate(members):
        there = spots.setdefault(tuple(values[i] for _, values in columns), [])
        if not member.failed:
            there.append(member)
    rest = [f"{len(set(map(str, given[name])))} values of {name}" for name in varying if name not in axes]
    return Field(tuple(title for title, _ in columns), spots, " and ".join(rest))


MAX_TICKS = 12


def cells(axes: Axes, field: Field[Value]) -> Iterator[tuple[int, int, Value]]:
    """Column, row and what is there, for each cell of a grid, whose ticks tell the settings' values."""
    xs, ys = field.along(0), field.along(1)
    axes.set_xlim(-0.5, len(xs) - 0.5)
    axes.set_ylim(-0.5, len(ys) - 0.5)
    axes.set_xticks(*_ticks(xs))
    axes.set_yticks(*_ticks(ys))
    for x, at_x in enumerate(xs):
        for y, at_y in enumerate(ys):
            yield x, y, field.spots[(at_x, at_y)]


def _ticks(values: Sequence[object]) -> tuple[list[int], list[str]]:
    """Places and labels, thinned where they would not fit."""
    every = -(-len(values) // MAX_TICKS)
    places = list(range(0, len(values), every))
    labels = [f"{values[i]:.6g}" if isinstance(values[i], float) else str(values[i]) for i in places]
    return places, labels


def labelled(axes: Axes, field: Field[Any]) -> None:
    """The settings along the axes."""
    axes.set_xlabel(field.labels[0])
    if len(field.labels) == 2:
        axes.set_ylabel(field.labels[1])


def legend_below(axes: Axes, patches: Sequence[Patch]) -> None:
    """A row under the panel."""
    axes.legend(
        handles=list(patches), loc="upper center", bbox_to_anchor=(0.5, -0.14), ncols=3, frameon=False
    )


SCALE = "cividis"  # even for eyes that tell no red from green, and in grey
SCALE_MARGIN = 1.08  # of the largest value, up to the frame
MAX_LABELLED_CELLS = 100  # cells with their numbers in words

Values = list[float]  # of the drops at one place


@dataclass(frozen=True)
class Quantity:
    """A figure of a drop."""

    key: str  # how the names of its figures begin
    label: str


FORCE = Quantity("peak_contact_force_N", "largest contact force [N]")
STRESS = Quantity("peak_bending_stress_MPa", "largest bending stress [MPa]")


def value_map(axes: Axes, field: Field[list[Member]], quantity: Quantity) -> Axes:
    """The largest of the drops at each place. Raises TouchdownError where no drop has the figure."""
    spots = {
        place: [value for m in members if (value := largest(m.summary, quantity.key)) is not None]
        for place, members in field.spots.items()
    }
    if not any(spots.values()):
        raise TouchdownError(f"no drop has the figure {quantity.key}")
    found = Field(field.labels, spots, field.together)
    draw: Callable[[Axes, Field[Values], Quantity], None]
    draw = _value_cells if found.is_grid else _value_marks if len(found.labels) == 2 else _line
    draw(axes, found, quantity)
    labelled(axes, found)
    title = f"{quantity.label}\nof {found.together}" if found.together else quantity.label
    axes.set_title(title, fontsize="medium")
    return axes


def _value_cells(axes: Axes, field: Field[Values], quantity: Quantity) -> None:
    xs, ys = field.along(0), field.along(1)
    grid = np.full((len(ys), len(xs)), np.nan)
    for x, y, values in cells(axes, field):
        grid[y, x] = max(values, default=np.nan)
    image = axes.imshow(grid, origin="lower", aspect="auto", cmap=SCALE, interpolation="nearest")
    axes.figure.colorbar(image, ax=axes, label=quantity.label)
    if grid.size > MAX_LABELLED_CELLS:
        return
    middle = 0.5 * (np.nanmin(grid) + np.nanmax(grid))
    for (y, x), value in np.ndenumerate(grid):
        told = "–" if np.isnan(value) else f"{value:.4g}"
        colour = "white" if value < middle else BLACK
        axes.text(x, y, told, ha="center", va="center", fontsize=7, color=colour)


def _value_marks(axes: Axes, field: Field[Values], quantity: Quantity) -> None:
    places = [place for place, values in field.spots.items() if values]
    peaks = [max(field.spots[place]) for place in places]
    marks = axes.scatter(
        [p[0] for p in places], [p[1] for p in places], c=peaks, cmap=SCALE, edgecolor=BLACK, lw=0.4
    )
    axes.figure.colorbar(marks, ax=axes, label=quantity.label)


def _line(axes: Axes, field: Field[Values], quantity: Quantity) -> None:
    """Over one setting: the largest as a line, down to the smallest as a band."""
    places = [x for x in field.along(0) if field.spots[(x,)]]
    largests, smallests = ([pick(field.spots[(x,)]) for x in places] for pick in (max, min))
    axes.plot(places, largests, "-o", color=BLUE, ms=4)
    axes.fill_between(places, smallests, largests, color=BLUE, alpha=0.18, lw=0)
    axes.set_ylim(0.0, SCALE_MARGIN * max(largests) or 1.0)
    axes.set_ylabel(quantity.label)


COLOURS: Mapping[Kind, str] = {Kind.SETTLES: "#dddddd", Kind.TRANSIENT: BLUE, Kind.SUSTAINED: ORANGE}
HATCHES = {Kind.SUSTAINED: "////"}  # told apart in grey, too
MARKERS = {Kind.SETTLES: "o", Kind.TRANSIENT: "s", Kind.SUSTAINED: "^"}
CELL_FILL = 0.96  # of a cell; the rest parts it from the next
MARGIN = 4.0  # % beyond none and all

Kinds = Counter[Kind]  # how many drops of each


def whirl_map(axes: Axes, field: Field[list[Member]]) -> Axes:
    """Verdicts over one setting, or two: part of the drops that whirl, with its confidence interval.

    Raises TouchdownError where no drop has a verdict.
    """
    found = Field(
        field.labels, {place: _kinds(members) for place, members in field.spots.items()}, field.together
    )
    if not any(found.spots.values()):
        raise TouchdownError("no drop has a whirl verdict")
    several = any(kinds.total() > 1 for kinds in found.spots.values())
    if found.is_grid:
        _whirl_cells(axes, found)
    elif len(found.labels) == 2 or not several:
        _whirl_marks(axes, found)
    else:
        _lines(axes, found)
    labelled(axes, found)
    title = (
        f"part of the drops that whirl, {100.0 * CONFIDENCE:.0f} % interval"
        if several
        else "whirl of every drop"
    )
    title += _followed([m for members in field.spots.values() for m in members])
    if found.together:
        title += f"\neach place over {found.together}"
    axes.set_title(title, fontsize="medium")
    return axes


def _followed(members: Sequence[Member]) -> str:
    """Up to when drops were followed: a whirl at the end is one at that time."""
    ends = [end for m in members if isinstance(end := m.summary.get("end_time_s"), float)]
    if not ends:
        return ""
    reach = dict.fromkeys(f"{end:.3g}" for end in (min(ends), max(ends)))
    return f"; the end is at {' to '.join(reach)} s"


def _kinds(members: list[Member]) -> Kinds:
    return Counter(kind(whirling(m.summary)) for m in members if has_verdict(m.summary))


def _whirl_cells(axes: Axes, field: Field[Kinds]) -> None:
    """A cell per place, filled from the left by the parts of its verdicts."""
    told = len(field.spots) <= MAX_LABELLED_CELLS
    for x, y, kinds in cells(axes, field):
        left = x - 0.5 * CELL_FILL
        for one in reversed(Kind):
            width = CELL_FILL * kinds[one] / kinds.total() if kinds.total() else 0.0
            fill = {"facecolor": COLOURS[one], "hatch": HATCHES.get(one), "edgecolor": "#ffffff80"}
            axes.add_patch(Rectangle((left, y - 0.5 * CELL_FILL), width, CELL_FILL, lw=0, **fill))
            left += width
        if told and kinds.total() != 1:
            box = {"boxstyle": "round,pad=0.15", "facecolor": "white", "edgecolor": "none", "alpha": 0.85}
            axes.text(x, y, _told(kinds), ha="center", va="center", fontsize=7, color=BLACK, bbox=box)
    _legend(axes)


def _told(kinds: Kinds) -> str:
    if not kinds.total():
        return "no verdict"
    part = _share(kinds)
    return f"{100.0 * part.value:.0f} %\n{100.0 * part.low:.0f}–{100.0 * part.high:.0f} %"


def _share(kinds: Kinds, sustained: bool = False) -> Share:
    hits = kinds[Kind.SUSTAINED] + (0 if sustained else kinds[Kind.TRANSIENT])
    return clopper_pearson(hits, kinds.total())


def _whirl_marks(axes: Axes, field: Field[Kinds]) -> None:
    """A mark per place, of its gravest verdict; over one setting they stand on a line for each."""
    gravest = {
        place: max(kinds, key=list(Kind).index, default=None) for place, kinds in field.spots.items()
    }
    for height, one in enumerate(Kind):
        places = [place for place, worst in gravest.items() if worst is one]
        xs = [place[0] for place in places]
        ys = [place[1] for place in places] if len(field.labels) == 2 else [height] * len(places)
        axes.scatter(xs, ys, color=COLOURS[one], marker=MARKERS[one], edgecolor=BLACK, lw=0.4)
    if len(field.labels) == 1:
        axes.set_yticks(range(len(Kind)), [one.value for one in Kind])
        axes.margins(y=0.3)
    else:
        _legend(axes)


def _lines(axes: Axes, field: Field[Kinds]) -> None:
    """Parts over one setting, with their intervals as bars: bands of both would hide each other."""
    for sustained, one, style in ((False, Kind.TRANSIENT, "-o"), (True, Kind.SUSTAINED, "--^")):
        places = [x for x in field.along(0) if field.spots[(x,)].total()]
        parts = [_share(field.spots[(x,)], sustained) for x in places]
        label = f"{one.value if sustained else 'any whirl'}, {100.0 * CONFIDENCE:.0f} % interval as a bar"
        values = [100.0 * p.value for p in parts]
        below = [100.0 * (p.value - p.low) for p in parts]
        above = [100.0 * (p.high - p.value) for p in parts]
        caps = 2.0 if sustained else 4.0  # both are seen where they are the same
        axes.errorbar(
            places, values, (below, above), fmt=style, color=COLOURS[one], ms=4, capsize=caps, label=label
        )
    axes.set_ylim(-MARGIN, 100.0 + MARGIN)  # marks at none and at all are whole
    axes.set_ylabel("part of the drops [%]")
    axes.legend()


def _legend(axes: Axes) -> None:
    patches = [
        Patch(facecolor=colour, hatch=HATCHES.get(one), edgecolor="#ffffff80", label=one.value)
        for one, colour in COLOURS.items()
    ]
    legend_below(axes, patches)


NAMES = ("whirl", "force", "stress")


class MapPlot:
    """The maps of a sweep: over two settings, or one, by name; none named: the first that vary.

    Where other settings vary, too, such as the phase of an unbalance, each place of a map stands for all
    drops there. Each is drawn on the axes that are given, or on new ones, and returns them. All raise
    TouchdownError where the drops have not what they show.
    """

    def __init__(self, definition: Definition, members: Sequence[Member]) -> None:
        self._definition = definition
        self._members = members

    def whirl(self, ax: Axes | None = None, over: str | Sequence[str] = ()) -> Axes:
        """The part of the drops that whirl, with its 95 % interval, in the colours of the verdicts."""

        return whirl_map(_axes(ax), self._field(over))

    def force(self, ax: Axes | None = None, over: str | Sequence[str] = ()) -> Axes:
        """The largest contact force [N]."""

        return value_map(_axes(ax), self._field(over), FORCE)

    def stress(self, ax: Axes | None = None, over: str | Sequence[str] = ()) -> Axes:
        """The largest bending stress of the rotor [MPa]."""

        return value_map(_axes(ax), self._field(over), STRESS)

    def _field(self, over: str | Sequence[str]) -> Field[list[Member]]:
        return field(self._definition, self._members, several(over))

    def save(self, folder: Path, over: Sequence[str] = ()) -> list[Path]:
        """Write those there is something for into `folder`, as whirl-map.png and so on."""
        from ...results.figures.style import sheet

        if over:
            self._field(over)  # a mistake is said
        drawn: list[Path] = []
        for name in NAMES:
            figure = sheet(7.2, 5.0)
            try:
                getattr(self, name)(figure.add_subplot(), over)
            except TouchdownError:  # there is nothing of it
                continue
            scene = self._definition.scene["name"]  # its title may tell what varies here
            figure.suptitle(f"Scene {scene}, {len(self._members)} drops")
            with writing_to(folder):
                figure.savefig(folder / f"{name}-map.png", dpi=150)
            drawn.append(folder / f"{name}-map.png")
        return drawn


def _axes(ax: Axes | None) -> Axes:
    from ...results.figures.style import drawable

    return drawable(None).add_subplot() if ax is None else ax
