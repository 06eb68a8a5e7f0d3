"""Rotors that levitate on a DC link whose mains failed: against closed forms, and however they are run."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import levitation as lev
import numpy as np
import pytest
from systems import bits, history, recorded, run_to_end

from touchdown.master.coupling.simulation import open_system
from touchdown.master.interop.find_scene import find_scene
from touchdown.master.interop.ssp.write import write_ssp
from touchdown.master.scene.file import load_scene
from touchdown.master.scene.scene import ComponentSpec, Scene, Wire

STANDBY = 10.0  # W
ENERGIES = "mains", "generated", "taken", "standby", "burnt", "stored"


def coil_power() -> float:
    """R i^2 of all coils that hold the disk at the centre (W)."""
    hold, *_ = lev.operating_point(lev.MASS * lev.GRAVITY / 2**0.5)
    return lev.RESISTANCE * 4 * (lev.BIAS**2 + hold**2)


def test_hold_up_is_the_capacitor_s_energy_over_what_is_consumed(tmp_path: Path):
    """Until the link locks out C (U0^2 - Umin^2)/(2 P); the rest is the fall, once currents have decayed.

    The disk hardly moves meanwhile: powers are steady to 1e-4 but for the first settling of the currents.
    """
    summary = run_to_end(load_scene("disk-caged-hold-up").set({"run.duration": 0.5}), tmp_path)
    found = summary["components"]["link"]
    expected = 0.5 * 2e-3 * (100.0**2 - 40.0**2) / (STANDBY + coil_power())
    assert expected == pytest.approx(0.4567, abs=1e-4)
    assert found["lock_out_time"] == pytest.approx(expected, rel=2e-4)
    assert found["hold_up"] == "dropped"
    assert found["hold_up_time"] == pytest.approx(summary["seats"]["A"]["first_contact_time"], rel=1e-12)
    assert 0.008 < found["hold_up_time"] - found["lock_out_time"] < 0.016
    mains, generated, taken, standby, burnt, stored = (found[f"link_{name}"] for name in ENERGIES)
    assert generated == burnt == 0.0
    assert abs(mains - taken - standby - (stored - 10.0)) < 1e-12 * 20.0


def test_a_rotor_that_does_not_drop_has_no_hold_up(tmp_path: Path):
    summary = run_to_end(load_scene("disk-caged-hold-up").set({"run.duration": 0.1}), tmp_path)
    found = summary["components"]["link"]
    assert found["hold_up"] == "levitated to the end of the run, 0.1 s"
    assert (found["hold_up_time"], found["lock_out_time"]) == (None, None)
    back = {"run.duration": 0.1, "link.event[2].time": 45e-3, "link.event[2].kind": "on"}
    found = run_to_end(load_scene("disk-caged-hold-up").set(back), tmp_path)["components"]["link"]
    assert found["hold_up"] == "levitated until the mains were back, 0.04 s"
    assert found["hold_up_time"] is None


def test_the_rotor_as_a_generator_covers_what_is_consumed_down_to_a_speed():
    """P = eta T w: the capacitor has most where w = P/(eta T); a macro step changes w by 2e-4 of it."""
    torque, speed = 0.2, 150.0
    brake = {"rotor.speed": speed, "rotor.brake_points": 1, "rotor.brake[1].torque": torque}
    scene = load_scene("disk-caged-hold-up").set({**brake, "run.duration": 0.2, "link.efficiency": 0.9})
    names = ["rotor.A.omega", "link.energy.stored", "link.energy.generated", "rotor.braking.work"]
    times, values, _ = history(scene, names)
    off = times > 5.1e-3
    most = int(np.argmax(np.where(off, values["link.energy.stored"], 0.0)))
    assert values["link.energy.stored"][most] > 10.3
    expected = (STANDBY + coil_power()) / (0.9 * torque)
    assert values["rotor.A.omega"][most] == pytest.approx(expected, rel=2e-3)
    assert values["link.energy.generated"] == pytest.approx(0.9 * values["rotor.braking.work"], rel=1e-9)


def two_on_one() -> Scene:
    """Rotor I in two magnetic bearings on one link, its brake a generator; the mains fail after 5 ms."""
    scene = load_scene("rotor1-relevitated")
    wires = [Wire("rotor.braking.work", "link.braked")]
    for k, end in enumerate("AB", 1):
        wires.append(Wire("link.voltage", f"amb_{end}.link_voltage"))
        wires.append(Wire(f"amb_{end}.link_energy", f"link.actuator[{k}].energy"))
    events = {"event[1].time": 5e-3, "event[1].kind": "off"}
    components = {**scene.components, "link": ComponentSpec("dc_link", {**events, "capacitance": 1e-3})}
    scene = replace(scene, components=components, connect=(*scene.connect, *wires))
    return scene.set({"rotor.brake_points": 1, "rotor.brake[1].torque": 0.01, "run.duration": 0.02})


def test_two_actuators_on_one_link(tmp_path: Path):
    """The link takes the sum of what each tells; its account closes at each recorded time."""
    run_to_end(two_on_one(), tmp_path)
    column = {name.replace("/", "."): values for name, values in recorded(tmp_path).items()}
    taken = column["amb_A.link_energy"] + column["amb_B.link_energy"]
    assert column["link.energy.taken"] == pytest.approx(taken, rel=1e-12)
    used = sum(column[f"link.energy.{name}"] for name in ("taken", "standby", "burnt"))
    came = column["link.energy.mains"] + column["link.energy.generated"]
    lost = column["link.energy.stored"][0] - column["link.energy.stored"]
    assert np.abs(came + lost - used).max() < 1e-12
    assert column["link.voltage"][-1] < 99.0


def test_the_same_in_compiled_steps_python_and_fmus(unpacked: Mapping[str, Path], tmp_path: Path):
    """To the last bit."""
    for name, inside in (("compiled", True), ("fmus", False)):
        run_to_end(two_on_one(), tmp_path / name, in_process=inside)
    assert bits(tmp_path / "compiled" / "result.h5") == bits(tmp_path / "fmus" / "result.h5")
    _, watched, _ = history(two_on_one(), ["link.voltage"])
    assert watched["link.voltage"][-1] == recorded(tmp_path / "fmus")["link/voltage"][-1]


def test_a_package_carries_the_link(tmp_path: Path):
    """With its energies, which are outputs, and its events, to the last bit."""
    scene = load_scene("disk-caged-hold-up").set({"run.duration": 0.01})
    write_ssp(scene, tmp_path / "link.ssp")
    names = ["rotor.A.y", "link.voltage", "link.energy.stored"]
    _, expected, _ = history(scene, names)
    package = find_scene(str(tmp_path / "link.ssp"))
    assert run_to_end(package, tmp_path / "run")["seats"].keys() == {"A"}  # none of magnets
    _, found, _ = history(package, names)
    assert expected["link.voltage"][-1] < 99.9
    for name in names:
        assert np.array_equal(expected[name], found[name])


def test_a_link_that_is_not_told_and_supplies_that_do_nothing_are_said():
    scene = load_scene("disk-caged-hold-up").set({"amb.supply.decay": "1 ms"})
    scene = replace(
        scene, connect=tuple(wire for wire in scene.connect if wire.source != "amb.link_energy")
    )
    system = open_system(scene, in_process=True)
    system.close()
    said = " ".join(system.remarks)
    assert "amb.supply.decay does nothing, as link feeds amb; leave it out" in said
    assert "link is not told what amb takes, and does not run empty by it; connect amb.link_energy" in said
