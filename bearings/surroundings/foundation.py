"""A foundation that touchdown bearings share: elastic modes, with a carrier on a mount at each seat.

Carrier j stands on its mount (`mount_law`), the mount on the foundation's point u_j = Phi_j eta; its
elements act on what the carrier is off that point. The modes are mass-normalised, Phi = shape/sqrt(modal
mass):

    eta_i'' + 2 zeta_i omega_i eta_i' + omega_i^2 eta_i = sum_j Phi_ji . f_j

f_j being what mount j presses with. All that is linear (carriers, modes, springs, dampers, branches) is one
system that goes by Gauss's collocation; slides, stops and films give their mean forces over the ways of a
step, as in `mount`. The ways d of all seats are linear in these forces, d = d_free - G f: G is what is left
of the system when all but the seats is eliminated (its Schur complement), and

    G^-1 (d - d_free) + f(d) = 0

is solved by Newton's method. Work, energy and heat close as a mount's do, whatever the step is.

At the start everything rests under the carriers' weight; modes are counted from where the foundation's own
weight has bent it. Along the shaft the foundation is rigid, and each carrier stands on its own spring.
Frame and signs as everywhere: x horizontal, y up, SI.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass

import numpy as np

from ...modelkit.gravity import INCLINATION, gravity_across, gravity_along
from ...modelkit.integrators import gauss
from ...modelkit.kernel import kernel
from ...modelkit.model import Model, memory_layout
from ...modelkit.numerics import squared
from ...modelkit.ports import Energy, MountLoad, MountState
from ...modelkit.status import BAD_INPUT, BAD_LOAD, OK
from ...modelkit.variables import array, flatten, group, groups, integer, real
from . import axial_mount
from .axial_mount import along_rate, derive_along, go_along, publish_along
from .mount import BEYOND_FILM, CLOSE, DIFFERENCE, DRIVES, MOST_PARTS, MOST_TRIES, RESOLUTION, take_parts
from .mount_law import (
    BRANCHES,
    DAMPER,
    HEATS,
    SLIDES,
    Carrier,
    StrokeReport,
    branches_in_use,
    drives,
    force_now,
    go,
    is_linear,
    linear_heat,
    linear_rate,
    mean_force,
    note_hit,
    note_peaks,
    outruns_film,
    quickness,
    rates,
    sag,
    sag_beyond_film,
    stored,
    tangent,
    tell,
)

SEATS, MODES = 4, 8
NAMES = "ABCD"  # of the seats
PLACES = 2 * SEATS + MODES
LINEAR = 2 * PLACES + 2 * BRANCHES * SEATS
Z = LINEAR  # stretch of the slides: seat by seat, x and y of each
WORK = Z + 2 * SLIDES * SEATS
HEAT = WORK + SEATS
MODES_HEAT = HEAT + HEATS * SEATS
ALONG = MODES_HEAT + 1
STATE = ALONG + axial_mount.SIZE * SEATS
OWN = 4 + 2 * BRANCHES  # numbers of one seat, as `mount_law` has them
LEAST = 1e-15  # m; ways that differ by less differ by rounding
WIDTH = LINEAR + 8 * SEATS  # forces on the carriers, forces of the mounts, and the slopes of both


@dataclass(frozen=True)
class Point:
    """Of a mode's shape at a seat."""

    x: float = real(0.0, "1", "horizontally")
    y: float = real(0.0, "1", "vertically")


@dataclass(frozen=True)
class Mode:
    """A mode of the foundation without the carriers."""

    omega: float = real(1000.0, "rad/s", "angular frequency", above=0.0, shown="rad/s")
    damping_ratio: float = real(0.0, "1", "of critical", minimum=0.0)
    mass: float = real(1.0, "kg", "modal mass, to which its shape is scaled", above=0.0)
    shape: tuple = groups(Point, SEATS, needs="seats >= #")


