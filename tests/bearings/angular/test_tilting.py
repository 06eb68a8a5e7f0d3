"""Tilt between rotor and bearing: one system by scipy against the coupled one, edges, faces."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from tests.support.bearing_states import instance_of
from tests.support.in_space import balance_of
from touchdown.bearings.angular import inner_ring
from touchdown.bearings.angular.pair_statics import MountedRows
from touchdown.bearings.contact.face import PLACES, Shoulder, Slip, Tilt, land_tilted
from touchdown.bearings.contact.friction import FrictionLaw
from touchdown.bearings.contact.materials import SILICON_NITRIDE
from touchdown.bearings.rolling.ball_set import BallSet
from touchdown.master.coupling.simulation import opened, simulate
from touchdown.master.scene.run_spec import RunSpec
from touchdown.master.scene.scene import ComponentSpec, Scene
from touchdown.modelkit.instance import Instance
from touchdown.modelkit.variables import as_record
from touchdown.studies.drop.monolithic import Monolith

BALLS = {
    "count": 17,
    "diameter": 4.8e-3,
    "pitch_diameter": 28.5e-3,
    "outer_conformity": 1.06,
    "play": 0.0,
    "material": SILICON_NITRIDE,
}
PAIR = MountedRows(BallSet(**BALLS), math.radians(25.0), arrangement=1, distance=9e-3, preload=100.0)  # type: ignore[arg-type]
HYBRID: dict[str, object] = {  # that pair, for scenes
    **{f"balls.{name}": value for name, value in BALLS.items()},
    "balls.contact_angle": "25 deg",
    "balls.rows": 2,
    "balls.damping_ratio": 0.05,
    "arrangement": "back to back",
    "row_distance": "9 mm",
    "preload": 100.0,
    "ring.mass": 0.019,
    "ring.inertia": 2.2e-6,
    "ring.transverse_inertia": 1.6e-6,
    "land": "16 mm",
    "rolling.f1": 0.0,
    "interface.tolerance": 1e-7,
}
OFF_CENTRE = (
    Scene(  # upright, the bearing 40 mm below the centre of mass, tilted by 0.2 mrad: one side lands
        "off centre",
        "test",
        {
            "rotor": ComponentSpec(
                "rigid_rotor",
                {
                    "axial": 1,
                    "transverse_inertia": 0.4e-3,
                    "bearing_position": -0.04,
                    "rx": 2e-4,
                    "x": 0.05e-3,
                    "z": -0.148e-3,
                    "vz": -0.05,
                },
            ),
            "bearing": ComponentSpec(
                "angular_simplified",
                {
                    **HYBRID,
                    "shoulder.gap_minus": "0.15 mm",
                    "shoulder.gap_plus": "0.15 mm",
                    "shoulder.dissipation": 5.0,
                },
            ),
            "housing": ComponentSpec("housing"),
        },
        attach=(("bearing.journal", "rotor.A"), ("bearing.housing", "housing.seat")),
        run=RunSpec(duration=1.5e-3, macro_step=1e-4),
        inclination=0.5 * math.pi,
    )
)
FALLING = {"modes": 5, "speed": "9000 rpm", "y": -0.299e-3, "vy": -0.1, "vx": 0.03}
ON_TWO = Scene(  # rotor I, flexible, on two pairs; B is opened a little more
    "on two pairs",
    "test",
    {
        "rotor": ComponentSpec("rotor_I", FALLING),
        "bearing_A": ComponentSpec("angular_simplified", {**HYBRID, "journal_radius": 9.7e-3}),
        "bearing_B": ComponentSpec(
            "angular_simplified", {**HYBRID, "journal_radius": 9.7e-3, "clearance": 0.32e-3}
        ),
    },
    attach=(("bearing_A.journal", "rotor.A"), ("bearing_B.journal", "rotor.B")),
    run=RunSpec(duration=1e-3, macro_step=1e-4),
)

Peaks = dict[str, float]
FACES, FACE_LOSS = ("shoulder.gap_minus", "shoulder.gap_plus"), "shoulder.dissipation"
FACE_PEAK = "bearing.shoulder.peak_force"


def in_one(scene: Scene, bearings: tuple[str, ...]) -> Peaks:
    """Peaks (N) of bore, most loaded ball and face of each bearing, by one system of equations."""
    one = Monolith(scene)
    weight = one._weights()
    atol = np.where(weight > 0.0, 1e-9 / np.where(weight > 0.0, weight, 1.0), 1e3)
    end = scene.run.duration
    found = solve_ivp(
        *(one.rhs, (0.0, end), one.initial(), "DOP853"),
        rtol=1e-11,
        atol=atol,
        dense_output=True,
        max_step=1e-5,
    )
    peaks: Peaks = {}
    for begin, length in zip(found.t[:-1], np.diff(found.t), strict=True):
        for part in (0.0, 0.5):
            one.rhs(begin, found.sol(begin + part * length))
            for name in bearings:
                s, space = (one._twins[name].instance.record[k] for k in ("s", "d"))
                forces = {
                    "contact": s["ring"]["normal"],
                    "balls": s["balls"]["force"] / space["space"]["abreast"],
                    "shoulder": s["shoulder"]["normal"],
                }
                for kind, force in forces.items():
                    key = f"{name}.{kind}.peak_force"
                    peaks[key] = max(peaks.get(key, 0.0), float(force))
    return {key: force for key, force in peaks.items() if force > 0.0}


def coupled(scene: Scene, names: Peaks) -> tuple[Peaks, float]:
    """The same by macro steps, and the energy residual (J)."""
    with opened(scene, in_process=True) as system:
        outcome = simulate(scene, system)
        assert not outcome.reason
        return {name: system.value(name) for name in names}, outcome.residual


def test_a_landing_off_centre_tilts_the_rotor() -> None:
    """At 100 us face 0.001 %, most loaded ball 0.003 %: the bearing's copy of the rotor precesses as that
    does. Where the bearing does not carry the rotor by its own load, a hundred times that."""
    exact = in_one(OFF_CENTRE, ("bearing",))
    assert exact["bearing.shoulder.peak_force"] > 300.0
    found, residual = coupled(OFF_CENTRE, exact)
    assert found == pytest.approx(exact, rel=8e-5)  # held gyroscopics: 2.4e-4
    face = "bearing.shoulder.peak_force"
    assert found[face] == pytest.approx(exact[face], rel=2e-5)
    assert residual < 1e-6  # J
    held, _ = coupled(OFF_CENTRE.set({"run.scheme": "velocity", "run.macro_step": 2e-5}), exact)
    assert abs(held[face] / exact[face] - 1.0) > 1e-3


def test_two_bearings_meet_through_a_flexible_rotor() -> None:
    """Each learns of the other's load a macro step late, as in the plane: 0.05 % at 100 us, 0.01 at 20."""
    exact = in_one(ON_TWO, ("bearing_A", "bearing_B"))
    assert min(exact.values()) > 20.0
    assert coupled(ON_TWO, exact)[0] == pytest.approx(exact, rel=9e-4)
    assert coupled(ON_TWO.set({"run.macro_step": 2e-5}), exact)[0] == pytest.approx(exact, rel=2e-4)


