"""The heat that each part of a bearing takes."""

from __future__ import annotations

import numpy as np
import pytest
from systems import CLEARANCE, LANDING, history, rotor_on

from touchdown.bearings.heat import shares
from touchdown.bearings.heat.shares import Sources

PARTS = ("journal", "inner", "balls", "outer")
BEND = {"ring.harmonics": 3, "ring.damping_ratio": 0.05}
RESIST = {"rolling.resistance": 0.01, "balls.damping_ratio": 0.02}
CASES = [  # beside those of `test_invariants`
    ("simplified_caged", {**RESIST, "slip": 1}),
    ("angular_simplified", {"balls.damping_ratio": 0.02, "damping": 20.0}),
    ("simplified_cageless", {**RESIST, **BEND}),
    ("detailed_caged", {"balls.damping_ratio": 0.02}),
    ("detailed_cageless", {"balls.damping_ratio": 0.02, **BEND}),
]


@pytest.mark.parametrize(("bearing", "settings"), CASES)
def test_parts_take_all_that_is_dissipated(bearing: str, settings: dict[str, object]) -> None:
    """To rounding of some thousand sums."""
    rotor = {"y": -CLEARANCE + 1e-6, "vy": -LANDING, "speed": 900.0}
    names = [*(f"bearing.heat.{part}" for part in PARTS), "bearing.energy.dissipated"]
    scene = rotor_on(bearing, rotor, settings, duration=2e-3, macro_step=2e-5)
    _, found, _ = history(scene, [*names, "bearing.contact.sliding_work"])
    taken = {part: found[f"bearing.heat.{part}"] for part in PARTS}
    dissipated = found["bearing.energy.dissipated"]
    assert dissipated[-1] > 1e-3
    assert np.allclose(sum(taken.values()), dissipated, rtol=0.0, atol=1e-11 * dissipated[-1])
    assert taken["journal"][-1] > 0.1 * dissipated[-1]
    assert taken["balls"][-1] > 0.0
    assert taken["balls"][-1] >= taken["outer"][-1]  # which has half of what arises at the outer race
    work = found["bearing.contact.sliding_work"]
    assert np.all(np.diff(work) >= 0.0)
    assert work[-1] > 0.0


def test_sliding_work_makes_the_journal_s_heat() -> None:
    """Sliding at speed, friction is the dynamic coefficient: half its heat is the journal's."""
    rotor = {"y": -CLEARANCE + 1e-6, "vy": -LANDING, "speed": 900.0}
    settings = {"friction.static": 0.2, "friction.dynamic": 0.2, "contact.damping": 0.0}
    names = ["bearing.heat.journal", "bearing.heat.inner", "bearing.contact.sliding_work"]
    _, found, _ = history(rotor_on("bushing", rotor, settings, duration=2e-3, macro_step=2e-5), names)
    journal, inner, work = (found[name][-1] for name in names)
    assert journal == pytest.approx(0.1 * work, rel=0.01)  # the law is 0.4 % above the coefficient
    assert inner == journal


def test_contacts_share_alike() -> None:
    to = np.zeros(shares.SIZE)
    shares.add_heat(Sources(2.0, 3.0, 4.0, 8.0, 16.0), to, 0)
    assert to.tolist() == [1.0, 6.0, 22.0, 4.0, 0.0]
