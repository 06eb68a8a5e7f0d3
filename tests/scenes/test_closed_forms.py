"""Drops against closed forms: impact, pendulum, rolling, sliding climb."""

from __future__ import annotations

import math

import numpy as np
import pytest
from systems import CLEARANCE, DISK, GRAVITY, LANDING, history, rotor_on

from touchdown.master.common.errors import TouchdownError
from touchdown.master.results.summary import dominant_frequency
from touchdown.master.scene.file import load_scene
from touchdown.studies.drop.monolithic import Monolith

RADIUS, INERTIA = 9.7e-3, 0.5e-3
ORBIT = CLEARANCE + (DISK * GRAVITY / 2.4e9) ** (1 / 1.5)  # of a disk that rests in the bore, m


def impact(gravity: float, **contact: float) -> tuple[float, float, float, float]:
    """Disk landing on a rigid bore: peak indentation [um], force [N], duration [ms], restitution."""
    rotor = {"y": -CLEARANCE, "vy": -LANDING, "gravity": gravity, "speed": 0.0}
    settings = {f"contact.{k}": v for k, v in {"damping": 0.0, **contact}.items()}
    scene = rotor_on("bushing", rotor, settings, duration=2.5e-3, macro_step=1e-6)
    times, found, _ = history(
        scene,
        [
            "bearing.contact.force",
            "bearing.contact.peak_force",
            "bearing.contact.peak_indentation",
            "rotor.A.vy",
        ],
    )
    touching = times[found["bearing.contact.force"] > 0.0]
    parted = np.searchsorted(times, touching[-1]) + 1
    rebound = found["rotor.A.vy"][parted] / LANDING
    peak = found["bearing.contact.peak_indentation"][-1], found["bearing.contact.peak_force"][-1]
    return peak[0] * 1e6, peak[1], (touching[-1] - touching[0]) * 1e3, rebound


def test_hertz_impact_without_gravity() -> None:
    depth, force, duration, restitution = impact(0.0)
    assert depth == pytest.approx(30.31, rel=1e-3)
    assert force == pytest.approx(400.5, rel=1e-3)
    assert duration == pytest.approx(1.163, rel=2e-3)  # read off to 1 us
    assert restitution == pytest.approx(1.0, abs=1e-5)


def test_hertz_impact_with_gravity() -> None:
    depth, force, duration, _ = impact(GRAVITY)
    assert depth == pytest.approx(31.55, rel=1e-3)
    assert force == pytest.approx(425.3, rel=1e-3)
    assert duration == pytest.approx(1.184, rel=2e-3)


def test_damped_impact() -> None:
    depth, _, _, restitution = impact(0.0, damping=1e7)
    assert depth == pytest.approx(29.71, rel=1e-3)
    assert restitution == pytest.approx(0.951, abs=1e-3)


FACE, FACE_GAP = 6e7, 0.15e-3  # N/m, m


def landing_on_a_face(rotor: dict[str, object], duration: float) -> tuple[float, float]:
    """Disk landing along its shaft on a linear face: peak force (N), velocity at the end (m/s)."""
    settings = {
        "shoulder.gap_minus": FACE_GAP, "shoulder.stiffness": FACE, "shoulder.exponent": 1.0,
        "shoulder.dissipation": 0.0, "interface.tolerance": 1e-9,
    }  # fmt: skip
    rotor = {"axial": 1, "speed": 0.0, **rotor}
    scene = rotor_on("landing_sleeve", rotor, settings, duration=duration, macro_step=1e-4)
    _, found, _ = history(scene, ["bearing.shoulder.peak_force", "rotor.A.vz"])
    return float(found["bearing.shoulder.peak_force"][-1]), float(found["rotor.A.vz"][-1])


def test_landing_along_the_shaft_without_gravity() -> None:
    """v sqrt(k m), and all of the speed back."""
    force, leaving = landing_on_a_face({"gravity": 0.0, "vz": -LANDING}, 6e-3)
    assert force == pytest.approx(LANDING * math.sqrt(FACE * DISK), rel=1e-6)
    assert leaving == pytest.approx(LANDING, rel=1e-6)


def test_fall_along_an_upright_shaft() -> None:
    """m g (1 + sqrt(1 + 2 k h/(m g)))."""
    force, _ = landing_on_a_face({"gravity": GRAVITY, "inclination": 0.5 * math.pi}, 8e-3)
    weight = DISK * GRAVITY
    assert force == pytest.approx(
        weight * (1.0 + math.sqrt(1.0 + 2.0 * FACE * FACE_GAP / weight)), rel=1e-6
    )


def test_pendulum_in_a_frictionless_bore() -> None:
    assert math.sqrt(GRAVITY / CLEARANCE) / (2.0 * math.pi) == pytest.approx(28.78, abs=0.01)
    assert swing(0.0) == pytest.approx(math.sqrt(GRAVITY / ORBIT) / (2.0 * math.pi), rel=2e-3)


def test_pendulum_rolling_in_a_fixed_bore() -> None:
    rolling = 1.0 + INERTIA / (DISK * RADIUS**2)
    assert math.sqrt(GRAVITY / CLEARANCE / rolling) / (2.0 * math.pi) == pytest.approx(14.0, abs=0.1)
    assert swing(1.0) == pytest.approx(math.sqrt(GRAVITY / ORBIT / rolling) / (2.0 * math.pi), rel=2e-3)


