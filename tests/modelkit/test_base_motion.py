"""Bodies on a base that moves, in its frame: closed forms, and gravity in its place."""

from __future__ import annotations

import math

import numpy as np
import pytest
from systems import history

from touchdown.bearings.supports import housing
from touchdown.master.coupling.simulation import opened
from touchdown.master.scene.file import load_scene
from touchdown.master.scene.run_spec import RunSpec, with_changes
from touchdown.master.scene.scene import ComponentSpec, Scene
from touchdown.modelkit.excitation import LINES as SINE
from touchdown.modelkit.excitation import PULSE
from touchdown.modelkit.instance import Instance

WIDTH, BEGIN = 2e-3, 1.1e-3  # s
ROTORS = {"rigid_rotor": "A", "rotor_I": "amb_B"}  # a port of each


def alone(rotor: str, settings: dict[str, object], duration: float = 5e-3) -> Scene:
    """A rotor that nothing holds."""
    run = with_changes(RunSpec(), {"duration": duration, "macro_step": 2e-5})
    return Scene("free", "free", {"rotor": ComponentSpec(rotor, {"gravity": 0.0, **settings})}, run=run)


@pytest.mark.parametrize("rotor", ROTORS)
def test_after_a_shock_a_free_rotor_lags_behind_the_base(rotor: str):
    """By -2 a width/pi; with unbalance at speed its energy, less the work of the base, stays."""
    port = f"rotor.{ROTORS[rotor]}"
    shock = {"base.x": 300.0, "base.y": -100.0, "base.course.form": "pulse"}
    shock |= {"base.course.begin": BEGIN, "base.course.width": WIDTH}
    still = {"unbalance_scale": 0.0} if rotor == "rotor_I" else {}
    _, found, _ = history(alone(rotor, {**shock, **still}), [f"{port}.vx", f"{port}.vy"])
    speed = -2.0 * WIDTH / math.pi
    assert found[f"{port}.vx"][-1] == pytest.approx(300.0 * speed, rel=1e-4)
    assert found[f"{port}.vy"][-1] == pytest.approx(-100.0 * speed, rel=1e-4)
    turning = {} if rotor == "rotor_I" else {"eccentricity": 1e-4}
    names = ["rotor.energy.kinetic", "rotor.energy.potential", "rotor.energy.dissipated"]
    _, energy, _ = history(alone(rotor, {**shock, **turning}), names)
    total = sum(energy[name] for name in names)
    gained = np.ptp(energy["rotor.energy.kinetic"])
    assert gained > 0.03
    assert np.ptp(total) < 1e-4 * gained


@pytest.mark.parametrize("rotor", ROTORS)
@pytest.mark.parametrize("width", [3e-6, 70e-6])
def test_no_shock_is_too_short_for_the_macro_step(rotor: str, width: float):
    """As the half sine's integral, wherever it lies among macro steps of 20 us."""
    still = {"unbalance_scale": 0.0} if rotor == "rotor_I" else {}
    shock = {"base.x": 3e4, "base.course.form": "pulse", "base.course.begin": 0.537e-3}
    scene = alone(rotor, {**shock, "base.course.width": width, **still}, 2e-3)
    ports = [
        f"rotor.{port}.vx" for port in (("A", "amb") if rotor == "rigid_rotor" else ("amb_A", "amb_B"))
    ]
    _, found, _ = history(scene, ports)
    speed = -3e4 * 2.0 * width / math.pi
    assert [found[port][-1] for port in ports] == pytest.approx([speed] * 2, rel=1e-6)


