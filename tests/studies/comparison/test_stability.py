"""Hard cases of the coupling schemes: the search, how runs are judged, the tables, the command."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from dataclasses import replace
from types import SimpleNamespace
from typing import cast

import pytest

from touchdown.master.common.errors import Ended
from touchdown.master.coupling.observer import RunState
from touchdown.master.coupling.simulation import open_system
from touchdown.master.coupling.system import System
from touchdown.studies.comparison.engine import Alarm, Row
from touchdown.studies.comparison.stability import (
    GROWTH_LIMIT,
    VISIBLE_ERROR,
    Bounds,
    Limits,
    Study,
    attempted,
    reference,
    report_lines,
    right,
    search,
)
from touchdown.studies.comparison.stability_cases import FIRST_STEP, STEPS, Expected, bounce, cases, chosen


def attempt(step: float, error: float, warned: bool = True, failed: str = "") -> Row:
    return Row(
        "hold",
        step,
        {"worst": error, "energy": error},
        ledger=Alarm.WARNS if warned else Alarm.NONE,
        failed=failed,
        values={"rebound speed": 1.0 + error, "peak force": 1.0},
    )


def judged(right_up_to: float, stable_up_to: float, warned: bool = True) -> Callable[[float], Row]:
    """What runs would say of a scheme with these limits (s)."""
    return lambda step: attempt(
        step, 0.01 if step <= right_up_to else 0.5, warned, "" if step <= stable_up_to else "lost"
    )


def limits(found: tuple[Row, ...]) -> tuple[float | None, float | None, float | None]:
    """Longest right, longest stable and shortest wrong macro step (s)."""
    of = Limits("case", "scheme", found)
    return tuple(a and a.step for a in (of.right, of.stable, of.wrong))  # type: ignore[return-value]


@pytest.mark.parametrize(
    ("right_up_to", "stable_up_to", "expected", "tried"),
    [
        (1.0, 1.0, (1e-3, 1e-3, None), (2e-5, 1e-3)),  # bears all
        (5e-5, 2e-4, (5e-5, 2e-4, 1e-4), (2e-5, 5e-4)),
        (2e-6, 1e-4, (2e-6, 1e-4, 5e-6), (2e-6, 2e-4)),
        (2e-6, 5e-6, (2e-6, 5e-6, 5e-6), (2e-6, 2e-5)),  # the first one tried is lost
        (0.0, 5e-5, (None, 5e-5, 1e-6), (1e-6, 1e-4)),
        (0.0, 0.0, (None, None, 1e-6), (1e-6, 2e-5)),  # bears none
    ],
)
def test_the_search_finds_both_limits(
    right_up_to: float, stable_up_to: float, expected: tuple[float | None, ...], tried: tuple[float, float]
) -> None:
    found = search(judged(right_up_to, stable_up_to), STEPS, FIRST_STEP)
    assert limits(found) == expected
    steps = [attempt.step for attempt in found]
    assert (steps[0], steps[-1]) == tried
    assert steps == [step for step in STEPS if tried[0] <= step <= tried[1]]  # each once, none left out


@pytest.mark.parametrize(
    ("warned", "limit", "silent"), [(True, 1e-5, False), (False, 1e-5, True), (False, 1.0, False)]
)
def test_the_ledger_is_asked_at_the_first_step_that_is_wrong(
    warned: bool, limit: float, silent: bool
) -> None:
    found = search(judged(limit, 1.0, warned), STEPS, FIRST_STEP)
    assert Limits("case", "scheme", found).silent is silent


def test_what_is_right_and_which_limit_counts() -> None:
    """A limit is what all smaller steps bear; a step that is right by luck beyond a wrong one is not."""
    assert right(attempt(1e-5, VISIBLE_ERROR))
    assert not right(attempt(1e-5, 1.001 * VISIBLE_ERROR))
    assert not right(attempt(1e-5, math.nan))
    assert not right(attempt(1e-5, VISIBLE_ERROR, failed="lost"))
    attempts = [judged(1.0, 1.0)(step) for step in STEPS[:5]]
    attempts[2] = judged(0.0, 0.0)(STEPS[2])
    assert limits(tuple(attempts)) == (STEPS[1], STEPS[1], STEPS[2])


@pytest.mark.parametrize(
    ("y", "vy", "breaks"),
    [(0.9, -0.9, False), (-1.1, 0.0, True), (0.0, 1.1, True), (math.nan, 0.0, True), (0.0, math.nan, True)],
)
def test_a_run_is_broken_off_beyond_its_bounds(y: float, vy: float, breaks: bool) -> None:
    names = ("x", "y", "vx", "vy")
    values = dict(zip((f"rotor.A.{name}" for name in names), (0.5, y, 0.5, vy), strict=True))
    now = RunState(cast(System, SimpleNamespace(signal=values.__getitem__)), zero=0.0, steps=1, time=0.1)
    bounds = Bounds(["rotor.A"], speed=1.0, distance=1.0)
    bounds.stepped(now)
    if breaks:
        assert now.ended is Ended.AS_WANTED
        assert re.fullmatch(r"rotor\.A is .* m off and .* m/s fast at t = 0\.1 s", now.reason)
    else:
        assert now.ended is None
        assert (bounds.farthest, bounds.fastest) == (0.9, 0.9)


def attempts_at_bounce(scheme: str, step: float = FIRST_STEP) -> Row:
    case = bounce()
    assert case.theory is not None
    return attempted(case, scheme, step, case.theory)


def test_the_default_bounces_as_theory_has_it() -> None:
    found = attempts_at_bounce("interface")
    assert right(found)
    assert list(found.values.values()) == pytest.approx((0.1, 0.1 * math.sqrt(10.0 * 1e8)), rel=1e-3)
    assert found.ledger is Alarm.NONE


@pytest.mark.parametrize(("scheme", "rebound"), [("hold", 1.05), ("jacobi-hold", 1.16)])
def test_motion_that_is_held_makes_energy_and_the_ledger_calls_it(scheme: str, rebound: float) -> None:
    found = attempts_at_bounce(scheme)
    assert found.values["rebound speed"] / 0.1 == pytest.approx(rebound, abs=0.005)
    assert not found.failed
    assert not right(found)
    assert found.ledger is Alarm.WARNS
    assert found.errors["energy"] > 0.5 * (rebound**2 - 1.0) * 0.5  # of the energy scale, m v^2


def test_growth_is_not_stable() -> None:
    found = attempts_at_bounce("jacobi-hold", 5e-4)
    assert "rotor.A" in found.failed
    assert found.errors["worst"] == math.inf
    assert not found.values


def test_a_reference_says_what_its_journal_does() -> None:
    """The case's own theory, found by a run."""
    case = bounce()
    theory, found = case.theory, reference(replace(case, theory=None))
    assert theory is not None
    assert found.values == pytest.approx(theory.values, rel=1e-5)
    assert (found.speed, found.distance) == pytest.approx((theory.speed, theory.distance), rel=1e-3)
    assert found.rate == pytest.approx(math.sqrt(1e8 / 10.0))  # rad/s, of spring and mass