def bore(land: float, **journal: float) -> tuple[Instance, np.ndarray]:
    """The pair with a journal pressed 5 um into its bore, and the derivative of its state."""
    instance = instance_of("angular_simplified")
    p = instance.record["p"]
    for name, value in BALLS.items():
        p["balls"][name] = value
    p["balls"]["contact_angle"], p["balls"]["rows"] = PAIR.contact_angle, 2
    p["arrangement"], p["row_distance"], p["preload"] = PAIR.arrangement, PAIR.distance, PAIR.preload
    p["land"] = land
    j = instance.record["u"]["journal"]
    j["y"], j["omega"], j["inv_m"], j["inv_I"] = -(float(p["clearance"]) + 5e-6), 900.0, 0.6, 2000.0
    for name, value in journal.items():
        j[name] = value
    instance.start(0.0)
    return instance, derivative(instance, instance.record["q"][: int(instance.record["n"])].copy())


def derivative(instance: Instance, q: np.ndarray) -> np.ndarray:
    """Of the state, all as it stands."""
    dq = np.zeros(len(q))
    instance.model.instant(0.0, q, dq, instance.words)  # type: ignore[misc]
    return dq


def test_two_edges_are_one_contact_where_nothing_tilts() -> None:
    flat, edged = bore(0.0)[0].record, bore(16e-3)[0].record
    assert float(flat["s"]["ring"]["normal"]) > 10.0
    for name in ("fx", "fy", "mz", "mx", "my"):
        assert edged["o"]["journal"][name] == pytest.approx(flat["o"]["journal"][name], rel=1e-12)
    assert edged["s"]["ring"]["normal"] == pytest.approx(flat["s"]["ring"]["normal"], rel=1e-12)


