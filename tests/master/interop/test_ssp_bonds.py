"""What a scene says of bonds goes with its package: those that it declares, and how they cross."""

from __future__ import annotations

from dataclasses import fields
from pathlib import Path

import pytest
from archives import saying

import touchdown
from touchdown.master.common.errors import TouchdownError
from touchdown.master.coupling.simulation import opened, simulate
from touchdown.master.interop.find_scene import find_scene
from touchdown.master.interop.ssp.read import RUN_KEYS
from touchdown.master.interop.ssp.write import write_ssp
from touchdown.master.interop.ssp.xml import SSD_FILE
from touchdown.master.scene.gaps import RotorGap
from touchdown.master.scene.requirements import Requirement
from touchdown.master.scene.run_spec import RunSpec
from touchdown.master.scene.scene import ComponentSpec, Document, Scene
from touchdown.validation import bodies

FORCE, POSITION, VELOCITY = bodies.TWO
RUN = {"macro_step": 1e-3, "duration": 0.01}
LISTED = list(bodies.TWO)
FOR = Document(customer="A & B", revision="C")
LIMIT = Requirement("ball_pressure", 2.5e9, "spec 4", "A")
BY_NAME = [{"force": FORCE, "velocity": VELOCITY}]
GEAR = [[*wire, 2.0, 0.0] for wire in bodies.TWO]


def two(path: Path, bond: object, **run: object) -> Scene:
    return bodies.scene(path, bodies.oscillator(), (), bond=bond, run={**RUN, **run})


def exchange(scene: Scene) -> str:
    scene = scene.set({"*.isolate": False})
    with opened(scene) as system:
        return simulate(scene, system).exchange


@pytest.mark.parametrize(("bond", "way"), [(LISTED, "auto"), (BY_NAME, "contact"), (GEAR, "hold")])
def test_values_cross_as_in_the_scene(unitless: Path, bond: object, way: str, tmp_path: Path) -> None:
    """Nothing but the declaration tells, as the FMUs state no units."""
    scene = two(unitless, bond, bonds=way)
    told = exchange(scene)
    assert f"s1.f on s2.f_in by {'smooth' if way == 'auto' else way}" in told
    again = find_scene(str(write_ssp(scene, tmp_path / "again.ssp").path))
    assert exchange(again) == told


def test_names_of_components_and_variables_are_those_of_the_package(unitless: Path, tmp_path: Path) -> None:
    """Components are called by identifiers there, variables as in the scene."""
    first, second = bodies.oscillator().values()
    bond = [{"force": ["1st.push", "s2.f_in"], "position": ["s2.x", "1st.place"]}]
    scene = bodies.scene(unitless, {"1st": first, "s2": second}, (), bond=bond, run=RUN)
    scene = scene.with_names("1st", {"push": "f", "place": "x2"})
    again = find_scene(str(write_ssp(scene, tmp_path / "again.ssp").path))
    told = exchange(scene)
    assert "1st.push on s2.f_in by smooth" in told
    assert exchange(again) == told.replace("1st", "x1st")


def test_all_of_how_to_run_goes_along() -> None:
    """But for times, which the structure tells, and for what belongs to a computer."""
    elsewhere = {"duration", "start_time", "macro_step", "call_timeout", "time_limit"}
    assert {field.name for field in fields(RunSpec)} - elsewhere == set(RUN_KEYS)


def test_gaps_and_requirements_go_along(tmp_path: Path) -> None:
    """With the names of the package."""
    gap = RotorGap("AMB A", "rotor.amb", 0.5e-3, "housing.seat")
    shroud = RotorGap("shroud", "rotor.A", axial=0.3e-3, radius=0.04)
    parts = {"rotor": ComponentSpec("rigid_rotor"), "housing": ComponentSpec("housing")}
    scene = Scene("test", "test", parts, gaps=(gap, shroud), requirements=(LIMIT,), document=FOR)
    again = touchdown.load(write_ssp(scene, tmp_path / "two.ssp").path)
    assert again.gaps == (gap, shroud)
    assert again.requirements == (LIMIT,)
    assert again.document == FOR


@pytest.fixture(scope="module")
def package(unitless: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_ssp(two(unitless, BY_NAME), tmp_path_factory.mktemp("bonds") / "whole.ssp").path


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ('force="s2.f_in"', 'force="s2.gone"', r"a Bond names s2\.gone, to which nothing is connected"),
        ('force="s2.f_in"', "", "a Bond has no force"),
        ('velocity="s1.v2"', "", r"the Bond of s2\.f_in has no position or velocity"),
    ],
)
def test_a_broken_bond_is_named(package: Path, old: str, new: str, expected: str, tmp_path: Path) -> None:
    broken = saying(package, tmp_path / "broken.ssp", old, new, SSD_FILE)
    with pytest.raises(TouchdownError, match=expected):
        find_scene(str(broken))
