"""A macro step of carriers on mounts (`mount_law`), and of the modes of what the mounts stand on.

Carrier j stands on mount j, the mount on the point u_j = Phi_j eta of the foundation; its elements act on
the carrier's displacement from that point. Modes are mass-normalised, Phi = shape/sqrt(modal mass), and

    eta_i'' + 2 zeta_i omega_i eta_i' + omega_i^2 eta_i = sum_j Phi_ji . f_j

under the forces f_j on the mounts. Without modes the ground is rigid.

A macro step is one step, or several equal ones where slides, stop or film act faster than it. In each, what
is linear (carriers, modes, springs, dampers, branches) goes by Gauss's collocation under the outer forces
and the mean forces f of the other elements. The ways d of all carriers are linear in f, d = d_free - G f,
and f follows from d; G is what is left of the system when all but the seats is eliminated:

    G^-1 (d - d_free) + f(d) = 0

Broyden's method solves it; where it does not, or where d is long beside the thickness of a film, the step
is halved, and in the end refused. The linear part gives f . d to the other elements, which state it as
stored energy and heat: energy and heat add up to the outer work whatever the step is. Without slides, stop
and film the step is exact to order six, with them to order two.

At the start everything rests under the carriers' weight; modes are counted from where the foundation's own
weight has bent it. The state is places of carriers and modes, their velocities, and the branches' stretch,
`m.d.size` numbers in all; then a block for each mount, and the heat of the modes.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ...modelkit.gravity import gravity_across, gravity_along
from ...modelkit.integrators import gauss
from ...modelkit.kernel import kernel
from ...modelkit.numerics import squared
from ...modelkit.status import BAD_INPUT, BAD_LOAD, OK, TOO_FAST
from ...modelkit.variables import array, integer, real
from . import axial_mount
from .axial_mount import along_rate, derive_along, go_along, publish_along
from .mount_law import (
    BRANCHES,
    DAMPER,
    HEATS,
    SLIDES,
    branches_in_use,
    drives,
    force_now,
    go,
    is_linear,
    linear_heat,
    linear_rate,
    mean_force,
    norm,
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

# Of a mount in the state: stretch of its slides (x and y of each), work, heat, motion along the shaft
WORK = 2 * SLIDES
HEAT = WORK + 1
ALONG = HEAT + HEATS
BLOCK = ALONG + axial_mount.SIZE
OWN = 4 + 2 * BRANCHES  # way, speed and branches of one mount, as `mount_law` takes them
RESOLUTION = 0.25  # rad of the fastest swing in a step
MOST_PARTS = 4096  # of a macro step
MOST_TRIES = 50  # evaluations of the equation of the ways
CLOSE = 1e-9  # of the ways; a last step of Broyden's method, after which the next would be rounding
ROUNDING = 1e-15  # of the forces; less of them is left by rounding
AT_REST = 1e-3  # of the way without slides, stop and film; below it the speed says little of the way
PROBLEMS = (  # numbered as `derive` returns them
    "damper has xx = {0:g}, yy = {1:g}, xy = {2:g}, yx = {3:g} N.s/m, which drives the carrier in some "
    "direction; xx and yy must not be below 0, nor ((xy + yx)/2)^2 above xx yy",
    "the carrier sags by {0:g} um under its weight, but film.clearance is {1:g} um, and a film bears no "
    "weight; stiffen the spring, set a stop within the clearance, or widen that",
)


def linear_size(seats: int, modes: int) -> int:
    """Numbers of the linear state at most."""
    return 2 * (2 * seats + modes) + 2 * BRANCHES * seats


def state_size(seats: int, modes: int) -> int:
    """Numbers of the state at most."""
    return linear_size(seats, modes) + BLOCK * seats + 1


def prepared(most_seats: int, most_modes: int) -> type:
    """Declaration of m.d: what follows from the parameters of up to so many seats and modes."""
    across, state, shapes = 2 * most_seats, linear_size(most_seats, most_modes), max(most_modes, 1)
    width = state + 2 * across * (2 if most_modes else 1)

    @dataclass(frozen=True)
    class Prepared:
        """The system, its linear part's step of one length, and scratch for a step."""

        omega: object = array(shapes)  # rad/s, of the modes
        ratio: object = array(shapes)  # of their critical damping
        shape: object = array(across, shapes)  # mass-normalised, x and y of each seat
        own: object = array(most_seats, OWN)  # of each mount, at the beginning of a step
        at_once: object = array(OWN)  # of one, at an instant
        seats: int = integer(0, "in use")
        modes: int = integer(0, "in use")
        branches: int = integer(0, "that each seat has in the state")
        places: int = integer(0, "coordinates: two of each carrier, one of each mode")
        size: int = integer(0, "of the linear state")
        forces: int = integer(0, "on carriers, then on mounts of a foundation with modes")
        linear: int = integer(0, "1 where there is nothing else")
        rate: float = real(0.0, "rad/s", "of the linear part, at most")
        length: float = real(0.0, "s", "that the matrices are for; 0: for none")
        points: object = array(gauss.POINTS * state, width)
        end: object = array(state, width)
        stiff: object = array(across, across)  # N/m, G^-1
        given: object = array(width)  # state, mean forces (N), slopes of those on the carriers (N/s)
        after: object = array(state)  # linear state at the end
        between: object = array(gauss.POINTS * state)  # and at the points
        free: object = array(across)  # m, ways without slides, stop and film
        ways: object = array(across)  # m
        left: object = array(across)  # N, of the equation of the ways
        later: object = array(across)  # N, the same after a step of Broyden's method
        change: object = array(across, 1)  # m, that step
        slopes: object = array(across, across)  # N/m, of what is left
        matrix: object = array(across, across)  # used up by solving

    return Prepared