def test_a_tilted_journal_is_pressed_back_at_one_edge() -> None:
    """A moment against its tilt, the ring's the opposite one but for what its balls add."""
    tilt, half = 1e-3, 8e-3  # the upper edge is out of the bore's wall
    instance, dq = bore(2.0 * half, rx=tilt)
    m = instance.record
    force, moment = float(m["o"]["journal"]["fy"]), float(m["o"]["journal"]["mx"])
    assert force > 10.0
    assert moment == pytest.approx(-half * force, rel=1e-12)  # +z end down: the load is there
    inertia = float(m["d"]["space"]["transverse_inertia"])
    assert inertia * dq[inner_ring.WX] == pytest.approx(-moment, rel=1e-9)


FACE = as_record(Shoulder(gap_minus=1e-4, radius=11e-3, stiffness=5e8, exponent=1.0, dissipation=2.0))
RUB = as_record(FrictionLaw())


def test_a_tilted_face_presses_by_the_closed_form() -> None:
    """All round in contact, a linear law: k d, and k R^2 tilt/2 as a moment against it, friction apart."""
    depth, tilt = 1e-5, 5e-4
    found = land_tilted(Slip(-1e-4 - depth, 0.0, 0.0, 0.0, 0.0), Tilt(tilt, 0.0, 0.0, 0.0), FACE, RUB)
    assert found.normal == pytest.approx(5e8 * depth, rel=1e-9)
    assert found.fz == pytest.approx(found.normal, rel=1e-12)
    assert found.mx == pytest.approx(-0.5 * 5e8 * 11e-3**2 * tilt, rel=1e-9)
    assert found.my == pytest.approx(0.0, abs=1e-12)
    part = land_tilted(Slip(-1e-4, 0.0, 0.0, 0.0, 0.0), Tilt(0.0, tilt, 0.0, 0.0), FACE, RUB)  # half of it
    assert part.fz == pytest.approx(5e8 * 11e-3 * tilt / math.pi, rel=0.5 * (2.0 * math.pi / PLACES) ** 2)
    assert part.my < 0.0


def test_a_landing_sleeve_gives_tilt_what_its_faces_take() -> None:
    """Energy inside closes to 6e-7 of the turnover; a moment that is lost would be all of the tilt's."""
    sleeve = ComponentSpec("landing_sleeve", {name: "0.15 mm" for name in FACES} | {FACE_LOSS: 5.0})
    scene = replace(OFF_CENTRE, components={**OFF_CENTRE.components, "bearing": sleeve})
    balance = balance_of(scene)
    assert balance.face > 500.0
    assert balance.tilt > 1e-3
    assert balance.error < 2e-6
    finer = coupled(scene.set({"run.macro_step": "10 us"}), {FACE_PEAK: 0.0})[0][FACE_PEAK]
    assert balance.face == pytest.approx(finer, rel=6e-4)  # 2.4e-4 found
