"""Races that are not circles: lobed or worn, and where a ball touches them.

In polar coordinates about the ring's centre, turning with the ring,

    r(s) = r0 + a cos(n (s - s0)) + w exp((cos(s - s1) - 1) / b^2)

`r0` is the circle's radius. Wear is a dent: it widens the outer race and narrows the inner one.

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

from ...modelkit.kernel import kernel
from ...modelkit.numerics import squared
from ...modelkit.variables import SWITCH, choice, integer, real
from .pair import ContactPlace

RACE_SAMPLES = 20_000  # around a race, for the check of its curvature
DENT_SAMPLES = 801  # across a worn dent; odd: one is its middle
MIN_CURVATURE_RATIO = 1.02  # radii of curvature of race and ball must differ by this factor where they nest


@dataclass(frozen=True)
class RaceProfile:
    """Deviation of a race from a circle; zero amplitude and zero wear: a circle."""

    lobes: int = integer(2, "number of lobes n", minimum=1, maximum=1000, needs="amplitude")
    amplitude: float = real(0.0, "m", "amplitude a of the lobes")
    phase: float = real(0.0, "rad", "angle of the first lobe s0 at the start", needs="amplitude")
    wear: float = real(0.0, "m", "depth of the worn dent", minimum=0.0)
    wear_angle: float = real(-math.pi / 2, "rad", "where the dent is at the start (s1)", needs="wear")
    wear_width: float = real(0.2, "rad", "width b of the dent", above=0.0, needs="wear")
    search: int = choice(0, SWITCH, "search the contact point even where the race is a circle")


@kernel
def active(profile):
    """Whether contacts with a race of this `profile`, a record, have to be searched for."""
    return profile.amplitude != 0.0 or profile.wear != 0.0 or profile.search == 1


@kernel
def radius_and_slopes(s, radius, profile, dent):
    """(r, dr/ds, d2r/ds2) of a race in m at the angle s (rad), on a circle of `radius` (m).

    `dent` is +1 where wear widens it, -1 where it narrows it.
    """
    turned = profile.lobes * (s - profile.phase)
    c, sn = profile.amplitude * math.cos(turned), profile.amplitude * math.sin(turned)
    r, d1, d2 = radius + c, -profile.lobes * sn, -float(profile.lobes * profile.lobes) * c
    if profile.wear != 0.0:
        off = s - profile.wear_angle
        cs, sns = math.cos(off), math.sin(off)
        sharp = 1.0 / (profile.wear_width * profile.wear_width)
        bump = dent * profile.wear * math.exp((cs - 1.0) * sharp)
        r += bump
        d1 -= bump * sharp * sns
        d2 += bump * sharp * (sharp * sns * sns - cs)
    return r, d1, d2


@kernel
def curvature(s, radius, profile, dent):
    """Curvature (1/m) at the angle s (rad), positive where it bends like a circle; rest as above."""
    r, d1, d2 = radius_and_slopes(s, radius, profile, dent)
    return (r * r + 2.0 * d1 * d1 - r * d2) / (r * r + d1 * d1) ** 1.5


@kernel
def sharpest(radius, profile, dent):
    """Largest curvature (1/m) of a race towards its ball, around it and again across its dent.

    A dent may be narrower than the samples around are apart; the others as for `radius_and_slopes`.
    """
    most = -math.inf
    for i in range(RACE_SAMPLES):
        most = max(most, dent * curvature(2.0 * math.pi / RACE_SAMPLES * i, radius, profile, dent))
    if profile.wear != 0.0:
        for i in range(DENT_SAMPLES):
            off = profile.wear_width * (8.0 / (DENT_SAMPLES - 1) * i - 4.0)
            most = max(most, dent * curvature(profile.wear_angle + off, radius, profile, dent))
    return most


def profile_problems(name: str) -> tuple[str, ...]:
    """Faults that `profile_problem` may find in the profile in the group `name` of a model's parameters."""

    def bent(cause: str, remedy: str) -> str:
        return (
            f"{name}.{cause} = {{0:g}} m bends the race to a radius of {{1:g}} m, where a ball of "
            f"{{2:g}} m touches it at more than one point; make it smaller, or the {remedy}"
        )

    return (
        f"{name}.amplitude = {{0:g}} m and {name}.wear = {{1:g}} m leave nothing of a race of {{2:g}} m; "
        "they must be far smaller",
        bent("wear", "dent wider"),
        bent("amplitude", "lobes fewer"),
    )


