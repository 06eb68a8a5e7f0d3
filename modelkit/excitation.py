"""Courses over time of what is forced upon a machine: step, half sine, multisine, table.

A multisine has lines at multiples of a frequency, with phases by Schroeder, which keep its peaks low. With
`ratio` above 1 the lines are spread as on a logarithmic scale: each is the first multiple that is at least
so many times the one before. All of them repeat themselves after one period of the frequency. What a square
law makes of odd multiples is at even ones.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from .kernel import kernel
from .variables import SWITCH, Choices, choice, group, groups, integer, real

ROUNDING = 1e-9  # of a line's number
MAX_POINTS = 16
NEVER = 1e300  # s
COURSES = Choices(
    "Course",
    ("none", "step", "pulse", "lines", "table"),
    ("nothing", "constant from then on", "half a sine", "a multisine", "points, and straight between them"),
)
NONE, STEP, PULSE, LINES, TABLE = range(5)
ORDER_PROBLEM = "point[{0:g}].time = {1:g} s is not after that of the point before, {2:g} s"


@dataclass(frozen=True)
class Lines:
    """Of a multisine; a sine is one line."""

    frequency: float = real(
        20.0 * math.pi, "rad/s", "angular frequency, of which lines are multiples", above=0.0, shown="rad/s"
    )
    first: int = integer(1, "multiple of the first line", minimum=1)
    count: int = integer(1, "lines", minimum=1)
    ratio: float = real(1.0, "1", "of a line to the one before, at least", minimum=1.0, needs="count > 1")
    odd: int = choice(0, SWITCH, "whether the lines after the first are odd multiples", needs="count > 1")


@dataclass(frozen=True)
class CoursePoint:
    """A point of a table."""

    time: float = real(0.0, "s", "from the beginning; the points come in order", minimum=0.0)
    share: float = real(0.0, "1", "of the size, then")


@dataclass(frozen=True)
class Course:
    """From `begin` on; 0 before, after a pulse, and beyond the points of a table."""

    form: int = choice(0, COURSES, "over time")
    begin: float = real(0.0, "s", "when it begins", minimum=0.0, needs="form")
    width: float = real(1e-3, "s", "of the half sine", above=0.0, needs="form == 2")
    lines: Lines = group(Lines, needs="form == 3")
    points: int = integer(0, "in use", minimum=0, maximum=MAX_POINTS, needs="form == 4")
    point: tuple = groups(CoursePoint, MAX_POINTS, needs="form == 4 and points >= #")


@kernel
def next_line(line, p):
    """The multiple that comes after `line`; p: `Lines`."""
    following = max(line + 1, math.ceil(line * p.ratio - ROUNDING))
    return following + 1 if p.odd == 1 and following % 2 == 0 else following


@kernel
def sum_of_lines(time, p):
    """Of cosines of size 1 at `time` (s) from the multisine's beginning, p: `Lines`."""
    total, line = 0.0, p.first
    for n in range(p.count):
        total += math.cos(line * p.frequency * time - math.pi * n * (n + 1) / p.count)
        line = next_line(line, p)
    return total


@kernel
def _integral_of_lines(time, p):
    """As `course_integral`."""
    total, line = 0.0, p.first
    for n in range(p.count):
        omega, phase = line * p.frequency, -math.pi * n * (n + 1) / p.count
        total += (math.sin(omega * time + phase) - math.sin(phase)) / omega
        line = next_line(line, p)
    return total


@kernel
def course(since, p):
    """Share of the size `since` (s) after the beginning; p: `Course`."""
    if since < 0.0:
        return 0.0
    if p.form == PULSE:
        return math.sin(math.pi * since / p.width) if since < p.width else 0.0
    if p.form == LINES:
        return sum_of_lines(since, p.lines)
    if p.form == TABLE:
        for i in range(1, p.points):
            a, b = p.point[i - 1], p.point[i]
            if a.time <= since < b.time:
                return a.share + (since - a.time) / (b.time - a.time) * (b.share - a.share)
        return 0.0
    return 1.0 if p.form == STEP else 0.0


@kernel
def course_integral(since, p):
    """The integral (s) of `course` from the beginning."""
    if since <= 0.0:
        return 0.0
    if p.form == PULSE:
        return p.width / math.pi * (1.0 - math.cos(math.pi * min(since / p.width, 1.0)))
    if p.form == LINES:
        return _integral_of_lines(since, p.lines)
    if p.form == TABLE:
        total = 0.0
        for i in range(1, p.points):
            a, b = p.point[i - 1], p.point[i]
            part = min(max(since - a.time, 0.0), b.time - a.time)
            slope = (b.share - a.share) / (b.time - a.time)
            total += part * (a.share + 0.5 * part * slope)
        return total
    return since if p.form == STEP else 0.0


@kernel
def next_change(since, p):
    """How long (s) after `since` (s) the course bends or jumps next; more than a run takes: never."""
    if since < 0.0:
        return -since
    if p.form == PULSE and since < p.width:
        return p.width - since
    if p.form == TABLE:
        for i in range(p.points):
            if p.point[i].time > since:
                return p.point[i].time - since
    return NEVER


@kernel
def course_problem(p, numbers):
    """Number of the first point that is not after the one before, from 2, or 0; numbers: of the message."""
    for i in range(1, p.points if p.form == TABLE else 0):
        if p.point[i].time <= p.point[i - 1].time:
            numbers[0], numbers[1], numbers[2] = i + 1, p.point[i].time, p.point[i - 1].time
            return i + 1
    return 0
