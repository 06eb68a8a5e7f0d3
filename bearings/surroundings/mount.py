"""The mount of a touchdown bearing: a carrier on springs, dampers, dry friction, rubber, a film and a stop.

It takes the place of `housing` at the same port. The carrier moves across the shaft's axis; between it and
the ground the elements of `mount_law` act in parallel. `x0`, `y0` put its relaxed place off the rotor's
axis (misalignment). Frame and signs as everywhere: x horizontal, y up, SI.

A macro step is one step, or several equal ones where slides, stop or film act faster than it. In each, what
is linear (mass, springs, dampers, branches) goes by Gauss's collocation under the outer force less the mean
force f of the other elements. Its way d is linear in that force, d = d_free - G f, and f follows from d:

    G^-1 (d - d_free) + f(d) = 0

which Broyden's method solves; where it does not, or where d is long beside the thickness of a film, the
step is halved, and in the end refused. As the linear
part gives f . d to the others, and they state it as stored energy and heat, kinetic and stored energy and
heat add up to the outer work whatever the step is. Without slides, stop and film the step is exact to order
six, with them to order two.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ...modelkit.gravity import INCLINATION, gravity_across, gravity_along
from ...modelkit.integrators import gauss
from ...modelkit.kernel import kernel
from ...modelkit.model import Model, memory_layout
from ...modelkit.numerics import squared
from ...modelkit.ports import Energy, MountLoad, MountState
from ...modelkit.status import BAD_INPUT, BAD_LOAD, OK, TOO_FAST
from ...modelkit.variables import array, flatten, group, integer, real
from . import axial_mount
from .axial_mount import along_rate, derive_along, go_along, publish_along
from .mount_law import (
    BRANCHES,
    DAMPER,
    HEATS,
    SLIDES,
    Carrier,
    StrokeReport,
    branches_in_use,
    drives,
    equations,
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

X, Y, VX, VY = range(4)
BRANCH = 4  # stretch of the branches, x and y of each
LINEAR = BRANCH + 2 * BRANCHES
Z = LINEAR  # stretch of the slides, x and y of each
WORK = Z + 2 * SLIDES
HEAT = WORK + 1
ALONG = HEAT + HEATS
STATE = ALONG + axial_mount.SIZE
WIDTH = LINEAR + 4  # and the outer force with its slope
RESOLUTION = 0.25  # rad of the fastest swing in a step
MOST_PARTS = 4096  # of a macro step
MOST_TRIES = 50  # evaluations of a way's equation
CLOSE = 1e-9  # of the way; a last step of Broyden's method, after which the next would be rounding
ROUNDING = 1e-15  # of the force; less of it is left by rounding
AT_REST = 1e-3  # of the way without slides, stop and film; below it the speed says little of the way
DIFFERENCE = 1e-7  # of the way, for slopes of the force


@dataclass(frozen=True)
class Parameters(Carrier):
    """Of the carrier, what it stands on, and the ground's gravity."""

    gravity: float = real(9.81, "m/s2", "gravity, downwards", minimum=0.0)
    inclination: float = real(0.0, "rad", INCLINATION)


@dataclass(frozen=True)
class Inputs:
    """Force of the bearing."""

    seat: MountLoad = group(MountLoad)


@dataclass(frozen=True)
class Outputs(StrokeReport):
    """Motion, and what the mount tells of itself."""

    seat: MountState = group(MountState)
    energy: Energy = group(Energy)


@dataclass(frozen=True)
class Prepared:
    """The linear part, and its step of one length, kept until another one is wanted."""

    length: float = real(0.0, "s", "that the matrices are for; 0: for none")
    size: int = integer(4, "of the linear state")
    linear: int = integer(0, "1 where there is nothing else")
    rate: float = real(0.0, "rad/s", "of the linear part, at most")
    points: object = array(gauss.POINTS * LINEAR, WIDTH)
    end: object = array(LINEAR, WIDTH)
    stiff: object = array(2, 2)


MEMORY = memory_layout(Parameters, Inputs, Outputs, STATE, derived=Prepared)


@kernel
def publish(q, m):
    """Outputs at the end of the step, from the state q."""
    p, o = m.p, m.o.seat
    mass = p.mass + p.outer_ring
    fx, fy, stop = force_now(p, q, q[Z:WORK])
    o.x, o.y, o.vx, o.vy = q[X] + p.x0, q[Y] + p.y0, q[VX], q[VY]
    down = gravity_across(p.gravity, p.inclination)
    o.ax_free, o.ay_free = -fx / mass, -fy / mass - down
    o.inv_m = 1.0 / mass
    k, c = tangent(p)
    o.k_over_m, o.c_over_m = k / mass, c / mass
    o.work = q[WORK]
    e = m.o.energy
    e.kinetic = 0.5 * mass * (squared(q[VX]) + squared(q[VY]))
    e.potential = stored(p, q, q[Z:WORK]) + mass * down * (q[Y] + p.y0)
    e.dissipated = np.sum(q[HEAT : HEAT + HEATS])
    kinetic, potential = publish_along(
        p.axial, mass, gravity_along(p.gravity, p.inclination), q[ALONG:STATE], o
    )
    e.kinetic += kinetic
    e.potential += potential
    tell(m.o, q, stop, q[HEAT:])


