"""Detailed bearings: momentum, energy, frame, order of convergence, the source's table, hard cases."""

from __future__ import annotations

import math

import numpy as np
import pytest
from bearing_states import pressed
from systems import history, rotor_on

from touchdown.bearings import detailed_caged, detailed_cageless, seat
from touchdown.bearings.rolling import ring
from touchdown.bearings.rolling.ball_bodies import ANGLE, SIZE, SPIN, VX, VY, X, Y
from touchdown.bearings.rolling.micro_step import MICRO_STEP
from touchdown.bearings.rolling.ring import BALLS
from touchdown.master.coupling.observer import EveryStep
from touchdown.master.coupling.simulation import open_system, simulate
from touchdown.master.coupling.system import System
from touchdown.master.scene.file import load_scene
from touchdown.master.scene.scene import Scene
from touchdown.modelkit.instance import Instance
from touchdown.studies.drop.monolithic import Monolith

MODELS = {"detailed_cageless": detailed_cageless.MODEL, "detailed_caged": detailed_caged.MODEL}
SCENES = {name: f"disk-{name.removeprefix('detailed_')}-detailed" for name in MODELS}
every_model = pytest.mark.parametrize("name", list(MODELS))


def derivative(instance: Instance) -> tuple[np.ndarray, np.ndarray]:
    """(State, its derivative), the loads then standing in the outputs."""
    m, n = instance.record, int(instance.record["n"])
    q = m["q"].copy()  # with the room that loops over balls may run into
    dq = np.zeros_like(q)
    assert instance.model.instant is not None
    instance.model.instant(0.0, q, dq, instance.words)
    return q[:n], dq[:n]


def bodies(instance: Instance) -> list[tuple[float, float, np.ndarray, np.ndarray, float]]:
    """(Mass, inertia, position, acceleration, spin acceleration) of ring, balls and cage."""
    q, dq = derivative(instance)
    m = instance.record
    found = [
        (
            float(m["p"]["ring"]["mass"]),
            float(m["p"]["ring"]["inertia"]),
            q[[ring.RX, ring.RY]],
            dq[[ring.RVX, ring.RVY]],
            float(dq[ring.RW]),
        )
    ]
    count = int(m["p"]["balls"]["count"])
    mass, inertia = float(m["d"]["mass"]), float(m["d"]["inertia"])
    for b in range(count):
        i = [BALLS + b + k * count for k in range(6)]
        found.append((mass, inertia, q[[i[X], i[Y]]], dq[[i[VX], i[VY]]], float(dq[i[SPIN]])))
    if instance.model.name == "detailed_caged":
        i = [BALLS + 6 * count + k for k in range(6)]
        of_cage = float(m["p"]["cage"]["mass"]), float(m["d"]["cage_inertia"])
        found.append((*of_cage, q[[i[X], i[Y]]], dq[[i[VX], i[VY]]], float(dq[i[SPIN]])))
    return found


def sides_touch(instance: Instance) -> bool:
    return bool(np.any(instance.record["s"]["side"]["normal"] > 0.0))


@every_model
@pytest.mark.parametrize("seed", range(5))
def test_momentum_closes(name: str, seed: int) -> None:
    """What journal and housing get, and what moves ring, balls and cage, adds up to nothing."""
    instance = pressed(name, seed, **({"balls__bunching": 1.0} if name == "detailed_cageless" else {}))
    inside = bodies(instance)
    m = instance.record
    journal, housing = m["o"]["journal"], m["o"]["housing"]
    force = np.array([journal["fx"] + housing["fx"], journal["fy"] + housing["fy"]])
    at_journal = np.array([m["u"]["journal"]["x"], m["u"]["journal"]["y"]])
    at_housing = np.array([m["u"]["housing"]["x"], m["u"]["housing"]["y"]])
    moment = float(journal["mz"]) + turning(at_journal, np.array([journal["fx"], journal["fy"]]))
    moment += turning(at_housing, np.array([housing["fx"], housing["fy"]]))
    moment += float(m["s"]["outer_moment"])
    for mass, inertia, position, acceleration, alpha in inside:
        force += mass * acceleration
        moment += inertia * alpha + turning(position, mass * acceleration)
    assert sides_touch(instance)
    assert abs(journal["fy"]) > 100.0
    assert force == pytest.approx([0.0, 0.0], abs=1e-9)
    assert moment == pytest.approx(0.0, abs=1e-11)


