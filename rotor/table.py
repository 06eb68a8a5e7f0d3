"""A value at points in order: a straight line between them, kept before the first and behind the last."""

from __future__ import annotations

from ..modelkit.kernel import kernel

MAX_POINTS = 12


@kernel
def out_of_order(count, place, p, numbers):
    """Number of the first of `count` points that is not behind the one before, or 0.

    place(p, i): of a point, of a rotor's parameters p; numbers: set then to that number and both places.
    """
    for i in range(1, count):
        if place(p, i) <= place(p, i - 1):
            numbers[0], numbers[1], numbers[2] = i + 1, place(p, i), place(p, i - 1)
            return i + 1
    return 0


@kernel
def table_value(at, count, place, value, p):
    """The value at the place `at`; value(p, i): of a point; the rest as of `out_of_order`, count > 0."""
    if at <= place(p, 0):
        return value(p, 0)
    for i in range(1, count):
        if at < place(p, i):
            before, start = place(p, i - 1), value(p, i - 1)
            return start + (at - before) / (place(p, i) - before) * (value(p, i) - start)
    return value(p, count - 1)
