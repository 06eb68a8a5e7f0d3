"""The elements of a mount: what each resists with over a step, what it keeps, and what becomes heat.

They act in parallel between carrier and ground; q is the carrier's way from the relaxed place. Springs,
dampers and Maxwell branches are linear. The others follow a step in which the carrier goes straight from
q to q + d in h seconds. Each gives the mean f of its force over that way, so that f . d is what it stores
and what it turns into heat, and heat is never below zero:

    slide   a spring behind dry friction (Jenkins): it is dragged like a weight on a string of length
            r = force/stiffness. While it slides, its stretch turns towards d,
            tan(psi'/2) = tan(psi/2) exp(-s/r) after s metres, and the foot goes r ln(sin psi/sin psi')
    stop    (U(r') - U(r))/(r'^2 - r^2) (q + q'), U = stiffness (r - gap)^(n + 1)/(n + 1), r = |q|; damping
            by chi times that force times the speed of r (Hunt and Crossley), without pull
    film    B(q + d/2, d) d/h: a short bearing that is squeezed (Ocvirk), B = viscosity radius length^3
            times the integral of n n^T/thickness^3 over the circle, or over the half that d closes
            (Guembel); its integrals by Sommerfeld's substitution

Several slides together are Iwan's model; their loop is that of Masing's rule.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ...modelkit.gravity import INCLINATION
from ...modelkit.kernel import interpret, kernel
from ...modelkit.numerics import squared
from ...modelkit.variables import Choices, as_record, choice, group, groups, integer, real

SLIDES, BRANCHES = 4, 3
SPRING, DAMPER, SLIDE, BRANCH, STOP, FILM = range(6)  # where heat arises
HEATS = 6
NEVER = -1.0  # s
NARROW = 1e-9  # m; changes of the stroke below it give the stop's mean force by its middle
LEAST_STROKE = 1e-12  # m; keeps a slope of the stop, whose gap may be 0, a number
FADING = 0.125  # of a film's rate: 2 in a step of 0.25 rad, up to which it fades without swinging
THINNEST = 1e-3  # of the clearance; a film is not squeezed below it
# Way of a step over the film's thickness. One a quarter thinner resists up to twice as much, by h^-2.5, and
# the middle of the step has that within 3 %; by a step across the clearance the orbit may never settle.
FILM_SHARE = 0.25
CAVITATION = Choices(
    "Cavitation", ("none", "half"), ("the film pulls as it pushes", "it pushes only, where it is squeezed")
)


@dataclass(frozen=True)
class Stiffness:
    """Of two directions; the force that resists is xx x + xy y horizontally, yx x + yy y vertically."""

    xx: float = real(0.0, "N/m", "horizontal")
    yy: float = real(0.0, "N/m", "vertical")
    xy: float = real(0.0, "N/m", "horizontal force by vertical motion")
    yx: float = real(0.0, "N/m", "vertical force by horizontal motion")


@dataclass(frozen=True)
class Damping:
    """Of two directions, as `Stiffness`, by velocity."""

    xx: float = real(0.0, "N.s/m", "horizontal")
    yy: float = real(0.0, "N.s/m", "vertical")
    xy: float = real(0.0, "N.s/m", "horizontal force by vertical motion")
    yx: float = real(0.0, "N.s/m", "vertical force by horizontal motion")


@dataclass(frozen=True)
class Slide:
    """A Jenkins element: a spring in series with a Coulomb slider, alike in all directions."""

    stiffness: float = real(
        0.0, "N/m", "of the spring of a Jenkins element; 0: not there", minimum=0.0, needs="force"
    )
    force: float = real(0.0, "N", "at which the Coulomb slider slides", minimum=0.0, needs="stiffness")


@dataclass(frozen=True)
class Branch:
    """A spring in series with a dashpot (Maxwell), as rubber has several of."""

    stiffness: float = real(0.0, "N/m", "of the spring of a Maxwell element; 0: not there", minimum=0.0)
    time: float = real(1e-3, "s", "relaxation time of the Maxwell element", above=0.0, needs="stiffness")


@dataclass(frozen=True)
class EndStop:
    """The end stop of the stroke."""

    gap: float = real(1e-4, "m", "stroke up to the end stop", minimum=0.0, needs="stiffness")
    stiffness: float = real(0.0, "N/m^n", "force by indentation^exponent; 0: no stop", minimum=0.0)
    exponent: float = real(1.5, "1", "n", minimum=1.0, maximum=4.0, needs="stiffness")
    dissipation: float = real(
        0.0,
        "s/m",
        "Hunt-Crossley coefficient epsilon: elastic force times (1 + epsilon d')",
        minimum=0.0,
        needs="stiffness",
    )


@dataclass(frozen=True)
class Film:
    """A squeeze film damper (short bearing) around the carrier."""

    radius: float = real(0.02, "m", "of the film", above=0.0, needs="viscosity")
    length: float = real(0.01, "m", "of the film along the shaft", above=0.0, needs="viscosity")
    clearance: float = real(1e-4, "m", "radial", above=0.0, needs="viscosity")
    viscosity: float = real(0.0, "Pa.s", "0: no film", minimum=0.0)
    cavitation: int = choice(
        1, CAVITATION, "cavitation of the film: full (2 pi) or half (pi) film", needs="viscosity"
    )


@dataclass(frozen=True)
class Elements:
    """Elements between a carrier and its support; everything is off by default."""

    spring: Stiffness = group(Stiffness)
    damper: Damping = group(Damping)
    slide: tuple = groups(Slide, SLIDES)
    branch: tuple = groups(Branch, BRANCHES)
    stop: EndStop = group(EndStop)
    film: Film = group(Film)


@dataclass(frozen=True)
class Body:
    """What holds an outer ring. Defaults: the housing of Halminen (2016)."""

    mass: float = real(5.0, "kg", "mass of the housing or carrier", above=0.0)
    outer_ring: float = real(0.042, "kg", "mass of the outer ring fixed in it", minimum=0.0)
    x0: float = real(0.0, "m", "horizontal position with its springs relaxed (misalignment)")
    y0: float = real(0.0, "m", "vertical position with its springs relaxed (misalignment)")


@dataclass(frozen=True)
class Ground:
    """What all of a machine's supports stand on."""

    gravity: float = real(9.81, "m/s2", "gravity, downwards", minimum=0.0)
    inclination: float = real(0.0, "rad", INCLINATION)