def turning(arm: np.ndarray, force: np.ndarray) -> float:
    """Moment of a planar force (N m)."""
    return float(arm[0] * force[1] - arm[1] * force[0])


@every_model
@pytest.mark.parametrize("angle", [0.3, 2.0, -1.1])
def test_a_turned_frame_turns_the_accelerations(name: str, angle: float) -> None:
    instance = pressed(name, 1)
    q, before = derivative(instance)
    m = instance.record
    count = int(m["p"]["balls"]["count"])
    pairs = [(seat.JX, seat.JY), (seat.JVX, seat.JVY), (seat.HX, seat.HY), (seat.HVX, seat.HVY)]
    pairs += [(ring.RX, ring.RY), (ring.RVX, ring.RVY)]
    pairs += [(BALLS + b + k * count, BALLS + b + (k + 1) * count) for b in range(count) for k in (X, VX)]
    if name == "detailed_caged":
        first = BALLS + 6 * count
        pairs += [(first + X, first + Y), (first + VX, first + VY)]
        m["q"][first + ANGLE] += angle
    m["q"][ring.RANGLE] += angle
    c, s = math.cos(angle), math.sin(angle)
    expected = before.copy()
    for i, j in pairs:
        m["q"][i], m["q"][j] = c * q[i] - s * q[j], s * q[i] + c * q[j]
        expected[i], expected[j] = c * before[i] - s * before[j], s * before[i] + c * before[j]
    for part, first in (("journal", seat.JX), ("housing", seat.HX)):
        for i, key in enumerate(("x", "y", "vx", "vy")):
            m["u"][part][key] = m["q"][first + i]
    _, after = derivative(instance)
    inside = slice(seat.INSIDE, len(after))
    scale = np.max(np.abs(before[inside]))
    assert np.max(np.abs(after[inside] - expected[inside])) < 1e-9 * scale


def drop(name: str, duration: float, **settings: object) -> Scene:
    """The disk's scene of a model, shortened, with settings written `bearing__micro_step`."""
    scene = load_scene(SCENES[name]).set({"run.duration": duration})
    for key, value in settings.items():
        scene = scene.set({key.replace("__", "."): value})
    return scene


@pytest.mark.long
@every_model
def test_energy_adds_up_over_many_impacts(name: str) -> None:
    """100 ms at a tight tolerance: the ledger and the sum of all energies close within 1e-5 of m g c."""
    scene = drop(name, 0.1, bearing__micro_step=0.0, bearing__interface__tolerance=1e-8)
    scene = scene.set({"run.macro_step": 2e-5})
    parts = [
        f"{c}.energy.{k}"
        for c in ("rotor", "bearing", "housing")
        for k in ("kinetic", "potential", "dissipated")
    ]
    _, found, outcome = history(scene, [*parts, "rotor.A.work"])
    total = sum(found[p] for p in parts)
    after = found["rotor.A.work"] != 0.0
    scale = 1.65 * 9.81 * 0.3e-3
    assert outcome.residual < 1e-5
    assert np.max(np.abs(total[after] - total[after][0])) < 1e-5 * scale


def touching(name: str, **settings: object) -> Scene:
    """Rotor at the ring with its landing speed, bearing and housing at rest: no chaos before the impact."""
    rotor = {"mass": 1.65, "inertia": 0.5e-3, "speed": 942.48, "y": -0.29999e-3, "vy": -0.0767}
    values: dict[str, object] = {"gravity": 0.0, "balls.play": 0.0, **settings}
    housing = {"mass": 5.0, "outer_ring": 0.02, "gravity": 0.0}
    return rotor_on(name, rotor, values, housing, duration=4e-4, macro_step=1e-4)


