"""The whirl predicted for a scene, and over two settings: where a designer should be."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure, FigureBase
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from ...master.common.errors import TouchdownError
from ...master.common.files import make_writable, write_records, writing_to
from ...master.common.progress import Progress
from ...master.scene.scene import Scene
from ...reports.figures.style import BLACK, BLUE, save, sized
from ..sweep.design import Design, number_and_unit
from .whirl_prediction import (
    ASSUMPTIONS,
    FORWARD,
    SURE,
    PredictedWhirl,
    Sensitivity,
    lines,
    machine,
    over,
    sensitivities,
)

if TYPE_CHECKING:
    import pandas

TABLE, PICTURE = "whirl.csv", "whirl.png"
SHOWN_FORCES = (10.0, 1e5)  # N, at most what the scale spans
LOGARITHMIC = 10.0  # from least to most, from which on an axis is
FREQUENCIES = 6  # lines of equal frequency


@dataclass(frozen=True)
class _Axis:
    """A setting of the map."""

    label: str
    values: np.ndarray


def _axis(name: str, values: Sequence[object]) -> _Axis:
    """The axis of a setting that takes these values, of one unit. Raises TouchdownError for words."""
    parts = [number_and_unit(value) for value in dict.fromkeys(values)]
    units = {unit for number, unit in filter(None, parts)}
    if None in parts or len(units) != 1:
        raise TouchdownError(f"a map over {name} takes numbers with one unit")
    (unit,) = units
    return _Axis(
        f"{name} [{unit}]" if unit else name, np.array([number for number, _ in filter(None, parts)])
    )


def _write_map(x: _Axis, y: _Axis, found: Sequence[PredictedWhirl], path: Path, title: str) -> None:
    """Draw it, the setting of `y` varying fastest in `found`, into a file."""
    figure = Figure(layout="constrained")
    _draw_map(figure, x, y, found, title)
    with writing_to(path):
        save(figure, path)


def _draw_map(figure: FigureBase, x: _Axis, y: _Axis, found: Sequence[PredictedWhirl], title: str) -> Axes:
    """Largest force [N] of the whirl, lines of its frequency [Hz], where it dents balls or does not last.

    Raises TouchdownError where there is no whirl at all.
    """
    shape = (len(x.values), len(y.values))
    values = [
        (one.settled.force.max() if one.settled else math.nan, one.frequency, one.margin, _dent(one))
        for one in found
    ]
    force, hertz, margin, dent = (np.array(v).reshape(shape).T for v in zip(*values, strict=True))
    if not np.any(np.isfinite(force)):
        raise TouchdownError("no whirl with any of these settings; there is no map to draw")
    axes = sized(figure, 7.2, 5.4).subplots()
    low = max(float(np.nanmin(force)), SHOWN_FORCES[0])
    high = max(min(float(np.nanmax(force)), SHOWN_FORCES[1]), 1.1 * low)
    shown = axes.pcolormesh(
        x.values, y.values, force, norm=LogNorm(low, high), cmap="YlOrRd", shading="nearest"
    )
    figure.colorbar(shown, ax=axes, label="largest force of a bearing in the whirl [N]", extend="both")
    _lines(axes, x, y, hertz, margin, dent)
    for axis, scale in ((x, axes.set_xscale), (y, axes.set_yscale)):
        if axis.values.min() > 0.0 and axis.values.max() / axis.values.min() >= LOGARITHMIC:
            scale("log")
    axes.set(xlabel=x.label, ylabel=y.label, title=title)
    return axes


def _lines(axes: Axes, x: _Axis, y: _Axis, hertz: np.ndarray, margin: np.ndarray, dent: np.ndarray) -> None:
    """Equal frequencies, where balls dent, and where the whirl may not last."""
    handles: list[Line2D | Patch] = []
    if np.nanmax(hertz) > np.nanmin(hertz):
        drawn = axes.contour(x.values, y.values, hertz, FREQUENCIES, colors=BLACK, linewidths=0.6)
        axes.clabel(drawn, fmt="%.0f Hz", fontsize="x-small")
    if np.nanmin(dent) < 1.0 < np.nanmax(dent):
        axes.contour(x.values, y.values, dent, [1.0], colors=BLUE, linewidths=2.2)
        handles.append(Line2D([], [], color=BLUE, lw=2.2, label="beyond: balls dent their races"))
    for limits, hatch, label in (
        ((-1.0, 1.0 / SURE), "..", "too slow to last against gravity"),
        ((1.0 / SURE, SURE), "//", "not sure whether it lasts"),
    ):
        if np.any((margin > limits[0]) & (margin <= limits[1])):
            axes.contourf(x.values, y.values, margin, limits, colors="none", hatches=[hatch])
            handles.append(Patch(facecolor="white", edgecolor=BLACK, hatch=hatch, label=label))
    if handles:
        axes.figure.legend(handles=handles, loc="outside lower center", ncols=3, fontsize="small")


def _dent(one: PredictedWhirl) -> float:
    """The most loaded ball over what dents a race."""
    loads = zip(one.balls, one.machine.journals, strict=False)
    return max((ball / journal.limits.ball for ball, journal in loads), default=math.nan)


FIGURES = (  # of each bearing in the table: name, factor from SI, values
    ("force_N", 1.0, lambda one: one.settled.force),
    ("ball_force_N", 1.0, lambda one: one.balls),
    ("stroke_um", 1e6, lambda one: one.settled.stroke),
)


@dataclass(frozen=True)
class WhirlPrediction:
    """The whirl of a scene both ways, and over a design."""

    scene: Scene
    backward: PredictedWhirl
    forward: PredictedWhirl
    sensitivities: Sequence[Sensitivity]  # of the backward whirl
    design: Design | None = None
    over: Sequence[PredictedWhirl] = ()  # backward, at each point of the design

    def lines(self) -> Iterator[str]:
        """The prediction, for people."""
        yield from lines(self.backward)
        yield from (f"  with {one.more}: {one}" for one in self.sensitivities)
        yield from (*lines(self.forward), *ASSUMPTIONS)

    def to_pandas(self) -> pandas.DataFrame:
        """Settings of the design and what is predicted with them, as `whirl.csv` has it."""
        import pandas

        if self.design is None:
            raise TouchdownError("nothing varies in this prediction; give it variations")
        table = pandas.DataFrame(self.design.points, columns=self.design.names)
        table["frequency_Hz"] = [one.frequency for one in self.over]
        table["margin"] = [one.margin for one in self.over]
        for k, journal in enumerate(self.backward.machine.journals):
            for what, scale, value_of in FIGURES:
                values = [scale * value_of(one)[k] if one.settled else math.nan for one in self.over]
                table[f"{what}_{journal.name}"] = values
        table["not_predicted"] = [one.refused or "; ".join(one.beyond) for one in self.over]
        return table

    @property
    def files(self) -> tuple[str, ...]:
        """The table, and the map where two settings vary and something whirls; none without a design."""
        drawn = (
            self.design is not None
            and len(self.design.names) == 2
            and any(one.settled for one in self.over)
        )
        return (TABLE, PICTURE) if drawn else (TABLE,) if self.design is not None else ()

    def write(self, folder: Path) -> None:
        """Its `files` into a folder, which is made. Raises TouchdownError."""
        if self.design is None:
            return
        make_writable(folder)
        write_records(self.to_pandas().to_dict("records"), folder / TABLE)
        if PICTURE in self.files:
            points = self.design.points
            x, y = (_axis(name, [point[k] for point in points]) for k, name in enumerate(self.design.names))
            _write_map(x, y, self.over, folder / PICTURE, f"Predicted backward whirl: {self.scene.name}")


def predict(scene: Scene, spin: float | None, design: Design | None, planned: Progress) -> WhirlPrediction:
    """The whirl of a scene at `spin` (rad/s; None: its own) and over a design. Raises TouchdownError."""
    known = machine(scene, spin)
    backward = known.predicted()
    found: list[PredictedWhirl] = []
    if design is not None:
        planned.planned(len(design))
        settings = [dict(zip(design.names, point, strict=True)) for point in design.points]
        found = over(known, scene, settings, lambda _: planned.done(), spin)
    slopes = sensitivities(backward, scene)
    return WhirlPrediction(scene, backward, known.predicted(FORWARD), slopes, design, found)
