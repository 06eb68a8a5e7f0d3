"""A macro step of carriers on mounts (`mount_law`), and of the modes of what the mounts stand on.

Carrier j stands on mount j, the mount on the point u_j = Phi_j eta of the foundation; its elements act on
the carrier's displacement from that point. Modes are mass-normalised, Phi = shape/sqrt(modal mass), and

    eta_i'' + 2 zeta_i omega_i eta_i' + omega_i^2 eta_i = sum_j Phi_ji . f_j

under the forces f_j on the mounts. Without modes the ground is rigid; along the shaft it always is.

A macro step is one step, or several equal ones where slides, stop or film act faster than it. In each, what
is linear (carriers, modes, springs, dampers, branches) goes by Gauss's collocation under the outer forces
and the mean forces f of the other elements. The ways d of all carriers are linear in f, d = d_free - G f,
and f follows from d; G is what is left of the system when all but the seats is eliminated:

    G^-1 (d - d_free) + f(d) = 0

Broyden's method solves it; where it does not, or where d is long beside the thickness of a film, the step
is halved, and in the end refused. The linear part gives f . d to the other elements, which state it as
stored energy and heat: energy and heat add up to the outer work at every step. Without slides, stop
and film the step is exact to order six, with them to order two.

At the start everything rests under the carriers' weight; modes are counted from where the foundation's own
weight has bent it. The state is places of carriers and modes, their velocities, and the branches' stretch,
`m.d.size` numbers in all; then a block for each mount, and the heat of the modes.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ...modelkit import numerics
from ...modelkit.gravity import gravity_across, gravity_along
from ...modelkit.integrators import gauss
from ...modelkit.kernel import kernel
from ...modelkit.model import memory_layout
from ...modelkit.numerics import squared
from ...modelkit.ports import Energy, MountLoad, MountState
from ...modelkit.status import BAD_INPUT, BAD_LOAD, OK, TOO_FAST
from ...modelkit.variables import array, group, groups, integer, real
from . import mount_law as law
from .mount_law import BRANCHES, DAMPER, HEATS, SLIDES, norm

# Of a mount in the state: stretch of its slides (x and y of each), work, heat, motion along the shaft
WORK = 2 * SLIDES
HEAT = WORK + 1
PLACE_Z = HEAT + HEATS
SPEED_Z = PLACE_Z + 1
BLOCK = SPEED_Z + 1
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


def declare_model(parameters: type, most_seats: int, most_modes: int) -> tuple[type, type, np.dtype]:
    """Inputs, outputs and memory of a model that has up to so many seats and modes."""
    across, shapes = 2 * most_seats, max(most_modes, 1)
    state = 2 * (across + most_modes) + BRANCHES * across  # that is linear
    width = state + 2 * across * (2 if most_modes else 1)

    @dataclass(frozen=True)
    class Inputs:
        """Forces of the bearings."""

        seat: tuple = groups(MountLoad, most_seats)

    @dataclass(frozen=True)
    class Outputs:
        """Motion of the carriers, and what the mounts tell of themselves."""

        strokes: tuple = groups(law.StrokeReport, most_seats)
        seat: tuple = groups(MountState, most_seats)
        energy: Energy = group(Energy)
        modes_heat: float = real(0.0, "J", "heat of the modes since the start", local=True)

    @dataclass(frozen=True)
    class Prepared:
        """The system, its linear part's step of one length, and scratch for a step."""

        omega: object = array(shapes)  # rad/s, of the modes
        ratio: object = array(shapes)  # of their critical damping
        shape: object = array(across, shapes)  # mass-normalised, x and y of each seat
        motions: object = array(most_seats, OWN)  # of each mount, at the beginning of a step
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
        known: object = array(width)  # state, mean forces (N), slopes of those on the carriers (N/s)
        after: object = array(state)  # linear state at the end
        between: object = array(gauss.POINTS * state)  # and at the points
        free: object = array(across)  # m, ways without slides, stop and film
        ways: object = array(across)  # m
        left: object = array(across)  # N, of the equation of the ways
        later: object = array(across)  # N, the same after a step of Broyden's method
        change: object = array(across, 1)  # m, that step
        slopes: object = array(across, across)  # N/m, of what is left
        matrix: object = array(across, across)  # used up by solving

    state += BLOCK * most_seats + 1
    return Inputs, Outputs, memory_layout(parameters, Inputs, Outputs, state, derived=Prepared)


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
def _mount_motion(m, state, j, motion):
    """Way (m), speed (m/s) and branches of mount j, as `mount_law` takes them, from a linear `state`."""
    d, places = m.d, m.d.places
    for axis in range(2):
        way, speed = state[2 * j + axis], state[places + 2 * j + axis]
        for i in range(d.modes):
            share = d.shape[2 * j + axis, i]
            way -= share * state[2 * d.seats + i]
            speed -= share * state[places + 2 * d.seats + i]
        motion[axis], motion[2 + axis] = way, speed
    first = 2 * places + 2 * d.branches * j
    for i in range(2 * d.branches):
        motion[4 + i] = state[first + i]


