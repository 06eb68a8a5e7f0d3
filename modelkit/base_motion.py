"""Motion of the base that a machine stands on, as a shock or a vibration test gives it.

The frame moves with the base, and so do stators that are fixed in space: every body that takes the base's
acceleration a feels -m a at its centre of mass. Its work is part of the body's potential energy, with the
opposite sign.
"""

from __future__ import annotations

from dataclasses import dataclass

from .excitation import ORDER_PROBLEM, Course, course
from .kernel import kernel
from .variables import group, real

BASE_PROBLEM = f"base.course.{ORDER_PROBLEM}"


@dataclass(frozen=True)
class BaseMotion:
    """Alike for all bodies of a machine."""

    x: float = real(0.0, "m/s2", "acceleration of the base where its course is 1, horizontally")
    y: float = real(0.0, "m/s2", "acceleration of the base where its course is 1, upwards")
    course: Course = group(Course, needs="x or y")


@kernel
def moving(p):
    """Whether the base moves at any time; p: `BaseMotion`."""
    return p.course.form != 0 and (p.x != 0.0 or p.y != 0.0)


@kernel
def base_acceleration(time, p):
    """(m/s2, m/s2) at `time` (s); p: `BaseMotion`."""
    share = course(time - p.course.begin, p.course)
    return share * p.x, share * p.y