@kernel
def _block(m, row, j):
    """Of mount j: a view (BLOCK,) of a state or its derivative."""
    first = m.d.size + BLOCK * j
    return row[first : first + BLOCK]


@kernel
def _mass(mount):
    """Of a carrier with the outer ring in it, kg."""
    return mount.mass + mount.outer_ring


@kernel
def _own(m, state, j, own):
    """Way (m), speed (m/s) and branches of mount j, as `mount_law` takes them, from a linear `state`."""
    d, places = m.d, m.d.places
    for axis in range(2):
        way, speed = state[2 * j + axis], state[places + 2 * j + axis]
        for i in range(d.modes):
            share = d.shape[2 * j + axis, i]
            way -= share * state[2 * d.seats + i]
            speed -= share * state[places + 2 * d.seats + i]
        own[axis], own[2 + axis] = way, speed
    first = 2 * places + 2 * d.branches * j
    for i in range(2 * d.branches):
        own[4 + i] = state[first + i]


@kernel
def derive(m):
    """Sizes, weights and the fastest rate, of m.d.seats and so on, which the model sets before.

    Returns 1 where the dampers of a mount drive its carrier, 2 where it would rest beyond its film's
    clearance.
    """
    p, d, number = m.p, m.d, 0
    d.length, d.branches, d.linear, d.rate = 0.0, 0, 1, 0.0
    down = gravity_across(p.gravity, p.inclination)
    for j in range(d.seats):
        mount, mass, c = p.mount[j], _mass(p.mount[j]), p.mount[j].damper
        d.branches = max(d.branches, branches_in_use(mount))
        d.linear = d.linear if is_linear(mount) else 0
        d.rate = max(d.rate, linear_rate(mount, mass))
        rest, numbers = sag_beyond_film(mount, mass * down), m.message_numbers
        if number == 0 and drives(c):
            numbers[0], numbers[1], numbers[2], numbers[3] = c.xx, c.yy, c.xy, c.yx
            number = 1
        if number == 0 and rest > 0.0:
            numbers[0], numbers[1] = 1e6 * rest, 1e6 * mount.film.clearance
            number = 2
    for i in range(d.modes):
        d.rate = max(d.rate, d.omega[i])
    d.places = 2 * d.seats + d.modes
    d.size = 2 * d.places + 2 * d.branches * d.seats
    d.forces = 2 * d.seats if d.modes == 0 else 4 * d.seats
    m.n = d.size + BLOCK * d.seats + 1
    for i in range(d.size):  # 1 um and 1 cm/s matter
        m.weight[i] = 1e2 if d.places <= i < 2 * d.places else 1e6
    for j in range(d.seats):
        weight = _block(m, m.weight, j)
        for i in range(WORK):
            weight[i] = 1e6
        weight[ALONG + axial_mount.Z], weight[ALONG + axial_mount.VZ] = 1e6, 1e2
    return number


