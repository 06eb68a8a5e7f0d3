"""What rotors tell bearings of a thrust that changes."""

from __future__ import annotations

import pytest
from rotor_alone import MODEL as FLEXIBLE

from touchdown.modelkit.instance import Instance
from touchdown.modelkit.model import Model
from touchdown.rotor.rigid import MODEL as RIGID

STEP, RAMP = 1e-4, -2e4  # s, N/s


@pytest.mark.parametrize("model", [RIGID, FLEXIBLE])
def test_a_copy_ends_a_step_as_fast_as_the_rotor(model: Model) -> None:
    """`az_free` stays over the copy's step: it is the mean thrust over it, times `inv_m_z`."""
    rotor = Instance(model)
    p, o = rotor.record["p"], rotor.record["o"]
    p["axial"], p["thrust_points"] = 1, 2
    p["thrust"][1]["time"], p["thrust"][1]["force"] = 1.0, RAMP
    rotor.start(0.0)
    seat = o["A"] if model is RIGID else o["station"][0]
    rotor.step(0.0, STEP)
    copy = float(seat["vz"]) + STEP * float(seat["az_free"])
    assert float(seat["az_free"]) == pytest.approx(1.5 * RAMP * STEP * float(seat["inv_m_z"]), rel=1e-12)
    rotor.step(STEP, STEP)
    assert float(seat["vz"]) == pytest.approx(copy, rel=1e-9)  # the rotor's own integration
