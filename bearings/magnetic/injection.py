"""What is added to the signals of a magnetic bearing, to identify its loop or to disturb it.

One multisine goes to the readings of the sensors, to the control currents, or as a force of an exciter to
the journal at the magnets, along the bearing's axes. Readings and currents change with the samples.
"""

from __future__ import annotations

from dataclasses import dataclass, fields

from ...modelkit.excitation import Lines, sum_of_lines
from ...modelkit.kernel import kernel
from ...modelkit.variables import Choices, choice, group, real
from .law import ROUNDING

INTO_READINGS = (  # settings of an actuator that its readings depend on
    *("inject.sensed", "inject.axis", "inject.begin"),
    *(f"inject.lines.{one.name}" for one in fields(Lines)),
)
AXES = Choices("InjectedAxes", ("both", "first", "second"))


@dataclass(frozen=True)
class Injection:
    """Sizes of each line, and the lines."""

    sensed: float = real(0.0, "m", "size of each line, added to the sensors' readings")
    set: float = real(0.0, "A", "size of each line, added to the control currents")
    force: float = real(0.0, "N", "size of each line, on the journal along the axes, from outside")
    axis: int = choice(0, AXES, "where it goes", needs="sensed or set or force")
    begin: float = real(0.0, "s", "when it begins", needs="sensed or set or force")
    lines: Lines = group(Lines, needs="sensed or set or force")


@kernel
def injected(time, axis, p):
    """Sum of the lines on an axis (from 0) at `time` (s), each of size 1; p: `Injection`."""
    if time < p.begin - ROUNDING or (p.axis > 0 and p.axis != axis + 1):
        return 0.0
    return sum_of_lines(time - p.begin, p.lines)