@kernel
def rhs(t, q, dq, m):
    """Derivative dq (STATE,) of the state q under the force mean + slope (t - t_mid); t: s."""
    p, u = m.p, m.u.seat
    mass, s = p.mass + p.outer_ring, t - m.half
    outer_x, outer_y = u.fx + u.dfx * s, u.fy + u.dfy * s
    fx, fy = rates(p, q, q[Z:WORK], dq[Z:WORK], dq[HEAT : HEAT + HEATS])
    dq[X], dq[Y] = q[VX], q[VY]
    dq[VX], dq[VY] = (outer_x - fx) / mass, (outer_y - fy) / mass - gravity_across(p.gravity, p.inclination)
    for i in range(BRANCHES):
        for axis in range(2):
            at = BRANCH + 2 * i + axis
            dq[at] = q[VX + axis] - q[at] / p.branch[i].time if p.branch[i].stiffness > 0.0 else 0.0
    dq[WORK] = outer_x * q[VX] + outer_y * q[VY]
    down, outer_z = gravity_along(p.gravity, p.inclination), u.fz + u.dfz * s
    power, heat = along_rate(p.axial, mass, down, outer_z, q[ALONG:STATE], dq[ALONG:STATE])
    dq[WORK] += power
    dq[HEAT + DAMPER] += heat


@kernel
def derive(words):
    """The size of the linear part and its fastest rate.

    Returns 1 where the dampers drive the carrier, 2 where it would rest beyond its film's clearance.
    """
    m = words.view(MEMORY)[0]
    p, d, c = m.p, m.d, m.p.damper
    m.n = STATE
    for i in range(WORK):
        m.weight[i] = 1e2 if i in (VX, VY) else 1e6  # 1 cm/s and 1 um matter
    m.weight[ALONG + axial_mount.Z], m.weight[ALONG + axial_mount.VZ] = 1e6, 1e2
    d.length = 0.0
    d.size = 4 + 2 * branches_in_use(p)
    d.linear = 1 if is_linear(p) else 0
    d.rate = linear_rate(p, p.mass + p.outer_ring)
    if drives(c):
        m.message_numbers[0], m.message_numbers[1], m.message_numbers[2], m.message_numbers[3] = (
            c.xx,
            c.yy,
            c.xy,
            c.yx,
        )
        return 1
    rest = sag_beyond_film(p, (p.mass + p.outer_ring) * gravity_across(p.gravity, p.inclination))
    if rest > 0.0:
        m.message_numbers[0], m.message_numbers[1] = 1e6 * rest, 1e6 * p.film.clearance
        return 2
    return 0


@kernel
def start(words):
    """At rest, sagged under its own weight on springs and stop."""
    m = words.view(MEMORY)[0]
    p = m.p
    mass = p.mass + p.outer_ring
    m.q[X], m.q[Y] = sag(p, mass * gravity_across(p.gravity, p.inclination))
    derive_along(p.axial, mass, gravity_along(p.gravity, p.inclination), m.q[ALONG:STATE])
    publish(m.q, m)


@kernel
def _prepare(m, h):
    """Have m.d ready for steps of h (s)."""
    d = m.d
    n = d.size
    a, b = np.empty((n, n)), np.empty((n, 2))
    equations(m.p, m.p.mass + m.p.outer_ring, a, b)
    gauss.prepare(a, b, h, d.points, d.end)
    xx, xy, yx, yy = d.end[X, n], d.end[X, n + 1], d.end[Y, n], d.end[Y, n + 1]
    det = xx * yy - xy * yx
    d.stiff[0, 0], d.stiff[0, 1], d.stiff[1, 0], d.stiff[1, 1] = yy / det, -xy / det, -yx / det, xx / det
    d.length = h


@kernel
def _parts(m, step, push_x, push_y):
    """Into how many equal steps a macro step of `step` (s) is divided: a power of two."""
    p, d = m.p, m.d
    rate = d.rate
    if d.linear == 0:
        rate = max(rate, quickness(p, p.mass + p.outer_ring, m.q, push_x, push_y, step))
    wanted = rate * step / RESOLUTION
    parts = 1
    while parts < wanted and parts < MOST_PARTS:
        parts *= 2
    return parts


