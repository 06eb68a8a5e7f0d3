"""A ball that its orbit throws outwards, between the grooves of a row (`angular_row`).

The inner groove's centre is at V = (u, v) from that of the outer groove, outwards and along the shaft. The
ball's centre p has no inertia here: it is where the energy of both contacts and of the centrifugal force,

    E(p) = 2/5 K_o max(|p| - l_o, 0)^2.5 + 2/5 K_i max(|V - p| - l_i, 0)^2.5 - F_c p_u

is least: of Jones' balls without gyroscopic moment. E is convex in p, and its least value in V, so the load
on the ring is its slope over V: the force of the inner contact, along V - p. Contact angles at both races
differ; a ball that the inner race does not press lies at the bottom of the outer groove.

Newton's search starts from where the ball was, moved on by the slope of p over V; mostly one step is
enough.

Harris, Kotzalas, Rolling Bearing Analysis, 5th ed., volume 2, chapter 3.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from ...modelkit.kernel import inlined, kernel

KEPT = 8  # numbers of a ball
NOWHERE = 0.0, 0.0, 0.0
STEPS = 40  # of the search; one or two are enough where the ball was near before
CLOSE = 3e-4  # of both indentations: what a step that short leaves out is of the size of its square, 1e-7


class ThrownBall(NamedTuple):
    """A ball between its contacts: forces in N, lengths in m."""

    inner: float  # force of the inner race
    outer: float  # force of the outer race
    indentation: float  # sum of both contacts, less that of the centrifugal force alone
    stored: float  # J, energy over that of the centrifugal force alone
    lifted: float  # out, less what it is under the centrifugal force alone
    cosine: float  # of the contact angle at the inner race
    sine: float
    outer_cosine: float  # of that at the outer race
    outer_sine: float


class _Contact(NamedTuple):
    """One of both contacts of a ball."""

    depth: float  # m
    force: float  # N
    cosine: float
    sine: float
    xx: float  # N/m, slope of the force's components over the way
    xy: float
    yy: float


@inlined
def _contact(stiffness, free, x, y):
    """`_Contact` of a ball (x, y) from a groove's centre (m), `free` (m) from it where they just touch."""
    way = math.sqrt(x * x + y * y)
    depth = max(way - free, 0.0)
    root = stiffness * math.sqrt(depth)
    by = 1.0 / way
    c, s, force = by * x, by * y, root * depth
    across, along = by * force, 1.5 * root
    more = along - across
    return _Contact(depth, force, c, s, across + more * c * c, more * c * s, across + more * s * s)


@kernel
def alone_on_outer(row, thrown):
    """Indentation (m) of the outer race under the centrifugal force `thrown` (N) alone."""
    return (thrown / row.outer_stiffness) ** (2.0 / 3.0)


@inlined
def rolled_orbit(ball, ratio):
    """Orbit over the inner ring's spin of a `ThrownBall` that rolls without spin on the outer race.

    ratio: ball over pitch diameter.
    """
    between = ball.cosine * ball.outer_cosine + ball.sine * ball.outer_sine
    return (1.0 - ratio * ball.cosine) / (1.0 + between)


@kernel
def thrown_ball(row, u, v, thrown, alone, grown, kept):
    """`ThrownBall` of a `row` (a record of `RowConstants`) with its grooves' centres (u, v) apart (m).

    thrown: F_c (N), above 0; alone: `alone_on_outer` (m); grown: by how much its diameter has (m); kept:
    (KEPT,) the last p and V (m), and the slope of p over V, all 0 before the first search, and set by it.
    """
    inner_free, outer_free = row.inner_free - 0.5 * grown, row.free - row.inner_free - 0.5 * grown
    bottom = outer_free + alone
    if (u - bottom) * (u - bottom) + v * v <= inner_free * inner_free:  # the inner race does not touch
        kept[0] = 0.0
        return ThrownBall(0.0, thrown, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 0.0)
    du, dv = u - kept[2], v - kept[3]
    out, along = kept[0] + kept[4] * du + kept[5] * dv, kept[1] + kept[6] * du + kept[7] * dv
    if not kept[0] * out > 0.0:
        length = math.sqrt(u * u + v * v)
        way = bottom + 0.5 * max(length - row.free + grown, 0.0)
        out, along = way * u / length, way * v / length
    outer, inner, x, y, h = _contact(1.0, 0.0, 1.0, 0.0), _contact(1.0, 0.0, 1.0, 0.0), 0.0, 0.0, NOWHERE
    for _ in range(STEPS):
        length = math.sqrt(out * out + along * along)
        if not length > outer_free:  # off the outer race nothing holds it
            out, along = bottom * out / length, bottom * along / length
        outer = _contact(row.outer_stiffness, outer_free, out, along)
        inner = _contact(row.inner_stiffness, inner_free, u - out, v - along)
        x = inner.force * inner.cosine + thrown - outer.force * outer.cosine  # what accelerates it
        y = inner.force * inner.sine - outer.force * outer.sine
        xx, xy, yy = outer.xx + inner.xx, outer.xy + inner.xy, outer.yy + inner.yy
        by = 1.0 / (xx * yy - xy * xy)
        h = by * yy, -by * xy, by * xx
        x, y = h[0] * x + h[1] * y, h[1] * x + h[2] * y
        out, along = out + x, along + y
        near = CLOSE * (outer.depth + inner.depth)
        if x * x + y * y < near * near:
            break
    kept[0], kept[1], kept[2], kept[3] = out, along, u, v
    kept[4], kept[5] = h[0] * inner.xx + h[1] * inner.xy, h[0] * inner.xy + h[1] * inner.yy
    kept[6], kept[7] = h[1] * inner.xx + h[2] * inner.xy, h[1] * inner.xy + h[2] * inner.yy
    # both contacts after the last step, by their slopes; their directions are those before it, within 1e-5
    across = inner.force * inner.cosine - inner.xx * x - inner.xy * y
    axial = inner.force * inner.sine - inner.xy * x - inner.yy * y
    force, lifted = across * inner.cosine + axial * inner.sine, out - bottom
    held = (across + thrown) * outer.cosine + axial * outer.sine
    deep_o = outer.depth + outer.cosine * x + outer.sine * y
    deep_i = inner.depth - inner.cosine * x - inner.sine * y
    stored = 0.4 * (held * deep_o + force * deep_i - thrown * alone) - thrown * lifted
    races = inner.cosine, inner.sine, outer.cosine, outer.sine
    return ThrownBall(force, held, max(deep_o + deep_i - alone, 0.0), stored, lifted, *races)
