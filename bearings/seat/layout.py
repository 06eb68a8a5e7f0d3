"""Where the copies of journal and housing lie in a bearing's state, and what a bearing's memory holds.

The state begins with the copies and their quadratures, `INSIDE` components. What is inside the bearing
follows, and behind it `PER_MODE` components for each elastic mode that is carried.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from touchdown.modelkit.kernel import kernel
from touchdown.modelkit.model import memory_layout
from touchdown.modelkit.ports import MODES, FlexibleSeatMotion, MountMotion
from touchdown.modelkit.variables import Nothing, group, integer, real

# State of the copies and quadratures, at the head of every bearing's state vector.
JX, JY, JVX, JVY, JW = range(5)  # journal copy
JPX, JPY, JPM, JQX, JQY, JQM, JE = range(5, 12)  # impulse, first moment, work
HX, HY, HVX, HVY = range(12, 16)  # housing copy
HFX, HFY, HFVX, HFVY, HE = range(16, 21)  # its response to the load alone, per mass; work
HPX, HPY = range(21, 23)  # impulse
INSIDE = 23  # first component of what is inside the bearing
# Of each elastic mode, behind what is inside: its share in the journal copy's motion, and the response
# of a mode of unit inv_m to the load alone.
ZX, ZY, ZVX, ZVY, QX, QY, PX, PY = range(8)
PER_MODE = 8
ROOM = PER_MODE * MODES  # in the state vector

POSITION_SCALE = 1e-5  # m; an indentation
VELOCITY_SCALE = 0.1  # m/s; a landing
SPIN_SCALE = 1e3  # rad/s
IMPULSE_SCALE = 0.1  # N s; of a kilogram that lands


@dataclass(frozen=True)
class BearingInputs:
    """What every bearing takes."""

    journal: FlexibleSeatMotion = group(FlexibleSeatMotion)
    housing: MountMotion = group(MountMotion)


@dataclass(frozen=True)
class SeatMemory:
    """The bearing's last known load: at the end of the last macro step, then at the restart."""

    jx: float = real(0.0, "N", "on the journal")
    jy: float = real(0.0, "N", "on the journal")
    jm: float = real(0.0, "N.m", "on the journal")
    hx: float = real(0.0, "N", "on the housing")
    hy: float = real(0.0, "N", "on the housing")
    inside: int = integer(0, "components of the state up to the elastic modes")
    modes: int = integer(0, "elastic modes that are carried")
    fastest: float = real(0.0, "rad/s", "largest angular frequency among them")


def bearing_memory(
    parameters: type,
    outputs: type,
    size: int,
    derived: type = Nothing,
    hidden: type = Nothing,
    inputs: type = BearingInputs,
) -> np.dtype:
    """Memory of a bearing whose state, with the copies, has up to `size` components."""
    return memory_layout(parameters, inputs, outputs, size + ROOM, derived, hidden)


@kernel
def set_weights(weight):
    """Set the error weights of the copies, the first `INSIDE` of a bearing's `weight` (n,)."""
    weight[JX] = weight[JY] = weight[HX] = weight[HY] = 1.0 / POSITION_SCALE
    weight[JVX] = weight[JVY] = weight[HVX] = weight[HVY] = 1.0 / VELOCITY_SCALE
    weight[JW] = 1.0 / SPIN_SCALE