@pytest.mark.parametrize("name", cases())
def test_a_case_can_be_run_and_read(name: str) -> None:
    """It is chosen by name, every macro step divides its run, and what it judges by is there."""
    assert [case.name for case in chosen([name])] == [name]
    assert (name in [case.name for case in chosen([])]) == (name != "drift")
    case = cases()[name]
    for step in case.steps:
        assert case.scene.run.duration / step == pytest.approx(round(case.scene.run.duration / step))
    assert case.first in case.steps
    assert case.theory is None or len(case.theory.values) == len(case.figures)
    assert case.scene.zero is None
    system = open_system(case.scene, in_process=True)
    wanted = [name for figure in case.figures for name in figure.variables]
    wanted += [f"{journal}.{v}" for journal in case.journals for v in ("x", "y", "vx", "vy")]
    wanted += case.scene.energy_scale
    for variable in wanted:
        system.value(variable)
    assert all(f"{journal}.vy" in system.position for journal in case.journals)
    system.close()


def test_tables_show_limits_and_where_the_ledger_was_silent() -> None:
    case = bounce()
    found = {
        (case.name, name): Limits(case.name, name, search(judge, STEPS, FIRST_STEP))
        for name, judge in {"hold": judged(1e-5, 5e-5, False), "interface": judged(1.0, 1.0)}.items()
    }
    expected = {case.name: Expected((1.0,), 1.0, 1.0, rate=1e4)}
    study = Study(
        [replace(case, theory=None)], ("hold", "interface", "velocity"), expected, found, {"it": "why"}
    )
    text = report_lines(study)
    rows = [line.split() for line in text if line.startswith(case.name)]
    assert rows[0] == ["bounce", "10/50!", "1000/1000", "?"]
    assert rows[1] == ["bounce", "50", "1", "?"]  # %
    assert rows[2] == ["bounce", "5e-01", "1e-02", "?"]
    assert rows[3] == ["bounce", "0.1", "10", "?"]  # rad
    assert text[-1] == "failed: it: why"


def test_bounds_are_a_factor_of_what_is_right() -> None:
    """A journal as fast as GROWTH allows is stable; a little more is not."""
    case = bounce()
    assert case.theory is not None
    speed = attempts_at_bounce("jacobi-hold").values["rebound speed"]
    for factor, stable in ((0.99, False), (1.01, True)):
        given = replace(case.theory, speed=max(0.1, factor * speed) / GROWTH_LIMIT)
        assert (not attempted(case, "jacobi-hold", FIRST_STEP, given).failed) is stable
