"""The flexible rotor obeys the laws of motion, rigid or not."""

from __future__ import annotations

import math

import numpy as np
import pytest
from rotor_alone import (
    ARMS,
    FAST,
    NAMES,
    PULLED,
    SHAFT,
    G,
    behind,
    coordinates,
    run,
    started,
)

from touchdown.rotor.motion.equations import ANGLE, LOSS, SPIN


def test_two_modes_fall_freely() -> None:
    """A rigid rotor that turns, without unbalance: every station falls alike."""
    rotor = started(modes=2, residual=0, unbalance_scale=0.0, y=1e-4, vx=0.3)
    run(rotor, 50, 1e-4)
    for o in rotor.record["o"]["station"][: len(NAMES)]:
        assert o["y"] == pytest.approx(1e-4 - 0.5 * G * 5e-3**2, rel=1e-11)
        assert o["vy"] == pytest.approx(-G * 5e-3, rel=1e-11)
        assert o["x"] == pytest.approx(0.3 * 5e-3, rel=1e-11)
        assert o["ay_free"] == pytest.approx(-G, rel=1e-11)


def test_a_tilting_rigid_rotor_precesses() -> None:
    """Tilt rate w turns at Ip/Id Omega: slope = w0 (exp(i k t) - 1) / (i k), seats move by their arms."""
    rotor = started(modes=2, residual=0, unbalance_scale=0.0, gravity=0.0, speed=FAST)
    rate, span, steps = 20.0, 1e-2, 100
    rotor.record["q"][2 * 2 + 1] = rate * math.sqrt(SHAFT.diametral_inertia)
    run(rotor, steps, span / steps)
    turn = SHAFT.polar_inertia / SHAFT.diametral_inertia * FAST
    assert turn * span > 1.0
    slope = rate * (np.exp(1j * turn * span) - 1.0) / (1j * turn)
    slope_rate = rate * np.exp(1j * turn * span)
    for arm, o in zip(ARMS, rotor.record["o"]["station"], strict=False):
        assert abs(complex(o["x"], o["y"]) - arm * slope) < 1e-7 * abs(arm * slope)
        assert abs(complex(o["vx"], o["vy"]) - arm * slope_rate) < 1e-10 * abs(arm * slope_rate)


def test_a_force_off_the_centre_moves_and_tilts_a_rigid_rotor() -> None:
    """At rest, F at arm a accelerates arm b by F (1/m + a b / Id)."""
    force, span = 50.0, 1e-3
    rotor = started({"A": {"fx": force}}, modes=2, residual=0, unbalance_scale=0.0, gravity=0.0, speed=0.0)
    run(rotor, 10, span / 10)
    for arm, o in zip(ARMS, rotor.record["o"]["station"], strict=False):
        answer = 1.0 / SHAFT.mass + ARMS[0] * arm / SHAFT.diametral_inertia
        assert o["vx"] == pytest.approx(force * span * answer, rel=1e-10)
        assert o["x"] == pytest.approx(0.5 * force * span**2 * answer, rel=1e-10)
        assert o["vy"] == 0.0
        own = 1.0 / SHAFT.mass + arm**2 / SHAFT.diametral_inertia
        assert o["inv_m"] == pytest.approx(own, rel=1e-12)


def test_a_turned_frame_turns_the_answer() -> None:
    """Loads, start and unbalance turned by 90 degrees: x becomes y, y becomes -x."""
    upright = started(
        PULLED, gravity=0.0, speed=FAST, unbalance_scale=100.0, x=1e-5, y=2e-5, vx=0.1, vy=-0.2
    )
    turned_loads = {
        name: {**f, "fx": -f.get("fy", 0.0), "fy": f.get("fx", 0.0), "dfx": -f.get("dfy", 0.0),
               "dfy": f.get("dfx", 0.0)}
        for name, f in PULLED.items()
    }  # fmt: skip
    turned = started(
        turned_loads, gravity=0.0, speed=FAST, unbalance_scale=100.0, unbalance_angle=0.5 * math.pi,
        x=-2e-5, y=1e-5, vx=0.2, vy=0.1,
    )  # fmt: skip
    run(upright, 20, 1e-4)
    run(turned, 20, 1e-4)
    for one, other in zip(coordinates(upright), coordinates(turned), strict=True):
        assert np.max(np.abs(other - 1j * one)) < 1e-9 * np.max(np.abs(one))
    assert behind(turned, SPIN) == pytest.approx(behind(upright, SPIN), rel=1e-12)
    assert behind(turned, LOSS) == pytest.approx(behind(upright, LOSS), rel=1e-9)


@pytest.mark.parametrize(
    ("unbalance", "largest"),
    [(0.0, 1e-11), (1.0, 3e-7), (100.0, 3e-5)],
)
def test_momentum_is_the_impulse(unbalance: float, largest: float) -> None:
    """m v + d/dt (U exp(i theta)) changes by the impulse of forces and weight, whatever bends."""
    rotor = started(PULLED, speed=FAST, unbalance_scale=unbalance, vx=0.1)
    moment = unbalance * SHAFT.unbalances[0].moment
    assert len(SHAFT.unbalances) == 1

    def momentum() -> complex:
        spin = 1j * behind(rotor, SPIN) * np.exp(1j * behind(rotor, ANGLE))
        return complex(math.sqrt(SHAFT.mass) * coordinates(rotor)[1][0] + moment * spin)

    before, span = momentum(), 2e-3
    run(rotor, 20, span / 20)
    forces = sum(complex(f.get("fx", 0.0), f.get("fy", 0.0)) for f in PULLED.values())
    impulse = (forces - 1j * SHAFT.mass * G) * span
    assert abs(momentum() - before - impulse) < largest * abs(impulse)


def test_the_spin_changes_by_the_impulse_of_the_moments() -> None:
    """Without unbalance; a moment's slope has no impulse."""
    rotor = started(PULLED, speed=FAST, unbalance_scale=0.0)
    run(rotor, 20, 1e-4)
    change = 0.03 * 2e-3 / SHAFT.polar_inertia
    assert behind(rotor, SPIN) - FAST == pytest.approx(change, rel=1e-9)
    assert rotor.record["o"]["station"][0]["omega"] == behind(rotor, SPIN)
