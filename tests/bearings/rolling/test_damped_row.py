"""All balls of a row brake the ring in one kick, each with the others' damping from the kick before."""

from __future__ import annotations

import pytest
from bearing_states import instance_of

from touchdown.bearings.rolling import ring

SPEED = 0.05  # m/s, of the ring, which preloaded balls hold
STEP = 20e-6  # s


@pytest.mark.parametrize("damping", [1e7, 5e8])  # N s/m2; with more the ring stops within a micro-step
def test_what_the_ring_had_is_heat_however_much_balls_damp(damping: float) -> None:
    bearing = instance_of("simplified_cageless")
    m = bearing.memory
    m["p"]["gravity"], m["p"]["balls"]["play"], m["p"]["balls"]["damping"] = 0.0, -2e-6, damping
    bearing.start(0.0)
    m["q"][0][ring.RVX] = SPEED
    for number in range(25):
        bearing.step(number * STEP, STEP)
    had = 0.5 * float(m["p"]["ring"]["mass"][0]) * SPEED**2
    assert abs(m["q"][0][ring.RVX]) < 0.005 * SPEED  # 0.0024
    assert m["o"]["energy"]["dissipated"][0] == pytest.approx(had, rel=1e-3)  # 0.0003
