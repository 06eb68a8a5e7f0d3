"""Balls in the grooves of both races, in space: where they touch, and what presses them.

A groove's arcs have their centres on a circle of radius R around its body's axis, at Z along it. A ball at
b touches on the line to the nearest centre G of an arc, which lies in the plane through ball and axis:

    u = (G - b)/|G - b|        d = |G - b| - r        N = k d^1.5

with r = (f - 1/2) D for grooves of radius f D. It feels N u, the body that has the groove -N u on the
same line, so that forces and moments close. Along the race t = a x e points around the axis a (e from the
axis to the ball), and m = u x t across the groove. In the body's own axes (e, t, a)

    u = (u_r, 0, u_a)        m = (-u_a, 0, u_r)

and the point of contact is at (rho, 0, zeta) from its centre. A body that turns with W then moves there,
along t, m and u, by

    W_a rho - W_r zeta        -W_t (u_a zeta + u_r rho)        W_t (u_r zeta - u_a rho)

Normal forces over a kick are those of `bearings.contact.pair` and `bearings.contact.passivity`; in the
plane they are those of `bearings.rolling.ball_bodies`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

from ....modelkit.kernel import inlined, kernel
from ....modelkit.variables import array
from ...contact.laws import elastic_energy, hertz
from ...contact.pair import damped_normal
from ...contact.passivity import middle_of, passive, settled_account
from .memory_layout import ROOM

NOT_TOUCHING = 1e3  # m; r of what stands behind the last ball


@dataclass(frozen=True)
class BallGrooves:
    """The groove of each ball in one race; laws are the same for all."""

    circle: tuple = array(ROOM)  # m, R
    along: tuple = array(ROOM)  # m, Z
    arc: tuple = array(ROOM)  # m, r


@dataclass(frozen=True)
class RaceContacts:
    """One contact of each ball, at the last evaluation; friction is `rubbing`'s."""

    ux: tuple = array(ROOM)  # from the ball to the centre of the arc
    uy: tuple = array(ROOM)
    uz: tuple = array(ROOM)
    tx: tuple = array(ROOM)  # around the shaft
    ty: tuple = array(ROOM)
    tz: tuple = array(ROOM)
    mx: tuple = array(ROOM)  # across the groove
    my: tuple = array(ROOM)
    mz: tuple = array(ROOM)
    cosine: tuple = array(ROOM)  # of the ball's angle around the body's axis
    sine: tuple = array(ROOM)
    outwards: tuple = array(ROOM)  # u_r
    axial: tuple = array(ROOM)  # u_a
    rho: tuple = array(ROOM)  # m
    zeta: tuple = array(ROOM)  # m
    indentation: tuple = array(ROOM)  # m
    stiffness: tuple = array(ROOM)  # N/m
    normal: tuple = array(ROOM)  # N
    damped: tuple = array(ROOM)  # N, what of it is damping
    stored: tuple = array(ROOM)  # J, as `bearings.contact.passivity`
    rate: tuple = array(ROOM)  # m/s, of the indentation, before the kick
    middle: tuple = array(ROOM)  # m/s, in the middle of the kick
    along_t: tuple = array(ROOM)  # m/s, of the ball over the race, before the kick
    along_m: tuple = array(ROOM)
    driven_t: tuple = array(ROOM)  # m/s, its change by all but friction at races
    driven_m: tuple = array(ROOM)
    expected_t: tuple = array(ROOM)  # m/s, at which the kick would end but for its own friction
    expected_m: tuple = array(ROOM)
    spot: tuple = array(ROOM)  # m/s, where the kick is expected to end
    last: tuple = array(ROOM)  # `Rises` there
    flat: tuple = array(ROOM)
    steep: tuple = array(ROOM)
    faded: tuple = array(ROOM)
    slope_tt: tuple = array(ROOM)  # N s/m, of friction alone over the change of the sliding speed
    slope_tm: tuple = array(ROOM)
    slope_mm: tuple = array(ROOM)
    alone_t: tuple = array(ROOM)  # N, friction as the other race's is 0 and its own body keeps its motion
    alone_m: tuple = array(ROOM)
    friction_t: tuple = array(ROOM)  # N, on the ball
    friction_m: tuple = array(ROOM)
    loss: tuple = array(ROOM)  # W, heat
    moved_t: tuple = array(ROOM)  # m/s, by which the kick has the race's surface run ahead
    moved_m: tuple = array(ROOM)
    opened: tuple = array(ROOM)  # m/s, and yield