@dataclass(frozen=True)
class AxialMount:
    """Spring and damper along the shaft; as stiff as the housing of Halminen (2016) is across."""

    stiffness: float = real(
        2.5e8, "N/m", "along the shaft; 0: the carrier keeps its place", minimum=0.0, needs="@axial"
    )
    damping: float = real(2500.0, "N.s/m", "along the shaft", minimum=0.0, needs="stiffness")


@dataclass(frozen=True)
class Carrier(Elements, Body):
    """A carrier and what it stands on. Defaults: the housing of Halminen (2016), stiff and linear."""

    spring: Stiffness = group(Stiffness, xx=2.5e8, yy=2.5e8)
    damper: Damping = group(Damping, xx=2500.0, yy=2500.0)
    axial: AxialMount = group(AxialMount)


@dataclass(frozen=True)
class Heat:
    """Heat by element, since the start."""

    spring: float = real(
        0.0, "J", "work that cross-coupling of the springs took; of either sign", local=True
    )
    damper: float = real(0.0, "J", "of the dampers, that along the shaft included", local=True)
    slide: float = real(0.0, "J", "of dry friction", local=True)
    branch: float = real(0.0, "J", "of the Maxwell branches", local=True)
    stop: float = real(0.0, "J", "of the stop", local=True)
    film: float = real(0.0, "J", "of the squeeze film", local=True)


@dataclass(frozen=True)
class StrokeReport:
    """Report of a mount's stroke."""

    stroke: float = real(0.0, "m", "distance from the relaxed place", local=True)
    peak_stroke: float = real(0.0, "m", "the largest stroke so far", local=True)
    stop_force: float = real(0.0, "N", "of the stop", local=True)
    peak_stop_force: float = real(0.0, "N", "the largest force of the stop so far", local=True)
    stop_time: float = real(NEVER, "s", "when the stop was first reached; -1: not yet", local=True)
    stop_hits: int = integer(0, "how often the stop was reached", local=True)
    heat: Heat = group(Heat)


@kernel
def norm(x, y):
    """Length of a vector, by its squares, which is quicker than `math.hypot`."""
    return math.sqrt(x * x + y * y)


@kernel
def branches_in_use(p):
    """How many branches the state has to hold: up to the last that there is."""
    count = 0
    for i in range(BRANCHES):
        if p.branch[i].stiffness > 0.0:
            count = i + 1
    return count


