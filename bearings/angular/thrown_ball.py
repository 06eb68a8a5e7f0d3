"""A ball that its orbit throws outwards, between the grooves of a row (`angular_row`).

The inner groove's centre is at V = (u, v) from that of the outer groove, outwards and along the shaft. The
ball's centre p has no inertia here: it is where the energy of both contacts and of the centrifugal force,

    E(p) = 2/5 K_o max(|p| - l_o, 0)^2.5 + 2/5 K_i max(|V - p| - l_i, 0)^2.5 - F_c p_u

is least: of Jones' balls without gyroscopic moment. E is convex in p, and its least value in V, so the load
on the ring is its slope over V: the force of the inner contact, along V - p. Contact angles at both races
differ; a ball that the inner race does not press lies at the bottom of the outer groove.

Newton's search starts from where the ball was, moved on by the slope of p over V: mostly one step is
enough, and all balls of a row take it in one loop, which becomes vector code.

Harris, Kotzalas, Rolling Bearing Analysis, 5th ed., volume 2, chapter 3.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

from ...modelkit.kernel import inlined, kernel
from ...modelkit.variables import array
from ..rolling.ball_set import MAX_BALLS

STEPS = 40  # of a search from afar
CLOSE = 3e-4  # of both indentations: what a step that short leaves out is of the size of its square, 1e-7
ROOM = 2 * MAX_BALLS  # balls of two rows
LANES = (
    4  # balls that vector code takes at a time: a loop runs past the last one rather than taking it alone
)


class ThrownBall(NamedTuple):
    """A ball between its contacts: forces in N, lengths in m."""

    inner: float  # force of the inner race
    outer: float  # force of the outer race
    indentation: float  # sum of both contacts, less that of the centrifugal force alone
    stored: float  # J, energy over that of the centrifugal force alone
    lifted: float  # how far out, less what it is under the centrifugal force alone
    cosine: float  # of the contact angle at the inner race
    sine: float
    outer_cosine: float  # of that at the outer race
    outer_sine: float


@dataclass(frozen=True)
class OrbitingBalls:
    """All balls, row by row, at the last evaluation; as `ThrownBall`."""

    u: tuple = array(ROOM)  # m, V
    v: tuple = array(ROOM)
    out: tuple = array(ROOM)  # m, p
    along: tuple = array(ROOM)
    last_u: tuple = array(ROOM)  # m, V that it is of
    last_v: tuple = array(ROOM)
    out_u: tuple = array(ROOM)  # slopes of p over V
    out_v: tuple = array(ROOM)
    along_u: tuple = array(ROOM)
    along_v: tuple = array(ROOM)
    missed: tuple = array(ROOM)  # 1 where a step was too long to be the last
    inner: tuple = array(ROOM)
    outer: tuple = array(ROOM)
    indentation: tuple = array(ROOM)
    cosine: tuple = array(ROOM)
    sine: tuple = array(ROOM)
    outer_cosine: tuple = array(ROOM)
    outer_sine: tuple = array(ROOM)


@kernel
def alone_on_outer(row, thrown):
    """Indentation (m) of the outer race under the centrifugal force `thrown` (N) alone."""
    return (thrown / row.outer_stiffness) ** (2.0 / 3.0)


@inlined
def step_balls(row, thrown, alone, grown, first, n, s):
    """One step of Newton's for `n` balls of a `row` (a record of `RowConstants`), from number `first` on.

    thrown: F_c (N), above 0; alone: `alone_on_outer` (m); grown: by how much their diameters have (m);
    s: `OrbitingBalls` with V. Forces are after the step, by the slopes before it, angles before it.
    """
    inner_free, outer_free = row.inner_free - 0.5 * grown, row.free - row.inner_free - 0.5 * grown
    stiff_o, stiff_i = row.outer_stiffness, row.inner_stiffness
    last = first + n  # views, whose numbers start at 0: the loop becomes vector code
    all_u, all_v = s.u[first:last], s.v[first:last]
    all_out, all_along = s.out[first:last], s.along[first:last]
    all_last_u, all_last_v = s.last_u[first:last], s.last_v[first:last]
    all_out_u, all_out_v = s.out_u[first:last], s.out_v[first:last]
    all_along_u, all_along_v = s.along_u[first:last], s.along_v[first:last]
    all_missed, all_inner = s.missed[first:last], s.inner[first:last]
    all_outer, all_indentation = s.outer[first:last], s.indentation[first:last]
    all_cosine, all_sine = s.cosine[first:last], s.sine[first:last]
    all_outer_cosine, all_outer_sine = s.outer_cosine[first:last], s.outer_sine[first:last]
    for b in range(n):
        du, dv = all_u[b] - all_last_u[b], all_v[b] - all_last_v[b]
        out = all_out[b] + all_out_u[b] * du + all_out_v[b] * dv
        along = all_along[b] + all_along_u[b] * du + all_along_v[b] * dv
        x, y = all_u[b] - out, all_v[b] - along
        way_o, way_i = math.sqrt(out * out + along * along), math.sqrt(x * x + y * y)
        deep_o, deep_i = max(way_o - outer_free, 0.0), max(way_i - inner_free, 0.0)
        root_o, root_i = stiff_o * math.sqrt(deep_o), stiff_i * math.sqrt(deep_i)
        by_o, by_i = 1.0 / way_o, 1.0 / way_i
        co, so, ci, si = by_o * out, by_o * along, by_i * x, by_i * y
        force_o, force_i = root_o * deep_o, root_i * deep_i
        across_o, across_i = by_o * force_o, by_i * force_i
        more_o, more_i = 1.5 * root_o - across_o, 1.5 * root_i - across_i
        ixx, ixy, iyy = across_i + more_i * ci * ci, more_i * ci * si, across_i + more_i * si * si
        xx, xy, yy = (
            ixx + across_o + more_o * co * co,
            ixy + more_o * co * so,
            iyy + across_o + more_o * so * so,
        )
        by = 1.0 / (xx * yy - xy * xy)
        hxx, hxy, hyy = by * yy, -by * xy, by * xx
        fx, fy = force_i * ci + thrown - force_o * co, force_i * si - force_o * so
        dx, dy = hxx * fx + hxy * fy, hxy * fx + hyy * fy
        near = CLOSE * (deep_o + deep_i)
        all_missed[b] = 0.0 if dx * dx + dy * dy < near * near else 1.0
        all_out[b], all_along[b], all_last_u[b], all_last_v[b] = out + dx, along + dy, all_u[b], all_v[b]
        all_out_u[b], all_out_v[b] = hxx * ixx + hxy * ixy, hxx * ixy + hxy * iyy
        all_along_u[b], all_along_v[b] = hxy * ixx + hyy * ixy, hxy * ixy + hyy * iyy
        px, py = force_i * ci - ixx * dx - ixy * dy, force_i * si - ixy * dx - iyy * dy
        all_inner[b], all_outer[b] = px * ci + py * si, (px + thrown) * co + py * so
        all_indentation[b] = max(deep_o + co * dx + so * dy + deep_i - ci * dx - si * dy - alone, 0.0)
        all_cosine[b], all_sine[b], all_outer_cosine[b], all_outer_sine[b] = ci, si, co, so


@kernel
def search_ball(row, thrown, alone, grown, b, s):
    """Find the ball number `b` of `s` (OrbitingBalls) from afar; the rest as for `step_balls`."""
    inner_free, outer_free = row.inner_free - 0.5 * grown, row.free - row.inner_free - 0.5 * grown
    bottom, u, v = outer_free + alone, s.u[b], s.v[b]
    if (u - bottom) * (u - bottom) + v * v <= inner_free * inner_free:  # the inner race does not touch
        s.inner[b], s.outer[b], s.out[b] = (
            0.0,
            thrown,
            0.0,
        )  # p of 0 has the next step miss, and search again
        s.indentation[b] = s.sine[b] = s.outer_sine[b] = 0.0
        s.cosine[b] = s.outer_cosine[b] = 1.0
        return
    length = math.sqrt(u * u + v * v)
    way = bottom + 0.5 * max(length - row.free + grown, 0.0)
    s.out[b], s.along[b], s.last_u[b], s.last_v[b] = way * u / length, way * v / length, u, v
    s.out_u[b] = s.out_v[b] = s.along_u[b] = s.along_v[b] = 0.0
    for _ in range(STEPS):
        length = math.sqrt(s.out[b] * s.out[b] + s.along[b] * s.along[b])
        if not length > outer_free:  # off the outer race nothing holds it
            s.out[b], s.along[b] = bottom * s.out[b] / length, bottom * s.along[b] / length
        step_balls(row, thrown, alone, grown, b, 1, s)
        if s.missed[b] == 0.0:
            return


@inlined
def thrown_ball(row, thrown, alone, grown, b, s):
    """`ThrownBall` number `b` of `s` (OrbitingBalls) after `step_balls`, searched where that missed it."""
    if s.missed[b] != 0.0 or not s.inner[b] > 0.0:
        search_ball(row, thrown, alone, grown, b, s)
    if s.inner[b] <= 0.0:
        return ThrownBall(0.0, thrown, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 0.0)
    outer_free = row.free - row.inner_free - 0.5 * grown
    lifted = s.out[b] - outer_free - alone
    on_outer = s.out[b] * s.outer_cosine[b] + s.along[b] * s.outer_sine[b] - outer_free
    on_inner = s.indentation[b] + alone - on_outer
    stored = 0.4 * (s.outer[b] * on_outer + s.inner[b] * on_inner - thrown * alone) - thrown * lifted
    races = s.cosine[b], s.sine[b], s.outer_cosine[b], s.outer_sine[b]
    return ThrownBall(s.inner[b], s.outer[b], s.indentation[b], stored, lifted, *races)


@inlined
def rolled_orbit(ball, ratio):
    """Orbit over the inner ring's spin of a `ThrownBall` that rolls without spin on the outer race.

    ratio: ball over pitch diameter.
    """
    between = ball.cosine * ball.outer_cosine + ball.sine * ball.outer_sine
    return (1.0 - ratio * ball.cosine) / (1.0 + between)
