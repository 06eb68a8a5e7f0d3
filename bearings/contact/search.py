"""Where a ball touches a race that is not a circle (2.29-2.36).

Both outlines are curves: a point on one is p(s) = R + A(theta) u(s). The contact is where the line
between the points is normal to both curves, which Newton's method finds from

    n_P . t_Q = 0        r_PQ . t_P = 0                                              (2.36, in the plane)

with s_P, s_Q of the last evaluation to start from. A solution counts only where it is the contact: the
points face each other there, and moving along either curve takes them apart. Where the warm start leads
elsewhere the search starts again from the nearest of many points around the race; where that fails, too,
it says so by a Place of NaN, which stops the step.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

from touchdown.bearings.contact.pair import Place
from touchdown.bearings.contact.profile import radius_and_slopes
from touchdown.modelkit.kernel import kernel
from touchdown.modelkit.variables import real

MOST_ITERATIONS = 20
CLOSE = 1e-10  # rad, last Newton step; what it leaves is of its square, and rounding stays well below
AROUND = 256  # points of the cold search, each time


class Point(NamedTuple):
    """A point of a curve, its tangent dp/ds and the tangent's derivative."""

    x: float
    y: float
    tx: float
    ty: float
    cx: float
    cy: float


class Disc(NamedTuple):
    """Outline of a ball: its centre and radius (m)."""

    x: float
    y: float
    radius: float


class Outline(NamedTuple):
    """Outline of a race: its centre (m), the angle by which it is turned (rad), its circle's radius (m)."""

    x: float
    y: float
    angle: float
    radius: float


@dataclass(frozen=True)
class SearchReport:
    """What the search had to do."""

    cold: float = real(0.0, "1", "searches that had to start anew")
    failed: float = real(0.0, "1", "searches that found nothing")


@kernel
def on_circle(s, x, y, radius):
    """`Point` (m) of a circle of `radius` around (x, y) (m) at the angle s (rad)."""
    c, sn = math.cos(s), math.sin(s)
    return Point(x + radius * c, y + radius * sn, -radius * sn, radius * c, -radius * c, -radius * sn)


@kernel
def on_race(s, x, y, angle, radius, profile, dent):
    """`Point` (m) of a race around (x, y) (m), turned by `angle` (rad); s (rad) from the frame's x axis.

    radius, profile, dent: as for `profile.radius_and_slopes`.
    """
    r, d1, d2 = radius_and_slopes(s - angle, radius, profile, dent)
    c, sn = math.cos(s), math.sin(s)
    return Point(
        x + r * c,
        y + r * sn,
        d1 * c - r * sn,
        d1 * sn + r * c,
        (d2 - r) * c - 2.0 * d1 * sn,
        (d2 - r) * sn + 2.0 * d1 * c,
    )


@kernel
def newton(sp, sq, ball, race, profile, dent):
    """(s_P on the ball, s_Q on the race (rad), whether (2.36) holds) from a start near the solution.

    ball: `Disc`; race: `Outline`.
    """
    bx, by, rb = ball
    rx, ry, angle, radius = race
    for _ in range(MOST_ITERATIONS):
        p = on_circle(sp, bx, by, rb)
        q = on_race(sq, rx, ry, angle, radius, profile, dent)
        dx, dy = q.x - p.x, q.y - p.y
        f = p.ty * q.tx - p.tx * q.ty  # n_P . t_Q with n_P = (t_y, -t_x)
        g = dx * p.tx + dy * p.ty
        fp = p.cy * q.tx - p.cx * q.ty
        fq = p.ty * q.cx - p.tx * q.cy
        gp = dx * p.cx + dy * p.cy - p.tx * p.tx - p.ty * p.ty
        gq = q.tx * p.tx + q.ty * p.ty
        determinant = fp * gq - fq * gp
        if determinant == 0.0:
            break
        step_p = (f * gq - fq * g) / determinant
        step_q = (fp * g - f * gp) / determinant
        if not abs(step_p) + abs(step_q) < 1.0:
            break
        sp -= step_p
        sq -= step_q
        if abs(step_p) + abs(step_q) < CLOSE:
            return sp, sq, True
    return sp, sq, False