@kernel
def linear_heat(p, state, duration, heat):
    """Add to heat (6,) what the linear elements turn into heat in `duration` (s) at the rate of `state`.

    State: x, y (m), vx, vy (m/s), then stretch x, y (m) of each branch's spring.
    """
    k, c = p.spring, p.damper
    x, y, vx, vy = state[0], state[1], state[2], state[3]
    turning = 0.5 * (k.xy - k.yx)  # the part of the springs that has no energy
    heat[SPRING] += duration * turning * (y * vx - x * vy)
    heat[DAMPER] += duration * (c.xx * vx * vx + (c.xy + c.yx) * vx * vy + c.yy * vy * vy)
    for i in range(branches_in_use(p)):
        wx, wy = state[4 + 2 * i], state[5 + 2 * i]
        heat[BRANCH] += duration * p.branch[i].stiffness / p.branch[i].time * (wx * wx + wy * wy)


@kernel
def slide(p, zx, zy, dx, dy):
    """A slide of stretch (zx, zy) (m) on the way (dx, dy) (m), its parameters p.

    Returns its mean force (N, N), its stretch afterwards (m, m), and how far its foot slid (m).
    """
    if p.force <= 0.0:
        return 0.0, 0.0, 0.0, 0.0, 0.0
    k, r = p.stiffness, p.force / p.stiffness
    ex, ey = zx + dx, zy + dy
    if ex * ex + ey * ey <= r * r:
        return k * (zx + 0.5 * dx), k * (zy + 0.5 * dy), ex, ey, 0.0
    way = norm(dx, dy)
    ux, uy = dx / way, dy / way
    along, left = zx * ux + zy * uy, max(r * r - zx * zx - zy * zy, 0.0)
    root = math.sqrt(along * along + left)
    first = left / (along + root) if along > 0.0 else root - along  # m, while it sticks
    first = min(first, way)
    bx, by = zx + first * ux, zy + first * uy
    across = (uy * bx - ux * by) / r  # sine of the angle from the stretch on to the way
    t = across / (1.0 + math.sqrt(max(1.0 - across * across, 0.0)))  # tan(psi/2); it points ahead
    length = (way - first) / r
    later = t * math.exp(-length)
    square, after = t * t, later * later
    slid = r * (length + math.log((1.0 + after) / (1.0 + square)))
    turned = 2.0 * r * r * math.atan((t - later) / (1.0 + t * later))
    cosine, sine = (1.0 - after) / (1.0 + after), 2.0 * later / (1.0 + after)
    fx = k / way * (0.5 * first * (zx + bx) + r * slid * ux + turned * uy)
    fy = k / way * (0.5 * first * (zy + by) + r * slid * uy - turned * ux)
    return fx, fy, r * (cosine * ux + sine * uy), r * (cosine * uy - sine * ux), slid


@kernel
def _pressed(p, stroke):
    """Force (N) of a stop at the stroke (m) at rest."""
    s = stroke - p.gap
    if s <= 0.0:
        return 0.0
    return p.stiffness * (s * math.sqrt(s) if p.exponent == 1.5 else s**p.exponent)


@kernel
def stop_energy(p, stroke):
    """Energy (J) of a stop at the stroke (m)."""
    return _pressed(p, stroke) * (stroke - p.gap) / (p.exponent + 1.0)


@kernel
def stop_force(p, stroke, rate):
    """Force (N) of a stop at the stroke (m) as it grows by `rate` (m/s)."""
    return _pressed(p, stroke) * max(1.0 + p.dissipation * rate, 0.0)


@kernel
def stop_mean(p, before, after, h):
    """Mean radial force (N) of a stop while the stroke goes from `before` to `after` (m) in h (s).

    And its slope (N/m) by the latter.
    """
    gone, middle = after - before, 0.5 * (before + after)
    halfway = _pressed(p, middle)
    steepness = p.exponent * halfway / (middle - p.gap) if halfway > 0.0 else 0.0
    if abs(gone) > NARROW:
        force = (stop_energy(p, after) - stop_energy(p, before)) / gone
        slope = (_pressed(p, after) - force) / gone
    else:
        force, slope = halfway, 0.5 * steepness
    force += p.dissipation * halfway * gone / h
    slope += p.dissipation * (halfway + 0.5 * steepness * gone) / h
    return (force, slope) if force > 0.0 else (0.0, 0.0)