class Axes(NamedTuple):
    """Unit vectors of a body of revolution in fixed axes; the last one is its own axis."""

    e1x: float
    e1y: float
    e1z: float
    e2x: float
    e2y: float
    e2z: float
    e3x: float
    e3y: float
    e3z: float


class Frame(NamedTuple):
    """A body with a groove: place and velocity in fixed axes, spins in its own."""

    axes: Axes
    x: float  # m
    y: float
    z: float
    vx: float  # m/s
    vy: float
    vz: float
    w1: float  # rad/s
    w2: float
    w3: float


class BodyChange(NamedTuple):
    """Change of a body's motion over a kick, in its own axes."""

    x: float  # m/s
    y: float
    z: float
    w1: float  # rad/s
    w2: float
    w3: float


@inlined
def find_contacts(balls, frame, groove, radius, n, c):
    """Set where `n` balls of a `radius` (m) touch the groove of a body (`Frame`), in c (RaceContacts)."""
    f = frame.axes
    for b in range(n):
        dx, dy, dz = balls.x[b] - frame.x, balls.y[b] - frame.y, balls.z[b] - frame.z
        x = f.e1x * dx + f.e1y * dy + f.e1z * dz
        y = f.e2x * dx + f.e2y * dy + f.e2z * dz
        z = f.e3x * dx + f.e3y * dy + f.e3z * dz
        distance = math.sqrt(x * x + y * y)
        inverse = 1.0 / distance
        cosine, sine = x * inverse, y * inverse
        outwards, axial = groove.circle[b] - distance, groove.along[b] - z
        length = math.sqrt(outwards * outwards + axial * axial)
        inverse = 1.0 / length
        outwards, axial = outwards * inverse, axial * inverse
        c.indentation[b] = length - groove.arc[b]
        c.cosine[b], c.sine[b], c.outwards[b], c.axial[b] = cosine, sine, outwards, axial
        c.rho[b], c.zeta[b] = distance - radius * outwards, z - radius * axial
    for b in range(n):
        cosine, sine, outwards, axial = c.cosine[b], c.sine[b], c.outwards[b], c.axial[b]
        ex, ey, ez = _in_plane(f, cosine, sine)
        c.tx[b], c.ty[b], c.tz[b] = _in_plane(f, -sine, cosine)
        c.ux[b], c.uy[b], c.uz[b] = _in_meridian_plane(f, ex, ey, ez, outwards, axial)
        c.mx[b], c.my[b], c.mz[b] = _in_meridian_plane(f, ex, ey, ez, -axial, outwards)


@inlined
def _in_plane(f, first, second):
    """A vector across the axis of `Axes`, in fixed ones."""
    return f.e1x * first + f.e2x * second, f.e1y * first + f.e2y * second, f.e1z * first + f.e2z * second


@inlined
def _in_meridian_plane(f, ex, ey, ez, outwards, axial):
    """A vector in the plane of e and the axis of `Axes`, in fixed ones."""
    return outwards * ex + axial * f.e3x, outwards * ey + axial * f.e3y, outwards * ez + axial * f.e3z


@inlined
def surface(c, b, x, y, z, w1, w2, w3):
    """Motion along t, m and u of the body's surface at contact `b`, by its own in its axes (m/s, rad/s)."""
    cosine, sine, outwards, axial = c.cosine[b], c.sine[b], c.outwards[b], c.axial[b]
    rho, zeta = c.rho[b], c.zeta[b]
    radial, turning = x * cosine + y * sine, w2 * cosine - w1 * sine
    along_t = y * cosine - x * sine + rho * w3 - zeta * (w1 * cosine + w2 * sine)
    along_m = outwards * z - axial * radial - turning * (axial * zeta + outwards * rho)
    return along_t, along_m, outwards * radial + axial * z + turning * (outwards * zeta - axial * rho)


@inlined
def follow(n, c, moved):
    """Set by how much `n` contacts c run ahead and yield as their body is `moved` (BodyChange)."""
    for b in range(n):
        ahead = surface(c, b, moved.x, moved.y, moved.z, moved.w1, moved.w2, moved.w3)
        c.moved_t[b], c.moved_m[b], c.opened[b] = ahead


