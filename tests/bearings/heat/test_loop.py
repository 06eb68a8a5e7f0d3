"""Preload, drag and heat of a pair, each of which makes the next one larger."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from touchdown.bearings import angular_simplified
from touchdown.bearings.angular.angular_row import BACK_TO_BACK
from touchdown.bearings.contact.materials import SILICON_NITRIDE, STEEL
from touchdown.bearings.heat.flash import TEMPERED
from touchdown.bearings.rolling.gaps import status_when_warm
from touchdown.modelkit.instance import Instance, ModelError
from touchdown.modelkit.kernel import interpret
from touchdown.modelkit.status import OK, TOO_HOT, TOO_MANY_STEPS

PARTS = "journal", "inner", "balls", "outer"
PAIR = {  # light, so that it gets warm soon; back to back
    "arrangement": BACK_TO_BACK, "balls.rows": 2, "balls.contact_angle": 0.44, "balls.play": 0.0,
    "row_distance": 9e-3, "preload": 100.0, "balls.density": 800.0, "ring.mass": 6e-3, "ring.inertia": 1e-7,
    "friction.kind": 0, "rolling.f1": 0.0, "rolling.resistance": 0.004, "thermal": 1,
}  # fmt: skip


def driven(step: float, until: float, speed: float, **more: float) -> Instance:
    """The pair under a journal that turns with `speed` (rad/s), pressed into its bore and held there."""
    made = Instance(angular_simplified.MODEL)
    places = {slot.variable.name: slot for slot in made.slots}
    for name, value in {**PAIR, **more}.items():
        made.store(places[name])[places[name].index] = value
    motion = made.record["u"]["journal"]
    motion["y"], motion["omega"] = -float(made.record["p"]["clearance"]) - 60e-6, speed
    made.start(0.0)
    for i in range(round(until / step)):
        made.step(i * step, step)
    return made


def test_macro_steps_do_not_change_temperatures() -> None:
    """A step of 1 ms beside one of 20 us, each up to the one that begins at 50 ms: to half a per cent."""
    found: list[Any] = [driven(step, 0.05 + step, 1500.0).record["o"] for step in (2e-5, 1e-3)]
    fine, coarse = ([float(o["temperature"][part]) for part in PARTS] for o in found)
    assert coarse == pytest.approx(fine, rel=0.005)
    assert fine[2] > 2.0
    assert float(found[1]["gaps"]["play"]) < -0.1e-6


def test_a_runaway_ends_the_run() -> None:
    """Five times the drag: heat clamps the balls, until the ring stands and the journal heats its bore."""
    with pytest.raises(
        ModelError, match=r"at t = 0\.1\d* s heat runs away .* take more play or less preload"
    ):
        driven(1e-3, 0.4, 3000.0, **{"rolling.resistance": 0.02, "ring.mass": 1e-3})
    bears = driven(1e-3, 0.12, 3000.0, **{"rolling.resistance": 0.02, "ring.mass": 1e-3}).record["o"]
    assert 30.0 < max(float(bears["temperature"][part]) for part in PARTS) < TEMPERED
    assert float(bears["balls"]["force"]) > 400.0  # of 220 N without heat


@pytest.mark.parametrize("part", range(4))
@pytest.mark.parametrize("ceramic", [(), ("balls",), ("balls", "ring")])
def test_only_steel_is_tempered(part: int, ceramic: tuple[str, ...]) -> None:
    """One part of `PARTS` is too hot for steel."""
    body = ("journal", "ring", "balls", "ring")[part]
    material = {name: SILICON_NITRIDE if name in ceramic else STEEL for name in ("balls", "ring")}
    warmth = [TEMPERED + 1.0 if i == part else TEMPERED - 1.0 for i in range(5)]
    p = SimpleNamespace(thermal=1, **{k: SimpleNamespace(material=v) for k, v in material.items()})
    m = SimpleNamespace(p=p, s=SimpleNamespace(gaps=SimpleNamespace(warmth=warmth)))
    assert interpret(status_when_warm, OK, m) == (OK if body in ceramic else TOO_HOT)
    assert interpret(status_when_warm, TOO_MANY_STEPS, m) == TOO_MANY_STEPS
    p.thermal = 0
    assert interpret(status_when_warm, OK, m) == OK