@kernel
def film_matrix(p, x, y, dx, dy):
    """(xx, xy, yy) of a film's resistance (N s/m) at (x, y) (m), squeezed along (dx, dy).

    Measured from the side where it is thinnest, thickness = clearance H, H = 1 - e cos(theta), and with
    cos(gamma) = (cos(theta) - e)/H the integrals of cos^2, cos sin and sin^2 over H^3 are elementary.
    """
    slender = p.length / p.clearance
    scale = p.viscosity * p.radius * (slender * slender * slender)
    place = norm(x, y)
    e = min(place / p.clearance, 1.0 - THINNEST)
    nx, ny = (x / place, y / place) if place > 0.0 else (1.0, 0.0)
    way = norm(dx, dy)
    s2 = 1.0 - e * e
    root = math.sqrt(s2)
    radial, mixed, across = math.pi * (1.0 + 2.0 * e * e), 0.0, math.pi
    if p.cavitation == 1 and way > 0.0:
        cosine, sine = (dx * nx + dy * ny) / way, (dy * nx - dx * ny) / way
        h1, h2 = 1.0 - e * sine, 1.0 + e * sine  # a quarter turn before the way, and after it
        c1, s1 = (sine - e) / h1, -root * cosine / h1
        c2, s2g = (-sine - e) / h2, root * cosine / h2
        turn = math.atan2(s2g * c1 - c2 * s1, c1 * c2 + s1 * s2g)
        turn = turn + 2.0 * math.pi if turn < 0.0 else turn
        double = 0.5 * (s2g * c2 - s1 * c1)
        radial = (e * e + 0.5) * turn + 2.0 * e * (s2g - s1) + double
        mixed = 0.5 * (s2g * s2g - s1 * s1) - e * (c2 - c1)
        across = 0.5 * turn - double
    radial, mixed, across = (
        scale * radial / (s2 * s2 * root),
        scale * mixed / (s2 * s2),
        scale * across / (s2 * root),
    )
    xx = radial * nx * nx - 2.0 * mixed * nx * ny + across * ny * ny
    yy = radial * ny * ny + 2.0 * mixed * nx * ny + across * nx * nx
    return xx, (radial - across) * nx * ny + mixed * (nx * nx - ny * ny), yy


@kernel
def outruns_film(p, x, y, dx, dy):
    """Whether the way (dx, dy) from (x, y) (m) is too long for a film, p, where that is thinner on it."""
    thinnest = max(p.clearance - max(norm(x, y), norm(x + dx, y + dy)), THINNEST * p.clearance)
    return p.viscosity > 0.0 and norm(dx, dy) > FILM_SHARE * thinnest


@kernel
def mean_force(p, x, y, dx, dy, h, z):
    """Mean force (N, N) of slides, stop and film on the way (dx, dy) from (x, y) (m) in h (s).

    And its slopes (N/m) by the way: x by dx, x by dy, y by dx, y by dy. Across the way those of what slides
    are estimates, and those of a film leave out that its thickness changes.
    z: stretch of the slides (2 SLIDES,), m.
    """
    fx, fy, xx, xy, yx, yy = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for i in range(SLIDES):
        if p.slide[i].stiffness > 0.0 and p.slide[i].force > 0.0:
            k = p.slide[i].stiffness
            gx, gy, ax, ay, slid = slide(p.slide[i], z[2 * i], z[2 * i + 1], dx, dy)
            fx += gx
            fy += gy
            if slid > 0.0:
                way = norm(dx, dy)
                ux, uy = dx / way, dy / way
                sx, sy = (k * ax - gx) / way, (k * ay - gy) / way
                across = k / (2.0 + k * way / p.slide[i].force)
                xx += sx * ux + across * uy * uy
                xy += sx * uy - across * ux * uy
                yx += sy * ux - across * ux * uy
                yy += sy * uy + across * ux * ux
            else:
                xx += 0.5 * k
                yy += 0.5 * k
    if p.stop.stiffness > 0.0:
        before, after = norm(x, y), norm(x + dx, y + dy)
        if max(before, after) > p.stop.gap:
            force, slope = stop_mean(p.stop, before, after, h)
            both = before + after
            share = force / both
            turn = (slope - share) / (both * max(after, LEAST_STROKE))  # of the share, by the place
            mx, my = 2.0 * x + dx, 2.0 * y + dy
            fx += share * mx
            fy += share * my
            xx += share + turn * mx * (x + dx)
            xy += turn * mx * (y + dy)
            yx += turn * my * (x + dx)
            yy += share + turn * my * (y + dy)
    if p.film.viscosity > 0.0:
        bxx, bxy, byy = film_matrix(p.film, x + 0.5 * dx, y + 0.5 * dy, dx, dy)
        fx += (bxx * dx + bxy * dy) / h
        fy += (bxy * dx + byy * dy) / h
        xx += bxx / h
        xy += bxy / h
        yx += bxy / h
        yy += byy / h
    return fx, fy, xx, xy, yx, yy


