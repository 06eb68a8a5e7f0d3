"""The balls as a set: where they and the ring rest at the start, and the largest of their loads.

The ring's weight and the springs at the balls have a potential that is convex in the ring's place: it rests
where that is least. Newton's method finds it from anywhere: where nothing holds the ring along a line it
goes far down that, and a step that overshoots is halved.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from ...modelkit.kernel import kernel
from ...modelkit.numerics import squared
from ..contact.peaks import Largest, watch_peaks
from .ball_set import outer_share, start_angle

MAX_STEPS = 100  # of Newton's method; ten are enough where balls hold the ring
MAX_HALVINGS = 40
# Determinant over squared trace below which the springs hold the ring along one line only
SINGULAR_RATIO = 1e-12
ROUNDING = 2e-16  # of all lengths
BOTTOM_ANGLE = 1e-9  # rad, how near to the bottom a ball is exactly below


class Springs(NamedTuple):
    """The balls as springs between the rings."""

    count: int
    first: float  # angular position of the first (rad)
    spread: float  # their spacing over even spacing
    play: float  # m
    stiffness: float  # N/m^1.5, of those side by side


class _LocalPotential(NamedTuple):
    """Potential, its gradient and its second derivatives at a place of the ring."""

    potential: float  # J
    x: float  # N
    y: float
    xx: float  # N/m
    xy: float
    yy: float


@kernel
def _balance(x, y, springs, weight):
    """`_LocalPotential` of a ring of `weight` (N) at (x, y) (m) on `Springs`."""
    potential, fx, fy, xx, xy, yy = weight * y, 0.0, weight, 0.0, 0.0, 0.0
    for i in range(springs.count):
        angle = start_angle(springs.first, springs.count, springs.spread, i)
        c, s = math.cos(angle), math.sin(angle)
        depth = x * c + y * s - springs.play
        if depth > 0.0:
            slope = 1.5 * springs.stiffness * math.sqrt(depth)
            force = slope * depth / 1.5
            potential += 0.4 * force * depth
            fx, fy = fx + force * c, fy + force * s
            xx, xy, yy = xx + slope * c * c, xy + slope * c * s, yy + slope * s * s
    return _LocalPotential(potential, fx, fy, xx, xy, yy)


@kernel
def _step_from(u, weight, far):
    """Step (m, m) to where a `_LocalPotential` has no gradient; `far` (m) where no spring holds the ring.

    Within `BOTTOM_ANGLE` of the direction of the weight (N) it does not slide off.
    """
    trace, det = u.xx + u.yy, u.xx * u.yy - u.xy * u.xy
    if det > SINGULAR_RATIO * trace * trace:
        return (u.xy * u.y - u.yy * u.x) / det, (u.xy * u.x - u.xx * u.y) / det
    if trace == 0.0:
        return 0.0, -far
    dx, dy = -(u.xx * u.x + u.xy * u.y) / trace, -(u.xy * u.x + u.yy * u.y) / trace
    x, y = u.x + dx, u.y + dy  # of the gradient, what is across the springs
    across = math.sqrt(x * x + y * y)
    slide = far / across if across > BOTTOM_ANGLE * weight else 0.0
    return dx / trace - slide * x, dy / trace - slide * y


@kernel
def _is_lower(tried, u):
    """Whether a `_LocalPotential` is nearer to rest than another; at rest they differ by rounding only."""
    return tried.potential < u.potential or squared(tried.x) + squared(tried.y) < squared(u.x) + squared(
        u.y
    )


@kernel
def _first_guess(springs, sunk):
    """A place (m, m) by the play and how deep the ring is `sunk` (m) on one ball, for even spacing."""
    half_gap = math.pi / springs.count
    gaps = (-0.5 * math.pi - springs.first) / (2.0 * half_gap)  # to the bottom, from the first ball
    off = (gaps - math.floor(gaps) - 0.5) * 2.0 * half_gap  # of the bottom from the middle of its gap
    # a ball exactly below: in the middle, on that ball
    direction, reach = -0.5 * math.pi, max(springs.play, 0.0) + sunk
    if abs(abs(off) - half_gap) >= BOTTOM_ANGLE:  # in the corner of the play between the two lowest balls
        direction, reach = direction - off, reach / math.cos(half_gap)
    return reach * math.cos(direction), reach * math.sin(direction)


@kernel
def resting_place(springs, weight, out):
    """Where a ring of `weight` (N, downwards) rests on the balls, from the centre (m, m).

    springs: `Springs`; out: how far off (m) no ball holds it any more. With a ball exactly below it is held
    sideways by nothing within the play, and rests in the middle; without weight it floats there, and where
    no balls hold it, it falls from there.
    """
    if weight == 0.0:
        return 0.0, 0.0
    sunk = (weight / springs.stiffness) ** (1.0 / 1.5)
    x, y = _first_guess(springs, sunk)
    local = _balance(x, y, springs, weight)
    for _ in range(MAX_STEPS):
        dx, dy = _step_from(local, weight, out)
        if not abs(dx) + abs(dy) > ROUNDING * (abs(x) + abs(y) + abs(springs.play)):
            break
        tried = _balance(x + dx, y + dy, springs, weight)
        for _ in range(MAX_HALVINGS):
            if _is_lower(tried, local):
                break
            dx, dy = 0.5 * dx, 0.5 * dy
            tried = _balance(x + dx, y + dy, springs, weight)
        if not _is_lower(tried, local):
            break
        x, y, local = x + dx, y + dy, tried
        if abs(x) + abs(y) >= out:
            return 0.0, 0.0
    return x, y


@kernel
def place_balls(d, b, spread, reach):
    """Set d.x and d.y, the centres of the balls at the start (m), with the ring at (d.rest_x, d.rest_y).

    A ball that both rings press sits where their forces balance; any other lies on the outer race in the
    lower half, on the inner one in the upper half, or on the edge of a pocket that keeps it from there.
    reach: how far (m) a pocket lets it off the pitch circle.
    """
    share, pitch = outer_share(d.stiffness), 0.5 * b.pitch_diameter
    for i in range(b.count):
        angle = start_angle(b.first_angle, b.count, spread, i)
        nx, ny = math.cos(angle), math.sin(angle)
        approach = d.rest_x * nx + d.rest_y * ny - b.play
        radius = pitch + 0.5 * b.play
        if approach > 0.0:
            radius += approach * share
        elif ny > 0.0:
            radius = max(radius + approach, min(pitch - reach, radius))
        else:
            radius = min(radius, max(pitch + reach, radius + approach))
        d.x[i], d.y[i] = radius * nx, radius * ny


class Total(NamedTuple):
    """Sum over all balls of their action on a race."""

    fx: float  # N
    fy: float
    moment: float  # N m, about its centre
    loss: float  # W, heat


@kernel
def largest_contact(force, indentation, count, rows):
    """`Largest` (N on one of those side by side, m) of the contacts of `count` balls in `rows`.

    force, indentation: of each ball, or of those side by side (N, m).
    """
    most, depth, loaded, deepest = 0.0, 0.0, 0, 0
    for b in range(count):
        if force[b] > most:
            most, loaded = force[b], b
        if indentation[b] > depth:
            depth, deepest = indentation[b], b
    return Largest(most / rows, depth, loaded, deepest)


@kernel
def watch_balls(time, largest, m):
    """Keep the peaks of the balls' forces (N) and of the rings' approach (m), after a micro-step.

    largest: `Largest`, at `time` (s).
    """
    force = watch_peaks(time, largest, m.o.balls, m.s.ball_peaks)
    lasts = m.o.contact.first_time >= 0.0 and m.o.contact.over_time < 0.0
    if lasts and force > m.o.balls.first_impact_force:
        m.o.balls.first_impact_force = force
