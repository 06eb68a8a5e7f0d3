"""A sweep as pictures: over one or two of its settings, and how many drops its machine survives."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure, FigureBase
from matplotlib.ticker import MaxNLocator

from ...master.common.errors import TouchdownError, as_list
from ...master.common.files import writing_to
from ...master.quantities import Quantity, most, named
from ...master.results.whirl.verdict import CONFIDENCE
from ...reports.figures.style import BLACK, BLUE, drawable, save, sheet, sized
from .definition import Definition
from .members import Member
from .parts import CAPTURE, WHIRL, parts_map
from .places import MAX_LABELLED_CELLS, Field, cells, field, labelled
from .survival import Survival

SCALE = "cividis"  # even for eyes that tell no red from green, and in grey
SCALE_MARGIN = 1.08  # of the largest value, up to the frame

Values = list[float]  # of the drops at one place


def _value_map(axes: Axes, field: Field[list[Member]], quantity: Quantity) -> Axes:
    """The largest of the drops at each place. Raises TouchdownError where no drop has the quantity."""
    spots = {
        place: [quantity.factor * v for m in there if (v := most(m.summary, quantity.key)) is not None]
        for place, there in field.spots.items()
    }
    if not any(spots.values()):
        raise TouchdownError(f"no drop has a quantity {quantity.key}")
    found = Field(field.labels, spots, field.together)
    draw: Callable[[Axes, Field[Values], Quantity], None]
    draw = _value_cells if found.is_grid else _value_marks if len(found.labels) == 2 else _line
    draw(axes, found, quantity)
    labelled(axes, found)
    title = f"{quantity.head}\nof {found.together}" if found.together else quantity.head
    axes.set_title(title, fontsize="medium")
    return axes


def _value_cells(axes: Axes, field: Field[Values], quantity: Quantity) -> None:
    xs, ys = field.along(0), field.along(1)
    grid = np.full((len(ys), len(xs)), np.nan)
    for x, y, values in cells(axes, field):
        grid[y, x] = max(values, default=np.nan)
    image = axes.imshow(grid, origin="lower", aspect="auto", cmap=SCALE, interpolation="nearest")
    axes.figure.colorbar(image, ax=axes, label=quantity.head)
    if grid.size > MAX_LABELLED_CELLS:
        return
    middle = 0.5 * (np.nanmin(grid) + np.nanmax(grid))
    for (y, x), value in np.ndenumerate(grid):
        text = "–" if np.isnan(value) else f"{value:.4g}"
        colour = "white" if value < middle else BLACK
        axes.text(x, y, text, ha="center", va="center", fontsize=7, color=colour)


def _value_marks(axes: Axes, field: Field[Values], quantity: Quantity) -> None:
    places = [place for place, values in field.spots.items() if values]
    peaks = [max(field.spots[place]) for place in places]
    marks = axes.scatter(
        [p[0] for p in places], [p[1] for p in places], c=peaks, cmap=SCALE, edgecolor=BLACK, lw=0.4
    )
    axes.figure.colorbar(marks, ax=axes, label=quantity.head)


def _line(axes: Axes, field: Field[Values], quantity: Quantity) -> None:
    """Over one setting: the largest as a line, down to the smallest as a band."""
    places = [x for x in field.along(0) if field.spots[(x,)]]
    largests, smallests = ([pick(field.spots[(x,)]) for x in places] for pick in (max, min))
    axes.plot(places, largests, "-o", color=BLUE, ms=4)
    axes.fill_between(places, smallests, largests, color=BLUE, alpha=0.18, lw=0)
    axes.set_ylim(0.0, SCALE_MARGIN * max(largests) or 1.0)
    axes.set_ylabel(quantity.head)


NAMES = ("whirl", "capture", "force", "stress")


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
        return parts_map(_axes(ax), self._field(over), WHIRL)

    def capture(self, ax: Axes | None = None, over: str | Sequence[str] = ()) -> Axes:
        """The part of the drops whose rotor is captured, with its 95 % interval; undecided ones are not."""
        return parts_map(_axes(ax), self._field(over), CAPTURE)

    def force(self, ax: Axes | None = None, over: str | Sequence[str] = ()) -> Axes:
        """The largest contact force [N]."""
        return _value_map(_axes(ax), self._field(over), named("peak_contact_force")[0])

    def stress(self, ax: Axes | None = None, over: str | Sequence[str] = ()) -> Axes:
        """The largest bending stress of the rotor [MPa]."""
        return _value_map(_axes(ax), self._field(over), named("peak_bending_stress")[0])

    def _field(self, over: str | Sequence[str]) -> Field[list[Member]]:
        return field(self._definition, self._members, as_list(over))

    def save(self, folder: Path, over: Sequence[str] = ()) -> list[Path]:
        """Write those there is something for into `folder`, as whirl-map.png and so on."""
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
                drawn.append(save(figure, folder / f"{name}-map.png", dpi=150))
        return drawn


def _axes(ax: Axes | None) -> Axes:
    return drawable(None).add_subplot() if ax is None else ax


SURVIVAL_FILE = "survival.png"


def write_survival(found: Survival, drops: Sequence[int], path: Path) -> None:
    """Draw it into a file."""
    figure = Figure(layout="constrained")
    draw_survival(sized(figure, 6.4, 4.2), found, drops)
    with writing_to(path):
        save(figure, path)


def draw_survival(figure: FigureBase, found: Survival, drops: Sequence[int]) -> Axes:
    """Probability [1] that the machine survives, over the number of drops, with its interval."""
    axes = figure.subplots()
    after = [found.after(n) for n in drops]
    axes.fill_between(
        drops, [s.low for s in after], [s.high for s in after], color=BLUE, alpha=0.25, lw=0.0,
        label=f"{CONFIDENCE:.0%} confidence, of {found.count} drops",
    )  # fmt: skip
    axes.plot(drops, [s.value for s in after], "o-", color=BLUE, ms=3.0)
    axes.xaxis.set_major_locator(MaxNLocator(integer=True))
    axes.set(xlabel="drops", ylabel="survived with probability [1]", ylim=(0.0, 1.05))
    axes.set_title(f"Ended by {found.limit.words()}, or used up by fatigue", fontsize="medium")
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.15), frameon=False)
    return axes
