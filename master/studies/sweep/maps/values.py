"""Maps of a figure: the largest contact force, the largest stress."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes

from touchdown.master.common.errors import TouchdownError
from touchdown.master.results.figures.style import BLACK, BLUE
from touchdown.master.studies.sweep.journal import Member
from touchdown.master.studies.sweep.maps.field import Field
from touchdown.master.studies.sweep.maps.paper import cells, labelled
from touchdown.master.studies.sweep.report import largest

SCALE = "cividis"  # even for eyes that tell no red from green, and in grey
ROOM = 1.08  # of the largest value, up to the frame
MOST_TOLD = 100  # cells with their numbers in words

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
    draw = _cells if found.is_grid else _marks if len(found.labels) == 2 else _line
    draw(axes, found, quantity)
    labelled(axes, found)
    title = f"{quantity.label}\nof {found.together}" if found.together else quantity.label
    axes.set_title(title, fontsize="medium")
    return axes


def _cells(axes: Axes, field: Field[Values], quantity: Quantity) -> None:
    xs, ys = field.along(0), field.along(1)
    grid = np.full((len(ys), len(xs)), np.nan)
    for x, y, values in cells(axes, field):
        grid[y, x] = max(values, default=np.nan)
    image = axes.imshow(grid, origin="lower", aspect="auto", cmap=SCALE, interpolation="nearest")
    axes.figure.colorbar(image, ax=axes, label=quantity.label)
    if grid.size > MOST_TOLD:
        return
    middle = 0.5 * (np.nanmin(grid) + np.nanmax(grid))
    for (y, x), value in np.ndenumerate(grid):
        told = "–" if np.isnan(value) else f"{value:.4g}"
        colour = "white" if value < middle else BLACK
        axes.text(x, y, told, ha="center", va="center", fontsize=7, color=colour)


def _marks(axes: Axes, field: Field[Values], quantity: Quantity) -> None:
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
    axes.set_ylim(0.0, ROOM * max(largests) or 1.0)
    axes.set_ylabel(quantity.label)
