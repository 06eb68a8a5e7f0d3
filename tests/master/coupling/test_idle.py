"""A setting whose needs are not met is said, once, wherever a scene is assembled."""

from __future__ import annotations

from pathlib import Path

import pytest

from touchdown.fmus.recipes import recipe
from touchdown.master.components.loading import built
from touchdown.master.coupling.simulation import opened
from touchdown.master.interop.ssp.read import read_package
from touchdown.master.interop.ssp.write import write_ssp
from touchdown.master.scene.file import load_scene
from touchdown.master.scene.scene import Scene

DISK = load_scene("disk-caged-simplified")
IN_SPACE = DISK.swap(bearing="angular_simplified")


def idle(scene: Scene, in_process: bool = True) -> list[str]:
    """What is said of settings that do nothing."""
    with opened(scene, in_process=in_process) as system:
        return [line for line in system.remarks if " nothing while " in line]


@pytest.mark.parametrize(
    ("scene", "name"),
    [
        (DISK, "rotor.thrust[1].force"),
        (DISK, "amb.axial.damping"),
        (DISK, "bearing.ring.width"),
        *(
            (DISK.swap(housing="mount"), f"housing.{of}")
            for of in ("stop.gap", "slide[1].force", "film.clearance")
        ),
    ],
)
def test_a_setting_that_does_nothing_is_said(scene: Scene, name: str) -> None:
    (line,) = idle(scene.set({name: 1e-3}))
    assert line.startswith(f"{name} does nothing while ")


def test_it_says_what_to_set() -> None:
    assert idle(DISK.set({"rotor.axial_load": 5.0, "rotor.z": 1e-4})) == [
        "rotor.axial_load, rotor.z do nothing while rotor.axial = off; set rotor.axial = on, or leave them "
        "out"
    ]
    assert idle(DISK.set({"bearing.contact.tilt": 1e-3})) == [
        "bearing.contact.tilt does nothing while bearing.contact.law = power; set bearing.contact.law = "
        "line, or leave it out"
    ]
    assert idle(IN_SPACE.set({"bearing.row_distance": 0.01})) == [
        "bearing.row_distance does nothing while bearing.arrangement = single; set bearing.arrangement, "
        "or leave it out"
    ]


def test_what_acts_is_not_said_nor_what_asks_for_nothing() -> None:
    along = {"rotor.axial": 1, "amb.axial.stiffness": 1e5, "bearing.shoulder.gap_plus": 1e-4}
    assert idle(IN_SPACE.set({**along, "rotor.axial_load": 5.0})) == []
    assert idle(DISK.set({"rotor.axial_load": 0.0})) == []


def test_a_package_is_not_told_of_values_that_it_was_written_with(tmp_path: Path) -> None:
    package = tmp_path / "disk.ssp"
    write_ssp(DISK, package)
    assert idle(read_package(package), in_process=False) == []
    assert idle(read_package(package).set({"bearing.contact.tilt": 1e-3}), in_process=False)


def test_fmus_say_the_same_as_models_in_process() -> None:
    scene = DISK.set({"rotor.axial_load": 5.0, "amb.axial.stiffness": 1e5})
    said = idle(scene)
    assert len(said) == 2
    assert idle(scene, in_process=False) == said
    path = built(recipe("amb"))
    assert idle(scene.swap(amb=path).set({"amb.axial.stiffness": 1e5}), in_process=False) == said
