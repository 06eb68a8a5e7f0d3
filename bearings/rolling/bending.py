"""The inner ring as a thick curved beam that bends in its plane.

Its centroid circle of radius R is displaced by u outwards, v along and turned by f: in harmonic n by
W cos n a, V sin n a and F sin n a, and likewise a quarter of a wave on. With z = r - R in the section,
S_k = int z^k/r dA and M_k = int z^k r dA, energies of Winkler and Bach's beam with shear are

    strain    pi/2 (E (S_0 (W + n V)^2 + 2 S_1 (W + n V) n F + S_2 n^2 F^2) + 5/6 G S_0 (R F - V - n W)^2)
    motion    pi/2 rho (M_0 (W'^2 + V'^2) + 2 M_1 V' F' + M_2 F'^2)

Of the three modes of a harmonic two lie at 70 kHz and more. The one that bends is kept, with unit modal
mass and with the compliance c_n of the whole harmonic to a radial load: it moves the ring by
W_n = w_n sqrt(c_n).
The thin limit is c_n = R^3/(pi E I (n^2 - 1)^2). Density is that which gives the ring its mass.

Balls press the race, and the journal the bore, at r + u(a) with a about the ring's centre in a frame that
does not turn: the ring is round, and what a turning frame would add is 2 n/(n^2 + 1) of its speed over
w_n, 1 % at 9000 rpm. Forces are the slopes of the potential; normals are turned by u'/r. Friction does no
work on bending. Harmonics 2 to ceil(0.41 Z), with Z balls in a row, give ball loads within 4 % of all of
them; frequencies above what a micro-step resolves are lowered to it, with the compliance kept, since the
load of balls is nearly a static matter.

A ring may also breathe, in harmonic 0: the last amplitude, of odd `waves`, opens the race alike all around
(`angular.hoop`).

Young, Budynas, Roark's Formulas for Stress and Strain, chapter 9; Timoshenko, Strength of Materials, part
II; Love, Mathematical Theory of Elasticity, article 293 (the thin ring's frequencies).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

from ...modelkit.kernel import inlined, kernel
from ...modelkit.numerics import squared
from ...modelkit.variables import array, integer, real
from ..contact.materials import elastic_of
from .ball_set import MAX_BALLS

MAX_HARMONICS = 13  # but for one, as many as `MAX_BALLS` ask for
MAX_WAVES = 2 * (MAX_HARMONICS - 1)
MAX_STATES = 2 * MAX_WAVES  # amplitudes and their rates
AUTOMATIC = -1  # harmonics as the balls ask for
HARMONICS_PER_BALL = 0.41  # with 0.40, 25 balls in a thin ring are off by 4.1 %
SHOULDER_HEIGHT = 0.2  # above the groove's bottom, over ball diameter
SHEAR_FACTOR = 5.0 / 6.0
INTERVALS = 64  # of Simpson's rule, in each part of the section
ITERATIONS = 100  # of the inverse iteration for a frequency


class SectionMoments(NamedTuple):
    """A ring's section: moments int z^k/r dA and int z^k r dA, z = r - R, k = 0, 1, 2."""

    radius: float  # m, R of the centroid
    s0: float  # m
    s1: float  # m2
    s2: float  # m3
    m0: float  # m3
    m1: float  # m4
    m2: float  # m5


class Groove(NamedTuple):
    """The section of a ring from its bore, or rim, to its shoulder, with grooves of a circle's arc."""

    bore: float  # m, radius; of an outer ring its outside
    bottom: float  # m, radius of the race
    shoulder: float  # m, radius
    width: float  # m, of the ring
    arc: float  # m, radius of a groove
    rows: int  # of grooves


class BentShape(NamedTuple):
    """A bent ring at one angle."""

    opening: float  # m, u outwards
    slope: float  # m, du/da
    rate: float  # m/s, of u


