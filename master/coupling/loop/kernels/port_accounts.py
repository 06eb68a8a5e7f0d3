"""The arithmetic of the energy ledger, on one record per connection."""

from __future__ import annotations

import numpy as np

from . import kernel

# pyright: basic


FALL_ENERGY_FLOOR = 0.03  # of the energy lost by falling; what brings less is not judged by its own measure
MIN_MEASURE_SHARE = 0.1  # of the largest measure of all connections; likewise
# Of what was turned over; where contact lasts, that is the measure and not a single impact
LASTING_CONTACT_SHARE = 0.2
FORCE_PER_ENERGY = 0.5  # a force goes with the root of the energy

BOOK = np.dtype(
    [
        ("every", "i8"),  # macro steps after which both sides have taken the same time
        ("total", "f8"),  # sum of |r_n|, J
        ("made", "f8"),  # minus the sum of r_n, J
        ("wrong", "f8"),  # the part of `total` that moves the figures, J
        ("carried", "i8"),  # whether the bearing carries the body by the body's own equations
        ("group", "i8"),  # connections of one bearing have the same
        ("turned", "f8"),  # sum of |mean force times displacement|, J
        ("kinetic", "f8"),  # largest along the force, J; 0 where the body states no velocity
        ("stating", "i8"),  # whether both sides state their work
        ("statements", "i8", (3,)),  # places in the signals: by the bearing, its jumps, by the body
        ("by_bearing", "f8"),  # J, as last stated
        ("jumps", "f8"),
        ("by_body", "f8"),
        ("pending", "f8"),  # J, work difference of the last step, its jump not yet known
        ("flowing", "i8"),  # whether motion and load are exchanged
        # places in the signals: x, y, fx, fy, vx, vy, z, fz, vz, rx, ry, mx, my; -1: not there
        ("flow", "i8", (13,)),
        ("mass", "f8"),  # kg, that moves with the port
        ("mass_z", "f8"),  # kg, likewise along the shaft
        ("x", "f8"),  # m, at the end of the last step; not a number before the first
        ("y", "f8"),
        ("vx", "f8"),  # m/s
        ("vy", "f8"),
        ("z", "f8"),
        ("vz", "f8"),
        ("rx", "f8"),  # rad
        ("ry", "f8"),
    ]
)


@kernel
def book(books: np.ndarray, signals: np.ndarray, done: int) -> None:
    """Book a step that was just taken, the number `done` (from 1), in all `books`."""
    for i in range(len(books)):
        b = books[i]
        if b.stating and done % b.every == 0:
            _compare(b, signals)
        if b.flowing:
            _flow(b, signals)


@kernel
def _compare(b, signals):
    """Compare what both sides of a connection have stated (J) up to the end of a step.

    Where a bearing carries the body by its equations, its own figures are wrong only as far as the body
    came to another place: what both sides make of the way between the same ends does not count as wrong.
    """
    places = b.statements
    by_bearing, jumps, by_body = signals[places[0]], signals[places[1]], signals[places[2]]
    jump = jumps - b.jumps
    residual = b.pending + jump
    b.total += abs(residual)
    b.made -= residual
    b.wrong += abs(jump) if b.carried and abs(jump) < abs(residual) else abs(residual)
    b.pending = (by_bearing - b.by_bearing) - (by_body - b.by_body)
    b.by_bearing, b.jumps, b.by_body = by_bearing, jumps, by_body


@kernel
def _flow(b, signals):
    """Add what a step to (x, y, z) (m), (rx, ry) (rad) under the mean load (N, N m) turned over.

    The velocity is that at its end.

    Kinetic energy counts along the force only: a journal that slides past a contact brings nothing of its
    motion along into it. Across the shaft and along it a body may have other masses, so each counts apart.
    """
    places = b.flow
    x, y, fx, fy, vx, vy = (
        signals[places[0]], signals[places[1]], signals[places[2]],
        signals[places[3]], signals[places[4]], signals[places[5]],
    )  # fmt: skip
    z, fz, vz = _at(signals, places[6]), _at(signals, places[7]), _at(signals, places[8])
    rx, ry = _at(signals, places[9]), _at(signals, places[10])
    mx, my = _at(signals, places[11]), _at(signals, places[12])
    squared = fx * fx + fy * fy
    if (squared > 0.0 or fz != 0.0) and b.x == b.x:  # from the second step on
        tilted = mx * (rx - b.rx) + my * (ry - b.ry)
        b.turned += abs(fx * (x - b.x) + fy * (y - b.y) + fz * (z - b.z) + tilted)
        kinetic = 0.0
        if squared > 0.0:
            along = max(abs(fx * vx + fy * vy), abs(fx * b.vx + fy * b.vy))
            kinetic = 0.5 * b.mass * along * along / squared
        if fz != 0.0:
            kinetic += 0.5 * b.mass_z * max(abs(vz), abs(b.vz)) ** 2
        if kinetic > b.kinetic:
            b.kinetic = kinetic
    b.x, b.y, b.vx, b.vy, b.z, b.vz = x, y, vx, vy, z, vz
    b.rx, b.ry = rx, ry


@kernel
def _at(signals, place):
    """The signal at a place; 0 where the place is negative."""
    return signals[place] if place >= 0 else 0.0


@kernel
def measure_of(books, i):
    """The energy scale of connection i's residual (J): twice the impact's kinetic energy, or more.

    An impact takes its kinetic energy and gives it back. That of the whole bearing counts: a housing is
    moved by what the journal brings.
    """
    kinetic, turnover = 0.0, 0.0
    for k in range(len(books)):
        if books[k].group == books[i].group:
            kinetic = max(kinetic, books[k].kinetic)
            turnover = max(turnover, books[k].turned + books[k].kinetic)
    return max(2.0 * kinetic, LASTING_CONTACT_SHARE * turnover)


@kernel
def shares(books: np.ndarray, fall: float) -> np.ndarray:
    """By how much the residual of each connection puts forces out, as a share; 0 where nothing moved.

    fall: energy lost by falling, J, or 0.
    """
    measures = np.zeros(len(books))
    for i in range(len(books)):
        measures[i] = measure_of(books, i)
    found = np.zeros(len(books))
    for i in range(len(books)):
        over = max(measures[i], MIN_MEASURE_SHARE * measures.max()) + FALL_ENERGY_FLOOR * fall
        if over != 0.0:
            found[i] = FORCE_PER_ENERGY * books[i].wrong / over
    return found


@kernel
def worst_of(books: np.ndarray, fall: float) -> tuple[int, float]:
    """The connection with the largest share of residual, and that share; -1 and 0 where there is none.

    A share that is NaN is the worst.
    """
    worst, largest = -1, 0.0
    found = shares(books, fall)
    for i in range(len(books)):
        share = found[i]
        if worst < 0 or share > largest or (share != share and largest == largest):
            worst, largest = i, share
    return worst, largest