@dataclass(frozen=True)
class Parameters:
    """Two seats, and no mode: each is a mount of its own."""

    seats: int = integer(2, "in use", minimum=1, maximum=SEATS)
    modes: int = integer(0, "in use", minimum=0, maximum=MODES)
    gravity: float = real(9.81, "m/s2", "gravity, downwards", minimum=0.0)
    mode: tuple = groups(Mode, MODES, needs="modes >= #")
    mount: tuple = groups(Carrier, SEATS, needs="seats >= #")
    inclination: float = real(0.0, "rad", INCLINATION)


@dataclass(frozen=True)
class Inputs:
    """Forces of the bearings."""

    seat: tuple = groups(MountLoad, SEATS)


@dataclass(frozen=True)
class Outputs:
    """Motion of the carriers."""

    seat: tuple = groups(MountState, SEATS)
    strokes: tuple = groups(StrokeReport, SEATS)
    energy: Energy = group(Energy)
    modes_heat: float = real(0.0, "J", "heat of the modes since the start", local=True)


@dataclass(frozen=True)
class Prepared:
    """The linear part, and its step of one length, kept until another one is wanted."""

    length: float = real(0.0, "s", "that the matrices are for; 0: for none")
    branches: int = integer(0, "that each seat has in the state")
    places: int = integer(0, "coordinates: two of each carrier, one of each mode")
    size: int = integer(0, "of the linear state")
    linear: int = integer(0, "1 where there is nothing else")
    rate: float = real(0.0, "rad/s", "of the linear part, at most")
    shape: object = array(2 * SEATS, MODES)  # mass-normalised, x and y of each seat
    points: object = array(gauss.POINTS * LINEAR, WIDTH)
    end: object = array(LINEAR, WIDTH)
    stiff: object = array(2 * SEATS, 2 * SEATS)


MEMORY = memory_layout(Parameters, Inputs, Outputs, STATE, derived=Prepared)


@kernel
def _shaftwise(row, j):
    """Of seat j along the shaft: a view (2,) of a state or its derivative."""
    return row[ALONG + axial_mount.SIZE * j : ALONG + axial_mount.SIZE * (j + 1)]


@kernel
def _own(m, state, j, own):
    """Way (m), speed (m/s) and branches of mount j, as `mount_law` takes them, from a linear `state`."""
    d, places = m.d, m.d.places
    for axis in range(2):
        way, speed = state[2 * j + axis], state[places + 2 * j + axis]
        for i in range(m.p.modes):
            share = d.shape[2 * j + axis, i]
            way -= share * state[2 * m.p.seats + i]
            speed -= share * state[places + 2 * m.p.seats + i]
        own[axis], own[2 + axis] = way, speed
    first = 2 * places + 2 * d.branches * j
    for i in range(2 * d.branches):
        own[4 + i] = state[first + i]


@kernel
def _press(m, a, row, sign, j, axis):
    """Add to a row of the matrix what mount j resists with (N) in a direction, times `sign`."""
    p, d = m.p, m.d
    mount, places, seats = p.mount[j], d.places, p.seats
    kx, ky = (mount.spring.xx, mount.spring.xy) if axis == 0 else (mount.spring.yx, mount.spring.yy)
    cx, cy = (mount.damper.xx, mount.damper.xy) if axis == 0 else (mount.damper.yx, mount.damper.yy)
    for other in range(2):
        k, c = (kx, cx) if other == 0 else (ky, cy)
        a[row, 2 * j + other] += sign * k
        a[row, places + 2 * j + other] += sign * c
        for i in range(p.modes):
            share = d.shape[2 * j + other, i]
            a[row, 2 * seats + i] -= sign * k * share
            a[row, places + 2 * seats + i] -= sign * c * share
    for i in range(d.branches):
        a[row, 2 * places + 2 * (d.branches * j + i) + axis] += sign * mount.branch[i].stiffness


