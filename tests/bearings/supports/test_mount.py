"""A carrier on its mount: closed forms, energy whatever the step, and drops onto it."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.linalg import expm
from systems import history

from touchdown.bearings.supports import mount
from touchdown.bearings.supports.mount_law import mount_dynamic_stiffness
from touchdown.master.scene.file import load_scene
from touchdown.master.scene.scene import Scene
from touchdown.modelkit.instance import Instance
from touchdown.modelkit.model import ModelError, StepSizeError
from touchdown.modelkit.variables import from_record

BARE = {"gravity": 0.0, "outer_ring": 0.0, "mass": 0.5} | {
    f"{part}.{axes}": 0.0 for part in ("spring", "damper") for axes in ("xx", "yy")
}
SOFT = {"spring.xx": 1e7, "spring.yy": 1e7}
ALL = BARE | {
    "mass": 0.4, "outer_ring": 0.02, "gravity": 9.81,
    "spring.xx": 8e6, "spring.yy": 4e6, "spring.xy": 1e6, "spring.yx": 1.2e6,
    "damper.xx": 100.0, "damper.yy": 50.0,
    "slide[1].stiffness": 1e7, "slide[1].force": 150.0, "slide[2].stiffness": 5e6, "slide[2].force": 300.0,
    "branch[1].stiffness": 4e6, "branch[1].time": 3e-4,
    "stop.gap": 1e-4, "stop.stiffness": 1e10, "stop.dissipation": 0.3,
    "film.viscosity": 0.01, "film.clearance": 3e-4,
}  # fmt: skip


def on(values: dict[str, float], **state: float) -> Instance:
    """A started mount with these parameters, without gravity and with nothing else under 0.5 kg."""
    made = Instance(mount.MODEL)
    places = {slot.variable.name: slot for slot in made.slots}
    for name, value in {**BARE, **values}.items():
        made.store(places[name])[places[name].index] = value
    made.start(0.0)
    for name, value in state.items():
        made.record["q"][["x", "y", "vx", "vy"].index(name)] = value
    return made


def swing(made: Instance, step: float, count: int) -> np.ndarray:
    """x, y, vx, vy at each step's end, (count + 1, 4)."""
    states = [np.array(made.record["q"][:4])]
    for i in range(count):
        made.step(i * step, step)
        states.append(np.array(made.record["q"][:4]))
    return np.array(states)


def test_a_linear_mount_swings_as_its_equations_do() -> None:
    """Coupled springs and dampers, to 1e-8 over 15 rad, whatever the macro step: order six at 0.25 rad."""
    k = {"spring.xx": 1e7, "spring.yy": 4e6, "spring.xy": 1e6, "spring.yx": -5e5}
    c = {"damper.xx": 100.0, "damper.yy": 200.0, "damper.xy": 30.0}
    stiff, damp = np.array([[1e7, 1e6], [-5e5, 4e6]]), np.array([[100.0, 30.0], [0.0, 200.0]])
    a = np.block([[np.zeros((2, 2)), np.eye(2)], [-2.0 * stiff, -2.0 * damp]])
    start = np.array([1e-4, -2e-5, 0.1, 0.2])
    for step in (2e-5, 1e-4, 5e-4):
        made = on(k | c, **dict(zip(("x", "y", "vx", "vy"), start, strict=True)))
        found = swing(made, step, round(3e-3 / step))
        expected = expm(3e-3 * a) @ start
        assert np.max(np.abs((found[-1] - expected) / (1e-4, 1e-4, 0.5, 0.5))) < 1e-8


@pytest.mark.parametrize("turn", [0.3, 3.0])
def test_a_branch_has_its_complex_stiffness(turn: float) -> None:
    """Swung by a force for 40 times its relaxation; force over way less inertia, to 2e-5."""
    k, tau, mass = 5e6, 1e-3, 0.5
    omega = turn / tau
    made = on({"branch[1].stiffness": k, "branch[1].time": tau, "damper.xx": 50.0, "damper.yy": 50.0})
    cycles, count = max(4, round(40.0 * turn / (2.0 * math.pi)) * 4), 256
    step = 2.0 * math.pi / omega / count
    load, ways = made.record["u"]["seat"][0], []
    lag = np.sinc(0.5 / count * 2.0)  # of the mean of a sine over a step
    bend = 3.0 * (np.sin(0.5 * omega * step) / (0.5 * omega * step) - np.cos(0.5 * omega * step))
    slope = bend / (0.5 * omega * step) ** 2 * omega  # of its best line there
    for i in range(cycles * count):
        middle = omega * (i + 0.5) * step
        load["fx"], load["dfx"] = lag * math.cos(middle), -slope * math.sin(middle)
        made.step(i * step, step)
        ways.append(float(made.record["q"][0]))
    angles = 2.0 * math.pi * np.arange(1, count + 1) / count
    way = 2.0 / count * np.sum((np.array(ways[-count:]) - np.mean(ways[-count:])) * np.exp(-1j * angles))
    found = 1.0 / way + mass * omega**2
    parameters = from_record(mount.Parameters, made.record["p"]).mount[0]
    expected = mount_dynamic_stiffness(parameters, omega)[0, 0]
    part = 1j * turn / (1.0 + 1j * turn)
    assert expected == pytest.approx(k * part + 50j * omega, rel=1e-12)
    assert found == pytest.approx(expected, rel=2e-5)


