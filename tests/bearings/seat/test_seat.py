"""How a bearing carries its bodies: the load handed over, the restart, the shutdown."""

from __future__ import annotations

import math

import numpy as np
import pytest
from systems import DISK, GRAVITY, history, rotor_on

from touchdown.bearings import bushing, landing_sleeve
from touchdown.bearings.magnetic import amb
from touchdown.modelkit.instance import Instance
from touchdown.modelkit.model import Model


def in_contact(order: int, model: Model = bushing.MODEL) -> Instance:
    """A bushing, or another model, with the journal pressed 10 um into it and moving on."""
    instance = Instance(model)
    instance.record["p"]["interface"]["order"] = order
    j = instance.record["u"]["journal"]
    j["y"], j["vy"], j["ay_free"], j["inv_m"] = -0.31e-3, -0.05, -GRAVITY, 1.0 / DISK
    j["omega"], j["inv_I"] = 900.0, 2000.0
    instance.start(0.0)
    return instance


def test_orders_carry_the_journal_as_they_say() -> None:
    """Held, extrapolated by velocity and acceleration, or driven by the load: forces order so."""
    step = 5e-5
    forces = []
    for order in range(4):
        instance = in_contact(order)
        instance.step(0.0, step)
        forces.append(float(instance.record["o"]["journal"]["fy"]))
    held, velocity, acceleration, model = forces
    law = 2.4e9 * (1e-5) ** 1.5 + 1e7 * 1e-5 * 0.05
    assert held == pytest.approx(law, rel=1e-9)
    deeper = sum(2.4e9 * (1e-5 + 0.05 * t) ** 1.5 + 1e7 * (1e-5 + 0.05 * t) * 0.05 for t in
                 (np.arange(2000) + 0.5) / 2000 * step) / 2000  # fmt: skip
    assert velocity == pytest.approx(deeper, rel=1e-6)
    assert velocity > model > held
    assert abs(acceleration - model) < 0.2 * abs(velocity - model)


@pytest.mark.parametrize("order", [0, 3])
def test_a_landing_sleeve_without_faces_is_a_bushing(order: int) -> None:
    """To the bit, in all that a bushing has."""
    plane, space = in_contact(order), in_contact(order, landing_sleeve.MODEL)
    for k in range(4):
        for one in (plane, space):
            one.step(5e-5 * k, 5e-5)
    found = {slot.variable.name: float(space.store(slot)[slot.index]) for slot in space.slots}
    told = {slot.variable.name: float(plane.store(slot)[slot.index]) for slot in plane.slots}
    assert told["contact.peak_force"] > 50.0
    assert {name: found[name] for name in told} == told
    assert found["journal.fz"] == found["journal.mx"] == found["shoulder.peak_force"] == 0.0


def test_the_body_ends_where_its_copy_did() -> None:
    """Impulse and first moment carry a point mass exactly: no jump at any restart."""
    rotor = {"y": -0.2999e-3, "vy": -0.07, "speed": 900.0}
    _, found, outcome = history(
        rotor_on("bushing", rotor, duration=2e-3, macro_step=1e-4),
        ["bearing.contact.force", "bearing.journal.jump", "bearing.journal.work"],
    )
    assert found["bearing.contact.force"].max() > 100.0
    assert abs(found["bearing.journal.jump"]).max() < 1e-12 * abs(found["bearing.journal.work"]).max()
    assert outcome.residual < 1e-7 * abs(found["bearing.journal.work"]).max()  # J, without a scale


def levitated(shutdown: float, step: float = 1e-3) -> Instance:
    """A magnetic bearing that found the disk's weight, not yet stepped."""
    instance = Instance(amb.MODEL)
    instance.record["p"]["shutdown_time"] = shutdown
    j = instance.record["u"]["journal"]
    j["ay_free"], j["inv_m"] = -GRAVITY, 1.0 / DISK
    instance.start(0.0)
    return instance


def test_the_magnetic_bearing_finds_the_weight_and_carries_it() -> None:
    instance = levitated(shutdown=1.0)
    instance.step(0.0, 1e-3)
    out = instance.record["o"]
    assert out["load_y"] == pytest.approx(DISK * GRAVITY)
    assert out["journal"]["fy"] == pytest.approx(DISK * GRAVITY, rel=1e-12)
    assert out["housing"]["fy"] == pytest.approx(-DISK * GRAVITY, rel=1e-12)
    assert out["active"] == 1


def test_a_shutdown_within_a_step_gives_its_impulse_and_moment() -> None:
    step, on = 1e-3, 0.3e-3
    instance = levitated(shutdown=on)
    instance.step(0.0, step)
    weight = DISK * GRAVITY
    out = instance.record["o"]["journal"]
    assert out["fy"] == pytest.approx(weight * on / step, rel=1e-9)
    moment = weight * (on**2 / 2 - on * step / 2)  # int_0^on (t - H/2) F dt
    assert out["dfy"] == pytest.approx(12.0 * moment / step**3, rel=1e-9)
    stator = instance.record["o"]["housing"]
    assert (stator["fy"], stator["dfy"]) == pytest.approx((-out["fy"], -out["dfy"]), rel=1e-9)
    instance.step(step, step)
    assert (out["fy"], out["dfy"], instance.record["o"]["active"]) == (0.0, 0.0, 0)


def test_the_magnetic_bearing_is_limited() -> None:
    instance = levitated(shutdown=1.0)
    instance.record["u"]["journal"]["x"] = 1.0
    instance.step(0.0, 1e-5)
    assert instance.record["o"]["journal"]["fx"] == pytest.approx(-1000.0, rel=1e-9)


def test_a_pushed_rotor_comes_back_as_the_gains_say() -> None:
    from dataclasses import replace

    from touchdown.master.scene.scene import ComponentSpec

    scene = rotor_on(None, {"x": 5e-5}, duration=0.03, macro_step=1e-4)
    scene = replace(
        scene,
        components={**scene.components, "amb": ComponentSpec("amb", {"shutdown_time": 1.0})},
        attach=(("amb.journal", "rotor.amb"),),
    )
    times, motion, _ = history(scene, ["rotor.A.x"])
    decay, natural = 400.0 / (2 * DISK), math.sqrt(2e5 / DISK)
    damped = math.sqrt(natural**2 - decay**2)
    exact = (
        5e-5 * np.exp(-decay * times) * (np.cos(damped * times) + decay / damped * np.sin(damped * times))
    )
    np.testing.assert_allclose(motion["rotor.A.x"], exact, atol=5e-10)
