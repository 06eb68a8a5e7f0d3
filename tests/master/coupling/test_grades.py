"""Balance quality grades: e times the spin speed is G in mm/s, and the unbalance is m e."""

from __future__ import annotations

import math
import re
from pathlib import Path

import pytest

import touchdown
from touchdown.master.common.errors import TouchdownError
from touchdown.master.coupling.simulation import opened
from touchdown.master.scene.scene import Scene

DISK, ROTOR = "disk-caged-simplified", "rotor1-9000"  # rigid; of a file, 3.3 kg with 3 g mm


def value(scene: Scene, name: str) -> float:
    with opened(scene, in_process=True) as system:
        return system.value(name)


def test_a_rigid_rotor_has_the_eccentricity() -> None:
    """G6.3 at 9000 rpm, in either sense: 6.3 mm/s over 942.5 rad/s is 6.68 um."""
    for speed in ("9000 rpm", "-150 Hz"):
        scene = touchdown.load(DISK).set({"rotor.eccentricity": "G6.3", "rotor.speed": speed})
        assert value(scene, "rotor.eccentricity") == pytest.approx(6.3e-3 / (300.0 * math.pi))
    swapped = scene.swap(rotor="rigid_rotor").set({"rotor.speed": "18000 rpm"})
    assert value(swapped, "rotor.eccentricity") == pytest.approx(6.3e-3 / (600.0 * math.pi))


def test_the_unbalances_of_a_file_sum_up_to_mass_times_eccentricity() -> None:
    rotor = touchdown.Rotor.load("rotor_I")
    scene = touchdown.load(ROTOR).set({"rotor.unbalance_scale": "G 2.5"})
    permitted = rotor.mass * 2.5e-3 / (300.0 * math.pi)
    assert value(scene, "rotor.unbalance_scale") * 3e-6 == pytest.approx(permitted, rel=1e-9)


@pytest.mark.parametrize(
    ("scene", "settings", "said"),
    [
        (DISK, {"rotor.eccentricity": "G2.5", "rotor.speed": 0}, "'G2.5' is a balance .* stands still"),
        (DISK, {"rotor.mass": "G2.5"}, "'G2.5' is not a number; a rotor's eccentricity or"),
        (DISK, {"rotor.eccentricity": "G"}, "'G' is not a number; write a number"),
    ],
)  # fmt: skip
def test_a_grade_without_a_speed_or_a_place_is_refused(
    scene: str, settings: dict[str, object], said: str
) -> None:
    with pytest.raises(TouchdownError, match=said):
        value(touchdown.load(scene).set(settings), "rotor.mass")


def test_a_sweep_of_the_speed_keeps_the_rotor(tmp_path: Path) -> None:
    scene, speeds = touchdown.load(DISK).set({"rotor.eccentricity": "G2.5"}), ["6000 rpm", "9000 rpm"]
    with pytest.raises(TouchdownError, match=r"rotor\.speed varies, and with it .*eccentricity = 'G2\.5'"):
        touchdown.sweep(scene, {"rotor.speed": speeds}, tmp_path)


def test_a_grade_needs_unbalances_to_scale(tmp_path: Path) -> None:
    text = Path(touchdown.Rotor.load("rotor_I").save(tmp_path / "rotor.toml")).read_text(encoding="utf-8")
    (tmp_path / "rotor.toml").write_text(re.sub(r"\[\[unbalance\]\][^\[]*", "", text), encoding="utf-8")
    scene = touchdown.load(ROTOR).swap(rotor=tmp_path / "rotor.toml")
    with pytest.raises(TouchdownError, match=r"the rotor's file has none; add \[\[unbalance\]\]"):
        value(scene.set({"rotor.unbalance_scale": "G2.5"}), "rotor.mass")
