"""Play and clearance that follow temperatures and spins: closed forms, energy, and nothing where off."""

from __future__ import annotations

import numpy as np
import pytest
from systems import CLEARANCE, LANDING, history, rotor_on

from touchdown.bearings import (
    angular_caged,
    angular_cageless,
    angular_simplified,
    detailed_cageless,
    simplified_caged,
)
from touchdown.bearings.angular.angular_row import BACK_TO_BACK, ball_rows
from touchdown.bearings.catalogue import bearing
from touchdown.bearings.catalogue.spinning import spun
from touchdown.bearings.contact.materials import STEEL_DENSITY, STEEL_NUMBERS
from touchdown.bearings.heat.growth import spin_growth
from touchdown.bearings.heat.warm_parts import (
    BALLS,
    INNER,
    ball_growth,
    bodies_by,
    clearance_change,
    play_change,
    strain_along,
)
from touchdown.bearings.rolling import ring
from touchdown.modelkit.instance import Instance
from touchdown.modelkit.kernel import interpret
from touchdown.modelkit.model import Model

# one of each way to step
EACH = (simplified_caged, detailed_cageless, angular_cageless, angular_caged, angular_simplified)
PARTS = ("journal", "inner", "balls", "outer", "housing")


def started(model: Model, values: dict[str, float]) -> Instance:
    """A started bearing whose journal is held in the middle."""
    made = Instance(model)
    places = {slot.variable.name: slot for slot in made.slots}
    for name, value in values.items():
        made.store(places[name])[places[name].index] = value
    made.start(0.0)
    return made


def energy(made: Instance) -> float:
    """All that a bearing has, and has made heat (J)."""
    return float(sum(made.record["o"]["energy"][part] for part in ("kinetic", "potential", "dissipated")))


@pytest.mark.parametrize("module", EACH[:4], ids=lambda m: m.__name__.rpartition(".")[2])
def test_hot_balls_preload_a_bearing_at_the_cost_of_their_heat(module: object) -> None:
    """Balls warmed by 60 K between cold rings: 3 um of preload, and its elastic energy is heat no more.

    To a per cent: the work of a step is the force before it times the change, 400 steps to the whole.
    """
    made = started(module.MODEL, {"thermal": 1, "balls.play": 0.0, "gravity": 0.0})  # type: ignore[attr-defined]
    given = {name: float(slot_value(made, name)) for name in names_of(made)}
    capacity = 460.0 * bodies_by({**given, "housing.inv_m": 0.0}).ball_mass
    steps, step, warmth = 400, 1e-5, 60.0
    before = energy(made)
    for i in range(steps):
        made.record["q"][ring.HEAT + BALLS] += capacity * warmth / steps
        made.step(i * step, step)
    o = made.record["o"]
    assert o["temperature"]["balls"] == pytest.approx(warmth, rel=0.01)  # less what flows off in 4 ms
    assert o["gaps"]["play"] == pytest.approx(-11.5e-6 * given["balls.diameter"] * warmth, rel=0.02)
    assert o["balls"]["loaded"] == given["balls.count"]
    assert o["energy"]["potential"] > 1e-4
    assert o["energy"]["dissipated"] < 0.0
    assert energy(made) - before == pytest.approx(0.0, abs=0.01 * float(o["energy"]["potential"]))
    heat = sum(float(o["heat"][part]) for part in PARTS[:4]) - capacity * warmth
    assert heat == pytest.approx(float(o["energy"]["dissipated"]), abs=1e-9 * capacity * warmth)


PAIR = {
    "arrangement": BACK_TO_BACK, "balls.rows": 2, "balls.contact_angle": 0.44, "balls.play": 0.0,
    "row_distance": 9e-3, "preload": 50.0, "thermal": 1, "gravity": 0.0, "balls.damping_ratio": 0.05,
}  # fmt: skip


@pytest.mark.parametrize("part", [INNER, BALLS])
@pytest.mark.parametrize("module", EACH[2:4], ids=lambda m: m.__name__.rpartition(".")[2])
def test_heat_clamps_a_pair(module: object, part: int) -> None:
    """By 40 K in the inner ring, across and along the shaft, or in the balls: forces in closed form.

    To two per cent: friction keeps a ball a little off the line between its grooves.
    """
    made = started(module.MODEL, PAIR)  # type: ignore[attr-defined]
    steps, step, before = 200, 2e-5, energy(made)
    given = bodies_by({name: float(slot_value(made, name)) for name in names_of(made)})
    heat = 460.0 * 40.0 * (given.ring_mass if part == INNER else given.ball_mass)
    for i in range(steps):
        made.record["q"][ring.HEAT + part] += heat / steps
        made.step(i * step, step)
    p, o = made.record["p"], made.record["o"]
    warmth = np.array([o["temperature"][name] for name in PARTS])
    assert warmth[part] == pytest.approx(40.0, rel=0.02)
    clamped = float(p["preload"]), 0.0, 0.0
    row, _ = interpret(
        ball_rows, p["balls"], STEEL_NUMBERS, PAIR["balls.contact_angle"], BACK_TO_BACK, 9e-3, clamped
    )
    grown = -play_change(given, warmth) - ball_growth(given, warmth)
    across, along = (
        row.inner + grown - row.outer,
        row.inner_at * (1.0 + strain_along(given, warmth)) - row.outer_at,
    )
    cold = np.hypot(row.inner - row.outer, row.inner_at - row.outer_at) - row.free
    depth = np.hypot(across, along) - row.free + ball_growth(given, warmth)
    forces = [float(o["ball"][b]["inner"]) for b in range(2 * int(p["balls"]["count"]))]
    assert depth > 1.3 * cold
    assert forces == pytest.approx([row.stiffness * depth**1.5] * len(forces), rel=0.02)
    assert energy(made) - before == pytest.approx(0.0, abs=0.01 * float(o["energy"]["potential"]))


