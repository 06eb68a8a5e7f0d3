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


def test_hertz_impact_with_gravity() -> None:
    """On a rigid bore: K d^2.5/2.5 = m v^2/2 + m g d; without gravity and damped: `touchdown validate`."""
    rotor = {"y": -CLEARANCE, "vy": -LANDING, "gravity": GRAVITY, "speed": 0.0}
    scene = rotor_on("bushing", rotor, {"contact.damping": 0.0}, duration=2.5e-3, macro_step=1e-6)
    names = [f"bearing.contact.{name}" for name in ("force", "peak_indentation", "peak_force")]
    times, found, _ = history(scene, names)
    touching = times[found["bearing.contact.force"] > 0.0]
    assert found["bearing.contact.peak_indentation"][-1] == pytest.approx(31.55e-6, rel=1e-3)
    assert found["bearing.contact.peak_force"][-1] == pytest.approx(425.3, rel=1e-3)
    assert touching[-1] - touching[0] == pytest.approx(1.184e-3, rel=2e-3)


FACE, FACE_GAP, WEIGHT = 6e7, 0.15e-3, DISK * GRAVITY  # N/m, m, N
UPRIGHT = {"gravity": GRAVITY, "inclination": 0.5 * math.pi}


@pytest.mark.parametrize(
    ("rotor", "duration", "expected", "leaving"),
    [
        # v sqrt(k m), and all of the speed back
        ({"gravity": 0.0, "vz": -LANDING}, 6e-3, LANDING * math.sqrt(FACE * DISK), LANDING),
        (UPRIGHT, 8e-3, WEIGHT * (1.0 + math.sqrt(1.0 + 2.0 * FACE * FACE_GAP / WEIGHT)), None),
    ],
)
def test_landing_along_the_shaft(
    rotor: dict[str, object], duration: float, expected: float, leaving: float | None
) -> None:
    """On a linear face, without gravity and by its weight alone."""
    settings = {
        "shoulder.gap_minus": FACE_GAP, "shoulder.stiffness": FACE, "shoulder.exponent": 1.0,
        "shoulder.dissipation": 0.0, "interface.tolerance": 1e-9,
    }  # fmt: skip
    rotor = {"axial": 1, "speed": 0.0, **rotor}
    scene = rotor_on("landing_sleeve", rotor, settings, duration=duration, macro_step=1e-4)
    _, found, _ = history(scene, ["bearing.shoulder.peak_force", "rotor.A.vz"])
    assert found["bearing.shoulder.peak_force"][-1] == pytest.approx(expected, rel=1e-6)
    if leaving is not None:
        assert found["rotor.A.vz"][-1] == pytest.approx(leaving, rel=1e-6)


@pytest.mark.parametrize(
    ("friction", "inertia"),
    [(0.0, 1.0), (1.0, 1.0 + INERTIA / (DISK * RADIUS**2))],
    ids=["slides", "rolls"],
)
def test_pendulum_in_a_fixed_bore(friction: float, inertia: float) -> None:
    """A disk let go at a small angle, in contact from the start: sqrt(g/c) over the inertia that turns."""
    rotor = {"x": ORBIT * math.sin(0.1), "y": -ORBIT * math.cos(0.1), "speed": 0.0}
    settings = {
        "friction.kind": 0, "friction.dynamic": friction, "friction.slope": 3000.0, "contact.viscous": 1e4,
    }  # fmt: skip
    scene = rotor_on("bushing", rotor, settings, duration=0.3, macro_step=1e-4)
    times, found, _ = history(scene, ["rotor.A.x", "bearing.contact.force"])
    assert found["bearing.contact.force"].min() > 1.0
    frequency = math.sqrt(GRAVITY / ORBIT / inertia) / (2.0 * math.pi)
    assert dominant_frequency(times, found["rotor.A.x"]) == pytest.approx(frequency, rel=2e-3)


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
    with pytest.raises(TouchdownError, match=r"component controller .* acts in steps and has no equations"):
        Monolith(load_scene("disk-caged-relevitated"))
