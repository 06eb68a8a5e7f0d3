"""What a scene does not need: variants by what its components have, and their price."""

from __future__ import annotations

from dataclasses import replace

import pytest

from touchdown.master.common.progress import Progress
from touchdown.master.coupling.simulation import opened
from touchdown.master.scene.file import load_scene
from touchdown.master.scene.scene import BondSpec, Wire
from touchdown.studies.comparison.engine import Comparison, Options, Row, Variant
from touchdown.studies.comparison.models import compare, dispensable, tied, variants
from touchdown.studies.drop.impact_watch import shortened

DISK = "disk-caged-simplified"
STEP = {"run.macro_step": "20 us"}  # within what forces on the journal are averaged over


def titles(name: str, **settings: object) -> list[str]:
    return [v.name for v in variants(load_scene(name).set(settings))]


def test_variants_are_of_what_a_scene_has() -> None:
    """A disk has no modes, housings out of line are needed, detailed bearings are simplified."""
    assert titles(DISK, **STEP) == [
        *("macro step of 10 us", "macro step of 40 us", "detailed bearings", "plain bushings"),
        *("friction: coulomb", "friction: stribeck", "tolerance inside bearings 100 times as large"),
        *("fine adaptive steps inside bearings", "housings that stand still", "nothing recorded"),
    ]
    assert "housings that stand still" not in titles("rotor1-9000-150um")
    assert "simplified bearings" in titles("disk-cageless-detailed")


def test_a_flexible_rotor_has_modes_to_leave_out() -> None:
    found = set(titles("rotor1-9000"))
    assert {"rigid rotor", "3 modes", "10 modes", "20 modes", "no stresses"} <= found
    assert {"rotor's modes not carried (point-mass)", "steps inside bearings twice as long"} <= found
    assert {"housings that stand still", "friction: makkar"} <= found
    assert "friction: coulomb" not in found  # it is what the scene has


def test_components_in_a_bond_are_needed() -> None:
    disk = load_scene(DISK)
    assert "housing" not in tied(disk)
    bond = BondSpec(Wire("spring.f", "housing.push"), velocity=Wire("housing.v", "spring.v2"))
    assert {"housing", "spring"} <= tied(replace(disk, bond=(bond,)))


@pytest.mark.parametrize("name", ["rotor1-9000", "disk-cageless-detailed", "disk-upright-pair"])
def test_every_variant_can_be_opened_and_keeps_the_scene(name: str) -> None:
    scene = load_scene(name)
    for variant in variants(scene):
        with opened(variant.scene, in_process=True) as system:
            seat = next(iter(system.attachments)).bearing
            assert seat in scene.components
            system.initialise()
    bushings = next(v for v in variants(scene) if v.name == "plain bushings")
    bearing = next(n for n in scene.components if n.startswith("bearing"))
    with opened(scene, in_process=True) as before, opened(bushings.scene, in_process=True) as after:
        for variable in ("clearance", "journal_radius", "friction.static"):
            assert after.value(f"{bearing}.{variable}") == before.value(f"{bearing}.{variable}")


@pytest.fixture(scope="module")
def disk() -> Comparison:
    scene = shortened(load_scene(DISK).set(STEP))
    chosen = [v for v in variants(scene) if v.name != "detailed bearings"]  # slow to compile
    early = scene.set({"run.macro_step": 1.0})
    chosen.append(Variant("impossible", early))
    pieces: list[int] = []
    progress = Progress(pieces.append, lambda: pieces.append(-1))
    found = compare(scene, Options(duration=3e-3, repeat=1, in_process=True), progress, chosen)
    assert pieces[0] == 1 + len(chosen) == -sum(pieces[1:])
    return found


def row(found: Comparison, title: str) -> Row:
    return next(r for r in found.rows if r.name == title)


def percent(found: Comparison, title: str) -> float:
    return 100.0 * row(found, title).errors["change"]


@pytest.mark.slow
def test_prices_are_what_the_parts_are_worth(disk: Comparison) -> None:
    """Forces inside are compared where both have them: a bushing has no balls, this bearing no pockets."""
    there = disk.reference
    assert there.first == pytest.approx(7.892e-3, abs=2e-6)
    assert there.traces["A"].peaks(there.ends["A"]).contact == pytest.approx(345.6, abs=0.5)
    assert there.end == pytest.approx(there.first + 3e-3, abs=3e-5)
    assert percent(disk, "nothing recorded") == 0.0
    assert percent(disk, "macro step of 10 us") < 0.1
    assert 0.001 < percent(disk, "friction: coulomb") < 1.0
    assert percent(disk, "housings that stand still") == pytest.approx(6.0, abs=0.5)
    bushing, fine = (
        row(disk, "plain bushings").errors,
        row(disk, "fine adaptive steps inside bearings").errors,
    )
    assert bushing["contact"] == pytest.approx(0.104, abs=0.01)
    assert bushing["first"] == pytest.approx(-69e-6, abs=2e-6)  # no ring that sags through its play
    assert abs(fine["ball"]) < 1e-3
    assert "side" not in fine
    assert not {"ball", "side"} & set(bushing)
    assert "most loaded ball" in disk.lines[1]


def test_without_friction_nothing_drives_the_cage() -> None:
    """Races that do not rub the balls leave them where they are in their pockets, and press them alike."""
    scene = shortened(load_scene("disk-caged-detailed"))
    smooth = scene.set({f"bearing.race_friction.{key}": 0.0 for key in ("static", "dynamic", "g6")})
    found = compare(
        scene, Options(duration=1e-3, repeat=1, in_process=True), chosen=[Variant("smooth", smooth)]
    )
    errors = found.rows[0].errors
    assert errors["side"] < -0.5
    assert abs(errors["ball"]) < 0.1
    assert "cage or neighbour on a ball" in found.lines[1]


def test_a_variant_that_cannot_run_says_why(disk: Comparison) -> None:
    failed = row(disk, "impossible")
    assert not failed.errors
    assert "run.macro_step = 1 s is longer than the run" in failed.failed
    assert failed not in dispensable(disk)


def test_only_what_is_cheap_and_faster_is_advised(disk: Comparison) -> None:
    rows = dispensable(disk)
    assert all(r.errors["change"] < 0.05 and r.ratio and r.ratio < 1.0 for r in rows)
    assert not {"housings that stand still", "plain bushings"} & {r.name for r in rows}
    nothing = "nothing of these makes the scene faster for less than 5 %"
    assert replace(disk, rows=[]).lines[-1] == nothing