@kernel
def go(p, x, y, dx, dy, h, z, heat):
    """Go (dx, dy) from (x, y) (m) in h (s): stretch z (m) of the slides and heat (6,) (J) follow."""
    for i in range(SLIDES):
        if p.slide[i].stiffness > 0.0:
            found = slide(p.slide[i], z[2 * i], z[2 * i + 1], dx, dy)
            z[2 * i], z[2 * i + 1] = found[2], found[3]
            heat[SLIDE] += p.slide[i].force * found[4]
    if p.stop.stiffness > 0.0:
        before, after = norm(x, y), norm(x + dx, y + dy)
        if max(before, after) > p.stop.gap:
            stored = stop_energy(p.stop, after) - stop_energy(p.stop, before)
            heat[STOP] += stop_mean(p.stop, before, after, h)[0] * (after - before) - stored
    if p.film.viscosity > 0.0:
        xx, xy, yy = film_matrix(p.film, x + 0.5 * dx, y + 0.5 * dy, dx, dy)
        heat[FILM] += (xx * dx * dx + 2.0 * xy * dx * dy + yy * dy * dy) / h


@kernel
def mount_energy(p, state, z):
    """Energy (J) in the mount: `state` as in `linear_heat`, z: stretch of the slides (2 SLIDES,), m."""
    k, x, y = p.spring, state[0], state[1]
    energy = 0.5 * (k.xx * x * x + (k.xy + k.yx) * x * y + k.yy * y * y)
    for i in range(branches_in_use(p)):
        energy += 0.5 * p.branch[i].stiffness * (squared(state[4 + 2 * i]) + squared(state[5 + 2 * i]))
    for i in range(SLIDES):
        energy += 0.5 * p.slide[i].stiffness * (squared(z[2 * i]) + squared(z[2 * i + 1]))
    if p.stop.stiffness > 0.0:
        energy += stop_energy(p.stop, norm(x, y))
    return energy


@kernel
def linear_force(p, state):
    """Force (N, N) that springs, dampers and branches resist with at an instant."""
    k, c = p.spring, p.damper
    x, y, vx, vy = state[0], state[1], state[2], state[3]
    fx = k.xx * x + k.xy * y + c.xx * vx + c.xy * vy
    fy = k.yx * x + k.yy * y + c.yx * vx + c.yy * vy
    for i in range(branches_in_use(p)):
        fx += p.branch[i].stiffness * state[4 + 2 * i]
        fy += p.branch[i].stiffness * state[5 + 2 * i]
    return fx, fy


@kernel
def force_now(p, state, z):
    """Force (N, N) that the mount resists with at an instant, and that of its stop (N)."""
    x, y, vx, vy = state[0], state[1], state[2], state[3]
    fx, fy = linear_force(p, state)
    for i in range(SLIDES):
        fx += p.slide[i].stiffness * z[2 * i]
        fy += p.slide[i].stiffness * z[2 * i + 1]
    stop, stroke = 0.0, norm(x, y)
    if p.stop.stiffness > 0.0 and stroke > p.stop.gap and stroke > 0.0:
        stop = stop_force(p.stop, stroke, (x * vx + y * vy) / stroke)
        fx += stop * x / stroke
        fy += stop * y / stroke
    if p.film.viscosity > 0.0:
        xx, xy, yy = film_matrix(p.film, x, y, vx, vy)
        fx += xx * vx + xy * vy
        fy += xy * vx + yy * vy
    return fx, fy, stop