def inside_at_end(scene: Scene) -> np.ndarray:
    """State of copies, ring, balls and cage at the end of a run, the ring's angle left out."""
    system = open_system(scene, in_process=True)
    simulate(scene, system)
    record = system.components["bearing"].instance.record  # type: ignore[attr-defined]
    assert record["o"]["contact"]["peak_force"] > 100.0
    q = record["q"][: int(record["n"])].copy()
    q[ring.RANGLE] = 0.0
    return q[[seat.JX, seat.JY, seat.JVX, seat.JVY, *range(seat.INSIDE, len(q))]]


LEVEL, FALLING = (0.1, 0.02), (0.15, 0.03)  # static coefficients: the curve's plateau, or a peak over it
FRICTION = {"none": ((0.0, 0.0), 2.0), "level": (LEVEL, 2.0), "falling": (FALLING, 1.0)}


@every_model
@pytest.mark.parametrize(("static", "least"), FRICTION.values(), ids=FRICTION)
def test_order_of_the_leapfrog_steps(name: str, static: tuple[float, float], least: float) -> None:
    """Second order through an impact that sets balls rolling.

    First at least where friction falls with speed: steps leave the slope out there.
    """
    side = "ball" if name == "detailed_cageless" else "cage"
    rubs = static != (0.0, 0.0)
    laws: dict[str, object] = {"contact.damping": 1e7 if rubs else 0.0}
    for law, peak, plateau in (
        ("friction", static[0], 0.1),
        ("race_friction", static[0], 0.1),
        (f"{side}_friction", static[1], 0.02),
    ):
        laws |= {f"{law}.static": peak, f"{law}.dynamic": rubs * plateau, f"{law}.g6": rubs * 1e-4}
    exact = inside_at_end(touching(name, micro_step=0.0, **{"interface.tolerance": 1e-11}, **laws))
    steps = 1.6e-7 / 2.0 ** np.arange(3)
    errors = [
        float(np.max(np.abs(inside_at_end(touching(name, micro_step=h, **laws)) - exact))) for h in steps
    ]
    slope = float(np.polyfit(np.log(steps), np.log(errors), 1)[0])
    assert least - 0.15 < slope < 2.15


# the source's Table 7, um, and the tolerance that a surrogate of its data deserves
TABLE_7 = {
    "detailed_cageless": {"contact": (27.8, 0.02), "inner": (2.72, 0.03), "outer": (2.65, 0.03)},
    "detailed_caged": {"contact": (27.4, 0.02), "inner": (3.99, 0.03), "outer": (3.88, 0.03)},
}


@every_model
def test_table_7(name: str) -> None:
    """At the first impact, medians over seven starts 1e-7 rad apart."""
    start = open_system(load_scene(SCENES[name]), in_process=True).value("bearing.balls.first_angle")
    ends = [finished(drop(name, 0.0095, bearing__balls__first_angle=start + 1e-7 * k)) for k in range(7)]
    for contact, (expected, tolerance) in TABLE_7[name].items():
        found = np.median([1e6 * end.value(f"bearing.{contact}.peak_indentation") for end in ends])
        assert found == pytest.approx(expected, rel=tolerance), contact


def finished(scene: Scene) -> System:
    """The system at the end of a run."""
    system = open_system(scene, in_process=True)
    outcome = simulate(scene, system)
    assert not outcome.reason, outcome.reason
    return system


def test_fewer_balls_bear_more_of_the_first_impact() -> None:
    forces = [finished(drop(n, 0.012)).value("bearing.balls.first_impact_force") for n in MODELS]
    assert 1.7 < forces[1] / forces[0] < 2.3


@every_model
def test_models_state_their_coordinates(name: str) -> None:
    """57 coordinates without a cage, 36 with one, and one constraint (the source's Table 5)."""
    instance = Instance(MODELS[name])
    instance.start(0.0)
    size = instance.record["o"]["size"]
    assert size["coordinates"] == {"detailed_cageless": 57, "detailed_caged": 36}[name]
    assert size["constraints"] == 1


