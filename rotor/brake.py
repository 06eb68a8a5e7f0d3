"""Torque against a rotor's spin: constant, in proportion to it, and a brake by a table over speed or time.

A torque above 0 brakes a rotor that spins either way, one below 0 drives it on. Near
standstill all but the torque in proportion fade, so that nothing turns back. Their work is heat,
`energy.dissipated`; the part of the brake is `braking.work`, too.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from ..modelkit.kernel import kernel
from ..modelkit.variables import Choices, real
from .table import MAX_POINTS, out_of_order, table_value

OVER = Choices("BrakeTable", ("time", "speed"))
OVER_SPEED = 1
FADING_SPEED = 0.1  # rad/s; below it constant torque and brake fade
TORQUES = (  # of the parameters
    *("drag", "viscous_drag", "brake_over", "brake_points"),
    *(f"brake[{i + 1}].{name}" for i in range(MAX_POINTS) for name in ("time", "speed", "torque")),
)
BRAKE_PROBLEM = "point {0:g} of the brake, at {1:g} (s, rad/s), is not after the one before, at {2:g}"


@dataclass(frozen=True)
class BrakePoint:
    """A point of the brake's torque."""

    time: float = real(
        0.0,
        "s",
        "when, from the start of the run; the points come in order",
        needs="brake_over == 0 and brake_points >= 2",
    )
    speed: float = real(
        0.0,
        "rad/s",
        "at which spin, of either sense; the points come in order",
        minimum=0.0,
        needs="brake_over == 1 and brake_points >= 2",
    )
    torque: float = real(0.0, "N.m", "torque against the spin then, beside drag; < 0: drives", tunable=True)


@dataclass(frozen=True)
class BrakeReport:
    """What the brake does."""

    power: float = real(0.0, "W", "power that the brake takes from the rotor", local=True)
    work: float = real(0.0, "J", "what it took since the start, part of energy.dissipated")


@kernel
def _place(p, i):
    return p.brake[i].speed if p.brake_over == OVER_SPEED else p.brake[i].time


@kernel
def _torque(p, i):
    return p.brake[i].torque


@kernel
def brake_problem(p, numbers):
    """Number of the first point that is not in order, or 0; numbers: numbers for `BRAKE_PROBLEM`."""
    return out_of_order(p.brake_points, _place, p, numbers)


@kernel
def brake_torque(spin, time, p):
    """Torque (N m) of the brake against the spin (rad/s) at `time` (s); p: a rotor's parameters."""
    if p.brake_points == 0:
        return 0.0
    at = abs(spin) if p.brake_over == OVER_SPEED else time
    return table_value(at, p.brake_points, _place, _torque, p) * math.tanh(spin / FADING_SPEED)


@kernel
def drag(spin, time, p):
    """Torque (N m) of all against the spin (rad/s) at `time` (s); p: a rotor's parameters."""
    constant = p.drag * math.tanh(spin / FADING_SPEED)
    return constant + p.viscous_drag * spin + brake_torque(spin, time, p)


@kernel
def report_brake(spin, time, work, m):
    """Publish what the brake does at `time` (s), and took (J) since the start; m: a rotor's memory."""
    m.o.braking.power, m.o.braking.work = brake_torque(spin, time, m.p) * spin, work