@kernel
def start(m):
    """At rest, every carrier sagged on its springs and stop, and the modes under all of them."""
    p, q, d = m.p, m.q, m.d
    down, along = gravity_across(p.gravity, p.inclination), gravity_along(p.gravity, p.inclination)
    for j in range(d.seats):
        mass = _mass(p.mount[j])
        weight = mass * down
        derive_along(p.mount[j].axial, mass, along, _block(m, q, j)[ALONG:])
        q[2 * j], q[2 * j + 1] = sag(p.mount[j], weight)
        for i in range(d.modes):
            q[2 * d.seats + i] -= d.shape[2 * j + 1, i] * weight / squared(d.omega[i])
    for r in range(2 * d.seats):
        for i in range(d.modes):
            q[r] += d.shape[r, i] * q[2 * d.seats + i]
    publish(q, m)


@kernel
def publish(q, m):
    """Outputs at the end of the step, from the state q."""
    p, d, own = m.p, m.d, m.d.at_once
    down, along = gravity_across(p.gravity, p.inclination), gravity_along(p.gravity, p.inclination)
    e, m.o.modes_heat = m.o.energy, q[m.n - 1]
    e.kinetic, e.potential, e.dissipated = 0.0, 0.0, q[m.n - 1]
    for j in range(d.seats):
        mount, mass, o, block = p.mount[j], _mass(p.mount[j]), m.o.seat[j], _block(m, q, j)
        _own(m, q, j, own)
        fx, fy, stop = force_now(mount, own, block)
        o.x, o.y = q[2 * j] + mount.x0, q[2 * j + 1] + mount.y0
        o.vx, o.vy = q[d.places + 2 * j], q[d.places + 2 * j + 1]
        o.ax_free, o.ay_free = -fx / mass, -fy / mass - down
        k, c = tangent(mount)
        o.inv_m, o.k_over_m, o.c_over_m = 1.0 / mass, k / mass, c / mass
        o.work = block[WORK]
        e.kinetic += 0.5 * mass * (squared(o.vx) + squared(o.vy))
        e.potential += stored(mount, own, block) + mass * down * o.y
        kinetic, potential = publish_along(mount.axial, mass, along, block[ALONG:], o)
        e.kinetic += kinetic
        e.potential += potential
        e.dissipated += np.sum(block[HEAT:ALONG])
        tell(m.o.strokes[j], own, stop, block[HEAT:])
    for i in range(d.modes):
        way, speed = q[2 * d.seats + i], q[d.places + 2 * d.seats + i]
        e.kinetic += 0.5 * speed * speed
        e.potential += 0.5 * squared(d.omega[i] * way)


@kernel
def rhs(t, q, dq, m):
    """Derivative dq of the state q under the forces mean + slope (t - t_mid); t: s."""
    p, d, s = m.p, m.d, t - m.half
    down, along = gravity_across(p.gravity, p.inclination), gravity_along(p.gravity, p.inclination)
    places, seats, own = d.places, d.seats, d.at_once
    for i in range(m.n):
        dq[i] = 0.0
    for i in range(d.modes):
        at, omega = 2 * seats + i, d.omega[i]
        speed, damping = q[places + at], 2.0 * d.ratio[i] * omega
        dq[at], dq[places + at] = speed, -damping * speed - omega * omega * q[at]
        dq[m.n - 1] += damping * speed * speed
    for j in range(seats):
        u, mount, mass, at = m.u.seat[j], p.mount[j], _mass(p.mount[j]), 2 * j
        block, rate = _block(m, q, j), _block(m, dq, j)
        outer_x, outer_y = u.fx + u.dfx * s, u.fy + u.dfy * s
        _own(m, q, j, own)
        fx, fy = rates(mount, own, block, rate, rate[HEAT:])
        vx, vy = q[places + at], q[places + at + 1]
        dq[at], dq[at + 1] = vx, vy
        dq[places + at], dq[places + at + 1] = (outer_x - fx) / mass, (outer_y - fy) / mass - down
        for i in range(d.modes):
            dq[places + 2 * seats + i] += d.shape[at, i] * fx + d.shape[at + 1, i] * fy
        for i in range(d.branches):
            for axis in range(2):
                branch = 2 * places + 2 * (d.branches * j + i) + axis
                dq[branch] = own[2 + axis] - q[branch] / mount.branch[i].time
        outer_z = u.fz + u.dfz * s
        power, loss = along_rate(mount.axial, mass, along, outer_z, block[ALONG:], rate[ALONG:])
        rate[HEAT + DAMPER] += loss
        rate[WORK] = outer_x * vx + outer_y * vy + power