def swing(friction: float) -> float:
    """Frequency of a disk let go at a small angle in a bore, in contact from the start (Hz)."""
    rotor = {"x": ORBIT * math.sin(0.1), "y": -ORBIT * math.cos(0.1), "speed": 0.0}
    settings = {
        "friction.kind": 0, "friction.dynamic": friction, "friction.slope": 3000.0, "contact.viscous": 1e4,
    }  # fmt: skip
    scene = rotor_on("bushing", rotor, settings, duration=0.5, macro_step=1e-4)
    times, found, _ = history(scene, ["rotor.A.x", "bearing.contact.force"])
    assert found["bearing.contact.force"].min() > 1.0
    frequency = dominant_frequency(times, found["rotor.A.x"])
    assert frequency is not None
    return frequency


@pytest.mark.parametrize(("friction", "turning"), [(0.10, 11.50), (0.15, 17.33), (0.27, 31.82)])
def test_a_sliding_rotor_climbs_to_its_turning_angle(friction: float, turning: float) -> None:
    """phi'^2 = (g/c) u,  u = A cos phi + B sin phi - A exp(2 mu phi), sliding all the way."""
    rotor = {"y": -ORBIT, "speed": 5000.0}
    settings = {"friction.kind": 0, "friction.dynamic": friction, "contact.viscous": 3e3}
    scene = rotor_on("bushing", rotor, settings, duration=0.02, macro_step=2e-5)
    _, found, _ = history(scene, ["rotor.A.x", "rotor.A.y", "bearing.contact.force"])
    assert found["bearing.contact.force"].min() > 1.0
    climbed = np.degrees(np.arctan2(found["rotor.A.x"], -found["rotor.A.y"]))
    peak = climbed[np.argmax(np.abs(climbed))]
    assert abs(peak) == pytest.approx(turning, rel=0.01)
    assert abs(turning_angle(friction)) == pytest.approx(turning, abs=0.01)  # printed to 0.01 deg
    assert peak < 0.0  # spinning counter-clockwise it climbs against its spin


def turning_angle(mu: float) -> float:
    """Where u of the closed form vanishes again (degrees)."""
    from scipy.optimize import brentq

    a = 2.0 * (1.0 - 2.0 * mu**2) / (1.0 + 4.0 * mu**2)
    b = 6.0 * mu / (1.0 + 4.0 * mu**2)
    root = brentq(lambda p: a * math.cos(p) + b * math.sin(p) - a * math.exp(2.0 * mu * p), 1e-3, 1.5)
    return math.degrees(root)  # type: ignore[arg-type]


def test_the_ring_is_spun_up_in_its_time() -> None:
    """t = omega I / (mu m g R) for a rotor that rests on the ring and slides at a constant coefficient."""
    mu, inertia = 0.10, 2e-6
    sag = 1e-5
    settings = {
        "friction.kind": 0, "friction.dynamic": mu, "ring.inertia": inertia, "rolling.f1": 0.0,
        "contact.viscous": 3e3, "balls.play": 0.0, "cage.mass": 0.0, "balls.density": 1.0,
    }  # fmt: skip
    rotor = {"y": -CLEARANCE - sag, "speed": 942.0, "inertia": 1e3, "mass": 1.65}
    scene = rotor_on("simplified_caged", rotor, settings, duration=0.5, macro_step=1e-4)
    times, found, _ = history(
        scene, ["bearing.ring.surface_speed", "bearing.ring.journal_speed", "bearing.contact.force"]
    )
    caught = times[found["bearing.ring.surface_speed"] >= 0.99 * found["bearing.ring.journal_speed"]]
    # to a few per cent: dragged up the bore, the rotor swings and does not always press with its weight
    bore = RADIUS + CLEARANCE
    expected = 0.99 * 942.0 * RADIUS / bore * inertia / (mu * DISK * GRAVITY * bore)
    assert caught[0] == pytest.approx(expected, rel=0.05)


def test_a_thrust_over_time_pushes_a_disk_along_the_shaft() -> None:
    """From the shutdown at 5 ms, when it is -200 N, it rises by 5 kN/s; by the scheme and as one system."""
    scene = load_scene("disk-thrust").swap(bearing="landing_sleeve").set({"run.duration": "1.4 ms"})
    times, found, _ = history(scene, ["rotor.A.z"])
    since = times - 5e-3
    falling = since > 0.0
    expected = (-200.0 * since**2 / 2.0 + 5e3 * since**3 / 6.0) / DISK
    assert found["rotor.A.z"][falling] == pytest.approx(expected[falling], rel=1e-9, abs=1e-15)
    asked = np.array([0.5e-3, 1.4e-3])
    joined = Monolith(scene).solve(asked, ["rotor.A.z"], 1e-9, "DOP853").series["rotor.A.z"]
    assert joined == pytest.approx((-100.0 * asked**2 + 5e3 * asked**3 / 6.0) / DISK, rel=1e-9)


def test_a_sampled_controller_has_no_equations_to_join() -> None:
    with pytest.raises(TouchdownError, match=r"component controller .* acts in steps and has no equations"):
        Monolith(load_scene("disk-caged-relevitated"))
