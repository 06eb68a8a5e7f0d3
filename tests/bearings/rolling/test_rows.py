"""Rows of balls side by side: one set with their mass and stiffness together, stated per ball."""

from __future__ import annotations

import pytest
from ball_sets import derived, resting_place
from systems import rotor_on

from touchdown.bearings.rolling.ball_set import BallSet
from touchdown.master.coupling.simulation import open_system, simulate
from touchdown.master.coupling.system import System

SIDE = {"simplified_cageless": "ball_contact", "detailed_caged": "cage_contact"}


def test_two_rows_carry_twice_the_load() -> None:
    one, two = BallSet(damping=1e3, damping_ratio=0.02), BallSet(damping=1e3, damping_ratio=0.02, rows=2)
    single, pair = derived(one), derived(two)
    assert pair["stiffness"] == single["stiffness"]  # of a ball
    assert pair["race"]["stiffness"] == 2.0 * single["race"]["stiffness"]
    assert pair["race"]["damping"] == pytest.approx(2.0 * single["race"]["damping"])
    assert (pair["mass"], pair["inertia"]) == (2.0 * single["mass"], 2.0 * single["inertia"])
    for weight in (0.1, 1.0):
        assert resting_place(two, 2.0 * weight) == pytest.approx(resting_place(one, weight), abs=1e-15)


def landed(bearing: str, **settings: object) -> System:
    """A bearing 0.6 ms after a rotor has touched it, its balls bunched where they can be."""
    rotor = {"speed": 942.48, "y": -0.29999e-3, "vy": -0.0767}
    if bearing.endswith("cageless"):
        settings["balls.bunching"] = 1.0
    housing = {"mass": 5.0, "outer_ring": 0.02}
    scene = rotor_on(bearing, rotor, settings, housing, duration=6e-4, macro_step=2e-5)
    system = open_system(scene, in_process=True)
    assert not simulate(scene, system).reason
    return system


@pytest.mark.parametrize("bearing", list(SIDE))
def test_two_rows_move_like_one_of_twice_the_stiffness_and_mass(bearing: str) -> None:
    """And half of its balls' forces are stated."""
    base = {"balls.damping": 1e5, "friction.g6": 0.0}
    twice: dict[str, object] = {
        "balls.damping": 2e5,
        "balls.modulus": 2 * 207e9,
        "ring.modulus": 2 * 207e9,
        "balls.density": 2 * 7830.0,
    }
    base |= {f"{SIDE[bearing]}.damping": 1e5}
    twice |= {f"{SIDE[bearing]}.damping": 2e5, f"{SIDE[bearing]}.stiffness": 2e8}
    two, one = landed(bearing, **base, **{"balls.rows": 2}), landed(bearing, **{**base, **twice})
    assert two.value("bearing.contact.peak_force") > 100.0
    for name in (
        "rotor.A.x",
        "rotor.A.y",
        "rotor.A.omega",
        "bearing.ring.omega",
        "bearing.energy.dissipated",
    ):
        assert two.value(name) == pytest.approx(one.value(name), rel=1e-6), name
    forces = ["balls.peak_force", "balls.force"]
    if bearing.endswith("cageless"):
        forces.append("neighbours.peak_force")
    if bearing.startswith("detailed"):
        forces += ["inner.peak_force", "outer.force", "hardest.outer_normal", "ball[1].outer"]
    for name in forces:
        assert two.value(f"bearing.{name}") == pytest.approx(
            0.5 * one.value(f"bearing.{name}"), rel=1e-4
        ), name
    assert one.value("bearing.balls.peak_force") > 20.0