@kernel
def _press(m, a, row, sign, j, axis):
    """Add to a row of the matrix what mount j resists with (N) in a direction, times `sign`."""
    d, mount = m.d, m.p.mount[j]
    kx, ky = (mount.spring.xx, mount.spring.xy) if axis == 0 else (mount.spring.yx, mount.spring.yy)
    cx, cy = (mount.damper.xx, mount.damper.xy) if axis == 0 else (mount.damper.yx, mount.damper.yy)
    for other in range(2):
        k, c = (kx, cx) if other == 0 else (ky, cy)
        a[row, 2 * j + other] += sign * k
        a[row, d.places + 2 * j + other] += sign * c
        for i in range(d.modes):
            share = d.shape[2 * j + other, i]
            a[row, 2 * d.seats + i] -= sign * k * share
            a[row, d.places + 2 * d.seats + i] -= sign * c * share
    for i in range(d.branches):
        a[row, 2 * d.places + 2 * (d.branches * j + i) + axis] += sign * mount.branch[i].stiffness


@kernel
def _system(m, a, b):
    """The linear system: a (n, n), and b (n, m.d.forces) of forces on carriers, then on mounts (N)."""
    d = m.d
    places, seats = d.places, d.seats
    for i in range(places):
        a[i, places + i] = 1.0
    for j in range(seats):
        mass = _mass(m.p.mount[j])
        for axis in range(2):
            at, row = 2 * j + axis, places + 2 * j + axis
            _press(m, a, row, -1.0 / mass, j, axis)
            b[row, at] = 1.0 / mass
            for i in range(d.modes):
                of_mode = places + 2 * seats + i
                _press(m, a, of_mode, d.shape[at, i], j, axis)
                b[of_mode, 2 * seats + at] = d.shape[at, i]
            for i in range(d.branches):
                branch = 2 * places + 2 * (d.branches * j + i) + axis
                a[branch, branch] = -1.0 / m.p.mount[j].branch[i].time
                a[branch, row] = 1.0
                for k in range(d.modes):
                    a[branch, places + 2 * seats + k] = -d.shape[at, k]
    for i in range(d.modes):
        row, omega = places + 2 * seats + i, d.omega[i]
        a[row, 2 * seats + i] -= omega * omega
        a[row, row] -= 2.0 * d.ratio[i] * omega


@kernel
def _off_ground(m, places, r):
    """Displacement r of the carriers (m) from the foundation's points, in the `places` of all."""
    way = places[r]
    for i in range(m.d.modes):
        way -= m.d.shape[r, i] * places[2 * m.d.seats + i]
    return way


@kernel
def _prepare(m, h):
    """Have m.d ready for steps of h (s)."""
    d = m.d
    n, ways = d.size, 2 * d.seats
    a, b = np.zeros((n, n)), np.zeros((n, d.forces))
    _system(m, a, b)
    gauss.prepare(a, b, h, d.points, d.end)
    compliance = d.matrix[:ways, :ways]
    for r in range(ways):
        for k in range(ways):
            compliance[r, k] = _off_ground(m, d.end[:, n + k], r)
            if d.modes > 0:
                compliance[r, k] -= _off_ground(m, d.end[:, n + ways + k], r)
            d.stiff[r, k] = 1.0 if r == k else 0.0
    gauss.solve(compliance, d.stiff[:ways, :ways])
    d.length = h


@kernel
def _parts(m, step):
    """Into how many equal steps a macro step of `step` (s) is divided: a power of two."""
    d, rate = m.d, m.d.rate
    if d.linear == 0:
        for j in range(d.seats):
            u, mount, own = m.u.seat[j], m.p.mount[j], d.own[j]
            _own(m, m.q, j, own)
            fx, fy = abs(u.fx) + m.half * abs(u.dfx), abs(u.fy) + m.half * abs(u.dfy)
            rate = max(rate, quickness(mount, _mass(mount), own, fx, fy, step))
    parts = 1
    while parts < rate * step / RESOLUTION and parts < MOST_PARTS:
        parts *= 2
    return parts


