"""The file of a mount that was fitted to its loop, and the picture of both."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import FigureBase

from ...reports.figures.style import BLUE, GREY, ORANGE, save, sheet, sized, styled
from .hysteresis import Fit, Loop

UM = 1e6


def mount_text(fit: Fit, name: str) -> str:
    """TOML for `touchdown new --mount` and `touchdown choose --mount`; name: of the loop's file."""
    return "\n".join(_lines(fit, name)) + "\n"


def _lines(fit: Fit, name: str) -> Iterator[str]:
    yield f"# Fitted to {name} by `touchdown import-mount`: its heat of a cycle is {fit.measured:.4g} J,"
    yield f"# that of the fit {fit.loss:.4g} J; misfit {100.0 * fit.misfit / fit.force:.2g} % of the force,"
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


def fit_lines(fit: Fit) -> list[str]:
    """The fit in words, a line each."""
    lines = [f"spring {1e-6 * fit.spring:.4g} MN/m"]
    lines += [
        f"slide {i}: {1e-6 * k:.4g} MN/m up to {force:.4g} N, from {UM * force / k:.3g} um on"
        for i, (k, force) in enumerate(fit.slides, 1)
    ]
    return [
        *lines,
        f"heat of a cycle of {UM * fit.amplitude:.4g} um: {fit.measured:.4g} J measured, "
        f"{fit.loss:.4g} J fitted",
        f"misfit {100.0 * fit.misfit / fit.force:.2g} % of the force, root of the mean square",
    ]


def notes(fit: Fit) -> list[str]:
    """Notes on its use."""
    found = ["mass, damping and stop are not in a loop: set them beside it"]
    if fit.spring <= 0.0:
        found.append(
            "no spring is left where all slides: the carrier would creep under its weight; add one"
        )
    if not fit.slides:
        found.append("the loop holds no friction")
    return found


def draw(fit: Fit, loop: Loop, name: str, path: Path) -> None:
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
