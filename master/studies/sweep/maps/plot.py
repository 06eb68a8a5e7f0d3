"""Maps of a sweep, drawn when they are asked for or saved all at once."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from touchdown.master.common.errors import TouchdownError
from touchdown.master.common.files import writing_to
from touchdown.master.common.several import several
from touchdown.master.studies.sweep.definition import Definition
from touchdown.master.studies.sweep.journal import Member
from touchdown.master.studies.sweep.maps.field import Field, field

if TYPE_CHECKING:
    from matplotlib.axes import Axes

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
        from touchdown.master.studies.sweep.maps.whirl import whirl_map

        return whirl_map(_axes(ax), self._field(over))

    def force(self, ax: Axes | None = None, over: str | Sequence[str] = ()) -> Axes:
        """The largest contact force [N]."""
        from touchdown.master.studies.sweep.maps.values import FORCE, value_map

        return value_map(_axes(ax), self._field(over), FORCE)

    def stress(self, ax: Axes | None = None, over: str | Sequence[str] = ()) -> Axes:
        """The largest bending stress of the rotor [MPa]."""
        from touchdown.master.studies.sweep.maps.values import STRESS, value_map

        return value_map(_axes(ax), self._field(over), STRESS)

    def _field(self, over: str | Sequence[str]) -> Field[list[Member]]:
        return field(self._definition, self._members, several(over))

    def save(self, folder: Path, over: Sequence[str] = ()) -> list[Path]:
        """Write those there is something for into `folder`, as whirl-map.png and so on."""
        from touchdown.master.results.figures.style import sheet

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
    from touchdown.master.results.figures.style import drawable

    return drawable(None).add_subplot() if ax is None else ax