@kernel
def _needed(m, r):
    """Mean force r (N) on the carriers that makes the ways m.d.ways of the free ones."""
    d, force = m.d, 0.0
    for k in range(2 * d.seats):
        force += d.stiff[r, k] * (d.free[k] - d.ways[k])
    return force


@kernel
def _lack(m, h, left, renew):
    """Fill `left` (N): mean forces of slides, stops and films on the ways m.d.ways in h (s) less `_needed`.

    Returns its square, and that of the latter (N2). renew: fill m.d.slopes by the closed forms, too.
    """
    d, lacking, needed = m.d, 0.0, 0.0
    for j in range(d.seats):
        at, own, way = 2 * j, d.own[j], d.ways[2 * j : 2 * j + 2]
        z = _block(m, m.q, j)
        left[at], left[at + 1], xx, xy, yx, yy = mean_force(
            m.p.mount[j], own[0], own[1], way[0], way[1], h, z
        )
        if renew:
            for r in range(2 * d.seats):
                d.slopes[r, at], d.slopes[r, at + 1] = d.stiff[r, at], d.stiff[r, at + 1]
            d.slopes[at, at] += xx
            d.slopes[at, at + 1] += xy
            d.slopes[at + 1, at] += yx
            d.slopes[at + 1, at + 1] += yy
    for r in range(2 * d.seats):
        force = _needed(m, r)
        left[r] -= force
        lacking, needed = lacking + squared(left[r]), needed + squared(force)
    return lacking, needed


@kernel
def _find_ways(m, h):
    """Fill the ways m.d.ways (m) of a step of h (s) whose free ones are m.d.free; returns whether found.

    By Broyden's method from where the carriers' speeds lead, with new slopes where it was too far across a
    kink. The force of an iterate that is no solution would do work on a way nobody goes.
    """
    d, count = m.d, 2 * m.d.seats
    ways, change, left, later = d.ways, d.change, d.left, d.later
    for j in range(d.seats):
        x, y = h * d.own[j, 2], h * d.own[j, 3]
        if norm(x, y) < AT_REST * norm(d.free[2 * j], d.free[2 * j + 1]):
            x, y = d.free[2 * j], d.free[2 * j + 1]
        ways[2 * j], ways[2 * j + 1] = x, y
    lacking, needed = _lack(m, h, left, True)
    tries = 1
    while tries < MOST_TRIES:
        for r in range(count):
            change[r, 0] = -left[r]
            for k in range(count):
                d.matrix[r, k] = d.slopes[r, k]
        gauss.solve(d.matrix[:count, :count], change[:count])
        gone, size = 0.0, 0.0
        for r in range(count):
            ways[r] += change[r, 0]
            gone, size = gone + squared(change[r, 0]), size + squared(ways[r])
        if gone <= squared(CLOSE) * size or lacking <= squared(ROUNDING) * needed:
            return True
        now, needed = _lack(m, h, later, False)
        tries += 1
        halved = False
        while not now <= lacking and gone > squared(CLOSE) * size and tries < MOST_TRIES:
            for r in range(count):
                change[r, 0] *= 0.5
                ways[r] -= change[r, 0]
            gone, halved = 0.25 * gone, True
            now, needed = _lack(m, h, later, True)
            tries += 1
        for r in range(count):
            left[r] = later[r]
            if not halved:
                for k in range(count):
                    d.slopes[r, k] += later[r] * change[k, 0] / gone
        lacking = now
    return False


@kernel
def _give_way(m, h):
    """Add the mean forces of slides, stops and films in a step of h (s) to m.d.given; their state follows.

    Returns whether there are such, and none is too long for a film.
    """
    d, n, count = m.d, m.d.size, 2 * m.d.seats
    gauss.apply(d.end, d.places, d.given, n + d.forces + count, d.after)
    for j in range(d.seats):
        for axis in range(2):
            d.free[2 * j + axis] = _off_ground(m, d.after, 2 * j + axis) - d.own[j, axis]
    if not _find_ways(m, h):
        return False
    for j in range(d.seats):
        x, y = d.own[j, 0], d.own[j, 1]
        if outruns_film(m.p.mount[j].film, x, y, d.ways[2 * j], d.ways[2 * j + 1]):
            return False
    for r in range(count):  # to rounding those of the elements on these ways, which the carriers so go
        force = _needed(m, r)
        d.given[n + r] -= force
        if d.modes > 0:
            d.given[n + count + r] = force
    for j in range(d.seats):
        x, y, block = d.own[j, 0], d.own[j, 1], _block(m, m.q, j)
        go(m.p.mount[j], x, y, d.ways[2 * j], d.ways[2 * j + 1], h, block, block[HEAT:])
    return True


