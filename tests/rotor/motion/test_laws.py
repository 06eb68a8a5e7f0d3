"""The flexible rotor obeys the laws of motion, rigid or not."""

from __future__ import annotations

import math

import numpy as np
import pytest
import rotor_alone as alone

from touchdown.rotor.motion.equations import ANGLE, SPIN


def test_a_tilting_rigid_rotor_precesses() -> None:
    """Tilt rate w turns at Ip/Id Omega: slope = w0 (exp(i k t) - 1) / (i k), seats move by their arms."""
    rotor = alone.started(modes=2, residual=0, unbalance_scale=0.0, gravity=0.0, speed=alone.FAST)
    rate, span, steps = 20.0, 1e-2, 100
    rotor.record["q"][2 * 2 + 1] = rate * math.sqrt(alone.SHAFT.diametral_inertia)
    alone.run(rotor, steps, span / steps)
    turn = alone.SHAFT.polar_inertia / alone.SHAFT.diametral_inertia * alone.FAST
    assert turn * span > 1.0
    slope = rate * (np.exp(1j * turn * span) - 1.0) / (1j * turn)
    slope_rate = rate * np.exp(1j * turn * span)
    for arm, o in zip(alone.ARMS, rotor.record["o"]["station"], strict=False):
        assert abs(complex(o["x"], o["y"]) - arm * slope) < 1e-7 * abs(arm * slope)
        assert abs(complex(o["vx"], o["vy"]) - arm * slope_rate) < 1e-10 * abs(arm * slope_rate)


def test_a_force_off_the_centre_moves_and_tilts_a_rigid_rotor() -> None:
    """At rest, F at arm a accelerates arm b by F (1/m + a b / Id)."""
    force, span = 50.0, 1e-3
    rotor = alone.started(
        {"A": {"fx": force}}, modes=2, residual=0, unbalance_scale=0.0, gravity=0.0, speed=0.0
    )
    alone.run(rotor, 10, span / 10)
    for arm, o in zip(alone.ARMS, rotor.record["o"]["station"], strict=False):
        answer = 1.0 / alone.SHAFT.mass + alone.ARMS[0] * arm / alone.SHAFT.diametral_inertia
        assert o["vx"] == pytest.approx(force * span * answer, rel=1e-10)
        assert o["x"] == pytest.approx(0.5 * force * span**2 * answer, rel=1e-10)
        assert o["vy"] == 0.0
        own = 1.0 / alone.SHAFT.mass + arm**2 / alone.SHAFT.diametral_inertia
        assert o["inv_m"] == pytest.approx(own, rel=1e-12)


@pytest.mark.parametrize(("unbalance", "largest"), [(0.0, 1e-11), (100.0, 3e-5)])
def test_momentum_is_the_impulse(unbalance: float, largest: float) -> None:
    """m v + d/dt (U exp(i theta)) changes by the impulse of forces and weight, whatever bends."""
    rotor = alone.started(alone.PULLED, speed=alone.FAST, unbalance_scale=unbalance, vx=0.1)
    moment = unbalance * alone.SHAFT.unbalances[0].moment
    assert len(alone.SHAFT.unbalances) == 1

    def momentum() -> complex:
        spin = 1j * alone.behind(rotor, SPIN) * np.exp(1j * alone.behind(rotor, ANGLE))
        return complex(math.sqrt(alone.SHAFT.mass) * alone.coordinates(rotor)[1][0] + moment * spin)

    before, span = momentum(), 2e-3
    alone.run(rotor, 20, span / 20)
    forces = sum(complex(f.get("fx", 0.0), f.get("fy", 0.0)) for f in alone.PULLED.values())
    impulse = (forces - 1j * alone.SHAFT.mass * alone.G) * span
    assert abs(momentum() - before - impulse) < largest * abs(impulse)


def test_the_spin_changes_by_the_impulse_of_the_moments() -> None:
    """Without unbalance; a moment's slope has no impulse."""
    rotor = alone.started(alone.PULLED, speed=alone.FAST, unbalance_scale=0.0)
    alone.run(rotor, 20, 1e-4)
    change = 0.03 * 2e-3 / alone.SHAFT.polar_inertia
    assert alone.behind(rotor, SPIN) - alone.FAST == pytest.approx(change, rel=1e-9)
    assert rotor.record["o"]["station"][0]["omega"] == alone.behind(rotor, SPIN)
