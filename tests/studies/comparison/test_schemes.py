"""Speed against error: `touchdown compare` on the disk."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import pytest

from touchdown.master.common.errors import Ended, TouchdownError
from touchdown.master.common.progress import Progress
from touchdown.master.coupling.simulation import Outcome, simulate
from touchdown.master.coupling.system import System
from touchdown.master.scene.file import load_scene
from touchdown.master.scene.scene import Scene
from touchdown.studies.comparison import models, modes, schemes
from touchdown.studies.comparison.engine import Alarm, Comparison, Options, Order, Row
from touchdown.studies.comparison.schemes import compare, fitted_order
from touchdown.studies.drop.impact_watch import shortened
from touchdown.studies.drop.reference import FIRST_SOLVER, POSITION, SECOND_SOLVER_OF_MANY

SCENE = "disk-caged-simplified"
STEPS = (1e-5, 2e-5, 4e-5, 8e-5)


@pytest.fixture(scope="module")
def disk() -> Comparison:
    asked = Options(("hold", "acceleration", "interface"), STEPS, repeat=1, in_process=True)
    # holding the motion makes 1.4 % of the turnover at 10 us, 17 % at 80 us
    limits = {"run.warn_residual": 0.005, "run.stop_residual": 0.06}
    pieces: list[int] = []
    progress = Progress(pieces.append, lambda: pieces.append(-1))
    found = compare(shortened(load_scene(SCENE)).set(limits), asked, progress)
    assert sum(pieces) == 0  # all that is planned is done
    return found


@pytest.fixture
def quick_reference(monkeypatch: pytest.MonkeyPatch) -> None:
    """A second solver that agrees in a tenth of the implicit one's time, for what does not look at it."""
    monkeypatch.setattr(schemes, "pair", lambda scene: (FIRST_SOLVER, SECOND_SOLVER_OF_MANY))


def row(found: Comparison, scheme: str, step: float) -> Row:
    return next(r for r in found.rows if (r.name, r.step) == (scheme, step))


def order(found: Comparison, scheme: str, quantity: str) -> Order:
    fitted = found.orders[scheme][quantity]
    assert fitted is not None
    return fitted


@pytest.mark.slow
def test_the_reference_is_far_better_than_what_is_measured_with_it(disk: Comparison) -> None:
    start, end = disk.reference.landing.impacts["A"]
    assert 7.8e-3 < start < 8.0e-3 < end < disk.reference.landing.end
    assert disk.reference.landing.peaks("A")["force"] == pytest.approx(345.6, abs=0.5)
    assert disk.reference.exact.whole
    assert disk.reference.exact.floor(POSITION) < 4e-11  # found 1.2e-11: it goes with the solver's steps
    assert disk.reference.fine["position"] < 1e-11  # co-simulation and monolithic solvers: one motion
    assert disk.reference.fine["force"] < 1e-6
    assert disk.reference.fine["ball"] < 1e-6


def test_schemes_have_their_orders_and_ledgers(disk: Comparison) -> None:
    """The default errs by nothing that the reference could see."""
    for quantity in ("position", "velocity"):
        assert order(disk, "hold", quantity).value == pytest.approx(1.0, abs=0.15)
    assert order(disk, "acceleration", "position").value == pytest.approx(2.4, abs=0.3)
    assert order(disk, "acceleration", "energy").value == pytest.approx(3.0, abs=0.3)
    assert max(row(disk, "interface", step).errors["position"] for step in STEPS) < 1e-10
    assert disk.orders["interface"]["position"] is None
    assert row(disk, "hold", 2e-5).errors["position"] == pytest.approx(1.1e-6, rel=0.1)
    ledgers = [row(disk, *one).ledger for one in (("hold", 1e-5), ("hold", 8e-5), ("interface", 8e-5))]
    assert ledgers == ["warns", "stops", ""]


def test_the_worst_ball_is_measured_where_there_is_one(disk: Comparison) -> None:
    """It errs as the contact does; the simplified bearing has no contacts at the sides of its balls."""
    assert list(disk.quantities) == ["position", "velocity", "force", "ball", "energy"]
    held = [row(disk, "hold", step).errors["ball"] for step in STEPS]
    assert held[0] < held[1] < held[2]
    assert row(disk, "interface", 2e-5).errors["ball"] < 1e-3
    about = disk.lines[1]
    assert f"most loaded ball {disk.reference.landing.peaks('A')['ball']:.5g} N" in about
    assert "cage" not in about


@pytest.mark.usefixtures("quick_reference")
def test_an_impact_cut_short_is_compared_up_to_there() -> None:
    """While the force still rises, each run is held against the reference at its own last instant."""
    asked = Options(("interface",), (1e-5, 8e-5), duration=2e-4, repeat=1, in_process=True)
    found = compare(shortened(load_scene(SCENE)), asked)
    _, end = found.reference.landing.impacts["A"]
    assert end == pytest.approx(found.reference.landing.end)
    assert found.reference.landing.peaks("A")["force"] < 300.0  # of 346
    for step in asked.macro_steps:
        assert row(found, "interface", step).errors["force"] < 1e-3
        assert row(found, "interface", step).errors["ball"] < 1e-3