@dataclass(frozen=True)
class RingBending:
    """Modes of a ring that bends."""

    waves: int = integer(
        0, "amplitudes: two for each harmonic from 2 on, and one if the ring breathes; 0: it is rigid"
    )
    first: int = integer(0, "first of them in the state; their rates follow")
    answer: float = real(0.0, "1/kg", "of a place on the ring to a force there, by all modes")
    fastest: float = real(0.0, "rad/s", "largest frequency in use")
    weight: tuple = array(MAX_HARMONICS)  # 1/sqrt(kg), W_n from harmonic 2 on
    frequency: tuple = array(MAX_HARMONICS)  # rad/s
    damping_ratio: float = real(0.0, "1", "of each mode")
    bore: float = real(0.0, "1", "how far the bore breathes, over how far the race does")


ROUND = BentShape(0.0, 0.0, 0.0)


@dataclass(frozen=True)
class BendingMemory:
    """Shape of the ring at all balls, at the last evaluation, and what accelerates it."""

    nx: tuple = array(MAX_BALLS)  # direction of a ball from the ring's centre
    ny: tuple = array(MAX_BALLS)
    cosine: tuple = array(MAX_BALLS)  # of n times its angle, on the way through the harmonics
    sine: tuple = array(MAX_BALLS)
    opening: tuple = array(MAX_BALLS)  # m
    slope: tuple = array(MAX_BALLS)  # m
    rate: tuple = array(MAX_BALLS)  # m/s
    faster: tuple = array(MAX_BALLS)  # m/s2, change of that rate at balls that press, over the last kick
    bore_faster: float = real(0.0, "m/s2", "likewise at the journal")
    bore_x: float = real(0.0, "1", "direction of the journal from the ring's centre")
    bore_y: float = real(0.0, "1", "likewise")
    acceleration: tuple = array(MAX_WAVES)


@kernel
def _moments(groove):
    """(int r^j dA) for j from -1 to 3: below the grooves, and between the races' bottoms and shoulders.

    Beside a groove r = bottom + height t^2, in which its edge is smooth. In an outer ring all heights are
    inwards, negative; its areas are not.
    """
    low = high = one = two = three = 0.0
    height, below = groove.shoulder - groove.bottom, groove.bottom - groove.bore
    high_edge, solid = abs(height), abs(below)
    for i in range(INTERVALS + 1):
        factor = 1.0 if i in (0, INTERVALS) else 4.0 if i % 2 == 1 else 2.0
        factor /= 3.0 * INTERVALS
        t = i / INTERVALS
        chord = 2.0 * t * math.sqrt(high_edge * (2.0 * groove.arc - high_edge * t * t))
        above = factor * 2.0 * high_edge * t * (groove.width - groove.rows * chord)
        for part in range(2):
            r = groove.bore + below * t if part == 0 else groove.bottom + height * t * t
            area = factor * solid * groove.width if part == 0 else above
            low, high = low + area / r, high + area
            one, two, three = one + area * r, two + area * r * r, three + area * r * r * r
    return low, high, one, two, three


@kernel
def section_of(groove):
    """`SectionMoments` of a ring by its `Groove`."""
    inverse, area, one, two, three = _moments(groove)
    r = one / area
    return SectionMoments(
        r,
        inverse,
        area - r * inverse,
        one - 2.0 * r * area + r * r * inverse,
        one,
        two - r * one,
        three - 2.0 * r * two + r * r * one,
    )


class Symmetric(NamedTuple):
    """A symmetric matrix of three rows."""

    xx: float
    xy: float
    xz: float
    yy: float
    yz: float
    zz: float


@kernel
def _stiffness(section, n, modulus, poisson):
    """`Symmetric` stiffness (N/m, N, N m) of harmonic `n` over its (W, V, F); modulus: Pa."""
    s, r = section, section.radius
    shear = SHEAR_FACTOR * modulus / (2.0 * (1.0 + poisson)) * s.s0
    e0, e1, e2 = modulus * s.s0, modulus * s.s1, modulus * s.s2
    return Symmetric(
        math.pi * (e0 + shear * n * n),
        math.pi * n * (e0 + shear),
        math.pi * n * (e1 - shear * r),
        math.pi * (e0 * n * n + shear),
        math.pi * (e1 * n * n - shear * r),
        math.pi * (e2 * n * n + shear * r * r),
    )


