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


@pytest.mark.parametrize("model", ["detailed_caged", "detailed_cageless", "simplified_cageless"])
def test_a_seed_stands_for_one_bearing(model: str) -> None:
    """Drawn again it is the same, another seed gives another, and all of fifty can be built."""
    import random_bearings

    drawn = [random_bearings.random_case(model, seed) for seed in range(50)]
    assert drawn == [random_bearings.random_case(model, seed) for seed in range(50)]
    assert len({case.rotor.speed for case in drawn}) == 50
    for name, value in (("balls.play", 0.0), ("balls.damping_ratio", 1e-9)):
        below = [case.parameters[name] < value for case in drawn]
        assert any(below)
        assert not all(below)
    for case in drawn:
        landed = random_bearings.landed(case, 1e-6, 2e-6)
        assert landed.record["o"]["contact"]["force"] == 0.0


def test_the_errors_of_inner_steps_are_tabled() -> None:
    """One shipped bearing over 0.2 ms: shorter steps err less, and the rows say so."""
    import inner_steps
    from random_bearings import shipped_cases

    plan = inner_steps.Plan((4e-6, 5e-7), 2e-4, 1e-4)
    found = inner_steps.judge((shipped_cases("detailed_caged")[1], ()), plan)
    assert not found.failed
    assert not found.chaotic
    coarse, fine = (inner_steps.errors([found], "worst ball, %", i)[0] for i in range(2))
    assert 0.0 < fine < coarse
    head, steps, _, *rows = inner_steps.table("6004", [found], plan.steps)
    assert head.startswith("6004: 1 cases, 0 chaotic, 0 stopped, 1 judged")
    assert "4 us" in steps
    assert "4 over 0.5 us" in steps
    ball = rows[0].split()
    assert float(ball[3]) == pytest.approx(coarse, rel=0.06)
    again = inner_steps.judge((found.case, found.references), plan)
    assert again.stepped == found.stepped