@kernel
def _system(m, a, b):
    """The linear system: a (n, n), and b (n, 4 seats) of forces on the carriers and of the mounts (N)."""
    p, d = m.p, m.d
    places, seats = d.places, p.seats
    for i in range(places):
        a[i, places + i] = 1.0
    for j in range(seats):
        mass = p.mount[j].mass + p.mount[j].outer_ring
        for axis in range(2):
            at, row = 2 * j + axis, places + 2 * j + axis
            _press(m, a, row, -1.0 / mass, j, axis)
            b[row, at] = 1.0 / mass
            b[row, 2 * seats + at] = -1.0 / mass
            for i in range(p.modes):
                of_mode = places + 2 * seats + i
                _press(m, a, of_mode, d.shape[at, i], j, axis)
                b[of_mode, 2 * seats + at] = d.shape[at, i]
            for i in range(d.branches):
                branch = 2 * places + 2 * (d.branches * j + i) + axis
                a[branch, branch] = -1.0 / p.mount[j].branch[i].time
                a[branch, row] = 1.0
                for k in range(p.modes):
                    a[branch, places + 2 * seats + k] = -d.shape[at, k]
    for i in range(p.modes):
        row, omega = places + 2 * seats + i, p.mode[i].omega
        a[row, 2 * seats + i] -= omega * omega
        a[row, row] -= 2.0 * p.mode[i].damping_ratio * omega


@kernel
def _prepare(m, h):
    """Have m.d ready for steps of h (s)."""
    d = m.d
    n, ways = d.size, 2 * m.p.seats
    a, b = np.zeros((n, n)), np.zeros((n, 2 * ways))
    _system(m, a, b)
    gauss.prepare(a, b, h, d.points, d.end)
    compliance, stiff = np.zeros((ways, ways)), np.zeros((ways, ways))
    for r in range(ways):
        stiff[r, r] = 1.0
        for k in range(ways):
            found = d.end[r, n + ways + k]
            for i in range(m.p.modes):
                found -= d.shape[r, i] * d.end[ways + i, n + ways + k]
            compliance[r, k] = -found
    gauss.solve(compliance, stiff)
    for r in range(ways):
        for k in range(ways):
            d.stiff[r, k] = stiff[r, k]
    d.length = h


@kernel
def publish(q, m):
    """Outputs at the end of the step, from the state q."""
    p, d, own = m.p, m.d, np.zeros(OWN)
    down, along = gravity_across(p.gravity, p.inclination), gravity_along(p.gravity, p.inclination)
    e = m.o.energy
    e.kinetic, e.potential, e.dissipated = 0.0, 0.0, q[MODES_HEAT]
    for j in range(p.seats):
        mount, o = p.mount[j], m.o.seat[j]
        mass = mount.mass + mount.outer_ring
        z, heat = (
            q[Z + 2 * SLIDES * j : Z + 2 * SLIDES * (j + 1)],
            q[HEAT + HEATS * j : HEAT + HEATS * (j + 1)],
        )
        _own(m, q, j, own)
        fx, fy, stop = force_now(mount, own, z)
        o.x, o.y = q[2 * j] + mount.x0, q[2 * j + 1] + mount.y0
        o.vx, o.vy = q[d.places + 2 * j], q[d.places + 2 * j + 1]
        o.ax_free, o.ay_free = -fx / mass, -fy / mass - down
        k, c = tangent(mount)
        o.inv_m, o.k_over_m, o.c_over_m = 1.0 / mass, k / mass, c / mass
        o.work = q[WORK + j]
        e.kinetic += 0.5 * mass * (o.vx * o.vx + o.vy * o.vy)
        e.potential += stored(mount, own, z) + mass * down * o.y
        kinetic, potential = publish_along(mount.axial, mass, along, _shaftwise(q, j), o)
        e.kinetic += kinetic
        e.potential += potential
        e.dissipated += np.sum(heat)
        tell(m.o.strokes[j], own, stop, heat)
    for i in range(p.modes):
        way, speed = q[2 * p.seats + i], q[d.places + 2 * p.seats + i]
        e.kinetic += 0.5 * speed * speed
        e.potential += 0.5 * squared(p.mode[i].omega * way)
    m.o.modes_heat = q[MODES_HEAT]