@kernel
def _account(m, state, since, part):
    """Book work and heat at a point of a step that counts for `part` (s), `since` (s) from the middle."""
    p, q, d, own = m.p, m.q, m.d, m.d.at_once
    for j in range(d.seats):
        u, at, block = m.u.seat[j], d.places + 2 * j, _block(m, q, j)
        block[WORK] += part * ((u.fx + u.dfx * since) * state[at] + (u.fy + u.dfy * since) * state[at + 1])
        _own(m, state, j, own)
        linear_heat(p.mount[j], own, part, block[HEAT:])
        note_peaks(m.o.strokes[j], p.mount[j].stop, own)
    for i in range(d.modes):
        speed = state[d.places + 2 * d.seats + i]
        q[m.n - 1] += part * 2.0 * d.ratio[i] * d.omega[i] * speed * speed


@kernel
def _step(m, time, h, since):
    """One step of h (s) from `time` (s), its middle `since` (s) after that of the macro step.

    Returns whether it is solved.
    """
    p, q, d = m.p, m.q, m.d
    n, count, own = d.size, 2 * d.seats, d.at_once
    down = gravity_across(p.gravity, p.inclination)
    for i in range(n):
        d.given[i] = q[i]
    for i in range(n + count, n + d.forces):
        d.given[i] = 0.0
    for j in range(d.seats):
        u, at = m.u.seat[j], n + 2 * j
        d.given[at], d.given[at + 1] = u.fx + u.dfx * since, u.fy + u.dfy * since - _mass(p.mount[j]) * down
        d.given[at + d.forces], d.given[at + d.forces + 1] = u.dfx, u.dfy
        _own(m, q, j, d.own[j])
    if d.linear == 0 and not _give_way(m, h):
        return False
    width = n + d.forces + count
    gauss.apply(d.end, n, d.given, width, d.after)
    gauss.apply(d.points, gauss.POINTS * n, d.given, width, d.between)
    for i in range(gauss.POINTS):
        late = since + (gauss.PLACES[i] - 0.5) * h
        _account(m, d.between[i * n : (i + 1) * n], late, h * gauss.WEIGHTS[i])
    for i in range(n):
        q[i] = d.after[i]
    for j in range(d.seats):
        _own(m, q, j, own)
        out, stop = m.o.strokes[j], p.mount[j].stop
        note_peaks(out, stop, own)
        note_hit(out, stop, norm(d.own[j, 0], d.own[j, 1]), norm(own[0], own[1]), time, h)
    return True


@kernel
def advance(m, time, step):
    """One macro step of `step` (s) from `time` (s) under the given forces; returns a status."""
    d = m.d
    for u in m.u.seat:  # those without a carrier, too: what is wrong is said where it is set
        if not math.isfinite(u.fx + u.fy + u.fz + u.dfx + u.dfy + u.dfz):
            return BAD_INPUT
    m.time = time
    m.half = 0.5 * step
    parts, done = _parts(m, step), 0
    while done < parts:
        h = step / parts
        if d.length != h:
            _prepare(m, h)
        if _step(m, time + done * h, h, (done + 0.5) * h - m.half):
            done += 1
            m.evaluations += 1
        elif parts < MOST_PARTS:
            parts, done = 2 * parts, 2 * done
        else:
            return TOO_FAST
    down = gravity_along(m.p.gravity, m.p.inclination)
    for j in range(d.seats):
        mount, block = m.p.mount[j], _block(m, m.q, j)
        given, heat = go_along(mount.axial, _mass(mount), down, m.u.seat[j], step, block[ALONG:])
        block[WORK] += given
        block[HEAT + DAMPER] += heat
    publish(m.q, m)
    return OK if math.isfinite(np.sum(m.q)) else BAD_LOAD