@kernel
def derive(m):
    """Sizes, weights and the fastest rate, by m.d.seats and modes; returns a number of `PROBLEMS`, or 0."""
    p, d, number = m.p, m.d, 0
    d.length, d.branches, d.linear, d.rate = 0.0, 0, 1, 0.0
    down = gravity_across(p.gravity, p.inclination)
    for j in range(d.seats):
        mount, mass, numbers = p.mount[j], _mass(p.mount[j]), m.message_numbers
        c, film, mixed = mount.damper, mount.film, 0.5 * (mount.damper.xy + mount.damper.yx)
        d.branches = max(d.branches, law.branches_in_use(mount))
        if mount.stop.stiffness > 0.0 or film.viscosity > 0.0:
            d.linear = 0
        for i in range(SLIDES):
            d.linear = 0 if mount.slide[i].stiffness > 0.0 else d.linear
        d.rate = max(d.rate, law.linear_rate(mount, mass))
        if number == 0 and (c.xx < 0.0 or c.yy < 0.0 or c.xx * c.yy < mixed * mixed):
            numbers[0], numbers[1], numbers[2], numbers[3] = c.xx, c.yy, c.xy, c.yx
            number = 1
        x, y = law.sag(mount, mass * down)
        if number == 0 and film.viscosity > 0.0 and norm(x, y) >= film.clearance:
            numbers[0], numbers[1] = 1e6 * norm(x, y), 1e6 * film.clearance
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
        weight[PLACE_Z], weight[SPEED_Z] = 1e6, 1e2
    return number


@kernel
def start(m):
    """At rest, every carrier sagged on its springs and stop, and the modes under all of them."""
    p, q, d = m.p, m.q, m.d
    down, along = gravity_across(p.gravity, p.inclination), gravity_along(p.gravity, p.inclination)
    for j in range(d.seats):
        mass = _mass(p.mount[j])
        weight = mass * down
        if p.mount[j].axial.stiffness > 0.0:
            _block(m, q, j)[PLACE_Z] = mass * along / p.mount[j].axial.stiffness
        q[2 * j], q[2 * j + 1] = law.sag(p.mount[j], weight)
        for i in range(d.modes):
            q[2 * d.seats + i] -= d.shape[2 * j + 1, i] * weight / squared(d.omega[i])
    for r in range(2 * d.seats):
        for i in range(d.modes):
            q[r] += d.shape[r, i] * q[2 * d.seats + i]
    publish_seats(q, m)


@kernel
def publish_seats(q, m):
    """Outputs at the end of the step, from the state q."""
    p, d, motion = m.p, m.d, m.d.at_once
    down, along = gravity_across(p.gravity, p.inclination), gravity_along(p.gravity, p.inclination)
    e, m.o.modes_heat = m.o.energy, q[m.n - 1]
    e.kinetic, e.potential, e.dissipated = 0.0, 0.0, q[m.n - 1]
    for j in range(d.seats):
        mount, mass, o, block = p.mount[j], _mass(p.mount[j]), m.o.seat[j], _block(m, q, j)
        _mount_motion(m, q, j, motion)
        fx, fy, stop = law.force_now(mount, motion, block)
        o.x, o.y = q[2 * j] + mount.x0, q[2 * j + 1] + mount.y0
        o.vx, o.vy = q[d.places + 2 * j], q[d.places + 2 * j + 1]
        o.ax_free, o.ay_free = -fx / mass, -fy / mass - down
        k, c = law.tangent(mount)
        o.inv_m, o.k_over_m, o.c_over_m = 1.0 / mass, k / mass, c / mass
        o.work = block[WORK]
        e.kinetic += 0.5 * mass * (squared(o.vx) + squared(o.vy))
        e.potential += law.mount_energy(mount, motion, block) + mass * down * o.y
        if mount.axial.stiffness > 0.0:
            o.z, o.vz, o.inv_m_z = block[PLACE_Z], block[SPEED_Z], 1.0 / mass
            o.k_over_m_z, o.c_over_m_z = mount.axial.stiffness / mass, mount.axial.damping / mass
            o.az_free = along - o.k_over_m_z * o.z - o.c_over_m_z * o.vz
            e.kinetic += 0.5 * mass * o.vz * o.vz
            e.potential += 0.5 * mount.axial.stiffness * o.z * o.z - mass * along * o.z
        e.dissipated += np.sum(block[HEAT:PLACE_Z])
        law.note_peaks(m.o.strokes[j], mount.stop, motion)
        m.o.strokes[j].stroke, m.o.strokes[j].stop_force = norm(motion[0], motion[1]), stop
        heat, booked = m.o.strokes[j].heat, block[HEAT:]
        heat.spring, heat.damper, heat.slide = booked[law.SPRING], booked[DAMPER], booked[law.SLIDE]
        heat.branch, heat.stop, heat.film = booked[law.BRANCH], booked[law.STOP], booked[law.FILM]
    for i in range(d.modes):
        way, speed = q[2 * d.seats + i], q[d.places + 2 * d.seats + i]
        e.kinetic += 0.5 * speed * speed
        e.potential += 0.5 * squared(d.omega[i] * way)