@kernel
def mount_rates(p, state, z, dz, dheat):
    """Force as `force_now` has it (N, N); fills dz (m/s) of the slides, dheat (6,) (W) of the elements."""
    x, y, vx, vy = state[0], state[1], state[2], state[3]
    fx, fy, stop = force_now(p, state, z)
    for i in range(HEATS):
        dheat[i] = 0.0
    linear_heat(p, state, 1.0, dheat)
    for i in range(SLIDES):
        zx, zy = z[2 * i], z[2 * i + 1]
        dz[2 * i], dz[2 * i + 1] = 0.0, 0.0
        if p.slide[i].stiffness > 0.0 and p.slide[i].force > 0.0:
            size, reach = norm(zx, zy), p.slide[i].force / p.slide[i].stiffness
            away = (zx * vx + zy * vy) / size if size >= reach else 0.0  # m/s, that the foot slides
            dz[2 * i], dz[2 * i + 1] = vx, vy
            if away > 0.0:
                dz[2 * i] -= away * zx / size
                dz[2 * i + 1] -= away * zy / size
                dheat[SLIDE] += p.slide[i].force * away
    if stop > 0.0:
        stroke = norm(x, y)
        rate = (x * vx + y * vy) / stroke
        dheat[STOP] = (stop - stop_force(p.stop, stroke, 0.0)) * rate
    if p.film.viscosity > 0.0:
        xx, xy, yy = film_matrix(p.film, x, y, vx, vy)
        dheat[FILM] = xx * vx * vx + 2.0 * xy * vx * vy + yy * vy * vy
    return fx, fy


@kernel
def tangent(p):
    """Stiffness (N/m) and damping (N s/m) at the relaxed place, slides sticking; the mean of x and y."""
    k, c = 0.5 * (p.spring.xx + p.spring.yy), 0.5 * (p.damper.xx + p.damper.yy)
    for i in range(SLIDES):
        k += p.slide[i].stiffness if p.slide[i].force > 0.0 else 0.0
    for i in range(BRANCHES):
        k += p.branch[i].stiffness
    if p.film.viscosity > 0.0:
        xx, _, yy = film_matrix(p.film, 0.0, 0.0, 1.0, 0.0)
        c += 0.5 * (xx + yy)
    return max(k, 0.0), max(c, 0.0)


@kernel
def quickness(p, mass, state, fx, fy, step):
    """Fastest rate (rad/s) of slides, stop and film within the `step` (s) ahead, under the force (N).

    That of a film counts by `FADING`: how far a mass goes until a film has braked it is right in a step of
    any length.
    """
    k = 0.0
    for i in range(SLIDES):
        k += p.slide[i].stiffness if p.slide[i].force > 0.0 else 0.0
    stroke, speed = norm(state[0], state[1]), norm(state[2], state[3])
    push = norm(fx, fy)
    if p.stop.stiffness > 0.0 and stroke + step * (speed + step * push / mass) > p.stop.gap:
        n = p.stop.exponent
        depth = max(stroke - p.stop.gap, (push / p.stop.stiffness) ** (1.0 / n))
        depth = max(depth, (0.5 * (n + 1.0) * mass * speed * speed / p.stop.stiffness) ** (1.0 / (n + 1.0)))
        k += n * p.stop.stiffness * depth ** (n - 1.0)
    rate = math.sqrt(k / mass)
    if p.film.viscosity > 0.0:
        xx, xy, yy = film_matrix(p.film, state[0], state[1], state[2], state[3])
        largest = 0.5 * (xx + yy + norm(xx - yy, 2.0 * xy))
        rate += FADING * largest / mass
    return rate


@kernel
def note_peaks(out, stop, state):
    """Keep in `out` (`StrokeReport`) the largest stroke and force of the stop, as they are in `state`."""
    stroke = norm(state[0], state[1])
    out.peak_stroke = max(out.peak_stroke, stroke)
    if stop.stiffness > 0.0 and stroke > stop.gap:
        rate = (state[0] * state[2] + state[1] * state[3]) / stroke
        out.peak_stop_force = max(out.peak_stop_force, stop_force(stop, stroke, rate))


@kernel
def linear_rate(p, mass):
    """Fastest rate (rad/s) of springs, dampers and branches under a carrier of `mass` (kg), at most."""
    k, c = p.spring, p.damper
    stiffness = max(abs(k.xx) + abs(k.xy), abs(k.yy) + abs(k.yx))
    for i in range(BRANCHES):
        stiffness += p.branch[i].stiffness
    return math.sqrt(stiffness / mass) + max(abs(c.xx) + abs(c.xy), abs(c.yy) + abs(c.yx)) / mass


