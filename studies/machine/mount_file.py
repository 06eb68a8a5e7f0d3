"""The file of a mount that was fitted to its loop, and the picture of both."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import FigureBase

from ...master.common.errors import TouchdownError
from ...master.common.text import UM, percent
from ...reports.figures.style import BLUE, GREY, ORANGE, save, sheet, sized, styled
from .foundation_file import write_new
from .hysteresis import MOST_SLIDES, Fit, Loop, fit, read_loop


@dataclass(frozen=True)
class ImportedMount:
    """A mount that was fitted to its measured loop."""

    fit: Fit
    loop: Loop
    name: str  # of the loop's file

    @classmethod
    def read(cls, path: Path, most: int = MOST_SLIDES) -> ImportedMount:
        """The loop at `path`, fitted with at most so many slides. Raises TouchdownError."""
        if not 1 <= most <= MOST_SLIDES:
            raise TouchdownError(f"--slides {most} must be at least 1 and at most {MOST_SLIDES}")
        loop = read_loop(path)
        return cls(fit(loop, most), loop, path.name)

    def lines(self) -> list[str]:
        """The fit, and notes on its use, for people."""
        fit = self.fit
        found = [f"spring {1e-6 * fit.spring:.4g} MN/m"]
        found += [
            f"slide {i}: {1e-6 * k:.4g} MN/m up to {force:.4g} N, from {UM * force / k:.3g} um on"
            for i, (k, force) in enumerate(fit.slides, 1)
        ]
        found += [
            f"heat of a cycle of {UM * fit.amplitude:.4g} um: {fit.measured:.4g} J measured, "
            f"{fit.loss:.4g} J fitted",
            f"misfit {percent(fit.misfit / fit.force, 2)} of the force, root of the mean square",
            "note: mass, damping and stop are not in a loop: set them beside it",
        ]
        if fit.spring <= 0.0:
            creep = "the carrier would creep under its weight; add one"
            found.append(f"note: no spring is left where all slides: {creep}")
        return found if fit.slides else [*found, "note: the loop holds no friction"]

    def save(self, path: str | os.PathLike[str], force: bool = True) -> Path:
        """Write the mount's file (.toml), and a picture of loop and fit beside it; returns the path.

        force=False: not over a file that holds something else. Raises TouchdownError.
        """
        path = Path(path)
        return write_new(
            path,
            "\n".join(_lines(self.fit, self.name)) + "\n",
            force,
            lambda: _draw(self.fit, self.loop, self.name, path.with_suffix(".png")),
        )


def _lines(fit: Fit, name: str) -> Iterator[str]:
    yield f"# Fitted to {name} by `touchdown import mount`: its heat of a cycle is {fit.measured:.4g} J,"
    yield f"# that of the fit {fit.loss:.4g} J; misfit {percent(fit.misfit / fit.force, 2)} of the force,"
    yield f"# from a stroke of {UM * fit.amplitude:.4g} um. Beyond that stroke nothing was measured."
    yield f"title = {json.dumps(f'Mount of {name}', ensure_ascii=False)}"
    yield ""
    yield '[set."housing_*"]'
    spring = f"{fit.spring:.6g}"
    yield f"spring = {{ xx = {spring}, yy = {spring} }}  # N/m, what is left when all slides"
    yield "damper = { xx = 0, yy = 0 }  # N s/m; one loop does not tell it from friction"
    for i, (stiffness, force) in enumerate(fit.slides, 1):
        yield f'"slide[{i}].stiffness" = {stiffness:.6g}  # N/m'
        yield f'"slide[{i}].force" = {force:.6g}  # N: it slides from {UM * force / stiffness:.3g} um on'


def _draw(fit: Fit, loop: Loop, name: str, path: Path) -> None:
    """The loop as measured and as fitted, as a PNG at `path`."""
    with styled():
        figure = sheet()
        _compared(figure, fit, loop, name)
        save(figure, path, dpi=110)


def _compared(figure: FigureBase, fit: Fit, loop: Loop, name: str) -> Axes:
    """Force [N] over displacement [um]."""
    axes = sized(figure, 7.0, 5.0).subplots()
    axes.plot(UM * loop.way, loop.force, color=GREY, lw=0.8, label=f"measured, {name}")
    way = np.linspace(0.0, 2.0 * fit.amplitude, 400)
    half, middle = fit.doubled(way), 0.5 * (np.max(loop.way) + np.min(loop.way))
    level = 0.5 * (np.max(loop.force) + np.min(loop.force))
    reach, top = fit.amplitude, 0.5 * float(half[-1])
    axes.plot(UM * (middle - reach + way), level - top + half, color=BLUE, label="fitted, loading")
    axes.plot(UM * (middle + reach - way), level + top - half, color=ORANGE, label="fitted, unloading")
    axes.set_xlabel("displacement [µm]")
    axes.set_ylabel("force [N]")
    axes.legend()
    return axes
