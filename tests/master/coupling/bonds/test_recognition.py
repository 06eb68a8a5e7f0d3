"""Which connections are a bond: told by their units, or declared."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import pytest

from touchdown.master.common.errors import TouchdownError
from touchdown.master.coupling.simulation import opened, simulate
from touchdown.master.results.run import run_scene
from touchdown.master.scene.scene import Scene
from touchdown.validation import bodies

FORCE, POSITION, VELOCITY = bodies.TWO
RUN = {"macro_step": 1e-3, "duration": 0.01}


def two(path: Path, wires: Sequence[object] = bodies.TWO, **tables: object) -> Scene:
    scene = bodies.scene(path, bodies.oscillator(), wires, **{"run": RUN, **tables})
    return scene.set({"*.isolate": False})


def found(scene: Scene) -> list[tuple[str, list[str]]]:
    """Titles of all bonds, each with what carries its motion."""
    with opened(scene) as system:
        return [(bond.title, [c.source_name for c in bond.motion]) for bond in system.bonds]


BOTH = [("s1.f on s2.f_in", ["s2.x", "s2.v"])]


def test_units_tell(body: Path) -> None:
    assert found(two(body)) == BOTH
    assert found(two(body, [VELOCITY, FORCE])) == [("s1.f on s2.f_in", ["s2.v"])]
    assert found(two(body, [FORCE])) == []
    assert found(two(body, [POSITION, VELOCITY])) == []


def test_two_forces_one_way_are_no_bond(body: Path) -> None:
    """Which of them belongs to the motion nobody knows: another one goes to a component beside."""
    parts = {**bodies.oscillator(), "s3": {}}
    wires = [*bodies.TWO, ["s1.f", "s3.f_in"]]
    assert found(bodies.scene(body, parts, wires, run=RUN).set({"*.isolate": False})) == BOTH


def test_without_units_the_run_says_that_it_holds_values(unitless: Path, tmp_path: Path) -> None:
    assert found(two(unitless)) == []
    result = run_scene(two(unitless), tmp_path)
    assert "scheme interface has nothing to act on: no bearing's port and no bond" in result.warnings[0]
    assert "3 connections are held over each macro step, in the order s1, s2" in result.warnings[0]
    held = "s1.f to s2.f_in, s2.x to s1.x2 and s2.v to s1.v2 held; stepped in the order s1, s2"
    assert result.summary["exchange"] == held


@pytest.mark.parametrize(
    ("bond", "wires"),
    [
        (list(bodies.TWO), bodies.TWO),
        ([list(bodies.TWO)], ()),
        ([{"force": FORCE, "position": POSITION, "velocity": VELOCITY}], ()),
    ],
)
def test_a_scene_declares_one(unitless: Path, bond: object, wires: Sequence[object]) -> None:
    """Its wires may stand among the others, too."""
    assert found(two(unitless, wires, bond=bond)) == BOTH


def test_a_lonely_motion_is_told_by_its_unit_or_by_name(body: Path, unitless: Path) -> None:
    only = [("s1.f on s2.f_in", ["s2.v"])]
    assert found(two(body, (), bond=[FORCE, VELOCITY])) == only
    assert found(two(unitless, (), bond=[{"force": FORCE, "velocity": VELOCITY}])) == only
    with pytest.raises(
        TouchdownError, match=r"its unit does not say whether s2\.v is position or velocity"
    ):
        found(two(unitless, (), bond=[FORCE, VELOCITY]))


@pytest.mark.parametrize(
    ("bond", "expected"),
    [
        ("s1.f", "bond = 's1.f' must be a list of bonds"),
        ([FORCE], "must be a force and one or two wires of motion"),
        ([{"force": FORCE, "place": POSITION}], "place is not a known key"),
        ([FORCE, ["s1.x", "s2.x2"]], r"s1\.x to s2\.x2 does not lead from s2 back to s1"),
        ([FORCE, [*POSITION, 2.0, 0.0]], "scaled so that the power that s1 gives is not what s2 takes"),
        ([["s1.f", "s1.f_in"], ["s1.x", "s1.x2"]], "leads back to s1; it needs two components"),
        ([[FORCE, POSITION], [FORCE, VELOCITY]], r"s2\.f_in is of another bond already"),
        ([FORCE, POSITION, POSITION], r"bond s1\.f: s2\.x stands in it twice; leave one out"),
        ([{"force": FORCE, "position": VELOCITY}],
         r"s2\.v is given as position, and its units say velocity"),
        ([["s1.x", "s2.x2"], POSITION], r"s1\.x is given as force, and its units say position"),
        ([["s1.f", "s2.f_ni"], POSITION], "has no variable f_ni; did you mean f_in"),
    ],
)  # fmt: skip
def test_what_can_be_none_is_refused(body: Path, bond: object, expected: str) -> None:
    with pytest.raises(TouchdownError, match=expected):
        found(two(body, (), bond=bond))


def test_a_gear_keeps_power(body: Path) -> None:
    """Force times two, motion times two: both sides still speak of the same power."""
    wires = [[*FORCE, 2.0, 0.0], [*POSITION, 2.0, 0.0], [*VELOCITY, 2.0, 0.0]]
    assert found(two(body, wires)) == BOTH
    assert found(two(body, [[*FORCE, 3.0, 0.0], *wires[1:]])) == []


def test_a_unit_of_factor_zero_tells_nothing(library: Path) -> None:
    path = bodies.fmu(library, "zero", bodies.Kind(newton=0.0))
    assert found(two(path)) == []
    assert found(two(path, (), bond=list(bodies.TWO))) == BOTH


def test_work_is_in_joules_whatever_the_units(library: Path) -> None:
    """The same numbers in kN and mm are the same energy as in N and m; in N and mm a thousandth of it."""

    def turned(name: str, **kind: float) -> float:
        scene = two(bodies.fmu(library, name, bodies.Kind(**kind)))  # type: ignore[arg-type]
        with opened(scene) as system:
            return simulate(scene, system).turnover

    plain = turned("si")
    assert turned("large", newton=1e3, metre=1e-3) == pytest.approx(plain, rel=1e-12)
    assert turned("small", metre=1e-3) == pytest.approx(1e-3 * plain, rel=1e-12)