@pytest.mark.parametrize("rotor", ROTORS)
def test_a_base_that_accelerates_upwards_is_gravity(rotor: str):
    """Also in what a bearing is told; an elastic rotor, which nothing bends, falls as a whole."""
    names = [f"rotor.{ROTORS[rotor]}.{name}" for name in ("y", "vy", "ay_free")]
    still = {"unbalance_scale": 0.0} if rotor == "rotor_I" else {}
    _, lifted, _ = history(alone(rotor, {**still, "base.y": 9.81, "base.course.form": "step"}), names)
    for name, last in zip(names, (-0.5 * 9.81 * 25e-6, -9.81 * 5e-3, -9.81), strict=True):
        assert lifted[name][-1] == pytest.approx(last, rel=1e-6)
    if rotor == "rigid_rotor":
        _, falling, _ = history(alone(rotor, {"gravity": 9.81}), names)
        for name in names:
            assert lifted[name] == pytest.approx(falling[name], rel=1e-12, abs=1e-15)


def test_the_transmissibility_of_a_housing():
    """(k + i omega c)/(k - m omega^2 + i omega c) of the ground's motion, at 1.3 times its frequency."""
    mass, stiffness, damping, size = 5.042, 2.5e6, 700.0, 20.0
    omega, one, step = 1.3 * math.sqrt(stiffness / mass), Instance(housing.MODEL), 2e-5
    p = one.record["p"]
    p["stiffness"], p["damping"], p["gravity"], p["base"]["y"] = stiffness, damping, 0.0, size
    p["base"]["course"]["form"], p["base"]["course"]["lines"]["frequency"] = SINE, omega
    one.start(0.0)
    seen = []
    for k in range(10000):
        one.step(k * step, step)
        seen.append(float(one.record["o"]["seat"]["y"]))
    times = step * np.arange(1, 10001)
    late = times > 0.15  # the transient is down by exp(-10)
    waves = np.column_stack((np.cos(omega * times[late]), np.sin(omega * times[late])))
    (cosine, sine), *_ = np.linalg.lstsq(waves, np.array(seen)[late], rcond=None)
    ground = -size / omega**2
    expected = complex(stiffness, omega * damping) / complex(stiffness - mass * omega**2, omega * damping)
    assert (complex(cosine, -sine) + ground) / ground == pytest.approx(expected, rel=1e-4)


def test_a_levitated_disk_takes_a_shock_and_no_energy_is_made():
    """Rotor, housing and a magnetic bearing that tells its work; the base pushes with 50 m/s2 for 2 ms."""
    shock = {"x": 50.0, "course.form": PULSE, "course.begin": BEGIN, "course.width": WIDTH}
    both = {f"{body}.base.{name}": value for body in ("rotor", "housing") for name, value in shock.items()}
    scene = load_scene("disk-caged-simplified").set(
        {**both, "run.duration": "10 ms", "amb.shutdown_time": 1.0}
    )
    kinds = ("kinetic", "potential", "dissipated")
    stored = [f"{body}.energy.{kind}" for body in ("rotor", "housing", "bearing") for kind in kinds]
    names = [*stored, "amb.supplied", "rotor.A.x"]
    _, found, _ = history(scene.set({"amb.shutdown_time": 1.0}), names)
    assert np.abs(found["rotor.A.x"]).max() > 5e-5
    total = sum(found[name] for name in stored) - found["amb.supplied"]
    assert np.ptp(total) < 1e-3 * np.ptp(found["rotor.energy.potential"])  # the work of the base is in it


def test_a_base_that_moves_under_one_body_alone_is_said():
    shocked = {f"{body}.base.y": 60.0 for body in ("rotor", "housing")}
    shocked |= {f"{body}.base.course.form": "pulse" for body in ("rotor", "housing")}
    alike, told = "base.* is not alike in rotor and housing", []
    for other in ({}, {"housing.base.y": 0.0}, {"rotor.base.x": 1.0}):
        with opened(
            load_scene("disk-caged-simplified").set({**shocked, **other}), in_process=True
        ) as system:
            told.append([line for line in system.remarks if line.startswith(alike)])
    assert [len(lines) for lines in told] == [0, 1, 1]
    assert "it stands still in housing;" in told[1][0]
