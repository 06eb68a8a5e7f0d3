"""The benchmark scripts still fit the code they measure."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from hosting import COMPILER
from places import ROOT

from touchdown.master.scene.file import load_scene

pytestmark = pytest.mark.slow

if TYPE_CHECKING:
    from cosimulated import comparison

    Compared = Callable[..., dict[str, dict[str, comparison.Result]]]

BENCHMARKS = ROOT / "benchmarks"
NEEDS_MORE = {"exudyn_drop", "ross_rotors"}  # installed by hand


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


@pytest.mark.parametrize("number", [0, 1])
def test_the_right_hand_side_in_c_finds_what_the_kernels_find(number: int, tmp_path: Path) -> None:
    """Of a bearing that has landed, its balls damped; a mass that is 1e-9 off is noticed."""
    import right_hand_side

    if COMPILER is None:
        pytest.skip("there is no C compiler")
    case = right_hand_side.CASES[number]
    instance = right_hand_side.landed(case, right_hand_side.DAMPED)
    instance.record["u"]["journal"]["y"] -= 1e-5
    instance.step(0.0, 2e-4)
    assert right_hand_side.loaded(instance) in case.compared
    both = right_hand_side.Pair(
        right_hand_side.InC(right_hand_side.library(right_hand_side.FLAGS, tmp_path), instance),
        right_hand_side.Kernels(right_hand_side.repeater(case.module), instance),
    )
    for _ in range(2):
        for one in both:
            one.evaluate(3)
        assert both.difference() <= right_hand_side.LIMIT
    both.in_c.bearing["mass"] *= 1.0 + 1e-9
    both.in_c.evaluate(1)
    both.kernels.evaluate(1)
    assert both.difference() > right_hand_side.LIMIT


@pytest.mark.parametrize(
    "model",
    ["detailed_caged", "detailed_cageless", "simplified_cageless", "angular_caged", "angular_cageless"],
)
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


def test_no_ball_gains_what_nothing_gave_it() -> None:
    """Balls that rattle undamped for 20 ms bear what the landing brings, and make no energy."""
    import rattle
    from random_bearings import random_case

    from touchdown.bearings.rolling.micro_step import MICRO_STEP

    assert random_case("detailed_caged", 1).parameters["balls.damping_ratio"] == 0.0
    found = rattle.rattled("detailed_caged", "random", 0.02, MICRO_STEP, 1)
    assert not found.stopped
    assert 0.05 < found.force < 2.0
    assert 0.0 < found.made < 1e-3
    assert 0.0 < found.withheld < 0.05
    assert found.taken_back < 1e-9
    assert "detailed_caged" in rattle.row("detailed_caged", [found])


def test_the_errors_of_inner_steps_are_tabled() -> None:
    """One shipped bearing over 0.2 ms: shorter steps err less, and the rows say so."""
    import inner_steps
    from random_bearings import shipped_cases

    plan = inner_steps.Plan((4e-6, 5e-7), 2e-4, 1e-4)
    found = inner_steps.judge((shipped_cases("detailed_caged")[1], ()), plan)
    assert not found.failed
    assert not found.chaotic
    coarse, fine = (inner_steps.errors([found], "most loaded ball, %", i)[0] for i in range(2))
    assert 0.0 < fine < coarse
    head, steps, _, *rows = inner_steps.table("6004", [found], plan.steps)
    assert head.startswith("6004: 1 cases, 0 chaotic, 0 stopped, 1 judged")
    assert "4 us" in steps
    assert "4 over 0.5 us" in steps
    ball = rows[0].split()
    assert float(ball[4]) == pytest.approx(coarse, rel=0.06)
    again = inner_steps.judge((found.case, found.references), plan)
    assert again.stepped == found.stepped


@pytest.mark.parametrize("count", [1, 3, 8])
def test_a_shaft_falls_onto_any_number_of_bearings(count: int, tmp_path: Path) -> None:
    """What it costs has an exponent."""
    from speeds import growth
    from speeds.measured import spread

    costs = tuple(spread([k * k, k * k, 9.0 * k * k]) for k in (2, 4, 8))
    found = growth.Grown("balls", "s", (2.0, 4.0, 8.0), costs)
    assert found.power == pytest.approx(2.0)
    assert found.costs[0].text == "4 (4-36)"
    scene = growth.seats(tmp_path, count).set({"run.duration": 4e-4})
    assert [name for name, part in scene.components.items() if part.fmu == "housing"] == [
        f"housing_{k}" for k in {1: [0], 3: [0, 4, 7], 8: range(8)}[count]
    ]
    assert growth.per_second(scene) > 0.0


def test_scenes_are_measured_and_drawn(tmp_path: Path) -> None:
    """One scene over 1 ms: each way has its time, the macro step its error."""
    from speeds import growth, picture, scenes
    from speeds.measured import spread

    found = scenes.cost(load_scene("disk-caged-simplified"), 1e-3, 1, native=False)
    assert list(found.ways) == ["kernels alone", "in process", "FMUs in Python"]
    assert 0.0 < found.ways["kernels alone"].median < found.ways["FMUs in Python"].median
    assert 0.0 < found.error.peak < 5e-3
    head, row = list(scenes.block([found], native=False).lines())[2:]
    assert head.startswith("scene")
    assert row.startswith("disk-caged-simplified")
    grown = growth.Grown("balls", "s", (1.0, 2.0), (spread([1.0]), spread([2.0])))
    picture.draw([found], [grown], tmp_path / "speed.png")
    assert (tmp_path / "speed.png").stat().st_size > 10_000


@pytest.fixture
def masters_compared(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> Compared:
    """What `masters.py --quick` keeps, by problem and master; it prints all and leaves a picture."""
    import fmpy

    from touchdown.validation import bodies

    if bodies.COMPILER is None or fmpy.platform != bodies.PLATFORM:
        pytest.skip(f"needs a C compiler for {bodies.PLATFORM}")

    def compared(*arguments: str) -> dict[str, dict[str, comparison.Result]]:
        import masters
        from cosimulated import comparison

        assert masters.main(["--quick", "-o", str(tmp_path), *arguments]) == 0
        printed = capsys.readouterr().out
        files = {path.stem: comparison.known(path) for path in tmp_path.glob("*.json")}
        found = {problem: {one.master: one for one in results} for problem, results in files.items()}
        assert all(f"\n{name} " in printed for results in found.values() for name in results)
        assert (tmp_path / "masters.png").stat().st_size > 10_000
        return found

    return compared


def test_ways_of_this_master_are_compared(masters_compared: Compared) -> None:
    """What keeps mean and moment is ahead of what is held, and what repeats is ahead of both."""
    found = masters_compared("--problems", "car,drop", "--tools", "")
    car = found["car"]
    assert car["iterated"].error < 0.1 * car["smooth"].error < 0.1 * car["hold"].error
    assert car["hold"].calls == 3 * 250
    assert 0.0 < found["drop"]["interface"].error < 1e-5


@pytest.mark.peers
def test_masters_of_other_tools_are_compared(masters_compared: Compared) -> None:
    """Tools that step all FMUs at once err as held values do; step control errs less, bonds still less."""
    found = masters_compared("--problems", "car")["car"]
    had = {name: one for name, one in found.items() if not one.own and "install" not in one.unable}
    if not had:
        pytest.skip("no tool can be had")
    assert not any(one.unable for name, one in had.items() if not name.startswith("ecos"))  # wants libtbb12
    plain = found["jacobi-hold"].error
    for name, one in had.items():
        if name.endswith("step control"):
            assert found["smooth"].error < one.error < plain
        elif name.endswith("gauss-seidel"):
            assert one.error == pytest.approx(found["hold"].error, rel=1e-2)
        elif not name.endswith("iterative") and not one.unable:
            assert one.error == pytest.approx(plain, rel=1e-6)


def test_balls_in_space_are_timed(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Bearings in the plane and in space come to states with the same loaded balls; a table is printed."""
    import in_space

    monkeypatch.setattr(in_space, "TIMES", 20)
    assert in_space.main(["--turns", "1"]) == 0
    rows = [row.strip() for row in capsys.readouterr().out.splitlines()]
    assert [row.split("  ")[0] for row in rows] == [
        *("angular_cageless", "in the plane, 17 balls", "in space, 17 balls", "a pair, 34 balls"),
        *("angular_caged", "in the plane, 9 balls", "in space, 9 balls", "a pair, 18 balls"),
    ]
    assert all(float(row.split()[-1]) > 0.0 for row in rows if row.endswith(tuple("0123456789")))