@kernel
def _flow(m, q, dq, force):
    """Set the rates dq of the linear state q (n,), mounts resisting with `force` (N), x and y of each."""
    d, places, first, motion = m.d, m.d.places, m.d.places + 2 * m.d.seats, m.d.at_once
    for i in range(places):
        dq[i] = q[places + i]
    for i in range(d.modes):
        omega = d.omega[i]
        dq[first + i] = -2.0 * d.ratio[i] * omega * q[first + i] - omega * omega * q[2 * d.seats + i]
    for j in range(d.seats):
        _mount_motion(m, q, j, motion)
        for r in (2 * j, 2 * j + 1):
            dq[places + r] = -force[r] / _mass(m.p.mount[j])
            for i in range(d.modes):
                dq[first + i] += d.shape[r, i] * force[r]
        for i in range(2 * d.branches):
            time = m.p.mount[j].branch[i // 2].time
            dq[2 * (places + d.branches * j) + i] = motion[2 + i % 2] - motion[4 + i] / time


@kernel
def rhs(t, q, dq, m):
    """Derivative dq of the state q under the forces mean + slope (t - t_mid); t: s."""
    p, d, s, motion = m.p, m.d, t - m.half, m.d.at_once
    down, along = gravity_across(p.gravity, p.inclination), gravity_along(p.gravity, p.inclination)
    for j in range(d.seats):
        rate = _block(m, dq, j)
        _mount_motion(m, q, j, motion)
        d.left[2 * j], d.left[2 * j + 1] = law.mount_rates(
            p.mount[j], motion, _block(m, q, j), rate, rate[HEAT:]
        )
    _flow(m, q, dq, d.left)
    for j in range(d.seats):
        u, mass, r, rate = m.u.seat[j], _mass(p.mount[j]), d.places + 2 * j, _block(m, dq, j)
        outer_x, outer_y, outer_z = u.fx + u.dfx * s, u.fy + u.dfy * s, u.fz + u.dfz * s
        dq[r] += outer_x / mass
        dq[r + 1] += outer_y / mass - down
        rate[WORK] = outer_x * q[r] + outer_y * q[r + 1]
        rate[PLACE_Z], rate[SPEED_Z], axial = 0.0, 0.0, p.mount[j].axial
        if axial.stiffness > 0.0:
            z, vz = _block(m, q, j)[PLACE_Z], _block(m, q, j)[SPEED_Z]
            rate[PLACE_Z] = vz
            rate[SPEED_Z] = (outer_z - axial.stiffness * z - axial.damping * vz) / mass + along
            rate[WORK] += outer_z * vz
            rate[HEAT + DAMPER] += axial.damping * squared(vz)
    dq[m.n - 1] = 0.0
    for i in range(d.modes):
        speed = q[d.places + 2 * d.seats + i]
        dq[m.n - 1] += 2.0 * d.ratio[i] * d.omega[i] * speed * speed


@kernel
def _system(m, a, b):
    """The linear system: a (n, n), and b (n, m.d.forces) of forces on carriers, then on mounts (N)."""
    d, state, motion = m.d, np.zeros(m.d.size), m.d.at_once
    for k in range(d.size):
        state[k] = 1.0
        for j in range(d.seats):
            _mount_motion(m, state, j, motion)
            d.left[2 * j], d.left[2 * j + 1] = law.linear_force(m.p.mount[j], motion)
        _flow(m, state, a[:, k], d.left)
        state[k] = 0.0
    for r in range(2 * d.seats):
        b[d.places + r, r] = 1.0 / _mass(m.p.mount[r // 2])
        for i in range(d.modes):
            b[d.places + 2 * d.seats + i, 2 * d.seats + r] = d.shape[r, i]


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
    gauss.prepare_steps(a, b, h, d.points, d.end)
    compliance = d.matrix[:ways, :ways]
    for r in range(ways):
        for k in range(ways):
            compliance[r, k] = _off_ground(m, d.end[:, n + k], r)
            if d.modes > 0:
                compliance[r, k] -= _off_ground(m, d.end[:, n + ways + k], r)
            d.stiff[r, k] = 1.0 if r == k else 0.0
    gauss.solve_in_place(compliance, d.stiff[:ways, :ways])
    d.length = h


@kernel
def _parts(m, step):
    """Into how many equal steps a macro step of `step` (s) is divided: a power of two."""
    d, rate = m.d, m.d.rate
    if d.linear == 0:
        for j in range(d.seats):
            u, mount, motion = m.u.seat[j], m.p.mount[j], d.motions[j]
            _mount_motion(m, m.q, j, motion)
            fx, fy = abs(u.fx) + m.half * abs(u.dfx), abs(u.fy) + m.half * abs(u.dfy)
            rate = max(rate, law.quickness(mount, _mass(mount), motion, fx, fy, step))
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
        row, motion, way = 2 * j, d.motions[j], d.ways[2 * j : 2 * j + 2]
        z = _block(m, m.q, j)
        left[row], left[row + 1], xx, xy, yx, yy = law.mean_force(
            m.p.mount[j], motion[0], motion[1], way[0], way[1], h, z
        )
        if renew:
            for r in range(2 * d.seats):
                d.slopes[r, row], d.slopes[r, row + 1] = d.stiff[r, row], d.stiff[r, row + 1]
            d.slopes[row, row] += xx
            d.slopes[row, row + 1] += xy
            d.slopes[row + 1, row] += yx
            d.slopes[row + 1, row + 1] += yy
    for r in range(2 * d.seats):
        force = _needed(m, r)
        left[r] -= force
        lacking, needed = lacking + squared(left[r]), needed + squared(force)
    return lacking, needed


@kernel
def _find_ways(m, h):
    """Fill the ways m.d.ways (m) of a step of h (s) whose free ones are m.d.free; returns whether found.

    By Broyden's method from where the carriers' speeds lead, with new slopes where it was too far across a
    kink. The force of an iterate that is not a solution would do work on a way that no carrier goes.
    """
    d, count = m.d, 2 * m.d.seats
    ways, change, left, later = d.ways, d.change, d.left, d.later
    for j in range(d.seats):
        x, y = h * d.motions[j, 2], h * d.motions[j, 3]
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
        gauss.solve_in_place(d.matrix[:count, :count], change[:count])
        gone, size = 0.0, 0.0
        for r in range(count):
            ways[r] += change[r, 0]
            gone, size = gone + squared(change[r, 0]), size + squared(ways[r])
        if gone <= squared(CLOSE) * size or lacking <= squared(ROUNDING) * needed:
            return True
        still_lacking, needed = _lack(m, h, later, False)
        tries += 1
        halved = False
        while not still_lacking <= lacking and gone > squared(CLOSE) * size and tries < MOST_TRIES:
            for r in range(count):
                change[r, 0] *= 0.5
                ways[r] -= change[r, 0]
            gone, halved = 0.25 * gone, True
            still_lacking, needed = _lack(m, h, later, True)
            tries += 1
        for r in range(count):
            left[r] = later[r]
            if not halved:
                for k in range(count):
                    d.slopes[r, k] += later[r] * change[k, 0] / gone
        lacking = still_lacking
    return False


@kernel
def _give_way(m, h):
    """Add the mean forces of slides, stops and films in a step of h (s) to m.d.known; their state follows.

    Returns whether there are such, on ways short enough for the films.
    """
    d, n, count = m.d, m.d.size, 2 * m.d.seats
    gauss.apply(d.end, d.places, d.known, n + d.forces + count, d.after)
    for j in range(d.seats):
        for axis in range(2):
            d.free[2 * j + axis] = _off_ground(m, d.after, 2 * j + axis) - d.motions[j, axis]
    if not _find_ways(m, h):
        return False
    for j in range(d.seats):
        x, y = d.motions[j, 0], d.motions[j, 1]
        if law.outruns_film(m.p.mount[j].film, x, y, d.ways[2 * j], d.ways[2 * j + 1]):
            return False
    for r in range(count):  # to rounding those of the elements on these ways, which the carriers so go
        force = _needed(m, r)
        d.known[n + r] -= force
        if d.modes > 0:
            d.known[n + count + r] = force
    for j in range(d.seats):
        x, y, block = d.motions[j, 0], d.motions[j, 1], _block(m, m.q, j)
        law.go(m.p.mount[j], x, y, d.ways[2 * j], d.ways[2 * j + 1], h, block, block[HEAT:])
    return True


@kernel
def _account(m, state, since, part):
    """Book work and heat at a point of a step that counts for `part` (s), `since` (s) from the middle."""
    p, q, d, motion = m.p, m.q, m.d, m.d.at_once
    for j in range(d.seats):
        u, r, block = m.u.seat[j], d.places + 2 * j, _block(m, q, j)
        block[WORK] += part * ((u.fx + u.dfx * since) * state[r] + (u.fy + u.dfy * since) * state[r + 1])
        _mount_motion(m, state, j, motion)
        law.linear_heat(p.mount[j], motion, part, block[HEAT:])
        law.note_peaks(m.o.strokes[j], p.mount[j].stop, motion)
    for i in range(d.modes):
        speed = state[d.places + 2 * d.seats + i]
        q[m.n - 1] += part * 2.0 * d.ratio[i] * d.omega[i] * speed * speed


@kernel
def _step(m, time, h, since):
    """Take a step of h (s) from `time` (s); since: s, from the macro step's middle to its own.

    Returns whether it is solved.
    """
    p, q, d = m.p, m.q, m.d
    n, count, motion = d.size, 2 * d.seats, d.at_once
    down = gravity_across(p.gravity, p.inclination)
    for i in range(n):
        d.known[i] = q[i]
    for i in range(n + count, n + d.forces):
        d.known[i] = 0.0
    for j in range(d.seats):
        u, r = m.u.seat[j], n + 2 * j
        d.known[r], d.known[r + 1] = u.fx + u.dfx * since, u.fy + u.dfy * since - _mass(p.mount[j]) * down
        d.known[r + d.forces], d.known[r + d.forces + 1] = u.dfx, u.dfy
        _mount_motion(m, q, j, d.motions[j])
    if d.linear == 0 and not _give_way(m, h):
        return False
    width = n + d.forces + count
    gauss.apply(d.end, n, d.known, width, d.after)
    gauss.apply(d.points, gauss.POINTS * n, d.known, width, d.between)
    for i in range(gauss.POINTS):
        late = since + (gauss.PLACES[i] - 0.5) * h
        _account(m, d.between[i * n : (i + 1) * n], late, h * gauss.WEIGHTS[i])
    for i in range(n):
        q[i] = d.after[i]
    for j in range(d.seats):
        _mount_motion(m, q, j, motion)
        out, stop = m.o.strokes[j], p.mount[j].stop
        law.note_peaks(out, stop, motion)
        before, after = norm(d.motions[j, 0], d.motions[j, 1]), norm(motion[0], motion[1])
        if stop.stiffness > 0.0 and after > stop.gap >= before:
            if out.stop_hits == 0:
                out.stop_time = time + h * (stop.gap - before) / (after - before)
            out.stop_hits += 1
    return True


@kernel
def _go_along(m, j, step):
    """Take carrier j along the shaft through a macro step of `step` (s), exactly: nothing couples it."""
    u, block, axial, mass = m.u.seat[j], _block(m, m.q, j), m.p.mount[j].axial, _mass(m.p.mount[j])
    k, c, g = axial.stiffness / mass, axial.damping / mass, u.dfz / mass
    f = u.fz / mass + gravity_along(m.p.gravity, m.p.inclination)
    s, z, v = numerics.oscillator_step(k, c, step), block[PLACE_Z], block[SPEED_Z]
    z_end = s.zz * z + s.zv * v + s.zf * f + s.zg * g
    v_end = s.vz * z + s.vv * v + s.vf * f + s.vg * g
    area = numerics.area(k, c, step, f, (z, v), (z_end, v_end))
    late = 0.5 * step * (z_end + z) - area  # int (t - t_mid) v dt
    heat = mass * (f * (z_end - z) + g * late)
    heat -= 0.5 * mass * ((v_end - v) * (v_end + v) + k * (z_end - z) * (z_end + z))
    block[PLACE_Z], block[SPEED_Z] = z_end, v_end
    block[WORK] += u.fz * (z_end - z) + u.dfz * late
    block[HEAT + DAMPER] += max(heat, 0.0)


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
    for j in range(d.seats):
        if m.p.mount[j].axial.stiffness > 0.0:
            _go_along(m, j, step)
    publish_seats(m.q, m)
    return OK if math.isfinite(np.sum(m.q)) else BAD_LOAD