@kernel
def _residual(m, dx, dy, free_x, free_y, h):
    """Residual of the equation of a step of h (s) on the way (dx, dy) (N, N), and its slopes (N/m).

    free: the way without slides, stop and film. Slopes: x by dx, x by dy, y by dx, y by dy.
    """
    q, s = m.q, m.d.stiff
    fx, fy, xx, xy, yx, yy = mean_force(m.p, q[X], q[Y], dx, dy, h, q[Z:WORK])
    needed_x, needed_y = _needed(m, dx, dy, free_x, free_y)
    return fx - needed_x, fy - needed_y, s[0, 0] + xx, s[0, 1] + xy, s[1, 0] + yx, s[1, 1] + yy


@kernel
def _needed(m, dx, dy, free_x, free_y):
    """Mean force (N, N) that makes (dx, dy) of the way (free_x, free_y) (m)."""
    s, rest_x, rest_y = m.d.stiff, free_x - dx, free_y - dy
    return s[0, 0] * rest_x + s[0, 1] * rest_y, s[1, 0] * rest_x + s[1, 1] * rest_y


@kernel
def _differences(m, dx, dy, free_x, free_y, h, rx, ry):
    """Slopes as `_residual` has them, by differences from what is left there."""
    small = DIFFERENCE * (abs(dx) + abs(dy)) + 1e-16
    ax, ay, _, _, _, _ = _residual(m, dx + small, dy, free_x, free_y, h)
    bx, by, _, _, _, _ = _residual(m, dx, dy + small, free_x, free_y, h)
    return (ax - rx) / small, (bx - rx) / small, (ay - ry) / small, (by - ry) / small


@kernel
def _way(m, free_x, free_y, h):
    """The way (m, m) of a step of h (s) that goes (free_x, free_y) without slides, stop and film.

    By Broyden's method from where the carrier's speed leads, with slopes by differences where it was too
    far across a kink. And whether it was found: the force of an iterate that is none does work on a way
    nobody goes.
    """
    dx, dy = h * m.q[VX], h * m.q[VY]
    if norm(dx, dy) < AT_REST * norm(free_x, free_y):
        dx, dy = free_x, free_y
    rx, ry, xx, xy, yx, yy = _residual(m, dx, dy, free_x, free_y, h)
    tries = 1
    while tries < MOST_TRIES:
        det, left = xx * yy - xy * yx, norm(rx, ry)
        jx, jy = (xy * ry - yy * rx) / det, (yx * rx - xx * ry) / det
        change, size = norm(jx, jy), norm(dx + jx, dy + jy)
        force_x, force_y = _needed(m, dx, dy, free_x, free_y)
        if change <= CLOSE * size or left <= ROUNDING * norm(force_x, force_y):
            return dx + jx, dy + jy, True
        nx, ny, _, _, _, _ = _residual(m, dx + jx, dy + jy, free_x, free_y, h)
        tries += 1
        halved = False
        while not norm(nx, ny) <= left and change > CLOSE * size and tries < MOST_TRIES:
            jx, jy, change, halved = 0.5 * jx, 0.5 * jy, 0.5 * change, True
            nx, ny, _, _, _, _ = _residual(m, dx + jx, dy + jy, free_x, free_y, h)
            tries += 1
        dx, dy = dx + jx, dy + jy
        if halved:
            xx, xy, yx, yy = _differences(m, dx, dy, free_x, free_y, h, nx, ny)
        else:
            ux, uy = jx / (change * change), jy / (change * change)
            xx, xy, yx, yy = xx + nx * ux, xy + nx * uy, yx + ny * ux, yy + ny * uy
        rx, ry = nx, ny
    return dx, dy, False


@kernel
def _step(m, time, h, since):
    """One step of h (s) from `time` (s), its middle `since` (s) after that of the macro step.

    Returns whether there is one.
    """
    p, q, u, d = m.p, m.q, m.u.seat, m.d
    n, weight = d.size, (p.mass + p.outer_ring) * gravity_across(p.gravity, p.inclination)
    outer_x, outer_y = u.fx + u.dfx * since, u.fy + u.dfy * since
    given, end, points = np.empty(WIDTH), np.empty(LINEAR), np.empty(gauss.POINTS * LINEAR)
    for i in range(n):
        given[i] = q[i]
    given[n], given[n + 1], given[n + 2], given[n + 3] = outer_x, outer_y - weight, u.dfx, u.dfy
    x, y = q[X], q[Y]
    if d.linear == 0:
        gauss.apply(d.end, 2, given, n + 4, end)
        dx, dy, found = _way(m, end[X] - x, end[Y] - y, h)
        if not found or outruns_film(p.film, x, y, dx, dy):
            return False
        # to rounding the one that the elements have on that way; so the carrier goes just there
        fx, fy = _needed(m, dx, dy, end[X] - x, end[Y] - y)
        given[n] -= fx
        given[n + 1] -= fy
        go(p, x, y, dx, dy, h, q[Z:WORK], q[HEAT:])
    gauss.apply(d.end, n, given, n + 4, end)
    gauss.apply(d.points, gauss.POINTS * n, given, n + 4, points)
    for i in range(gauss.POINTS):
        state, part = points[i * n : (i + 1) * n], h * gauss.WEIGHTS[i]
        late = (gauss.PLACES[i] - 0.5) * h
        linear_heat(p, state, part, q[HEAT:])
        q[WORK] += part * ((outer_x + u.dfx * late) * state[VX] + (outer_y + u.dfy * late) * state[VY])
        note_peaks(m.o, p.stop, state)
    for i in range(n):
        q[i] = end[i]
    note_peaks(m.o, p.stop, q)
    note_hit(m.o, p.stop, norm(x, y), norm(q[X], q[Y]), time, h)
    return True


