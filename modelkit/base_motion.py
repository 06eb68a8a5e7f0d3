"""Motion of the base that a machine stands on, as a shock or a vibration test gives it.

The frame moves with the base, and so do stators that are fixed in space: every body that takes the base's
acceleration a feels -m a at its centre of mass. Its work is part of the body's potential energy, with the
opposite sign.
"""

from __future__ import annotations

from dataclasses import dataclass

from .excitation import ORDER_PROBLEM, Course, course, course_integral
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
def base_acceleration(m, since_middle):
    """(m/s2, m/s2) `since_middle` (s) after the middle of the macro step, of a body's memory m.

    Straight over the step, with its exact mean, so that no impulse is lost, however short.
    """
    p, step = m.p.base, 2.0 * m.half
    since = m.time - p.course.begin
    if step == 0.0:
        share = course(since + since_middle, p.course)
    else:
        share = (course_integral(since + step, p.course) - course_integral(since, p.course)) / step
        share += since_middle * (course(since + step, p.course) - course(since, p.course)) / step
    return share * p.x, share * p.y


@kernel
def base_jerk(m):
    """Rate (m/s3, m/s3) of `base_acceleration` over the macro step."""
    p, step = m.p.base, 2.0 * m.half
    since = m.time - p.course.begin
    rate = (course(since + step, p.course) - course(since, p.course)) / step
    return rate * p.x, rate * p.y


@kernel
def base_after(m):
    """(m/s2, m/s2) at the end of the macro step."""
    p = m.p.base
    share = course(m.time + 2.0 * m.half - p.course.begin, p.course)
    return share * p.x, share * p.y
