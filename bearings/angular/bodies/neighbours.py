"""Balls of a row that touch the next one, in space; in the plane that is `bearings.rolling.ball_contacts`.

n points from a ball to the next one, t is square to it and to the shaft's axis, m = n x t. Normal forces
of a chain of balls are solved together; friction, along t and m, meets both of its balls and what else
acts on them as it did in the kick before.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from ....modelkit.kernel import kernel
from ....modelkit.variables import array
from ...contact.friction import curve
from ...contact.laws import elastic_and_damping, elastic_force
from ...contact.passivity import passive
from ...rolling.ball_contacts import SideContacts, after, part_ways, set_normal_forces
from ...rolling.ball_set import MAX_BALLS
from ...rolling.micro_step import beat_of
from .memory_layout import FIRST_BALL, WX, WY, WZ
from .rubbing import lone_friction


@dataclass(frozen=True)
class SpaceSides(SideContacts):
    """Contacts at the sides of a row's balls: `sliding`, `driven` and `tangential` are along t."""

    sliding_m: tuple = array(MAX_BALLS)  # m/s, before the kick
    driven_m: tuple = array(MAX_BALLS)
    tangential_m: tuple = array(MAX_BALLS)  # N


@dataclass(frozen=True)
class NeighbourSides(SpaceSides):
    """Contact of each ball of a row with the next one, on which friction is told."""

    half: tuple = array(MAX_BALLS)  # m, of the distance of both centres


@kernel
def meet_neighbours(m):
    """All balls against the next one in their row: adds to their accelerations in m.s.balls."""
    for row in range(m.d.rows):
        side, first = m.s.side[row], row * m.p.balls.count
        _find(side, first, m)
        set_normal_forces(side, m.s.chain, m.p.balls.count)
        if side.touching > 0:
            _rub(side, first, m)


@kernel
def _tangents(c, b):
    """t and m of contact b."""
    nx, ny, nz = c.nx[b], c.ny[b], c.nz[b]
    by = 1.0 / math.sqrt(nx * nx + ny * ny)
    tx, ty = -ny * by, nx * by
    return tx, ty, -nz * ty, nz * tx, nx * ty - ny * tx


@kernel
def _relative(c, b, u, w):
    """Rate of the indentation and sliding along t and m (m/s) of contact b.

    u: of the next ball's centre over this one's; w: sum of their spins; or changes of both.
    """
    tx, ty, mx, my, mz = _tangents(c, b)
    sliding_t = u[0] * tx + u[1] * ty - c.half[b] * (w[0] * mx + w[1] * my + w[2] * mz)
    sliding_m = u[0] * mx + u[1] * my + u[2] * mz + c.half[b] * (w[0] * tx + w[1] * ty)
    return -(u[0] * c.nx[b] + u[1] * c.ny[b] + u[2] * c.nz[b]), sliding_t, sliding_m


@kernel
def _find(c, first, m):
    """Balls of the row that starts with ball `first` which touch the next one, in c (NeighbourSides)."""
    s, count, apart = m.s.balls, m.p.balls.count, 2.0 * m.d.ball_radius
    c.touching = 0
    for b in range(count):
        i, k = first + b, first + after(b, count)
        ex, ey, ez = s.x[k] - s.x[i], s.y[k] - s.y[i], s.z[k] - s.z[i]
        square = ex * ex + ey * ey + ez * ez
        if square >= apart * apart:
            part_ways(c, b)
            continue
        distance = math.sqrt(square)
        c.nx[b], c.ny[b], c.nz[b] = ex / distance, ey / distance, ez / distance
        c.indentation[b], c.half[b] = apart - distance, 0.5 * distance
        _link(c, b, i, k, m)