@kernel
def is_contact(sp, sq, side, ball, race, profile, dent):
    """Whether the solution (sp, sq) (rad) is where ball and race meet, and not one of (2.36)'s others.

    Seen from the ball's centre the race's point must be the nearest one around, on the side of the
    ball's point; and not behind the race's centre, where a hollow of the far side is nearest, too.
    """
    bx, by, _ = ball
    rx, ry, angle, radius = race
    q = on_race(sq, rx, ry, angle, radius, profile, dent)
    dx, dy = q.x - bx, q.y - by
    nearest = q.tx * q.tx + q.ty * q.ty + dx * q.cx + dy * q.cy > 0.0
    facing = dx * math.cos(sp) + dy * math.sin(sp) > 0.0
    outward = side * ((bx - rx) * (q.x - bx) + (by - ry) * (q.y - by)) > 0.0
    before = (bx - rx) * (q.x - rx) + (by - ry) * (q.y - ry) > 0.0
    return nearest and facing and outward and before


@kernel
def cold_start(ball, race, profile, dent):
    """(s_P, s_Q) (rad) at the nearest to the ball (`Disc`) of many points of the race (`Outline`)."""
    bx, by, _ = ball
    rx, ry, angle, radius = race
    best, nearest, width = math.inf, 0.0, 2.0 * math.pi
    for _ in range(2):  # all around, then between the neighbours of the nearest: lobes may be many
        middle = nearest
        for i in range(AROUND):
            s = middle + width * (i / AROUND - 0.5)
            q = on_race(s, rx, ry, angle, radius, profile, dent)
            distance = (q.x - bx) ** 2 + (q.y - by) ** 2
            if distance < best:
                best, nearest = distance, s
        width *= 2.0 / AROUND
    q = on_race(nearest, rx, ry, angle, radius, profile, dent)
    return math.atan2(q.y - by, q.x - bx), nearest


@kernel
def race_place(b, side, ball, race, profile, starts, report):
    """`Place` (m) of ball number `b` on a race.

    side: INSIDE (outer race) or OUTSIDE; ball: `Disc`; race: `Outline`; `starts`, (2 balls,), holds s_P
    and s_Q (rad) of each ball, NaN before the first search, and is brought up to date.
    """
    rb = ball.radius
    dent = side
    race = Outline(race.x, race.y, race.angle % (2.0 * math.pi), race.radius)  # s - angle keeps its digits
    sp, sq, solved = newton(starts[2 * b], starts[2 * b + 1], ball, race, profile, dent)
    if not (solved and is_contact(sp, sq, side, ball, race, profile, dent)):
        report.cold += 1.0
        sp, sq = cold_start(ball, race, profile, dent)
        sp, sq, solved = newton(sp, sq, ball, race, profile, dent)
        if not (solved and is_contact(sp, sq, side, ball, race, profile, dent)):
            report.failed += 1.0
            return Place(math.nan, math.nan, math.nan, side * rb, 0.0, 0.0)
    starts[2 * b], starts[2 * b + 1] = sp, sq
    q = on_race(sq, race.x, race.y, race.angle, race.radius, profile, dent)
    length = math.sqrt(q.tx * q.tx + q.ty * q.ty)
    nx, ny = q.ty / length, -q.tx / length  # outwards from the race's centre
    gap = side * ((q.x - ball.x) * nx + (q.y - ball.y) * ny) - rb
    px, py = ball.x + side * rb * nx - race.x, ball.y + side * rb * ny - race.y
    return Place(nx, ny, -gap, side * rb, px * nx + py * ny, py * nx - px * ny)