@inlined
def set_sliding(balls, frame, radius, n, c):
    """Set the sliding speeds of `n` balls over the groove of a body (`Frame`), and the rates (m/s)."""
    f, turned = frame, (frame.w1, frame.w2, frame.w3)
    for b in range(n):
        vx, vy, vz = balls.vx[b] - f.vx, balls.vy[b] - f.vy, balls.vz[b] - f.vz
        wx, wy, wz = balls.wx[b], balls.wy[b], balls.wz[b]
        ux, uy, uz = c.ux[b], c.uy[b], c.uz[b]
        tx, ty, tz = c.tx[b], c.ty[b], c.tz[b]
        mx, my, mz = c.mx[b], c.my[b], c.mz[b]
        ahead = surface(c, b, 0.0, 0.0, 0.0, turned[0], turned[1], turned[2])
        # the surface of the ball by its spin: radius u x w, along t and m
        by_spin_t = -(wx * mx + wy * my + wz * mz)
        by_spin_m = wx * tx + wy * ty + wz * tz
        c.along_t[b] = vx * tx + vy * ty + vz * tz + radius * by_spin_t - ahead[0]
        c.along_m[b] = vx * mx + vy * my + vz * mz + radius * by_spin_m - ahead[1]
        c.rate[b] = ahead[2] - (vx * ux + vy * uy + vz * uz)


@inlined
def press_on_race(balls, law, beat, answer, hvx, hvy, n, c):
    """Set the normal forces of `n` balls at their places c on a race.

    law: a record; beat: `Beat`; answer: of a ball's speed to a force over the kick (s/kg). `c.opened` is by
    how much the race yielded in the kick before (m/s), `c.normal` the force in it; hvx, hvy: of the housing
    (m/s).
    """
    stiffness, damping, h = law.stiffness, law.damping, beat.kick
    for b in range(n):
        elastic, slope, c.stiffness[b] = hertz(c.indentation[b], stiffness, damping)
        before = balls.bx[b] * c.ux[b] + balls.by[b] * c.uy[b] + balls.bz[b] * c.uz[b]
        others = c.opened[b] - h * before + answer * c.normal[b]
        rate = c.rate[b]
        elastic = passive(elastic, 0.4 * c.indentation[b], c.stored[b], rate, others, answer, beat)
        # damping meets a ball as axes that go round with it have it (`rubbing`)
        vx, vy = balls.vx[b] - hvx, balls.vy[b] - hvy
        turned = balls.orbit[b] * (vy * c.ux[b] - vx * c.uy[b])
        closing = rate + (h - beat.drift) * turned
        normal = damped_normal(elastic, slope, closing, answer, others - h * turned)
        c.normal[b], c.damped[b] = normal, normal - elastic


@kernel
def settle_grooves(c, n, kick, part, vx, vy, vz):
    """Settle the accounts of `n` contacts c after a `kick` (s); returns what they withheld (J).

    part: of the kick in which the forces were found; vx, vy, vz: by how much the race was faster in its
    middle than it was taken to be (m/s).
    """
    withheld = 0.0
    for b in range(n):
        if c.indentation[b] <= 0.0 and c.stored[b] <= 0.0:  # apart for longer
            continue
        closing = middle_of(c.rate[b], c.middle[b], part) + vx * c.ux[b] + vy * c.uy[b] + vz * c.uz[b]
        taken = kick * (c.normal[b] - c.damped[b]) * closing
        c.stored[b], lost = settled_account(c.stored[b], c.indentation[b], taken)
        withheld += lost
    return withheld


@kernel
def fill_race(c, law, n):
    """Have the accounts of `n` contacts c hold what their law, a record, has stored."""
    for b in range(n):
        c.stored[b] = elastic_energy(c.indentation[b], law)


@kernel
def stored_in(c, law, n):
    """Energy (J) of `n` contacts c; law: a record."""
    energy = 0.0
    for b in range(n):
        energy += elastic_energy(c.indentation[b], law)
    return energy


@inlined
def accelerate_balls(balls, o, i, by_mass, gy, gz, n):
    """Set the accelerations of `n` balls pressed at o and i, under gravity gy, gz (m/s2); by_mass: 1/kg."""
    for b in range(n):
        outer, inner = o.normal[b] * by_mass, i.normal[b] * by_mass
        balls.ax[b] = outer * o.ux[b] + inner * i.ux[b]
        balls.ay[b] = outer * o.uy[b] + inner * i.uy[b] + gy
        balls.az[b] = outer * o.uz[b] + inner * i.uz[b] + gz
        balls.px[b] = balls.py[b] = balls.pz[b] = 0.0
