"""What is stiff in a row of free balls, for linearly implicit steps (`modelkit.integrators.rosenbrock`).

Friction on a ball of half a gram is stiff: 1e7 per second under load. With k_i and k_o the slope of
friction times load (N s/m) at the inner and the outer race of a ball, and l the inner contact's distance
from the ring's centre, the slopes of its orbit's and its spin's accelerations are

    orbit   -(k_i + k_o)/m               over orbit    (k_i - k_o) r_b/(r_m m)    over spin
    spin    (k_i - k_o) r_b r_m/I        over orbit   -(k_i + k_o) r_b^2/I        over spin

and those over the ring's spin k_i l/(r_m m) and -k_i l r_b/I. The ring's acceleration answers with
k_i l r_m/I_r and -k_i l r_b/I_r, and with -k_i l^2/I_r and the journal's slope to itself. So the matrix
is an arrow: each ball's orbit and spin are tied to each other and to the ring's spin only.
"""

from __future__ import annotations

from typing import NamedTuple

from touchdown.bearings import seat
from touchdown.bearings.contact.friction import slope
from touchdown.bearings.rolling import ring
from touchdown.bearings.rolling.ball_state import BALLS
from touchdown.bearings.rolling.pitch_circle import meet
from touchdown.bearings.rolling.row import raceway
from touchdown.modelkit.kernel import kernel


class BallBlock(NamedTuple):
    """Rows of a ball in s - J: its orbit's and its spin's, over both of them and over the ring's spin.

    Those over the ring's spin bear the sign they have in J.
    """

    orbit_orbit: float
    orbit_spin: float
    spin_orbit: float
    spin_spin: float
    orbit_ring: float
    spin_ring: float


@kernel
def linearise(q, stiff, m):
    """Fill `stiff` (m.n,), which describes J at the state q, from the loads of the last evaluation.

    In the places of a ball's angle, orbit and spin it holds k_i, k_o (N s/m) and l (m); in that of the
    ring's spin, what the journal makes of it (1/s).
    """
    p, d, s = m.p, m.d, m.s.balls
    count, gap, way = p.balls.count, ring.gap(q), raceway(m)
    for b in range(count):
        i = BALLS + b
        orbit = q[i + count]
        at = meet(gap, s.cosine[b], s.sine[b], orbit, q[i + 2 * count], way)
        pressed = m.s.inner.normal[b] + at.radius * d.mass * orbit * orbit
        stiff[i] = slope(at.inner, d.race_friction) * m.s.inner.normal[b]
        stiff[i + count] = slope(at.outer, d.race_friction) * pressed
        stiff[i + 2 * count] = at.lever
    bore = p.journal_radius + p.clearance
    stiff[ring.RW] = 0.0
    if m.s.ring.normal > 0.0:
        sliding = q[seat.JW] * p.journal_radius - q[ring.RW] * bore
        stiff[ring.RW] = slope(sliding, d.friction) * m.s.ring.normal * bore * bore / p.ring.inertia


@kernel
def _ball_block(inner, outer, lever, shift, d):
    """The `BallBlock` of a ball for s = `shift` (1/s), with its slopes (N s/m) and its lever (m)."""
    rm, rb, mass, inertia = d.pitch_radius, d.ball_radius, d.mass, d.inertia
    return BallBlock(
        shift + (inner + outer) / mass,
        (outer - inner) * rb / (rm * mass),
        (outer - inner) * rb * rm / inertia,
        shift + (inner + outer) * rb * rb / inertia,
        inner * lever / (rm * mass),
        -inner * lever * rb / inertia,
    )


@kernel
def _determinant(block):
    """Of a ball's own four (`BallBlock`), 1/s2."""
    return block.orbit_orbit * block.spin_spin - block.orbit_spin * block.spin_orbit


@kernel
def _solved(block, of_orbit, of_spin, scale):
    """(Orbit, spin) that a ball's own four (`BallBlock`) take to the right-hand side given.

    scale: one over the determinant, times what else is to multiply the solution.
    """
    orbit = (block.spin_spin * of_orbit - block.orbit_spin * of_spin) * scale
    return orbit, (block.orbit_orbit * of_spin - block.spin_orbit * of_orbit) * scale


@kernel
def solve(stiff, shift, right, m):
    """Overwrite `right` (m.n,) with the solution x of (s - J) x = right; s = `shift` (1/s), J by `stiff`.

    The balls are eliminated one by one, the ring is solved for, and its share handed back to them.
    """
    p, d = m.p, m.d
    rm, rb, count = d.pitch_radius, d.ball_radius, p.balls.count
    ring_ring, of_ring = shift + stiff[ring.RW], right[ring.RW]
    for i in range(BALLS, BALLS + count):
        inner, outer, lever = stiff[i], stiff[i + count], stiff[i + 2 * count]
        block = _ball_block(inner, outer, lever, shift, d)
        scale = 1.0 / _determinant(block)
        orbit, spin = _solved(block, right[i + count], right[i + 2 * count], scale)
        with_ring = _solved(block, block.orbit_ring, block.spin_ring, scale)  # per speed of the ring
        back = inner * lever / p.ring.inertia
        ring_ring += back * (lever - rm * with_ring[0] + rb * with_ring[1])
        of_ring += back * (rm * orbit - rb * spin)
        right[i], right[i + count], right[i + 2 * count] = right[i] / shift, orbit, spin
    turned = of_ring / ring_ring
    for i in range(BALLS, BALLS + count):
        block = _ball_block(stiff[i], stiff[i + count], stiff[i + 2 * count], shift, d)
        orbit, spin = _solved(block, block.orbit_ring, block.spin_ring, turned / _determinant(block))
        right[i + count] += orbit
        right[i + 2 * count] += spin
    for i in range(BALLS):
        right[i] /= shift
    for i in range(m.s.seat.inside, m.n):
        right[i] /= shift
    right[ring.RW] = turned