def test_a_stop_gives_the_speed_back_after_its_time() -> None:
    """Undamped, exponent 3/2: as fast as before, 2.9433 depths over the speed later (Hertz)."""
    made = on({"stop.gap": 1e-4, "stop.stiffness": 1e10}, x=0.999e-4, vx=0.3)
    step, entered, left = 1e-6, None, None
    for i in range(4000):
        made.step(i * step, step)
        x, vx = float(made.record["q"][0]), float(made.record["q"][2])
        entered = i if entered is None and x > 1e-4 else entered
        if vx < 0.0 and x < 1e-4:
            left = i
            break
    assert entered is not None
    assert left is not None
    assert -float(made.record["q"][2]) == pytest.approx(0.3, rel=1e-12)
    deepest = (1.25 * 0.5 * 0.3**2 / 1e10) ** 0.4
    assert (left - entered) * step == pytest.approx(2.943275 * deepest / 0.3, abs=2.0 * step)
    o = made.record["o"]["strokes"][0]
    assert o["stop_hits"] == 1
    assert o["stop_time"] == pytest.approx(1e-7 / 0.3, rel=1e-3)
    assert o["peak_stroke"] - 1e-4 == pytest.approx(deepest, rel=1e-5)
    assert o["peak_stop_force"] == pytest.approx(1e10 * deepest**1.5, rel=2e-5)


@pytest.mark.parametrize("step", [2e-5, 1e-3])
def test_energy_closes_with_everything_whatever_the_step(step: float) -> None:
    """Shaken at random against the stop: work is heat and energy, to rounding; heat never comes back.

    Cross-coupling of the springs is left out of the latter, as it feeds the carrier now and then.
    """
    made = on(ALL)
    generator, o, load = np.random.default_rng(1), made.record["o"], made.record["u"]["seat"][0]
    energy = o["energy"]["kinetic"] + o["energy"]["potential"]
    strokes = o["strokes"][0]
    heats = [list(strokes["heat"])]
    for i in range(round(0.1 / step)):
        phase = 2e3 * i * step
        load["fx"] = 1500.0 * math.sin(phase) + 300.0 * generator.standard_normal()
        load["fy"] = 1500.0 * math.cos(phase)
        load["dfx"], load["dfy"] = 1e6 * generator.standard_normal(2)
        made.step(i * step, step)
        heats.append(list(strokes["heat"]))
    gained = o["energy"]["kinetic"] + o["energy"]["potential"] - energy
    heat = o["energy"]["dissipated"]
    assert strokes["stop_hits"] > 0
    assert strokes["peak_stop_force"] > 1000.0
    assert abs(o["seat"][0]["work"] - heat - gained) < 1e-12 * heat
    assert heat == pytest.approx(sum(heats[-1]), rel=1e-14)
    assert np.min(np.diff(np.array(heats)[:, 1:], axis=0)) >= -1e-15 * heat
    assert np.min(np.array(heats)[-1, 1:]) > 0.0


def test_steps_converge_in_second_order_with_everything() -> None:
    """A ring-down with slides, rubber, film and a stop that is hit: a sixteenth at a quarter of it."""
    ends = {}
    for count in (400, 1600, 25600):  # short enough that none is divided
        made = on({**ALL, "gravity": 0.0}, x=8e-5, vx=1.0, vy=0.5)
        ends[count] = swing(made, 2e-3 / count, count)[-1, :2]
    far = {count: np.hypot(*(ends[count] - ends[25600])) for count in (400, 1600)}
    assert far[1600] < far[400] / 8.0
    assert far[400] < 2e-3 * np.hypot(*ends[25600])
    assert made.record["o"]["strokes"][0]["stop_hits"] > 0


