"""Where on the bore of each bearing the journal pressed, and when."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure

from touchdown.master.results.figures.style import TIME, beginning, sized

SECTORS = 72  # of the bore
MOMENTS = 240  # of the run
DECADES = 3.0  # of force shown at most
COLOURS = "viridis"


@dataclass(frozen=True)
class Presses:
    """How the journal presses on a bore: each of shape (rows,)."""

    title: str
    time: np.ndarray  # s
    angle: np.ndarray  # rad, of the place, counter-clockwise from +x
    force: np.ndarray  # N

    def largest(self) -> tuple[np.ndarray, np.ndarray, np.ma.MaskedArray]:
        """Edges of time (s) and of angle (deg, 0 at the bottom), and the largest force in each field.

        The field is (SECTORS, MOMENTS), masked where nothing pressed.
        """
        moments = np.linspace(beginning(self.time), float(self.time[-1]), MOMENTS + 1)
        sectors = np.linspace(-180.0, 180.0, SECTORS + 1)
        degrees = (np.degrees(self.angle) + 90.0 + 180.0) % 360.0 - 180.0
        when = np.clip(np.searchsorted(moments, self.time, "right") - 1, 0, MOMENTS - 1)
        where = np.clip(np.searchsorted(sectors, degrees, "right") - 1, 0, SECTORS - 1)
        field = np.zeros((SECTORS, MOMENTS))
        pressed = (self.force > 0.0) & (self.time >= moments[0])
        np.maximum.at(field, (where[pressed], when[pressed]), self.force[pressed])
        return moments, sectors, np.ma.masked_less_equal(field, 0.0)


def contact_map(figure: Figure, bores: list[Presses]) -> None:
    """Place over time, the colour telling the largest force there [N]."""
    fields = [bore.largest() for bore in bores]
    top = max(float(field.max()) for _, _, field in fields if field.count())
    norm = LogNorm(top * 10.0**-DECADES, top, clip=True)
    panels = sized(figure, 9.4, 0.6 + 2.1 * len(bores)).subplots(len(bores), 1, squeeze=False, sharex=True)
    for axes, bore, (moments, sectors, field) in zip(panels[:, 0], bores, fields, strict=True):
        mesh = axes.pcolormesh(moments, sectors, field, norm=norm, cmap=COLOURS, rasterized=True)
        axes.set_yticks([-180, -90, 0, 90, 180], ["top", "left", "bottom", "right", "top"])
        axes.set_ylim(-180, 180)
        axes.set_title(bore.title)
        axes.grid(alpha=0.4, lw=0.5)
    panels[-1, 0].set_xlabel(TIME)
    figure.colorbar(mesh, ax=list(panels[:, 0]), label="largest contact force [N]", pad=0.015, aspect=14)