@kernel
def profile_problem(profile, radius, ball_radius, dent, numbers):
    """Why a ball would touch the race at more than one point: its number in `profile_problems`, or 0.

    profile: a record; radius, ball_radius: m; dent: +1 where the ball rolls inside (outer race), else -1.
    The race must nowhere be hollowed out as sharply as the ball is round. numbers: of the message.
    """
    if not active(profile):
        return 0
    if abs(profile.amplitude) + profile.wear >= 0.5 * radius:
        numbers[0], numbers[1], numbers[2] = profile.amplitude, profile.wear, radius
        return 1
    most = sharpest(radius, profile, dent)
    if most * ball_radius * MIN_CURVATURE_RATIO < 1.0:
        return 0
    worn = profile.wear / (profile.wear_width * profile.wear_width)
    lobed = abs(profile.amplitude) * profile.lobes * profile.lobes
    numbers[1], numbers[2] = 1.0 / most, ball_radius
    if worn > lobed:
        numbers[0] = profile.wear
        return 2
    numbers[0] = profile.amplitude
    return 3


MAX_ITERATIONS = 20
# Rad, last Newton step; what it leaves is of its square, and rounding stays well below
NEWTON_TOLERANCE = 1e-10
COLD_SEARCH_POINTS = 256  # points of the cold search, each time


class _CurvePoint(NamedTuple):
    """A point of a curve, its tangent dp/ds and the tangent's derivative."""

    x: float
    y: float
    tx: float
    ty: float
    cx: float
    cy: float


class BallOutline(NamedTuple):
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
    """Effort of the search."""

    cold: float = real(0.0, "1", "searches that had to start anew")
    failed: float = real(0.0, "1", "searches that found nothing")


@kernel
def on_circle(s, x, y, radius):
    """`_CurvePoint` (m) of a circle of `radius` around (x, y) (m) at the angle s (rad)."""
    c, sn = math.cos(s), math.sin(s)
    return _CurvePoint(x + radius * c, y + radius * sn, -radius * sn, radius * c, -radius * c, -radius * sn)


@kernel
def on_race(s, x, y, angle, radius, profile, dent):
    """`_CurvePoint` (m) of a race around (x, y) (m), turned by `angle` (rad); s: rad from the frame's x.

    radius, profile, dent: as for `profile.radius_and_slopes`.
    """
    r, d1, d2 = radius_and_slopes(s - angle, radius, profile, dent)
    c, sn = math.cos(s), math.sin(s)
    return _CurvePoint(
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

    ball: `BallOutline`; race: `Outline`.
    """
    bx, by, rb = ball
    rx, ry, angle, radius = race
    for _ in range(MAX_ITERATIONS):
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
        if abs(step_p) + abs(step_q) < NEWTON_TOLERANCE:
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
    """(s_P, s_Q) (rad) at that of many points of the race (`Outline`) nearest to a `BallOutline`."""
    bx, by, _ = ball
    rx, ry, angle, radius = race
    best, nearest, width = math.inf, 0.0, 2.0 * math.pi
    for _ in range(2):  # all around, then between the neighbours of the nearest: lobes may be many
        middle = nearest
        for i in range(COLD_SEARCH_POINTS):
            s = middle + width * (i / COLD_SEARCH_POINTS - 0.5)
            q = on_race(s, rx, ry, angle, radius, profile, dent)
            distance = squared(q.x - bx) + squared(q.y - by)
            if distance < best:
                best, nearest = distance, s
        width *= 2.0 / COLD_SEARCH_POINTS
    q = on_race(nearest, rx, ry, angle, radius, profile, dent)
    return math.atan2(q.y - by, q.x - bx), nearest


@kernel
def race_place(b, side, ball, race, profile, starts, report):
    """`ContactPlace` (m) of ball number `b` on a race.

    side: INSIDE (outer race) or OUTSIDE; ball: `BallOutline`; race: `Outline`; `starts`, (2 balls,), holds
    s_P and s_Q (rad) of each ball, NaN before the first search, and is brought up to date.
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
            return ContactPlace(math.nan, math.nan, math.nan, side * rb, 0.0, 0.0)
    starts[2 * b], starts[2 * b + 1] = sp, sq
    q = on_race(sq, race.x, race.y, race.angle, race.radius, profile, dent)
    length = math.sqrt(q.tx * q.tx + q.ty * q.ty)
    nx, ny = q.ty / length, -q.tx / length  # outwards from the race's centre
    gap = side * ((q.x - ball.x) * nx + (q.y - ball.y) * ny) - rb
    px, py = ball.x + side * rb * nx - race.x, ball.y + side * rb * ny - race.y
    return ContactPlace(nx, ny, -gap, side * rb, px * nx + py * ny, py * nx - px * ny)