def test_the_cheapest_that_is_good_enough_is_recommended(disk: Comparison) -> None:
    """A ledger that holds goes first, and one that stops a run is not chosen."""

    def good(name: str, wall: float, error: float, ledger: Alarm = Alarm.NONE) -> Row:
        return Row(name, 1e-5, {"position": error}, wall, ledger)

    slow, fast, rough = good("slow", 3.0, 1e-9), good("fast", 1.0, 5e-8), good("rough", 0.1, 1e-6)
    close, warned = good("as fast", 1.1, 1e-8), good("warned", 1.0, 1e-9, Alarm.WARNS)
    stopped = good("stopped", 0.1, 1e-9, Alarm.STOPS)
    for rows, best in (
        ((slow, fast, rough), fast),
        ((slow, fast, close), close),
        ((slow, warned, stopped), slow),
        ((warned, stopped), warned),
        ((stopped,), None),
    ):
        assert replace(disk, rows=rows).recommended() is best
    said = replace(disk, rows=(slow, fast)).lines[-2]
    assert '--set run.scheme=fast --set "run.macro_step=10 us"' in said
    strict = replace(disk, targets={"position": 1e-20})
    assert strict.recommended() is None
    assert "none of these" in strict.lines[-1]


def test_the_table_has_a_line_for_each_row(disk: Comparison) -> None:
    text = disk.lines
    assert sum(line.startswith("interface ") for line in text) == len(STEPS) + 1  # and its orders
    assert any("Radau 1e-06" in line and "monolithic" in line for line in text)
    assert any(line.startswith("hold") and line.endswith("ledger stops") for line in text)


@pytest.mark.usefixtures("quick_reference")
def test_a_scheme_that_fails_says_so_in_its_row(monkeypatch: pytest.MonkeyPatch) -> None:
    """The second of two schemes cannot go on; the first has its numbers, and the command goes on."""
    scene = shortened(load_scene(SCENE))

    def simulated(run: Scene, system: System, **options: Any) -> Outcome:
        if run.run.scheme.name == "hold":
            return Outcome(ended=Ended.STOPPED, reason="it broke")
        return simulate(run, system, **options)

    monkeypatch.setattr(schemes, "simulate", simulated)
    asked = Options(("interface", "hold"), (2e-5, 1e-4), repeat=1, in_process=True)
    found = compare(scene, asked)
    good, broken = row(found, "interface", 1e-4), row(found, "hold", 1e-4)
    assert not good.failed
    assert good.errors
    assert (broken.failed, broken.errors, broken.wall) == ("it broke", {}, None)
    assert found.orders["hold"] == dict.fromkeys(("position", "velocity", "force", "ball", "energy"))
    assert any(line.endswith("100 us  it broke") for line in found.lines)


@pytest.mark.parametrize(("kind", "scene"), [(schemes, SCENE), (models, SCENE), (modes, "rotor1-9000")])
def test_a_drop_that_never_lands(kind: Any, scene: str) -> None:
    scene = load_scene(scene).set({"run.duration": 1e-3})
    with pytest.raises(TouchdownError, match=r"nothing touches down within run\.duration = 0\.001 s"):
        kind.compare(scene, Options(modes=[2], macro_steps=[1e-5]))


ORDER_STEPS = (1e-6, 2e-6, 5e-6, 1e-5, 2e-5, 5e-5)


def of_order(order: float, scale: float = 1e-6) -> list[float]:
    """`scale` at 10 us."""
    return [scale * (step / 1e-5) ** order for step in ORDER_STEPS]


@pytest.mark.parametrize(
    ("errors", "floor", "most", "steps", "value"),
    [
        (of_order(1.0), 0.0, math.inf, ORDER_STEPS, 1.0),
        (of_order(3.0), 0.0, math.inf, ORDER_STEPS, 3.0),
        # near the floor: 2.6e-7 at 5 us is the first beyond ten times it
        ([error + 1e-8 for error in of_order(2.0)], 1e-8, math.inf, ORDER_STEPS[2:], 2.0),
        ([min(error, 2e-6) for error in of_order(2.0)], 0.0, 2e-6, ORDER_STEPS[:4], 2.0),  # saturated
        # a plateau of another cause: the steps inside a bearing err by 1e-7
        ([max(error, 1e-7) for error in of_order(3.0)], 0.0, math.inf, ORDER_STEPS[2:], 3.0),
        ([math.nan, *of_order(1.0)[1:5], math.inf], 0.0, math.inf, ORDER_STEPS[1:5], 1.0),  # failed runs
        ([1e-6] * 6, 0.0, math.inf, None, 0.0),
        ([0.0] * 6, 0.0, math.inf, None, 0.0),
        ([1e-6, 4e-6, 0.0, 0.0, 0.0, 0.0], 0.0, math.inf, None, 0.0),  # too few tell nothing
    ],
)
def test_an_order_is_fitted_to_what_tells_of_it(
    errors: list[float], floor: float, most: float, steps: tuple[float, ...] | None, value: float
) -> None:
    found = fitted_order(ORDER_STEPS, errors, floor, most)
    assert (found and found.steps) == steps
    if found:
        assert found.value == pytest.approx(value, abs=0.05 if floor else 1e-8)
        assert found == fitted_order(ORDER_STEPS[::-1], errors[::-1], floor, most)
