"""The simplified cageless bearing's leapfrog steps against the accurate ones, and its vector code."""

from __future__ import annotations

import math

import numpy as np
import pytest
from systems import history, rotor_on

from touchdown.bearings.rolling import ring
from touchdown.master.coupling.observer import EveryBeat
from touchdown.master.coupling.simulation import open_system, simulate
from touchdown.master.coupling.system import System
from touchdown.master.scene.file import load_scene
from touchdown.master.scene.scene import Scene
from touchdown.modelkit.numerics import cosine_and_sine

SCENE = "disk-cageless-simplified"


def finished(scene: Scene) -> System:
    """The system at the end of a run."""
    system = open_system(scene, in_process=True)
    outcome = simulate(scene, system)
    assert not outcome.reason, outcome.reason
    return system


def drop(**settings: object) -> System:
    """The disk 9 ms after the shutdown, just past the first impact."""
    scene = load_scene(SCENE).set({"run.duration": 9e-3, "run.macro_step": 4e-5})
    for key, value in settings.items():
        scene = scene.set({f"bearing.{key.replace('__', '.')}": value})
    return finished(scene)


def test_cosine_and_sine_are_those_of_the_library() -> None:
    angles = np.concatenate([np.linspace(-20.0, 20.0, 4001), np.linspace(-1e5, 1e5, 4001)])
    quarters = 0.5 * math.pi * np.arange(-40, 41)
    for angle in np.concatenate([angles, quarters, quarters + 1e-9]):
        c, s = cosine_and_sine(angle)
        assert c == pytest.approx(math.cos(angle), abs=4e-16)
        assert s == pytest.approx(math.sin(angle), abs=4e-16)


def test_the_default_steps_follow_the_accurate_ones() -> None:
    """Rotor within 0.01 um at 9 ms, peak forces of the first impact within 0.1 %."""
    exact, found = drop(micro_step=0.0, interface__tolerance=1e-8), drop()
    for name in ("rotor.A.x", "rotor.A.y"):
        assert found.value(name) == pytest.approx(exact.value(name), abs=1e-8)
    for name in ("bearing.contact.peak_force", "bearing.balls.peak_force"):
        assert found.value(name) == pytest.approx(exact.value(name), rel=1e-3)


def test_steep_friction_sticks_instead_of_chattering() -> None:
    """A hundred times as steep, friction would reverse the balls at every step, were it explicit."""
    steep = {f"race_friction__{g}": v for g, v in (("g2", 1e4), ("g3", 1e3), ("slope", 1e4))}
    exact, found = drop(**steep, micro_step=0.0, interface__tolerance=1e-6), drop(**steep)
    for name in ("rotor.A.x", "rotor.A.y"):
        assert found.value(name) == pytest.approx(exact.value(name), abs=1e-8)
    for name, within in (
        ("contact.peak_force", 1e-3),
        ("balls.peak_force", 1e-3),
        ("energy.dissipated", 0.01),
    ):
        assert found.value(f"bearing.{name}") == pytest.approx(exact.value(f"bearing.{name}"), rel=within)
    record = found.components["bearing"].instance.record  # type: ignore[attr-defined]
    orbit, spin = (record["q"][ring.NEXT + k * 17 : ring.NEXT + (k + 1) * 17] for k in (1, 2))
    sliding = np.abs(record["d"]["pitch_radius"] * orbit + record["d"]["ball_radius"] * spin)
    assert np.median(sliding[record["s"]["inner"]["normal"][:17] > 10.0]) < 2e-3


def rolling(bearing: str, duration: float, **settings: object) -> Scene:
    """A rotor that lies on the ring at full speed; half the weight and inertia of one on two bearings."""
    rotor = {"mass": 1.65, "inertia": 0.5e-3, "speed": 942.48, "y": -0.308e-3}
    values = {
        "rolling__resistance": 0.013,
        **({"rolling__f1": 0.0} if bearing == "simplified_caged" else {}),
    }
    values = {key.replace("__", "."): value for key, value in {**values, **settings}.items()}
    housing = {"mass": 5.0, "outer_ring": 0.02}
    return rotor_on(bearing, rotor, values, housing, duration=duration, macro_step=5e-5)


ROLLING = [("simplified_cageless", 0), ("simplified_caged", 1)]


@pytest.mark.parametrize(("bearing", "slip"), ROLLING)
def test_a_rotor_runs_down_by_rolling_resistance(bearing: str, slip: int) -> None:
    """Torque on the rotor: mu (sum of F + F_o) times the balls' speed over the rotor's."""
    given = {"slip": slip} if slip else {}
    speeds: list[tuple[float, float]] = []
    scene = rolling(bearing, 1.0, **given)
    system = open_system(scene, in_process=True)
    watch = EveryBeat(lambda now: speeds.append((now.time, system.value("rotor.A.omega"))))
    assert not simulate(scene, system, observers=[watch]).reason
    times, found = np.array(speeds).T
    late = times > 0.8  # when every ball rolls
    slope = float(np.polyfit(times[late], found[late], 1)[0])
    record = system.components["bearing"].instance.record  # type: ignore[attr-defined]
    s, d, p = record["s"], record["d"], record["p"]
    count = int(p["balls"]["count"])
    each = bearing == "simplified_cageless"
    forces = np.sum(s["inner"]["normal"][:count]) if each else s["balls"]["total"]
    omega = system.value("rotor.A.omega")
    race = omega * 9.7e-3 / 10e-3 * d["inner_radius"]  # the bore rolls on the journal
    speed = 0.5 * race
    pressed = 2.0 * forces + count * d["mass"] * speed**2 / d["pitch_radius"]
    expected = -0.013 * pressed * speed / omega / 0.5e-3
    assert forces > 16.2
    assert slope == pytest.approx(expected, rel=0.04)
    assert 60.0 * slope / (2.0 * math.pi) == pytest.approx(-77.7, abs=2.0)  # rpm/s


@pytest.mark.parametrize(("bearing", "slip"), ROLLING)
def test_rolling_resistance_is_heat(bearing: str, slip: int) -> None:
    """All energies add up while the rotor runs down, and nothing turns back."""
    given = {"slip": slip} if slip else {}
    if bearing == "simplified_cageless":
        given["micro_step"] = 0.0
    scene = rolling(bearing, 0.05, **given, rolling__resistance=0.1, interface__tolerance=1e-8)
    parts = [
        f"{c}.energy.{k}"
        for c in ("rotor", "bearing", "housing")
        for k in ("kinetic", "potential", "dissipated")
    ]
    _, found, _ = history(scene, parts)
    total = sum(found[name] for name in parts)
    assert found["bearing.energy.dissipated"][-1] > 0.5
    assert np.all(np.diff(found["bearing.energy.dissipated"]) > -1e-9)
    assert np.max(np.abs(total - total[0])) < 1e-6 * found["bearing.energy.dissipated"][-1] + 1e-7
