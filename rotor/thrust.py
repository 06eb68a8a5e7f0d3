"""Thrust of the process on a rotor along its shaft: a constant, and a table over time.

Its work is part of a rotor's potential energy, with the opposite sign.
"""

from __future__ import annotations

from dataclasses import dataclass

from ..modelkit.kernel import kernel
from ..modelkit.variables import real
from .table import MAX_POINTS, out_of_order, table_value

NAMES = (  # of the parameters
    *("axial_load", "thrust_points"),
    *(f"thrust[{i + 1}].{name}" for i in range(MAX_POINTS) for name in ("time", "force")),
)
ORDER_PROBLEM = "thrust[{0:g}].time = {1:g} s is not after that of the point before, {2:g} s"


@dataclass(frozen=True)
class ThrustPoint:
    """A point of the thrust over time."""

    time: float = real(
        0.0,
        "s",
        "when, from the start of the run; the points come in order",
        needs="thrust_points >= 2",
    )
    force: float = real(0.0, "N", "thrust towards +z then, beside axial_load")


@kernel
def _time(p, i):
    return p.thrust[i].time


@kernel
def _force(p, i):
    return p.thrust[i].force


@kernel
def order_problem(p, numbers):
    """Number of the first point that is not in order, or 0; numbers: numbers for `ORDER_PROBLEM`."""
    return out_of_order(p.thrust_points, _time, p, numbers)


@kernel
def thrust(p, time):
    """Thrust (N) towards +z at `time` (s); p: a rotor's parameters."""
    if p.thrust_points == 0:
        return p.axial_load
    return p.axial_load + table_value(time, p.thrust_points, _time, _force, p)


@kernel
def thrust_ahead(m):
    """Mean thrust (N) over a macro step as long as the last one and after it; m: a rotor's memory.

    A bearing carries the rotor through that step by an acceleration that stays. With the thrust at its
    begin, a thrust that rises or falls would leave the rotor faster or slower than the bearing's copy. The
    mean is exact unless a point of the table is within the step, or the step has another length: one half
    as long is told as far ahead as it would be behind. At the start it is the thrust itself.
    """
    return thrust(m.p, m.time + 3.0 * m.half)
