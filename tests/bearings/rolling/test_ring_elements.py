"""The 2-D finite elements that ball loads are held against, themselves against closed forms and others."""

from __future__ import annotations

import math
import sys

import pytest
from places import ROOT

from touchdown.bearings import catalogue


@pytest.fixture(autouse=True)
def importable(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "path", [str(ROOT / "benchmarks"), *sys.path])


def test_a_thin_ring_under_two_opposite_loads() -> None:
    """An inextensible line's figures; h/R of 2 % adds some 4e-4 of extension and shear."""
    import ring_elements

    under, across = ring_elements.two_loads()
    assert under == pytest.approx(math.pi / 4.0 - 2.0 / math.pi, rel=1.5e-3)
    assert across == pytest.approx(2.0 / math.pi - 0.5, rel=1.5e-3)


@pytest.mark.parametrize(
    ("name", "on_a_ball", "between"), [("6904", 133.03, 118.80), ("6004", 222.96, 181.65)]
)
def test_ball_loads_of_another_mesh(name: str, on_a_ball: float, between: float) -> None:
    """350 N: two-dimensional quadrilaterals of another program; found within 0.1 %."""
    import ring_elements

    bearing = catalogue.bearing(name)
    ring = ring_elements.ring_of(bearing)
    for offset, theirs in ((0.0, on_a_ball), (0.5, between)):
        loads = ring_elements.by_elements(bearing, ring, 350.0, offset)
        assert loads.max() == pytest.approx(theirs, rel=3e-3)