PEAKS = ("contact.peak_force", "balls.peak_force")
HARD = {
    "zero play": {"bearing.balls.play": 0.0},
    "preload": {"bearing.balls.play": -2e-6},
    "1 um in the pockets": {"bearing.cage.clearance": 0.5e-6},
    "friction ten times steeper": {
        f"bearing.{law}.{key}": 10.0 * value
        for law in ("friction", "race_friction")
        for key, value in (("slope", 100.0), ("g2", 100.0), ("g3", 10.0))
    },
    "races a hundred times stiffer": {
        "bearing.balls.modulus": 207e11,
        "bearing.ring.modulus": 207e11,
    },
    "1e5 rpm": {"rotor.speed": "100000 rpm"},
    "bunched": {"bearing.balls.bunching": 0.8},
    "stiff contacts between balls": {"bearing.ball_contact.stiffness": 1e12},
    "stiff pockets": {"bearing.cage_contact.stiffness": 1e12},
    "light cage": {"bearing.cage.mass": 1e-5},
}

RATTLING = {  # share by which the force on one ball may differ where a caged bearing's balls rattle most
    "1 um in the pockets": 0.1,
    "stiff pockets": 0.4,
    "races a hundred times stiffer": 0.25,
}


@every_model
@pytest.mark.parametrize("case", list(HARD))
def test_hard_cases_converge_to_the_reference(name: str, case: str) -> None:
    """Default steps against adaptive ones: the first impact's peaks within 2 % and, on one ball, 8 %.

    In a cage balls rattle before the impact, chaotically: starts 1e-3 rad apart, which have nothing more in
    common, differ in the force on one ball by up to 2 % (standard deviation), by 3 to 15 % in the cases of
    `RATTLING`. Medians over seven differ by two thirds of that; the bounds are three times it. In stiff
    pockets the default steps are low, too, by about a tenth.
    """
    settings = HARD[case]
    if any(".cage" in key for key in settings) and name == "detailed_cageless":
        pytest.skip("no cage")
    if any("bunching" in key or "ball_contact" in key for key in settings) and name == "detailed_caged":
        pytest.skip("the cage keeps the balls apart")
    medians = []
    for micro in (MICRO_STEP, 0.0):
        found = []
        for start in range(7 if name == "detailed_caged" else 1):
            angle = math.pi + 1e-3 * start
            scene = drop(name, 0.0095, bearing__micro_step=micro, bearing__balls__first_angle=angle)
            for key, value in settings.items():
                scene = scene.set({key: value})
            system = finished(scene)
            found.append([system.value(f"bearing.{peak}") for peak in PEAKS])
        medians.append(np.median(found, axis=0))
    assert medians[0][0] == pytest.approx(medians[1][0], rel=0.02)
    assert medians[0][1] == pytest.approx(medians[1][1], rel=RATTLING.get(case, 0.08))


@every_model
def test_searched_circles_are_circles(name: str) -> None:
    """The contact search on races without a profile changes nothing but rounding."""
    ends = []
    for search in (0, 1):
        scene = drop(name, 0.0085, bearing__inner_profile__search=search, bearing__micro_step=5e-7)
        system = finished(scene)
        ends.append([system.value(f"bearing.{v}") for v in ("contact.peak_indentation", "ring.y")])
        assert (searches(system) > 0.0) == bool(search)
    assert np.max(np.abs(np.subtract(*ends))) < 1e-7  # rattling balls amplify rounding


def searches(system: System) -> float:
    """Contact searches that started anew; none may have failed."""
    s = system.components["bearing"].instance.record["s"]["search"]  # type: ignore[attr-defined]
    assert s["failed"] == 0.0
    return float(s["cold"])


@pytest.mark.parametrize("phase", [0.0, 0.5 * math.pi])
def test_a_lobed_race_moves_the_ring(phase: float) -> None:
    """Two lobes on the outer race give way, or not, below the pressed ring: by their mean height there."""
    height = []
    for amplitude in (0.0, 2e-6):
        profile = {"outer_profile.amplitude": amplitude, "outer_profile.phase": phase, "gravity": 0.0}
        scene = touching("detailed_cageless", micro_step=0.0, **profile)
        system = finished(scene.set({"run.duration": 6e-4}))
        height.append(system.value("bearing.ring.y"))
    given = 2e-6 * math.cos(2.0 * (-0.5 * math.pi - phase))  # outwards at the bottom
    # over the arc of loaded balls; 0.56 and 0.44, and too soon after first touch for chaos
    assert 0.4 < (height[0] - height[1]) / given < 0.8