@kernel
def _inverse(a):
    """Inverse of a `Symmetric` matrix."""
    xx, xy, xz = a.yy * a.zz - a.yz * a.yz, a.xz * a.yz - a.xy * a.zz, a.xy * a.yz - a.xz * a.yy
    det = a.xx * xx + a.xy * xy + a.xz * xz
    yy, yz, zz = a.xx * a.zz - a.xz * a.xz, a.xy * a.xz - a.xx * a.yz, a.xx * a.yy - a.xy * a.xy
    return Symmetric(xx / det, xy / det, xz / det, yy / det, yz / det, zz / det)


@kernel
def compliance(section, n, modulus, poisson):
    """c_n (m/N): W of harmonic `n` by a radial load cos n a of unit generalised force; modulus: Pa."""
    return _inverse(_stiffness(section, n, modulus, poisson)).xx


@kernel
def frequency(section, n, modulus, poisson, density):
    """Angular frequency (rad/s) of bending in harmonic `n`, free; modulus: Pa, density: kg/m3."""
    c = _inverse(_stiffness(section, n, modulus, poisson))
    scale = math.pi * density
    w, v, f, square = 1.0, -1.0 / n, 0.0, 0.0
    for _ in range(ITERATIONS):
        a, b, g = section.m0 * w, section.m0 * v + section.m1 * f, section.m1 * v + section.m2 * f
        kinetic = scale * (a * w + b * v + g * f)
        a, b, g = scale * a, scale * b, scale * g
        w, v, f = (
            c.xx * a + c.xy * b + c.xz * g,
            c.xy * a + c.yy * b + c.yz * g,
            c.xz * a + c.yz * b + c.zz * g,
        )
        square = kinetic / (a * w + b * v + g * f)  # of Rayleigh, of the iterate before
        size = math.sqrt(w * w + v * v + f * f)
        w, v, f = w / size, v / size, f / size
    return math.sqrt(square)


@kernel
def groove_of(p):
    """`Groove` of the inner ring with the parameters p of a rolling bearing."""
    b = p.balls
    bottom = 0.5 * (b.pitch_diameter - b.diameter)
    width = p.ring.width if p.ring.width > 0.0 else p.contact.length
    shoulder = bottom + SHOULDER_HEIGHT * b.diameter
    return Groove(
        p.journal_radius + p.clearance, bottom, shoulder, width, 0.5 * b.conformity * b.diameter, b.rows
    )


@kernel
def harmonics_of(p):
    """The highest harmonic in use; below 2 the ring is rigid."""
    if p.ring.harmonics != AUTOMATIC:
        return p.ring.harmonics
    return min(math.ceil(HARMONICS_PER_BALL * p.balls.count), MAX_HARMONICS)


PROBLEMS = (
    "ring.harmonics = {0:g} lets a ring bend whose bore of {1:g} m reaches its race of {2:g} m (radii); "
    "correct them, or set ring.harmonics = 0",
    "ring.harmonics = {0:g} lets a ring bend whose {1:g} grooves leave nothing of its width of {2:g} m; "
    "set ring.width to that of the bearing, or ring.harmonics = 0",
)


@kernel
def section_problem(p, numbers):
    """The number in `PROBLEMS` of a fault in the section of a ring that bends, or 0."""
    if harmonics_of(p) < 2:
        return 0
    g = groove_of(p)
    numbers[0] = p.ring.harmonics
    if g.bore >= g.bottom:
        numbers[1], numbers[2] = g.bore, g.bottom
        return 1
    height = g.shoulder - g.bottom
    if g.width <= g.rows * 2.0 * math.sqrt(height * (2.0 * g.arc - height)):
        numbers[1], numbers[2] = g.rows, g.width
        return 2
    return 0


