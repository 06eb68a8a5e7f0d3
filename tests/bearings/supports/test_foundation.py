"""A foundation under several seats: mounts where it does not move, two masses, energy, rotor I on it."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import expm
from systems import dropped, history

from touchdown.bearings.supports import foundation, mount
from touchdown.master.scene.scene import ComponentSpec, Scene
from touchdown.modelkit.instance import Instance
from touchdown.modelkit.model import Model
from touchdown.studies.drop.monolithic import Monolith

RICH = {
    "mass": 0.5, "spring.xx": 8e6, "spring.yy": 4e6, "spring.xy": 1e6, "spring.yx": 1.2e6,
    "damper.xx": 100.0, "damper.yy": 50.0, "slide[1].stiffness": 1e7, "slide[1].force": 150.0,
    "branch[1].stiffness": 4e6, "branch[1].time": 3e-4, "stop.gap": 1e-4, "stop.stiffness": 1e10,
    "stop.dissipation": 0.3, "film.viscosity": 0.01, "film.clearance": 3e-4,
}  # fmt: skip
QUIET = {"mass": 2.0, "spring.xx": 1e6, "spring.yy": 1e6, "damper.xx": 10.0, "damper.yy": 10.0}


def started(model: Model, values: dict[str, float]) -> Instance:
    """A started instance with these parameters."""
    made = Instance(model)
    places = {slot.variable.name: slot for slot in made.slots}
    for name, value in values.items():
        made.store(places[name])[places[name].index] = value
    made.start(0.0)
    return made


def at(seat: str, values: dict[str, float]) -> dict[str, float]:
    """Settings of a mount at a seat of a foundation."""
    return {f"mount_{seat}.{name}": value for name, value in values.items()}


def test_on_rigid_ground_each_seat_is_a_mount() -> None:
    """Without modes, whatever is in the mounts; rounding that a stop makes larger."""
    generator = np.random.default_rng(2)
    whole = started(foundation.MODEL, {"seats": 2, **at("A", RICH), **at("B", QUIET)})
    alone = started(mount.MODEL, RICH)
    for i in range(300):
        phase = 0.04 * i
        force = 1500.0 * math.sin(phase), 1500.0 * math.cos(phase), *(1e6 * generator.normal(size=2))
        for u in (whole.record["u"]["seat"][0], alone.record["u"]["seat"][0]):
            u["fx"], u["fy"], u["dfx"], u["dfy"] = force
        for made in (whole, alone):
            made.step(2e-5 * i, 2e-5)
    one, other = whole.record["o"]["strokes"][0], alone.record["o"]["strokes"][0]
    assert other["stop_hits"] > 0
    assert one["stop_hits"] == other["stop_hits"]
    for name in ("stroke", "peak_stroke", "peak_stop_force", "stop_time"):
        assert one[name] == pytest.approx(other[name], rel=1e-9), name
    assert one["heat"]["slide"] == pytest.approx(other["heat"]["slide"], rel=1e-9)


def test_two_seats_on_one_mode_are_two_masses() -> None:
    """Carriers that move as one, 2 m on 2 k, on a mode of M and w: two masses' exponential, to 1e-9."""
    m, k, big, omega, push, time = 2.0, 3e6, 15.0, 900.0, 100.0, 1e-2
    values = {"seats": 2, "modes": 1, "gravity": 0.0, "mode[1].omega": omega, "mode[1].mass": big}
    springs = {"mass": m, "outer_ring": 0.0, "damper.xx": 0.0, "damper.yy": 0.0}
    for seat in "AB":
        values |= {f"mode[1].{seat}.y": 1.0, **at(seat, springs | {"spring.xx": k, "spring.yy": k})}
    made = started(foundation.MODEL, values)
    for i in range(2000):
        made.record["u"]["seat"]["fy"][:2] = push
        made.step(5e-6 * i, 5e-6)
    rates = np.zeros((5, 5))  # of carriers x, mode u, their speeds, and 1
    rates[0, 2] = rates[1, 3] = 1.0
    rates[2] = -k / m, k / m, 0.0, 0.0, push / m
    rates[3] = 2.0 * k / big, -2.0 * k / big - omega**2, 0.0, 0.0, 0.0
    x, u = (expm(rates * time) @ [0.0, 0.0, 0.0, 0.0, 1.0])[:2]
    still = 2.0 * push / (big * omega**2) + push / k
    assert max(abs(x), abs(u)) > 0.3 * still
    found = made.record["o"]
    for j in range(2):
        assert found["seat"][j]["y"] == pytest.approx(x, abs=1e-9 * still)
        assert found["strokes"][j]["stroke"] == pytest.approx(abs(x - u), abs=1e-9 * still)