def test_a_carrier_rests_where_springs_and_stop_bear_it() -> None:
    weight = 9.81 * 0.5
    plain = on({**SOFT, "gravity": 9.81})
    assert plain.record["q"][1] == pytest.approx(-weight / 1e7, rel=1e-12)
    on_stop = on({"gravity": 9.81, "stop.gap": 1e-5, "stop.stiffness": 1e10})
    stroke = on_stop.record["o"]["strokes"][0]["stroke"]
    assert stroke == pytest.approx(1e-5 + (weight / 1e10) ** (2 / 3), rel=1e-9)
    for made in (plain, on_stop):
        states = swing(made, 2e-5, 50)
        assert np.max(np.abs(states[:, :2] - states[0, :2])) < 1e-12
    assert plain.record["o"]["strokes"][0]["stop_hits"] == 0


def test_a_saved_state_goes_on_with_other_steps() -> None:
    """What was prepared for one length of step is not part of the state."""
    one, other = on(ALL, x=5e-5), on(ALL)
    swing(one, 2e-5, 20)
    kept = one.save()
    other.step(0.0, 7e-5)
    for made in (one, other):
        made.restore(kept)
        made.step(4e-4, 3e-5)
    assert one.save() == other.save()


def test_dampers_that_drive_are_refused() -> None:
    for wrong in ({"damper.xx": -1.0}, {"damper.xx": 1.0, "damper.yy": 1.0, "damper.xy": 5.0}):
        with pytest.raises(ModelError, match="drives the carrier"):
            on(wrong)


def peaks(scene: Scene, names: list[str], until: float, step: float | None = None) -> np.ndarray:
    """Last values of a drop until `until` (s), at macro steps of `step` (s) where one is given."""
    run = {"run.duration": until, "run.warn_residual": 1e9, "run.stop_residual": 1e9}
    scene = scene.set(run if step is None else {**run, "run.macro_step": step})
    _, found, _ = history(scene, names)
    return np.array([found[name][-1] for name in names])


def test_a_linear_mount_is_a_housing() -> None:
    """Peaks of the first impacts and where everything is after them, on either: 1e-8, found 1e-9."""
    scene = load_scene("disk-caged-simplified")
    same = scene.swap(housing="mount")
    names = ["bearing.contact.peak_force", "bearing.balls.peak_force", "housing.seat.x", "housing.seat.y"]
    one, other = (peaks(s, names, 12e-3) for s in (scene, same))
    assert np.min(one[:2]) > 60.0
    np.testing.assert_allclose(other, one, rtol=1e-8, atol=1e-14)


def test_a_step_that_is_not_solved_is_refused() -> None:
    """Held beyond its film's clearance and shaken: it is said, and until then energy closes to rounding."""
    film = {"film.viscosity": 0.01, "film.length": 0.02, "film.radius": 0.03, "film.clearance": 15e-6}
    made = on({**film, "mass": 12.0, "spring.xx": 5e6, "spring.yy": 5e6}, y=-23.544e-6)
    o, load, step, force, said = made.record["o"], made.record["u"]["seat"][0], 1e-4, 200.0, ""
    held = 0.5 * 5e6 * 23.544e-6**2
    for i in range(200):
        angle = 2.0 * math.pi * 200.0 * i * step
        load["fx"], load["fy"] = force * math.sin(angle), force * math.cos(angle) - 117.72
        try:
            made.step(i * step, step)
        except StepSizeError as error:
            said = str(error)
            break
    assert "with a macro step of 0.0001 s: film, stop or slides act too fast" in said
    assert "Take a macro step of 1e-05 s" in said
    e = o["energy"]
    assert e["dissipated"] > 1e-7
    missing = o["seat"][0]["work"] - e["dissipated"] - (e["kinetic"] + e["potential"] - held)
    assert abs(missing) < 1e-9 * held


def test_a_film_that_would_have_to_bear_the_carrier_is_refused() -> None:
    """12 kg on 5 N/um sag by 23.544 um; a stop that holds them within the clearance will do."""
    heavy = {"gravity": 9.81, "mass": 12.0, "spring.xx": 5e6, "spring.yy": 5e6}
    film = {"film.viscosity": 0.01, "film.clearance": 20e-6}
    with pytest.raises(
        ModelError, match=r"sags by 23\.544 um under its weight, but film\.clearance is 20 um"
    ):
        on(heavy | film)
    on(heavy | film | {"film.viscosity": 0.0})
    on(heavy | film | {"film.clearance": 24e-6})
    on(heavy | film | {"stop.gap": 10e-6, "stop.stiffness": 1e11})