@kernel
def derive(bending, p, first, limit):
    """Set the modes in `bending` (RingBending) by the parameters p; `first`: their place in the state.

    limit: the highest frequency (rad/s), to which those above are lowered.
    """
    top = harmonics_of(p)
    bending.first, bending.waves, bending.answer, bending.fastest = first, 2 * max(top - 1, 0), 0.0, 0.0
    bending.damping_ratio, bending.bore = p.ring.damping_ratio, 0.0
    if top < 2:
        return
    section, (modulus, poisson) = section_of(groove_of(p)), elastic_of(p.ring)
    density = p.ring.mass / (2.0 * math.pi * section.m0)
    for n in range(2, top + 1):
        w = min(frequency(section, n, modulus, poisson, density), limit)
        bending.frequency[n - 2] = w
        bending.weight[n - 2] = w * math.sqrt(compliance(section, n, modulus, poisson))
        bending.answer += squared(bending.weight[n - 2])
        bending.fastest = max(bending.fastest, w)


@kernel
def add_breathing(bending, compliance, bore, mass, limit):
    """Add harmonic 0: the race opens by `compliance` (m/N) times the sum of the forces outwards.

    bore: how far the bore opens over that; mass: of the ring (kg); limit: as for `derive` (rad/s).
    """
    k, w = bending.waves // 2, min(1.0 / math.sqrt(compliance * mass), limit)
    bending.frequency[k], bending.weight[k] = w, w * math.sqrt(compliance)
    bending.waves, bending.bore = bending.waves + 1, bore