ELASTIC = {
    "seats": 3, "modes": 2, "mode[1].omega": 800.0, "mode[1].damping_ratio": 0.02, "mode[1].mass": 20.0,
    "mode[1].A.y": 1.0, "mode[1].B.y": 0.8, "mode[1].C.x": 0.3, "mode[2].omega": 2500.0,
    "mode[2].mass": 8.0, "mode[2].A.x": 1.0, "mode[2].A.y": 0.2, "mode[2].B.x": -0.7, "mode[2].C.y": 1.0,
    **at("A", RICH), **at("B", {**RICH, "mass": 0.8, "slide[1].force": 60.0}),
    **at("C", {"mass": 1.5, "spring.xx": 1e7}),
}  # fmt: skip


@pytest.mark.parametrize("step", [2e-5, 1e-3])
def test_energy_closes_whatever_the_step(step: float) -> None:
    """Shaken at all seats until stops are hit; work is heat and energy, to rounding."""
    made = started(foundation.MODEL, ELASTIC)
    generator, o = np.random.default_rng(1), made.record["o"]
    energy, before = o["energy"]["kinetic"] + o["energy"]["potential"], 0.0
    for i in range(round(0.05 / step)):
        for j in range(3):
            u, phase = made.record["u"]["seat"][j], 2e3 * i * step + j
            u["fx"], u["fy"] = (
                1500.0 * math.sin(phase) + 300.0 * generator.normal(),
                1500.0 * math.cos(phase),
            )
            u["dfx"], u["dfy"] = 1e6 * generator.normal(size=2)
        made.step(i * step, step)
        before = float(o["modes_heat"])
    work = sum(float(o["seat"][j]["work"]) for j in range(3))
    gained, heat = o["energy"]["kinetic"] + o["energy"]["potential"] - energy, o["energy"]["dissipated"]
    assert o["strokes"][0]["stop_hits"] > 0
    assert before > 1e-6
    assert abs(work - heat - gained) < 1e-12 * heat


def test_it_rests_under_its_carriers() -> None:
    made = started(foundation.MODEL, ELASTIC)
    first = np.array(made.record["q"])
    assert first[1] < -1e-6
    for i in range(50):
        made.step(2e-5 * i, 2e-5)
    assert np.max(np.abs(np.array(made.record["q"])[:8] - first[:8])) < 1e-12


FALL = 0.33e-3  # m, of rotor I
SOFT = {"mass": 0.5, "outer_ring": 0.02, "spring.xx": 1e7, "spring.yy": 1e7, "damper.xx": 500.0}
SOFT["damper.yy"] = 500.0
SHARED = {
    "modes": 2, "mode[1].omega": 1500.0, "mode[1].mass": 20.0, "mode[1].damping_ratio": 0.01,
    "mode[1].A.y": 1.0, "mode[1].B.y": 0.7, "mode[2].omega": 3000.0, "mode[2].mass": 10.0,
    "mode[2].A.x": 1.0, "mode[2].B.x": -0.8, "mode[2].A.y": 0.3, **at("A", SOFT), **at("B", SOFT),
}  # fmt: skip


def rotor_on(changes: dict[str, float]) -> Scene:
    """Rotor I that falls from rest onto two caged bearings on one foundation, past the first impacts."""
    scene = dropped().set({"amb_*.shutdown_time": 0.0, "run.duration": 9e-3, "run.macro_step": 2e-6})
    scene = scene.set({"bearing_*.interface.tolerance": 1e-9})
    parts = {name: spec for name, spec in scene.components.items() if not name.startswith("housing")}
    parts["foundation"] = ComponentSpec("foundation", {**SHARED, **changes})
    seats = {f"housing_{end}.seat": f"foundation.{end}" for end in "AB"}
    attach = tuple((bearing, seats.get(body, body)) for bearing, body in scene.attach)
    return replace(scene, components=parts, attach=attach)


RUBBING = {
    "mount_A.slide[1].stiffness": 2e7, "mount_A.slide[1].force": 20.0,
    "mount_B.stop.gap": 1e-5, "mount_B.stop.stiffness": 1e10, "mount_B.film.viscosity": 0.01,
}  # fmt: skip


def test_rotor_1_on_it_moves_as_one_system_does() -> None:
    """All equations joined and solved by scipy: places of journals and carriers, over the fall's 0.33 mm.

    At macro steps of 2 us, of second order with friction: found 1e-6.
    """
    scene = rotor_on(RUBBING)
    names = [f"{part}.{end}.{axis}" for part in ("rotor", "foundation") for end in "AB" for axis in "xy"]
    force = "bearing_A.contact.peak_force"
    time, found, _ = history(scene, [*names, force, "foundation.mount_B.stop_hits"])
    assert found[force][-1] > 500.0
    assert found["foundation.mount_B.stop_hits"][-1] > 0
    asked = np.linspace(7e-3, 9e-3, 5)
    joined = Monolith(scene).solve(asked, names, 1e-9, "DOP853")
    rows = [int(np.argmin(np.abs(time - t))) for t in asked]
    for name in names:
        apart = np.max(np.abs(found[name][rows] - joined.series[name]))
        assert apart < 4e-6 * FALL, name