@kernel
def rhs(t, q, dq, m):
    """Derivative dq (STATE,) of the state q under the forces mean + slope (t - t_mid); t: s."""
    p, d, s = m.p, m.d, t - m.half
    down, along = gravity_across(p.gravity, p.inclination), gravity_along(p.gravity, p.inclination)
    places, seats, own = d.places, p.seats, np.zeros(OWN)
    for i in range(STATE):
        dq[i] = 0.0
    for i in range(p.modes):
        at, mode = 2 * seats + i, p.mode[i]
        speed, damping = q[places + at], 2.0 * mode.damping_ratio * mode.omega
        dq[at], dq[places + at] = speed, -damping * speed - mode.omega * mode.omega * q[at]
        dq[MODES_HEAT] += damping * speed * speed
    for j in range(seats):
        u, mount = m.u.seat[j], p.mount[j]
        mass, at = mount.mass + mount.outer_ring, 2 * j
        z, heat = Z + 2 * SLIDES * j, HEAT + HEATS * j
        outer_x, outer_y = u.fx + u.dfx * s, u.fy + u.dfy * s
        _own(m, q, j, own)
        fx, fy = rates(mount, own, q[z : z + 2 * SLIDES], dq[z : z + 2 * SLIDES], dq[heat : heat + HEATS])
        vx, vy = q[places + at], q[places + at + 1]
        dq[at], dq[at + 1] = vx, vy
        dq[places + at], dq[places + at + 1] = (outer_x - fx) / mass, (outer_y - fy) / mass - down
        for i in range(p.modes):
            dq[places + 2 * seats + i] += d.shape[at, i] * fx + d.shape[at + 1, i] * fy
        for i in range(d.branches):
            for axis in range(2):
                branch = 2 * places + 2 * (d.branches * j + i) + axis
                dq[branch] = own[2 + axis] - q[branch] / mount.branch[i].time
        outer_z = u.fz + u.dfz * s
        power, loss = along_rate(mount.axial, mass, along, outer_z, _shaftwise(q, j), _shaftwise(dq, j))
        dq[heat + DAMPER] += loss
        dq[WORK + j] = outer_x * vx + outer_y * vy + power


@kernel
def derive(words):
    """Shapes, sizes and the fastest rate.

    Returns 1 where the dampers of a mount drive its carrier, 2 where one's weight is more than its film has
    room for.
    """
    m = words.view(MEMORY)[0]
    p, d = m.p, m.d
    m.n = STATE
    d.length, d.branches, d.linear, d.rate = 0.0, 0, 1, 0.0
    number = 0
    for j in range(p.seats):
        mount = p.mount[j]
        c = mount.damper
        d.branches = max(d.branches, branches_in_use(mount))
        d.linear = d.linear if is_linear(mount) else 0
        d.rate = max(d.rate, linear_rate(mount, mount.mass + mount.outer_ring))
        if number == 0 and drives(c):
            m.message_numbers[0], m.message_numbers[1], m.message_numbers[2], m.message_numbers[3] = (
                c.xx,
                c.yy,
                c.xy,
                c.yx,
            )
            number = 1
        weight = (mount.mass + mount.outer_ring) * gravity_across(p.gravity, p.inclination)
        rest = sag_beyond_film(mount, weight)
        if number == 0 and rest > 0.0:
            m.message_numbers[0], m.message_numbers[1] = 1e6 * rest, 1e6 * mount.film.clearance
            number = 2
        for i in range(p.modes):
            scale = 1.0 / math.sqrt(p.mode[i].mass)
            d.shape[2 * j, i] = scale * p.mode[i].shape[j].x
            d.shape[2 * j + 1, i] = scale * p.mode[i].shape[j].y
    for i in range(p.modes):
        d.rate = max(d.rate, p.mode[i].omega)
    d.places = 2 * p.seats + p.modes
    d.size = 2 * d.places + 2 * d.branches * p.seats
    for j in range(p.seats):
        along = _shaftwise(m.weight, j)
        along[axial_mount.Z], along[axial_mount.VZ] = 1e6, 1e2
    for i in range(WORK):
        m.weight[i] = 1e2 if d.places <= i < 2 * d.places else 1e6  # 1 cm/s and 1 um matter
    return number


