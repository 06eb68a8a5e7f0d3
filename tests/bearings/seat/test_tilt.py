"""The journal copy's tilt within a macro step, against the closed form."""

from __future__ import annotations

import numpy as np
import pytest

from touchdown.bearings import landing_sleeve, seat
from touchdown.bearings.seat import space
from touchdown.modelkit.instance import Instance
from touchdown.modelkit.ports import ACCELERATION, MODEL

GYRO, STEP, RATE, LEVER = 1200.0, 1e-4, 0.5 + 0.2j, 0.04  # rad/s, s, rad/s (x + i y), m


@pytest.mark.parametrize(("order", "inverse"), [(MODEL, 2500.0), (ACCELERATION, 2500.0), (MODEL, 0.0)])
def test_a_free_tilt_precesses_where_the_bearing_carries_it(order: int, inverse: float) -> None:
    """rx' + i ry' = w0 exp(i gyro t); with the acceleration of the restart alone it goes straight on."""
    bearing = Instance(landing_sleeve.MODEL)
    bearing.record["p"]["interface"]["order"] = order
    j = bearing.record["u"]["journal"]
    j["inv_m"], j["inv_I_t"], j["inv_mI"], j["gyro"] = 1.0, inverse, LEVER * inverse, GYRO
    j["wx"], j["wy"] = RATE.real, RATE.imag
    turned = 1j * GYRO * RATE
    j["alpha_x_free"], j["alpha_y_free"] = turned.real, turned.imag
    j["ax_free"], j["ay_free"] = LEVER * turned.imag, -LEVER * turned.real
    bearing.start(0.0)
    bearing.step(0.0, STEP)
    q = bearing.record["q"]
    assert float(bearing.record["o"]["contact"]["force"]) == 0.0
    carried = order == MODEL and inverse > 0.0
    rate = RATE * np.exp(1j * GYRO * STEP) if carried else RATE + turned * STEP
    assert complex(q[space.JWX], q[space.JWY]) == pytest.approx(rate, rel=1e-6)
    gained = LEVER * (rate - RATE)  # of the seat: x goes with ry, y against rx
    assert complex(q[seat.JVX], q[seat.JVY]) == pytest.approx(-1j * gained, rel=1e-6)
