"""The benchmark scripts still fit the code they measure."""

from __future__ import annotations

import sys

import pytest
from places import ROOT

BENCHMARKS = ROOT / "benchmarks"
NEEDS_MORE = {"exudyn_drop"}  # installed by hand


@pytest.fixture(autouse=True)
def beside_each_other(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "path", [str(BENCHMARKS), *sys.path])


@pytest.mark.parametrize(
    "name", sorted(p.stem for p in BENCHMARKS.glob("*.py") if p.stem not in NEEDS_MORE)
)
def test_a_benchmark_imports(name: str) -> None:
    assert __import__(name).__doc__


def test_the_tried_integrators_advance() -> None:
    """Each of them takes a cageless bearing 2 us further and sees evaluations."""
    import detailed_speed

    module = detailed_speed.MODULES["cageless"]
    plain = detailed_speed.carrier(module, detailed_speed.make(module)["leapfrog, friction as it stands"])
    runner = detailed_speed.Runner("", plain, 2e-7)
    assert runner.run(module, 2e-6)[2] > 10