@kernel
def start(words):
    """At rest, every carrier sagged on its mount, and the modes under all of them."""
    m = words.view(MEMORY)[0]
    p, q, d = m.p, m.q, m.d
    down, along = gravity_across(p.gravity, p.inclination), gravity_along(p.gravity, p.inclination)
    for j in range(p.seats):
        mass = p.mount[j].mass + p.mount[j].outer_ring
        weight = mass * down
        derive_along(p.mount[j].axial, mass, along, _shaftwise(q, j))
        q[2 * j], q[2 * j + 1] = sag(p.mount[j], weight)
        for i in range(p.modes):
            q[2 * p.seats + i] -= d.shape[2 * j + 1, i] * weight / squared(p.mode[i].omega)
    for j in range(p.seats):
        for axis in range(2):
            for i in range(p.modes):
                q[2 * j + axis] += d.shape[2 * j + axis, i] * q[2 * p.seats + i]
    publish(q, m)


@kernel
def _parts(m, step):
    """Into how many equal steps a macro step of `step` (s) is divided: a power of two."""
    p, rate, own = m.p, m.d.rate, np.zeros(OWN)
    if m.d.linear == 0:
        for j in range(p.seats):
            u, mount = m.u.seat[j], p.mount[j]
            _own(m, m.q, j, own)
            fx, fy = abs(u.fx) + m.half * abs(u.dfx), abs(u.fy) + m.half * abs(u.dfy)
            rate = max(rate, quickness(mount, mount.mass + mount.outer_ring, own, fx, fy, step))
    parts = 1
    while parts < rate * step / RESOLUTION and parts < MOST_PARTS:
        parts *= 2
    return parts


@kernel
def _force(m, own, ways, j, h):
    """Mean force (N, N) of slides, stop and film of mount j on its way in `ways`, from `own` on."""
    z = m.q[Z + 2 * SLIDES * j : Z + 2 * SLIDES * (j + 1)]
    fx, fy, _, _, _, _ = mean_force(m.p.mount[j], own[j, 0], own[j, 1], ways[2 * j], ways[2 * j + 1], h, z)
    return fx, fy


@kernel
def _solve_strokes(m, own, free, h, ways, forces):
    """Fill the `ways` (m) and mean `forces` (N) of all mounts in a step of h (s); free: without them.

    Returns whether they were found, as of `mount`.
    """
    seats, stiff = m.p.seats, m.d.stiff
    count = 2 * seats
    matrix, right, change = np.zeros((count, count)), np.zeros((count, 1)), np.zeros(count)
    trial, was, found = np.zeros(count), math.inf, False
    for k in range(count):
        ways[k] = free[k]
    for _ in range(MOST_TRIES):
        now, size, last = 0.0, 0.0, 0.0
        for j in range(seats):
            forces[2 * j], forces[2 * j + 1] = _force(m, own, ways, j, h)
        for r in range(count):
            total = forces[r]
            for k in range(count):
                total += stiff[r, k] * (ways[k] - free[k])
            right[r, 0] = -total
            now, size, last = now + total * total, size + squared(ways[r]), last + squared(change[r])
        if now > was and last > CLOSE * CLOSE * size:  # too far across a kink
            for k in range(count):
                change[k] *= 0.5
                ways[k] -= change[k]
            continue
        was = now
        for j in range(seats):
            small = DIFFERENCE * (abs(ways[2 * j]) + abs(ways[2 * j + 1])) + 1e-16
            for axis in range(2):
                for k in range(count):
                    trial[k] = ways[k]
                trial[2 * j + axis] += small
                fx, fy = _force(m, own, trial, j, h)
                for k in range(count):
                    matrix[k, 2 * j + axis] = stiff[k, 2 * j + axis]
                matrix[2 * j, 2 * j + axis] += (fx - forces[2 * j]) / small
                matrix[2 * j + 1, 2 * j + axis] += (fy - forces[2 * j + 1]) / small
        gauss.solve(matrix, right)
        last, size = 0.0, 0.0
        for k in range(count):
            change[k] = right[k, 0]
            ways[k] += change[k]
            last, size = last + squared(change[k]), size + squared(ways[k])
        found = last <= LEAST * LEAST
        if last <= CLOSE * CLOSE * size:
            found = True
            break
    for j in range(seats):
        forces[2 * j], forces[2 * j + 1] = _force(m, own, ways, j, h)
    return found