@kernel
def _leant(p, weight, reach):
    """Place (m, m) where the springs and `reach` (N/m) more in both directions bear `weight` (N)."""
    k = p.spring
    xx, yy = k.xx + reach, k.yy + reach
    det = xx * yy - k.xy * k.yx
    if det > 0.0:
        return k.xy * weight / det, -xx * weight / det
    return 0.0, (-weight / yy if yy > 0.0 and k.xy == 0.0 else 0.0)


@kernel
def sag(p, weight):
    """Where the carrier rests (m, m) under `weight` (N) on springs and stop, slides slack.

    The middle where nothing bears it. The stop stands for a spring of its secant stiffness, which is found
    by bisection.
    """
    x, y = _leant(p, weight, 0.0)
    stroke, s = norm(x, y), p.stop
    free = p.spring.yy <= 0.0
    if weight <= 0.0 or s.stiffness <= 0.0 or (stroke <= s.gap and not free):
        return x, y
    low, high = 0.0, weight / (s.gap + (weight / s.stiffness) ** (1.0 / s.exponent))
    for _ in range(200):
        secant = 0.5 * (low + high)
        x, y = _leant(p, weight, secant)
        stroke = norm(x, y)
        if stop_force(s, stroke, 0.0) > secant * stroke:
            low = secant
        else:
            high = secant
    return x, y


def mount_dynamic_stiffness(p: Elements, omega: float, amplitude: float = 0.0) -> np.ndarray:
    """Force over way of a mount, (2, 2) complex (N/m), swinging as exp(i omega t); omega: rad/s.

    Row: direction of the force that resists, column: of the motion; x, y. Springs, dampers and branches
    are exact. Slides, stop and film are linearised harmonically for a circle of radius `amplitude` (m)
    about the relaxed place, either way round; 0: slides stick, the film is that of small motion.

        slide   force^2/(k a^2) + i force/a sqrt(1 - (force/(k a))^2)    where a > force/k
        film    (C_tt i + 2 s e/(1 - e^2)^2 if torn) omega, C_tt = s pi (1 - e^2)^(-3/2), half if torn
    """
    return _linear_stiffness(p, omega) + _by_stroke(p, omega)(amplitude) * np.eye(2)


def circle_stiffness(p: Elements, omega: float) -> Callable[[float], complex]:
    """Force over way (N/m) of a mount whose carrier goes round at `omega` (rad/s, counter-clockwise).

    By its stroke (m). What is not alike in all directions is taken in the mean over the circle.
    """
    there = _linear_stiffness(p, omega)
    mean = 0.5 * complex(there[0, 0] + there[1, 1] + 1j * (there[1, 0] - there[0, 1]))
    others = _by_stroke(p, omega)
    return lambda stroke: mean + others(stroke)


def _linear_stiffness(p: Elements, omega: float) -> np.ndarray:
    """Of springs, dampers and branches, as `mount_dynamic_stiffness`."""
    k, c = p.spring, p.damper
    found = np.array([[k.xx, k.xy], [k.yx, k.yy]], complex)
    found += 1j * omega * np.array([[c.xx, c.xy], [c.yx, c.yy]])
    turns = ((branch.stiffness, 1j * omega * branch.time) for branch in p.branch)
    return found + sum(stiffness * turn / (1.0 + turn) for stiffness, turn in turns) * np.eye(2)


def _by_stroke(p: Elements, omega: float) -> Callable[[float], complex]:
    """Of slides, stop and film on a circle, as `mount_dynamic_stiffness`, by its radius (m)."""
    # plain numbers: an equation's root asks for it some thousand times
    sense, film, stop = math.copysign(1.0, omega), as_record(p.film), as_record(p.stop)
    slides = [(s.stiffness, s.force / s.stiffness) for s in p.slide if s.stiffness > 0.0 and s.force > 0.0]

    def at(stroke: float) -> complex:
        alike = 0.0j
        for stiffness, reach in slides:
            share = min(reach / stroke, 1.0) if stroke > 0.0 else 1.0
            alike += stiffness * share * complex(share, sense * math.sqrt(1.0 - share * share))
        if p.stop.stiffness > 0.0 and stroke > p.stop.gap:
            alike += interpret(stop_force, stop, stroke, 0.0) / stroke
        if p.film.viscosity > 0.0:  # at (stroke, 0), moving along y
            _, across, along = interpret(film_matrix, film, stroke, 0.0, 0.0, sense)
            alike += omega * complex(across, along)
        return alike

    return at