@every_model
def test_energy_at_the_default_steps(name: str) -> None:
    """Through the first impact the leapfrog steps lose or make less than 2 % of m g c, beside the heat."""
    parts = [
        f"{c}.energy.{k}"
        for c in ("rotor", "bearing", "housing")
        for k in ("kinetic", "potential", "dissipated")
    ]
    heats = [f"bearing.heat.{part}" for part in ("journal", "inner", "balls", "outer")]
    _, found, _ = history(drop(name, 0.01), [*parts, *heats, "rotor.A.work"])
    total = sum(found[p] for p in parts)
    after = found["rotor.A.work"] != 0.0
    assert np.max(np.abs(total[after] - total[after][0])) < 0.02 * 1.65 * 9.81 * 0.3e-3
    lost = found["bearing.energy.dissipated"]
    assert lost[-1] > 1e-3
    assert sum(found[h] for h in heats) == pytest.approx(lost, rel=1e-11, abs=1e-15)  # 1e5 sums, rounded


LIGHT = {"detailed_cageless": (24, 3.608e-3, 0.02), "detailed_caged": (14, 3.5e-3, 0.1)}


@every_model
def test_many_light_balls_do_not_gain_speed(name: str) -> None:
    """Balls of 0.2 g rattle between the races, undamped, where hits take few steps; to 0.02 and 0.1 s.

    Where steps shorten only as a hit is found, a ball gains energy at every hit, up to meganewtons. None
    bears more than a part of what the rotor's landing brings: 65 to 190 N of 350 N.
    """
    count, diameter, duration = LIGHT[name]
    balls = {"bearing.balls.count": count, "bearing.balls.diameter": diameter}
    system = finished(load_scene(SCENES[name]).set({"run.duration": duration, **balls}))
    assert 50.0 < system.value("bearing.balls.peak_force") < system.value("bearing.contact.peak_force")


def test_weights_and_states_match() -> None:
    for model in MODELS.values():
        instance = Instance(model)
        instance.start(0.0)
        m = instance.record
        extra = SIZE if model.name == "detailed_caged" else 0
        assert m["n"] == BALLS + SIZE * m["p"]["balls"]["count"] + extra
        assert m["weight"][m["n"] - 1] > 0.0
        assert not np.any(m["weight"][m["n"] :])


@pytest.mark.long
@every_model
def test_adaptive_steps_follow_two_references(name: str) -> None:
    """From first touch: within 1e-6 of 10 um, 0.1 m/s and 1000 rad/s for every body, for most of 1 ms.

    Where DOP853 and Radau themselves part by more, nothing can be compared. DOP853 is asked for 1e-12: at
    1e-10 its dense output errs by 1e-6 at single points. The steps under test, at 1e-10, are 1e-7 off it.
    """
    scene = touching(name, micro_step=0.0, **{"interface.tolerance": 1e-10})
    scene = scene.set({"run.duration": 1e-3, "run.macro_step": 2e-5})
    times = 2e-5 * np.arange(1, 51)
    first = Monolith(scene).solve(times, ["rotor.A.y"], 1e-12, "DOP853").states["bearing"]
    second = Monolith(scene).solve(times, ["rotor.A.y"], 1e-8, "Radau").states["bearing"]
    rows: list[np.ndarray] = []
    system = open_system(scene, in_process=True)
    instance = system.components["bearing"].instance  # type: ignore[attr-defined]
    simulate(scene, system, observers=[EveryStep(lambda _: rows.append(instance.record["q"].copy()))])
    weight = instance.record["weight"][: first.shape[1]]
    inside = slice(seat.INSIDE, first.shape[1])
    apart = np.max(np.abs((first - second) * weight)[:, inside], axis=1)
    off = np.max(np.abs((np.array(rows)[:, : first.shape[1]] - first) * weight)[:, inside], axis=1)
    comparable = apart < 1e-6
    assert np.sum(comparable) >= 30
    assert np.max(off[comparable]) < 1e-6