@kernel
def take_parts(prepare, take, parts, m, time, step):
    """Take a macro step of `step` (s) from `time` (s) in so many equal `parts`; returns a status.

    prepare(m, h) has m.d ready for steps of h (s); take(m, time, h, since) takes one, whose middle is
    `since` (s) after that of the macro step, and returns whether it is solved. If not, parts are halved.
    """
    done = 0
    while done < parts:
        h = step / parts
        if m.d.length != h:
            prepare(m, h)
        if take(m, time + done * h, h, (done + 0.5) * h - m.half):
            done += 1
            m.evaluations += 1
        elif parts < MOST_PARTS:
            parts, done = 2 * parts, 2 * done
        else:
            return TOO_FAST
    return OK


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
    """One macro step of `step` (s) from `time` (s) under the given force; returns a status."""
    m = words.view(MEMORY)[0]
    u = m.u.seat
    if not math.isfinite(u.fx + u.fy + u.fz + u.dfx + u.dfy + u.dfz):
        return BAD_INPUT
    m.time = time
    m.half = 0.5 * step
    parts = _parts(m, step, abs(u.fx) + m.half * abs(u.dfx), abs(u.fy) + m.half * abs(u.dfy))
    status = take_parts(_prepare, _step, parts, m, time, step)
    if status != OK:
        return status
    p, down = m.p, gravity_along(m.p.gravity, m.p.inclination)
    given, heat = go_along(p.axial, p.mass + p.outer_ring, down, u, step, m.q[ALONG:STATE])
    m.q[WORK] += given
    m.q[HEAT + DAMPER] += heat
    publish(m.q, m)
    finite = math.isfinite(np.sum(m.q))
    return OK if finite else BAD_LOAD


DRIVES = (
    "damper has xx = {0:g}, yy = {1:g}, xy = {2:g}, yx = {3:g} N.s/m, which drives the carrier in some "
    "direction; xx and yy must not be below 0, nor ((xy + yx)/2)^2 above xx yy"
)
BEYOND_FILM = (
    "the carrier sags by {0:g} um under its weight, but film.clearance is {1:g} um, and a film bears no "
    "weight; stiffen the spring, set a stop within the clearance, or widen that"
)
_NAMES = [variable.name for variable in flatten(Parameters())]


def _named(*starts: str) -> tuple[str, ...]:
    """Parameters whose names start so."""
    return tuple(name for name in _NAMES if name.startswith(starts))


_MASS = ("mass", "outer_ring")
_BORNE = ("stop.gap", "stop.stiffness", "stop.exponent")
_SAG = _named(*_MASS, "gravity", "inclination", "spring.", *_BORNE)
_HANGS = _named(*_MASS, "gravity", "inclination", "axial.stiffness")
_TANGENT = _named(
    *_MASS, "spring.xx", "spring.yy", "slide[", *(f"branch[{i + 1}].s" for i in range(BRANCHES))
)
_FADING = _named(*_MASS, "damper.xx", "damper.yy", "film.")

MODEL = Model(
    name="mount",
    title="Mount",
    about="Carrier with the outer ring on springs, dry friction, rubber, a squeeze film and a stop",
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
    starts_from={
        "seat.x": ("x0", *_SAG),
        "seat.y": ("y0", *_SAG),
        "seat.ax_free": _SAG,
        "seat.ay_free": _SAG,
        "seat.inv_m": _MASS,
        "seat.k_over_m": _TANGENT,
        "seat.c_over_m": _FADING,
        "seat.z": _HANGS,
        "seat.az_free": _HANGS,
        "seat.inv_m_z": _named(*_MASS, "axial.stiffness"),
        "seat.k_over_m_z": _named(*_MASS, "axial.stiffness"),
        "seat.c_over_m_z": _named(*_MASS, "axial."),
        "energy.potential": ("y0", *_SAG, "axial.stiffness"),
        "stroke": _SAG,
        "peak_stroke": _SAG,
        "stop_force": _SAG,
        "peak_stop_force": _SAG,
    },
)