@kernel
def _link(c, b, i, k, m):
    """Write the equation of contact b, of balls i and k, as `bearings.rolling.ball_contacts.link`."""
    s, d, count, before, beat = m.s.balls, m.d, m.p.balls.count, m.s.before, beat_of(m)
    law, h, n, depth = d.side_contact, beat.kick, d.balls, c.indentation[b]
    u = s.vx[k] - s.vx[i], s.vy[k] - s.vy[i], s.vz[k] - s.vz[i]
    w = s.wx[k] + s.wx[i], s.wy[k] + s.wy[i], s.wz[k] + s.wz[i]
    rate, c.sliding[b], c.sliding_m[b] = _relative(c, b, u, w)
    u = s.bx[k] - s.bx[i], s.by[k] - s.by[i], s.bz[k] - s.bz[i]
    mate, ball = FIRST_BALL + k, FIRST_BALL + i
    w = (
        before[mate + WX * n] + before[ball + WX * n],
        before[mate + WY * n] + before[ball + WY * n],
        before[mate + WZ * n] + before[ball + WZ * n],
    )
    back, on = b - 1 if b > 0 else count - 1, after(b, count)
    beside = c.normal[back] * (c.nx[back] * c.nx[b] + c.ny[back] * c.ny[b] + c.nz[back] * c.nz[b])
    beside += c.normal[on] * (c.nx[on] * c.nx[b] + c.ny[on] * c.ny[b] + c.nz[on] * c.nz[b])
    across = h * (2.0 / d.mass + 2.0 * c.half[b] * c.half[b] / d.inertia)
    along = 2.0 * h / d.mass
    faster, driven_t, driven_m = _relative(c, b, u, w)
    c.driven[b] = h * driven_t - across * c.tangential[b]
    c.driven_m[b] = h * driven_m - across * c.tangential_m[b]
    others = h * faster + along * (c.normal[b] - 0.5 * beside)
    elastic, damping = elastic_and_damping(depth, law)
    elastic = passive(elastic, depth / (law.exponent + 1.0), c.stored[b], rate, others, along, beat)
    z, chain = along * damping, m.s.chain
    chain.elastic[b], chain.pull[b], chain.base[b] = elastic, 0.5 * (3.0 + z) * z, 6.0 + z * (4.0 + z)
    chain.free[b] = (6.0 + z) * (elastic + damping * rate) + (3.0 + z) * damping * others
    c.stiffness[b] = law.exponent * elastic_force(depth, law) / depth
    c.rate[b], c.across[b] = rate, across
    c.touching += 1


@kernel
def _rub(c, first, m):
    """Friction of contacts c that touch, and the accelerations by all their forces."""
    s, count, law = m.s.balls, m.p.balls.count, curve(m.d.side_friction)
    by_mass, by_inertia = 1.0 / m.d.mass, 1.0 / m.d.inertia
    for b in range(count):
        if c.indentation[b] <= 0.0:
            continue
        i, k, n = first + b, first + after(b, count), c.normal[b]
        sliding, driven = (c.sliding[b], c.sliding_m[b]), (c.driven[b], c.driven_m[b])
        f, g = lone_friction(sliding, driven, c.across[b], n, law)
        c.tangential[b], c.tangential_m[b] = f, g
        c.highest[b] = max(n, m.d.side_contact.viscous * c.rate[b])
        tx, ty, mx, my, mz = _tangents(c, b)
        x, y, z = n * c.nx[b] + f * tx + g * mx, n * c.ny[b] + f * ty + g * my, n * c.nz[b] + g * mz
        s.ax[k], s.ay[k], s.az[k] = s.ax[k] + x * by_mass, s.ay[k] + y * by_mass, s.az[k] + z * by_mass
        s.ax[i], s.ay[i], s.az[i] = s.ax[i] - x * by_mass, s.ay[i] - y * by_mass, s.az[i] - z * by_mass
        turn = c.half[b] * by_inertia
        x, y, z = turn * (g * tx - f * mx), turn * (g * ty - f * my), -turn * f * mz
        s.px[k], s.py[k], s.pz[k] = s.px[k] + x, s.py[k] + y, s.pz[k] + z
        s.px[i], s.py[i], s.pz[i] = s.px[i] + x, s.py[i] + y, s.pz[i] + z


@kernel
def neighbours_heat(h, m):
    """Heat (W) between neighbours over a kick of h (s) whose accelerations are in m.s.balls."""
    s, loss, count = m.s.balls, 0.0, m.p.balls.count
    for row in range(m.d.rows):
        c, first = m.s.side[row], row * count
        if c.touching == 0:
            continue
        for b in range(count):
            if c.indentation[b] <= 0.0:
                continue
            i, k = first + b, first + after(b, count)
            u = s.ax[k] - s.ax[i], s.ay[k] - s.ay[i], s.az[k] - s.az[i]
            w = s.px[k] + s.px[i], s.py[k] + s.py[i], s.pz[k] + s.pz[i]
            rate, slid_t, slid_m = _relative(c, b, u, w)
            c.middle[b] = c.rate[b] + 0.5 * h * rate
            loss += c.damped[b] * c.middle[b]
            loss -= c.tangential[b] * (c.sliding[b] + 0.5 * h * slid_t)
            loss -= c.tangential_m[b] * (c.sliding_m[b] + 0.5 * h * slid_m)
    return loss