@pytest.mark.parametrize("module", EACH, ids=lambda m: m.__name__.rpartition(".")[2])
def test_both_kernels_take_a_step_to_the_same_bits(module: object) -> None:
    """A landing, in space on a tilted journal that turns, where no effect acts."""
    model = module.MODEL  # type: ignore[attr-defined]
    memory = []
    for advance in (model.advance, model.advance_without):
        made = started(model, {})
        made.advance = advance
        motion = made.record["u"]["journal"]
        motion["omega"], motion["vy"], motion["inv_m"] = 900.0, -LANDING, 0.6
        for name, value in {"rx": 1e-4, "wy": 0.1, "inv_I_t": 50.0, "inv_mI": 2.0, "gyro": 800.0}.items():
            if name in (motion.dtype.names or ()):
                motion[name] = value
        for i in range(20):
            motion["y"] = -float(made.record["p"]["clearance"]) - 1e-6 * (i + 1)
            made.step(1e-5 * i, 1e-5)
        assert made.record["o"]["contact"]["force"] > 0.0
        memory.append(made.words.tobytes())
    assert memory[0] == memory[1]


def names_of(made: Instance) -> list[str]:
    """Parameters of balls, ring, journal and bore."""
    known = [slot.variable.name for slot in made.slots]
    start = ("balls.", "ring.", "journal_radius", "clearance", "contact.length")
    return [n for n in known if n.startswith(start) and "[" not in n]


def slot_value(made: Instance, name: str) -> float:
    """Of the parameter or output first declared with that name."""
    slot = next(slot for slot in made.slots if slot.variable.name == name)
    return made.store(slot)[slot.index]


SPINNING = {"y": -CLEARANCE + 1e-6, "vy": -LANDING, "speed": 900.0}
OWN = [f"bearing.temperature.{part}" for part in PARTS]
HEAT = [f"bearing.heat.{part}" for part in PARTS[:4]]
GAPS = ["bearing.gaps.play", "bearing.gaps.clearance"]


def test_gaps_follow_the_temperatures_of_a_drop() -> None:
    """Play and clearance are those of the temperatures told beside them; without thermal = 1 they stay."""
    names = [*OWN, *HEAT, *GAPS, "bearing.contact.force", "bearing.energy.dissipated"]
    runs = [
        history(rotor_on("simplified_caged", SPINNING, settings, duration=4e-3, macro_step=2e-5), names)[1]
        for settings in ({}, {"thermal": 1})
    ]
    cold, warm = runs
    assert np.max(cold["bearing.contact.force"]) > 100.0
    assert np.ptp(cold["bearing.gaps.play"]) == np.ptp(cold["bearing.gaps.clearance"]) == 0.0
    assert not any(np.any(cold[name]) for name in OWN)
    values = {slot.variable.name: slot.variable.default for slot in Instance(simplified_caged.MODEL).slots}
    own = bodies_by({**values, "housing.inv_m": 0.0})
    warmth = np.array([warm[name][-1] for name in OWN])
    assert warmth[1] > 0.01
    assert warm["bearing.gaps.play"][-1] - 5e-6 == pytest.approx(play_change(own, warmth), rel=1e-9)
    found = warm["bearing.gaps.clearance"][-1] - values["clearance"]
    assert found == pytest.approx(clearance_change(own, warmth), rel=1e-6)
    heat = sum(warm[name] for name in HEAT)
    assert np.allclose(heat, warm["bearing.energy.dissipated"], rtol=0.0, atol=1e-11 * heat[-1])


def test_a_ring_grows_with_its_own_spin() -> None:
    """Of a 6904 at once by the journal's, then by the ring's spin at the beginning of each macro step."""
    names = [*GAPS, "bearing.ring.omega", "rotor.A.omega"]
    settings = {"ring.growth": 1, "journal_radius": 9.7e-3, "clearance": 0.3e-3}
    scene = rotor_on("simplified_cageless", SPINNING, settings, duration=4e-3, macro_step=2e-5)
    _, found, _ = history(scene, names)
    spin, play, clearance = (found[n] for n in ("bearing.ring.omega", *GAPS))
    assert spin[-1] > 100.0
    inside = [spin_growth(10e-3, 11.85e-3, w, STEEL_DENSITY, STEEL_NUMBERS) for w in spin[:-1]]
    shaft = spin_growth(0.0, 9.7e-3, float(found["rotor.A.omega"][-2]), STEEL_DENSITY, STEEL_NUMBERS)
    np.testing.assert_allclose(play[1:], [-one.rim for one in inside], rtol=1e-9)
    assert clearance[-1] - 0.3e-3 == pytest.approx(inside[-1].bore - shaft.rim, rel=1e-5)
    at_18000 = spun(bearing("6904"), 18000.0 * np.pi / 30.0)  # 0.1792 um, as its catalogue's page has it
    scaled = inside[-1].bore * (18000.0 * np.pi / 30.0 / spin[-2]) ** 2
    assert scaled == pytest.approx(at_18000.bore, rel=1e-9)
