"""Friction over two components: of balls at both races in space, and of any contact, over a kick.

A contact slides along t and m (`races`) at s = (s_t, s_m), and friction is F(s) = -N mu(|s|) s/|s|. Over a
kick it is taken as `bearings.contact.pair` has it, as the tangent at the sliding s0 where the kick is
expected to end, here with one slope along s0 and another one across, where it only turns:

    f = F(s0) + F'(s0) (s + theta ds - s0)        F' = -N (mu' e e' + mu/|s0| (1 - e e'))        e = s0/|s0|

each with a theta of its own, by its z = w N mu' or w N mu/|s0|. Where all slide along one line that is
friction in the plane. A ball's two contacts, with W what sliding at the outer race answers to friction at
the inner one (s/kg), d = h J(other forces) and Delta what the kick does to the ring,

    ds_o = d_o + w f_o + W f_i        f_o = p_o - A_o (d_o + W f_i)
    ds_i = d_i + w f_i + W' f_o - J Delta        f_i = p_i - A_i (d_i + W' f_o - J Delta)

with w = h (1/m + r^2/I) the same along both directions and taken into A = F'/(1 + w F') of each contact. So

    f_i = held + G J Delta        G = (1 - A_i W' A_o W)^-1 A_i

is put into the ring's six equations (`space_ring`), which give Delta.

A ball goes round while it is kicked: its velocity after a kick is that in the middle of the drift that
follows, turned by the orbit's angle over half of that drift against its place, and that before the kick by
as much backwards as half of the drift before takes. Across the groove that is sliding only as seen from a
fixed frame, so it is taken out of s there, and put into what else drives it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

from ....modelkit.kernel import inlined, kernel
from ....modelkit.variables import array
from ...contact.friction import Rises, height_and_slope, rises
from ...contact.pair import spot, steepest
from .memory_layout import ROOM

SUMS = 27  # of the balls in the ring's equations: 21 of the symmetric matrix, 6 of the right-hand side
STICKING = 1e-6  # m/s; slower than that, friction is as good as linear
TINY = 1e-300


@dataclass(frozen=True)
class BallFriction:
    """Both contacts of each ball together, on their way through a kick."""

    w_tt: tuple = array(ROOM)  # s/kg, W
    w_tm: tuple = array(ROOM)
    w_mt: tuple = array(ROOM)
    w_mm: tuple = array(ROOM)
    held_t: tuple = array(ROOM)  # N, at the inner race as the ring keeps its motion
    held_m: tuple = array(ROOM)
    gain_tt: tuple = array(ROOM)  # N s/m, G
    gain_tm: tuple = array(ROOM)
    gain_mm: tuple = array(ROOM)
    sums: tuple = array(SUMS, ROOM)


class TwoLines(NamedTuple):
    """Friction over a kick: alone - slope ds (N, N s/m), ds the change of the sliding speed by all else."""

    alone_t: float
    alone_m: float
    slope_tt: float
    slope_tm: float
    slope_mm: float


@inlined
def two_lines(dt, dm, speed, risen, st, sm, answer, own_answer, normal, law):
    """`TwoLines` of a contact under the force `normal` (N) that is expected to end its kick along (dt, dm).

    speed: its `spot` (m/s); risen: `Rises` there; st, sm: sliding before the kick (m/s); answer: of the
    sliding to friction (s/kg); own_answer: the same, where its own part of ds is to be taken in, or 0.
    """
    mu, along = height_and_slope(speed, risen, law)
    along *= normal
    across = normal * (mu / max(speed, STICKING) if speed > STICKING else steepest(law))
    s_e, s_n = st * dt + sm * dm, sm * dt - st * dm
    z, y = answer * along, answer * across
    by_e = 1.0 / (6.0 + z + own_answer * (3.0 + z) * along)
    by_n = 1.0 / (6.0 + y + own_answer * (3.0 + y) * across)
    p_e = (6.0 + z) * (along * (speed - s_e) - normal * mu) * by_e
    p_n = -(6.0 + y) * across * s_n * by_n
    a_e, a_n = (3.0 + z) * along * by_e, (3.0 + y) * across * by_n
    return TwoLines(
        p_e * dt - p_n * dm,
        p_e * dm + p_n * dt,
        a_e * dt * dt + a_n * dm * dm,
        (a_e - a_n) * dt * dm,
        a_e * dm * dm + a_n * dt * dt,
    )


@kernel
def line_over(sliding, expected, answer, normal, law):
    """`TwoLines` of a contact alone, whose own part of ds is not taken in.

    sliding, expected: (t, m) before the kick and at its end without its own friction (m/s).
    """
    size = math.sqrt(expected[0] * expected[0] + expected[1] * expected[1])
    dt, dm = (expected[0] / size, expected[1] / size) if size > 0.0 else (1.0, 0.0)
    speed = spot(size, answer, normal, law)
    return two_lines(dt, dm, speed, rises(speed, law), sliding[0], sliding[1], answer, 0.0, normal, law)


@kernel
def lone_friction(sliding, driven, answer, normal, law):
    """Friction (N, N) along t and m of a contact that meets but its own part of ds over a kick.

    sliding, driven: (t, m), before the kick and its change by all else (m/s); answer: s/kg.
    """
    x, y = sliding[0] + driven[0], sliding[1] + driven[1]
    size = math.sqrt(x * x + y * y)
    dt, dm = (x / size, y / size) if size > 0.0 else (1.0, 0.0)
    speed = spot(size, answer, normal, law)
    risen = rises(speed, law)
    line = two_lines(dt, dm, speed, risen, sliding[0], sliding[1], answer, answer, normal, law)
    along = line.alone_t - line.slope_tt * driven[0] - line.slope_tm * driven[1]
    return along, line.alone_m - line.slope_tm * driven[0] - line.slope_mm * driven[1]


@inlined
def driven_sliding(balls, c, beat, radius, hvx, hvy, n):
    """How all but friction at races changes the sliding of `n` balls at contacts c over a kick (`Beat`).

    radius: of a ball (m); hvx, hvy: of the housing (m/s).
    """
    h, ahead = beat.kick, beat.drift
    for b in range(n):
        tx, ty, tz = c.tx[b], c.ty[b], c.tz[b]
        mx, my, mz = c.mx[b], c.my[b], c.mz[b]
        ax, ay, az = balls.ax[b], balls.ay[b], balls.az[b]
        px, py, pz = balls.px[b], balls.py[b], balls.pz[b]
        vx, vy = balls.vx[b] - hvx, balls.vy[b] - hvy
        turned = balls.orbit[b] * (vx * my - vy * mx + radius * (balls.wx[b] * ty - balls.wy[b] * tx))
        c.driven_t[b] = h * (ax * tx + ay * ty + az * tz - radius * (px * mx + py * my + pz * mz))
        driven = h * (ax * mx + ay * my + az * mz + radius * (px * tx + py * ty + pz * tz))
        c.driven_m[b] = driven - h * turned
        c.along_m[b] += (h - ahead) * turned


@inlined
def cross(o, i, f, by_mass, by_spin, n):
    """Set W (s/kg) of `n` balls in f (BallFriction) by their contacts o and i with the races.

    by_mass, by_spin: answers of a ball's centre and of its surface by its spin (s/kg).
    """
    for b in range(n):
        tt = o.tx[b] * i.tx[b] + o.ty[b] * i.ty[b] + o.tz[b] * i.tz[b]
        tm = o.tx[b] * i.mx[b] + o.ty[b] * i.my[b] + o.tz[b] * i.mz[b]
        mt = o.mx[b] * i.tx[b] + o.my[b] * i.ty[b] + o.mz[b] * i.tz[b]
        mm = o.mx[b] * i.mx[b] + o.my[b] * i.my[b] + o.mz[b] * i.mz[b]
        f.w_tt[b], f.w_tm[b] = by_mass * tt + by_spin * mm, by_mass * tm - by_spin * mt
        f.w_mt[b], f.w_mm[b] = by_mass * mt - by_spin * tm, by_mass * mm + by_spin * tt


@inlined
def expect(o, i, f, n):
    """Set the sliding (m/s) at which the kick of `n` balls would end but for each contact's own friction.

    What the other race's friction and the ring do in it is what they did in the kick before.
    """
    for b in range(n):
        by_inner_t = f.w_tt[b] * i.friction_t[b] + f.w_tm[b] * i.friction_m[b]
        by_inner_m = f.w_mt[b] * i.friction_t[b] + f.w_mm[b] * i.friction_m[b]
        by_outer_t = f.w_tt[b] * o.friction_t[b] + f.w_mt[b] * o.friction_m[b]
        by_outer_m = f.w_tm[b] * o.friction_t[b] + f.w_mm[b] * o.friction_m[b]
        o.expected_t[b] = o.along_t[b] + o.driven_t[b] + by_inner_t
        o.expected_m[b] = o.along_m[b] + o.driven_m[b] + by_inner_m
        i.expected_t[b] = i.along_t[b] + i.driven_t[b] + by_outer_t - i.moved_t[b]
        i.expected_m[b] = i.along_m[b] + i.driven_m[b] + by_outer_m - i.moved_m[b]


@inlined
def draw_friction(c, answer, law, n):
    """Set the friction of `n` contacts c alone and its slopes; answer: w (s/kg); law: a `Curve`."""
    for b in range(n):
        size = math.sqrt(c.expected_t[b] * c.expected_t[b] + c.expected_m[b] * c.expected_m[b])
        inverse = 1.0 / max(size, TINY)
        c.expected_t[b] = c.expected_t[b] * inverse if size > TINY else 1.0
        c.expected_m[b] *= inverse
        c.spot[b] = spot(size, answer, c.normal[b], law)
    for b in range(n):
        risen = rises(c.spot[b], law)
        c.last[b], c.flat[b], c.steep[b], c.faded[b] = risen.last, risen.flat, risen.steep, risen.faded
    for b in range(n):
        risen = Rises(c.last[b], c.flat[b], c.steep[b], c.faded[b])
        dt, dm, st, sm = c.expected_t[b], c.expected_m[b], c.along_t[b], c.along_m[b]
        line = two_lines(dt, dm, c.spot[b], risen, st, sm, answer, answer, c.normal[b], law)
        tt, tm, mm = line.slope_tt, line.slope_tm, line.slope_mm
        c.slope_tt[b], c.slope_tm[b], c.slope_mm[b] = tt, tm, mm
        c.alone_t[b] = line.alone_t - tt * c.driven_t[b] - tm * c.driven_m[b]
        c.alone_m[b] = line.alone_m - tm * c.driven_t[b] - mm * c.driven_m[b]


@inlined
def join(o, i, f, n):
    """Set what friction of `n` balls at the inner race is, and how it answers to the ring, in f."""
    for b in range(n):
        w_tt, w_tm, w_mt, w_mm = f.w_tt[b], f.w_tm[b], f.w_mt[b], f.w_mm[b]
        a, c, d = o.slope_tt[b], o.slope_tm[b], o.slope_mm[b]
        # A_o W
        b_tt, b_tm = a * w_tt + c * w_mt, a * w_tm + c * w_mm
        b_mt, b_mm = c * w_tt + d * w_mt, c * w_tm + d * w_mm
        # A_i W'
        a, c, d = i.slope_tt[b], i.slope_tm[b], i.slope_mm[b]
        c_tt, c_tm = a * w_tt + c * w_tm, a * w_mt + c * w_mm
        c_mt, c_mm = c * w_tt + d * w_tm, c * w_mt + d * w_mm
        k_tt, k_tm = 1.0 - c_tt * b_tt - c_tm * b_mt, -c_tt * b_tm - c_tm * b_mm
        k_mt, k_mm = -c_mt * b_tt - c_mm * b_mt, 1.0 - c_mt * b_tm - c_mm * b_mm
        inverse = 1.0 / (k_tt * k_mm - k_tm * k_mt)
        q_t = i.alone_t[b] - c_tt * o.alone_t[b] - c_tm * o.alone_m[b]
        q_m = i.alone_m[b] - c_mt * o.alone_t[b] - c_mm * o.alone_m[b]
        f.held_t[b], f.held_m[b] = (k_mm * q_t - k_tm * q_m) * inverse, (k_tt * q_m - k_mt * q_t) * inverse
        f.gain_tt[b] = (k_mm * a - k_tm * c) * inverse
        f.gain_tm[b] = (k_mm * c - k_tm * d) * inverse
        f.gain_mm[b] = (k_tt * d - k_mt * c) * inverse


@inlined
def _matrix_sums(i, f, h, n):
    """Set what each of `n` balls adds to the ring's matrix, J' G J h, in f.sums."""
    s = f.sums
    for b in range(n):
        c, n1, u, v, rho, zeta = i.cosine[b], -i.sine[b], i.outwards[b], i.axial[b], i.rho[b], i.zeta[b]
        lever = -(v * zeta + u * rho)
        g, k, e = h * f.gain_tt[b], h * f.gain_tm[b], h * f.gain_mm[b]
        # J_t = (n1, c, 0, -zeta c, zeta n1, rho); J_m = (-v c, v n1, u, lever n1, lever c, 0)
        t4, t5 = -zeta * c, zeta * n1
        m1, m2, m4, m5 = -v * c, v * n1, lever * n1, lever * c
        p1, p2, p3, p4, p5, p6 = (
            g * n1 + k * m1,
            g * c + k * m2,
            k * u,
            g * t4 + k * m4,
            g * t5 + k * m5,
            g * rho,
        )
        r1, r2, r3, r4, r5, r6 = (
            k * n1 + e * m1,
            k * c + e * m2,
            e * u,
            k * t4 + e * m4,
            k * t5 + e * m5,
            k * rho,
        )
        s[0, b], s[1, b], s[2, b] = n1 * p1 + m1 * r1, n1 * p2 + m1 * r2, n1 * p3 + m1 * r3
        s[3, b], s[4, b], s[5, b] = n1 * p4 + m1 * r4, n1 * p5 + m1 * r5, n1 * p6 + m1 * r6
        s[6, b], s[7, b], s[8, b] = c * p2 + m2 * r2, c * p3 + m2 * r3, c * p4 + m2 * r4
        s[9, b], s[10, b], s[11, b] = c * p5 + m2 * r5, c * p6 + m2 * r6, u * r3
        s[12, b], s[13, b], s[14, b] = u * r4, u * r5, u * r6
        s[15, b], s[16, b], s[17, b] = t4 * p4 + m4 * r4, t4 * p5 + m4 * r5, t4 * p6 + m4 * r6
        s[18, b], s[19, b], s[20, b] = t5 * p5 + m5 * r5, t5 * p6 + m5 * r6, rho * p6


@inlined
def _force_sums(i, f, n):
    """Set the force and the moment of each of `n` balls on the ring as it keeps its motion, in f.sums."""
    s = f.sums
    for b in range(n):
        c, si, u, v, rho, zeta = i.cosine[b], i.sine[b], i.outwards[b], i.axial[b], i.rho[b], i.zeta[b]
        normal, along, across = i.normal[b], f.held_t[b], f.held_m[b]
        radial, around, axial = across * v - normal * u, -along, -(normal * v + across * u)
        m_radial, m_around = along * zeta, zeta * radial - rho * axial
        s[21, b], s[22, b], s[23, b] = radial * c - around * si, radial * si + around * c, axial
        s[24, b], s[25, b] = m_radial * c - m_around * si, m_radial * si + m_around * c
        s[26, b] = -along * rho


@inlined
def load_ring(i, f, h, count, n, six):
    """Add what `count` balls do to the ring over a kick of h (s) to its equations `six` (`Six`)."""
    _matrix_sums(i, f, h, n)
    _force_sums(i, f, n)
    k = 0
    for row in range(6):
        for column in range(row, 6):
            total = _total(f.sums, k, count)
            six.matrix[row, column] += total
            if column > row:
                six.matrix[column, row] += total
            k += 1
    for row in range(6):
        six.right[row] += _total(f.sums, 21 + row, count)


@inlined
def _total(sums, k, count):
    """The sum of row k over `count` balls."""
    total = 0.0
    for b in range(count):
        total += sums[k, b]
    return total


@inlined
def set_friction(o, i, f, w, n):
    """Set the friction of `n` balls at both races (N), and its heat (W); w: s/kg.

    i.moved_t and i.moved_m are how far the ring's surface runs ahead in this kick.
    """
    for b in range(n):
        w_tt, w_tm, w_mt, w_mm = f.w_tt[b], f.w_tm[b], f.w_mt[b], f.w_mm[b]
        ahead_t, ahead_m = i.moved_t[b], i.moved_m[b]
        f_t = f.held_t[b] + f.gain_tt[b] * ahead_t + f.gain_tm[b] * ahead_m
        f_m = f.held_m[b] + f.gain_tm[b] * ahead_t + f.gain_mm[b] * ahead_m
        d_t, d_m = w_tt * f_t + w_tm * f_m, w_mt * f_t + w_mm * f_m
        g_t = o.alone_t[b] - o.slope_tt[b] * d_t - o.slope_tm[b] * d_m
        g_m = o.alone_m[b] - o.slope_tm[b] * d_t - o.slope_mm[b] * d_m
        d_t, d_m = d_t + o.driven_t[b] + w * g_t, d_m + o.driven_m[b] + w * g_m
        o.loss[b] = -g_t * (o.along_t[b] + 0.5 * d_t) - g_m * (o.along_m[b] + 0.5 * d_m)
        d_t = i.driven_t[b] + w * f_t + w_tt * g_t + w_mt * g_m - ahead_t
        d_m = i.driven_m[b] + w * f_m + w_tm * g_t + w_mm * g_m - ahead_m
        i.loss[b] = -f_t * (i.along_t[b] + 0.5 * d_t) - f_m * (i.along_m[b] + 0.5 * d_m)
        o.friction_t[b], o.friction_m[b], i.friction_t[b], i.friction_m[b] = g_t, g_m, f_t, f_m


@inlined
def brake(balls, o, i, by_mass, by_inertia, n):
    """Add friction at both races to the accelerations of `n` balls.

    by_mass: 1/kg; by_inertia: radius over inertia (1/(kg m)).
    """
    for b in range(n):
        g_t, g_m, f_t, f_m = o.friction_t[b], o.friction_m[b], i.friction_t[b], i.friction_m[b]
        balls.ax[b] += (g_t * o.tx[b] + g_m * o.mx[b] + f_t * i.tx[b] + f_m * i.mx[b]) * by_mass
        balls.ay[b] += (g_t * o.ty[b] + g_m * o.my[b] + f_t * i.ty[b] + f_m * i.my[b]) * by_mass
        balls.az[b] += (g_t * o.tz[b] + g_m * o.mz[b] + f_t * i.tz[b] + f_m * i.mz[b]) * by_mass
        balls.px[b] += (g_m * o.tx[b] - g_t * o.mx[b] + f_m * i.tx[b] - f_t * i.mx[b]) * by_inertia
        balls.py[b] += (g_m * o.ty[b] - g_t * o.my[b] + f_m * i.ty[b] - f_t * i.my[b]) * by_inertia
        balls.pz[b] += (g_m * o.tz[b] - g_t * o.mz[b] + f_m * i.tz[b] - f_t * i.mz[b]) * by_inertia


@inlined
def find_middle(balls, c, h, n):
    """Set the rates of `n` contacts c in the middle of a kick of h (s), and add the heat of damping."""
    for b in range(n):
        into = balls.ax[b] * c.ux[b] + balls.ay[b] * c.uy[b] + balls.az[b] * c.uz[b]
        middle = c.rate[b] + 0.5 * (c.opened[b] - h * into)
        c.middle[b] = middle
        c.loss[b] += c.damped[b] * middle


class RaceTotal(NamedTuple):
    """Sum over all balls of their action on a race: force, its part that makes heat (N), heat (W)."""

    fx: float
    fy: float
    fz: float
    hx: float
    hy: float
    hz: float
    loss: float


@inlined
def total_on(c, count):
    """`RaceTotal` of `count` balls on the body of contacts c."""
    fx, fy, fz, hx, hy, hz, loss = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for b in range(count):
        along, across, damped, elastic = (
            c.friction_t[b],
            c.friction_m[b],
            c.damped[b],
            c.normal[b] - c.damped[b],
        )
        x = along * c.tx[b] + across * c.mx[b] + damped * c.ux[b]
        y = along * c.ty[b] + across * c.my[b] + damped * c.uy[b]
        z = along * c.tz[b] + across * c.mz[b] + damped * c.uz[b]
        hx, hy, hz = hx - x, hy - y, hz - z
        fx, fy, fz = fx - x - elastic * c.ux[b], fy - y - elastic * c.uy[b], fz - z - elastic * c.uz[b]
        loss += c.loss[b]
    return RaceTotal(fx, fy, fz, hx, hy, hz, loss)