@kernel
def _give_way(m, own, given, end, h):
    """Add the mean forces of slides, stops and films in a step of h (s) to `given`; their state follows.

    Returns whether there are such, and none is too long for a film.
    """
    n, seats, q = m.d.size, m.p.seats, m.q
    ways, forces, free = np.zeros(2 * seats), np.zeros(2 * seats), np.zeros(2 * seats)
    after = np.zeros(OWN)
    gauss.apply(m.d.end, n, given, n + 8 * seats, end)
    for j in range(seats):
        _own(m, end, j, after)
        free[2 * j], free[2 * j + 1] = after[0] - own[j, 0], after[1] - own[j, 1]
    solved = _solve_strokes(m, own, free, h, ways, forces)
    for j in range(seats):
        film = m.p.mount[j].film
        solved = solved and not outruns_film(film, own[j, 0], own[j, 1], ways[2 * j], ways[2 * j + 1])
    if not solved:
        return False
    for j in range(seats):
        given[n + 2 * seats + 2 * j], given[n + 2 * seats + 2 * j + 1] = forces[2 * j], forces[2 * j + 1]
        z = q[Z + 2 * SLIDES * j : Z + 2 * SLIDES * (j + 1)]
        go(m.p.mount[j], own[j, 0], own[j, 1], ways[2 * j], ways[2 * j + 1], h, z, q[HEAT + HEATS * j :])
    return True


@kernel
def _account(m, state, since, part):
    """Book work and heat at a point of a step that counts for `part` (s), `since` (s) from the middle."""
    p, q, own = m.p, m.q, np.zeros(OWN)
    for j in range(p.seats):
        u, at = m.u.seat[j], m.d.places + 2 * j
        q[WORK + j] += part * ((u.fx + u.dfx * since) * state[at] + (u.fy + u.dfy * since) * state[at + 1])
        _own(m, state, j, own)
        linear_heat(p.mount[j], own, part, q[HEAT + HEATS * j :])
        note_peaks(m.o.strokes[j], p.mount[j].stop, own)
    for i in range(p.modes):
        speed = state[m.d.places + 2 * p.seats + i]
        q[MODES_HEAT] += part * 2.0 * p.mode[i].damping_ratio * p.mode[i].omega * speed * speed