@kernel
def set_weights(bending, weight, length, speed):
    """Set the error weights of the modes in `weight` (n,); length, speed: of a place (1/m, s/m).

    Returns the number of components up to them.
    """
    first, waves = bending.first, bending.waves
    for i in range(waves):
        weight[first + i] = length * bending.weight[i // 2]
        weight[first + waves + i] = speed * bending.weight[i // 2]
    return first + 2 * waves


@inlined
def drift(trial, q, mid, h, bending):
    """Amplitudes in the state `trial`: those in q and h (s) times their rates in `mid`."""
    first, waves = bending.first, bending.waves
    to, start = trial[first : first + waves], q[first : first + waves]
    by = mid[first + waves : first + 2 * waves]
    for i in range(len(to)):
        to[i] = start[i] + h * by[i]


@inlined
def breath(q, bending):
    """(How far the race has opened all around (m), its rate (m/s)) in the state q."""
    if bending.waves % 2 == 0:
        return 0.0, 0.0
    i, w = bending.first + bending.waves - 1, bending.weight[bending.waves // 2]
    return w * q[i], w * q[i + bending.waves]


@inlined
def press_breath(force, bending, memory):
    """Add a `force` (N), the sum of those outwards, to what accelerates that mode, if there is one."""
    if bending.waves % 2 == 1:
        memory.acceleration[bending.waves - 1] += force


@kernel
def shape_at(q, nx, ny, bending):
    """`BentShape` of the bent ring in the state q at a direction (nx, ny) from its centre."""
    c, s, opening, slope, rate = nx, ny, 0.0, 0.0, 0.0
    waves = bending.waves
    for k in range(waves // 2):
        c, s = c * nx - s * ny, s * nx + c * ny
        i, w = bending.first + 2 * k, bending.weight[k]
        opening += w * (q[i] * c + q[i + 1] * s)
        slope += w * (k + 2) * (q[i + 1] * c - q[i] * s)
        i += waves
        rate += w * (q[i] * c + q[i + 1] * s)
    return BentShape(opening, slope, rate)


@kernel
def bore_at(q, nx, ny, bending):
    """`BentShape` of the bore in the state q at a direction (nx, ny) from the ring's centre."""
    bent, breathed = shape_at(q, nx, ny, bending), breath(q, bending)
    opening = bent.opening + bending.bore * breathed[0]
    return BentShape(opening, bent.slope, bent.rate + bending.bore * breathed[1])


@inlined
def bend(q, n, bending, memory):
    """Set in `memory` (BendingMemory) the shape of the ring in the state q at `n` balls.

    Their directions are there. Each harmonic is a loop over the balls, which becomes vector code.
    """
    s, first, waves = memory, bending.first, bending.waves
    for k in range(waves // 2):
        i, w, order = first + 2 * k, bending.weight[k], k + 2.0
        x, y, vx, vy = w * q[i], w * q[i + 1], w * q[i + waves], w * q[i + 1 + waves]
        along_x, along_y = order * x, order * y
        if k == 0:  # sets what the others add to
            for b in range(n):
                c = s.nx[b] * s.nx[b] - s.ny[b] * s.ny[b]
                d = 2.0 * s.nx[b] * s.ny[b]
                s.cosine[b], s.sine[b] = c, d
                s.opening[b] = x * c + y * d
                s.slope[b] = along_y * c - along_x * d
                s.rate[b] = vx * c + vy * d
            continue
        for b in range(n):
            c = s.cosine[b] * s.nx[b] - s.sine[b] * s.ny[b]
            d = s.sine[b] * s.nx[b] + s.cosine[b] * s.ny[b]
            s.cosine[b], s.sine[b] = c, d
            s.opening[b] += x * c + y * d
            s.slope[b] += along_y * c - along_x * d
            s.rate[b] += vx * c + vy * d


@kernel
def press_modes(force, nx, ny, bending, memory):
    """Add a `force` (N) on the ring, outwards at a direction (nx, ny), to what accelerates its bending."""
    c, s = nx, ny
    for k in range(bending.waves // 2):
        c, s = c * nx - s * ny, s * nx + c * ny
        memory.acceleration[2 * k] += force * c
        memory.acceleration[2 * k + 1] += force * s


@kernel
def press_bore(force, nx, ny, bending, memory):
    """The same of a `force` (N) in the bore, which also has the ring breathe."""
    press_modes(force, nx, ny, bending, memory)
    press_breath(bending.bore * force, bending, memory)


@kernel
def accelerate_modes(q, h, bending, memory):
    """Turn what presses the modes in `memory` (BendingMemory) to their accelerations over a kick of h (s).

    Returns the heat of their own damping (W).
    """
    loss, waves = 0.0, bending.waves
    for i in range(waves):
        rate, weight = bending.frequency[i // 2], bending.weight[i // 2]
        held = bending.damping_ratio * rate
        resisting = 1.0 / (1.0 + held * h)
        place, speed = bending.first + i, q[bending.first + waves + i]
        force = weight * memory.acceleration[i] - rate * rate * q[place]
        gained = (force - 2.0 * held * speed) * resisting
        memory.acceleration[i] = gained
        if held > 0.0:
            loss += 2.0 * held * squared(speed + 0.5 * h * gained)
    return loss


@kernel
def faster_at(nx, ny, bending, memory):
    """The ring's acceleration outwards (m/s2) at a direction (nx, ny), by its modes' in `memory`."""
    c, s, faster = nx, ny, 0.0
    for k in range(bending.waves // 2):
        c, s = c * nx - s * ny, s * nx + c * ny
        faster += bending.weight[k] * (memory.acceleration[2 * k] * c + memory.acceleration[2 * k + 1] * s)
    return faster


@inlined
def hand_over_modes(q, dq, bending, memory):
    """Set the modes' derivatives in dq."""
    first, waves = bending.first, bending.waves
    rates, values = dq[first : first + waves], q[first + waves : first + 2 * waves]
    for i in range(len(rates)):
        rates[i] = values[i]
    faster, values = dq[first + waves : first + 2 * waves], memory.acceleration[:waves]
    for i in range(len(faster)):
        faster[i] = values[i]


@kernel
def bending_energy(q, bending):
    """(Kinetic, elastic) energy (J) of the modes in the state q."""
    kinetic, elastic = 0.0, 0.0
    for i in range(bending.waves):
        w = bending.frequency[i // 2] * q[bending.first + i]
        kinetic += 0.5 * squared(q[bending.first + bending.waves + i])
        elastic += 0.5 * w * w
    return kinetic, elastic


@kernel
def ovality(q, bending):
    """Amplitude (m) of the second harmonic in the state q: half of what the diameters differ by."""
    if bending.waves < 2:
        return 0.0
    return bending.weight[0] * math.sqrt(squared(q[bending.first]) + squared(q[bending.first + 1]))
