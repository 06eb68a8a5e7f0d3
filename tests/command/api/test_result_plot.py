"""The pictures that a result draws, `result.plot`."""

from __future__ import annotations

import pickle
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.figure import Figure

import touchdown
from touchdown import Result
from touchdown.reports.figures.plot import Plot
from touchdown.reports.figures.style import sheet


def short(name: str, duration: float = 0.01) -> Result:
    """A short run in a temporary folder."""
    return touchdown.run(touchdown.load(name).set({"run.duration": duration}), in_process=True)


@pytest.fixture(scope="module")
def detailed() -> Result:
    """Of a bearing that tells of each ball."""
    return short("disk-caged-detailed", 0.012)


@pytest.fixture(scope="module")
def flexible() -> Result:
    """Of a rotor on two bearings, with stresses."""
    return short("rotor2-case1")


@pytest.mark.parametrize("name", ["orbit", "contacts"])
def test_a_picture_of_one_panel_goes_onto_given_axes(name: str, detailed: Result) -> None:
    figure = Figure()
    axes = figure.subplots(1, 2)[1]
    assert getattr(detailed.plot, name)(ax=axes) is axes
    assert axes.get_xlabel().startswith("x ")
    assert axes.lines


@pytest.mark.parametrize("name", ["paths", "forces", "speeds", "energy"])
def test_a_picture_of_several_panels_goes_onto_a_given_figure(name: str, detailed: Result) -> None:
    figure = Figure()
    part = figure.subfigures(1, 2)[1]
    drawn = getattr(detailed.plot, name)(figure=part)
    assert drawn
    assert all(isinstance(axes, Axes) and axes in figure.axes and axes.has_data() for axes in drawn)


@pytest.mark.parametrize("name", ["orbits", "stress"])
def test_pictures_of_a_flexible_rotor(name: str, flexible: Result) -> None:
    drawn = getattr(flexible.plot, name)(figure=Figure())
    assert len(drawn) in (2, 4)
    assert all(axes.has_data() for axes in drawn)
    both = Figure().subplots(1, 2)
    for axes, bearing in zip(both, ("bearing_A", "bearing_B"), strict=True):
        flexible.plot.orbit(ax=axes, bearing=bearing)
    first, second = (axes.lines[-1].get_xydata() for axes in both)
    assert not np.array_equal(first, second)


@pytest.mark.parametrize(
    ("call", "says"),
    [
        (lambda plot: plot.orbit(bearing="bearing_C"), "no touchdown bearing bearing_C; did you mean"),
        (lambda plot: plot.contacts(), "does not report single balls"),
        (lambda plot: plot.spectrum(), "needs a run.duration"),
        (lambda plot: plot.waterfall(), "needs a run.duration"),
        (lambda plot: plot.stress(rotor="rotr"), "did you mean rotor"),
    ],
)
def test_a_picture_that_cannot_be_says_so(
    call: Callable[[Plot], object], says: str, flexible: Result
) -> None:
    with pytest.raises(touchdown.TouchdownError, match=says) as caught:
        call(flexible.plot)
    assert "\n" not in str(caught.value)


def test_without_a_figure_pyplot_makes_one(detailed: Result) -> None:
    pyplot = pytest.importorskip("matplotlib.pyplot")
    pyplot.switch_backend("agg")
    axes = detailed.plot.orbit()
    assert pyplot.gcf() is axes.figure
    pyplot.close("all")


def test_a_result_needs_no_fmu_any_more(tmp_path: Path) -> None:
    scene = touchdown.load("disk-caged-simplified").set({"run.duration": 2e-3})
    touchdown.run(scene, tmp_path, in_process=True, pictures=True)
    here = pickle.loads(pickle.dumps(touchdown.open_result(tmp_path)))
    figure = sheet()
    here.plot.paths(figure)
    figure.savefig(tmp_path / "again.png", dpi=110)
    assert (tmp_path / "again.png").read_bytes() == (tmp_path / "orbit.png").read_bytes()