@kernel
def _step(m, time, h, since):
    """One step of h (s) from `time` (s), its middle `since` (s) after that of the macro step.

    Returns whether there is one.
    """
    p, q, d = m.p, m.q, m.d
    n, seats = d.size, p.seats
    given, end, points = np.zeros(WIDTH), np.empty(LINEAR), np.empty(gauss.POINTS * LINEAR)
    own, after = np.zeros((SEATS, OWN)), np.zeros(OWN)
    down = gravity_across(p.gravity, p.inclination)
    for i in range(n):
        given[i] = q[i]
    for j in range(seats):
        u, weight = m.u.seat[j], (p.mount[j].mass + p.mount[j].outer_ring) * down
        given[n + 2 * j], given[n + 2 * j + 1] = u.fx + u.dfx * since, u.fy + u.dfy * since - weight
        given[n + 4 * seats + 2 * j], given[n + 4 * seats + 2 * j + 1] = u.dfx, u.dfy
        _own(m, q, j, own[j])
    if d.linear == 0 and not _give_way(m, own, given, end, h):
        return False
    gauss.apply(d.end, n, given, n + 8 * seats, end)
    gauss.apply(d.points, gauss.POINTS * n, given, n + 8 * seats, points)
    for i in range(gauss.POINTS):
        late = since + (gauss.PLACES[i] - 0.5) * h
        _account(m, points[i * n : (i + 1) * n], late, h * gauss.WEIGHTS[i])
    for i in range(n):
        q[i] = end[i]
    for j in range(seats):
        _own(m, q, j, after)
        out, stop = m.o.strokes[j], p.mount[j].stop
        note_peaks(out, stop, after)
        strokes = math.hypot(own[j, 0], own[j, 1]), math.hypot(after[0], after[1])
        note_hit(out, stop, strokes[0], strokes[1], time, h)
    return True


@kernel
def derivative(t, q, dq, words):
    """`rhs`, for Python."""
    rhs(t, q, dq, words.view(MEMORY)[0])


@kernel
def motion(q, words):
    """`publish`, for Python."""
    publish(q, words.view(MEMORY)[0])


@kernel
def advance(words, work, time, step):
    """One macro step of `step` (s) from `time` (s) under the given forces; returns a status."""
    m = words.view(MEMORY)[0]
    for u in m.u.seat:  # those without a carrier, too: what is wrong is said where it is set
        if not math.isfinite(u.fx + u.fy + u.fz + u.dfx + u.dfy + u.dfz):
            return BAD_INPUT
    m.time = time
    m.half = 0.5 * step
    status = take_parts(_prepare, _step, _parts(m, step), m, time, step)
    if status != OK:
        return status
    down = gravity_along(m.p.gravity, m.p.inclination)
    for j in range(m.p.seats):
        mount = m.p.mount[j]
        mass = mount.mass + mount.outer_ring
        given, heat = go_along(mount.axial, mass, down, m.u.seat[j], step, _shaftwise(m.q, j))
        m.q[WORK + j] += given
        m.q[HEAT + HEATS * j + DAMPER] += heat
    publish(m.q, m)
    return OK if math.isfinite(np.sum(m.q)) else BAD_LOAD


def exposed(name: str) -> str:
    """Seats by letters: seat[1].x is A.x, mount[1].mass mount_A.mass, strokes[1].stroke mount_A.stroke."""
    name = re.sub(r"^(mount|strokes)\[(\d)\]", lambda match: f"mount_{NAMES[int(match[2]) - 1]}", name)
    return re.sub(r"(?:shape|seat)\[(\d)\]", lambda match: NAMES[int(match[1]) - 1], name)


_ALL = tuple(exposed(variable.name) for variable in flatten(Parameters()))
_FIRST = tuple(
    exposed(variable.name)
    for variable in flatten(Outputs())
    if variable.name.startswith(("seat[", "strokes["))
    and not variable.name.endswith((".work", ".jump", ".stop_time", ".stop_hits"))
    and ".heat." not in variable.name
)

MODEL = Model(
    name="foundation",
    title="Foundation",
    about="Elastic modes under several touchdown bearings, with a carrier on a mount at each seat",
    parameters=Parameters,
    inputs=Inputs,
    outputs=Outputs,
    memory=MEMORY,
    derive=derive,
    start=start,
    advance=advance,
    derivative=derivative,
    motion=motion,
    problems=(DRIVES, BEYOND_FILM),
    rename=exposed,
    starts_from={name: _ALL for name in (*_FIRST, "energy.potential")},
)
