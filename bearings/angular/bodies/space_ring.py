"""The inner ring with six coordinates, and the rotor that lands in its bore and on its faces.

The ring's state is its place, its velocity, two tilts and three spins. It is a body of revolution about
its axis a, whose cosines the tilts are: a = (ry, -rx, 1) but for what makes that a unit vector. Spins are
about its own axes (`tilted_axes`), which tilt with it and do not turn: w1, w2 across and w about a. To the
first order in the tilt (1e-3 rad in a drop) the tilts' rates are w1 and w2. With I_t and I_p, and moments M
in its axes,

    I_t w1' + I_p w w2 = M_1        I_t w2' - I_p w w1 = M_2        I_p w' = M_3

Over a kick the gyroscopic terms take the mean of w1 and of w2, and do no work.

The journal touches the bore at both edges of its land, each with half of the stiffness: without tilt, or
without a land, that is the one contact of a bearing in the plane. Shoulders touch a face, at the end of the
land, at twelve places around, each with a twelfth of it. Each of these `TOUCHES` is a contact with friction
along two directions (`rubbing`), that meets the ring's motion over the kick and a rotor that keeps its own.

Both bodies are round: an indentation d depends on the rotor's place x and on its axis A = (A_x, A_y, 1), in
the ring's axes, and on no spin. A touch's force is N times the gradient n of d over x, through a point p;
n times the velocity there of the rotor over the ring is then d'. With e the rotor's axis at an edge, and D
the way in which the rotor leans,

    bore   d = |e| - c                                     n = (e_x, e_y, -e A)/|e|    p = e + r n
    face   d = s (x A - R cos b D A) - gap |A| - l/2 (|A| - 1)
           s = 1 or -1, the side                           n = s A    p = R cos b D + s (d - l/2) (0, 0, 1)

n is square to the rotor's axis or along it, and lies in one plane with p and the ring's axis: N has no
moment about either axis, and no spin does work on it. The places of a face lie at the angles b from D.
Those at b and -b press alike, so that p may lie between them; they rub where they are. Damping resists the
lean and not a turn of its direction, as what did would have to go round with one of the bodies.

Tilts of the rotor may be larger than the ring's: exactly, its axis is a = (ry, -rx, a_z) and its angular
velocity (rx', ry', 0)/a_z + spin a. The moments on it are those that do work on these three, (M_x, M_y)/a_z
and M a.

All of that is solved together with the balls on the inner race: six equations for the ring's acceleration
A,

    (M + h sum J' G J) A = F - sum J' f        friction of a contact: f + G h J A
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

from ....modelkit.kernel import inlined, kernel
from ....modelkit.variables import array, real
from ... import seat
from ...contact.face import PLACES, has_face, nearer
from ...contact.friction import curve
from ...contact.laws import elastic_and_damping, elastic_energy
from ...contact.pair import damped_normal
from ...contact.passivity import middle_of, passive, settled_account
from ...rolling import ring
from ...seat import space
from .memory_layout import RTX, RTY, RVZ, RWX, RWY, RZ
from .races import Axes, BodyChange, Frame
from .rubbing import line_over

EDGES = 2
TOUCHES = EDGES + PLACES
SIX = 6


@dataclass(frozen=True)
class Touches:
    """Places at which the rotor touches the ring, in the ring's axes, at the last evaluation."""

    rx: tuple = array(TOUCHES)  # m, from the ring's centre
    ry: tuple = array(TOUCHES)
    rz: tuple = array(TOUCHES)
    px: tuple = array(TOUCHES)  # m, likewise, on the line of the normal force
    py: tuple = array(TOUCHES)
    pz: tuple = array(TOUCHES)
    nx: tuple = array(TOUCHES)  # from the rotor into the ring
    ny: tuple = array(TOUCHES)
    nz: tuple = array(TOUCHES)
    tx: tuple = array(TOUCHES)  # around the shaft
    ty: tuple = array(TOUCHES)
    tz: tuple = array(TOUCHES)
    indentation: tuple = array(TOUCHES)  # m; negative: the gap
    stiffness: tuple = array(TOUCHES)  # N/m
    normal: tuple = array(TOUCHES)  # N
    damped: tuple = array(TOUCHES)  # N
    stored: tuple = array(TOUCHES)  # J
    rate: tuple = array(TOUCHES)  # m/s
    middle: tuple = array(TOUCHES)  # m/s
    friction_t: tuple = array(TOUCHES)  # N, on the rotor
    friction_m: tuple = array(TOUCHES)
    along_t: tuple = array(TOUCHES)  # m/s, of the rotor over the ring
    along_m: tuple = array(TOUCHES)
    alone_t: tuple = array(TOUCHES)  # N, friction as the ring keeps its motion
    alone_m: tuple = array(TOUCHES)
    slope_tt: tuple = array(TOUCHES)  # N s/m
    slope_tm: tuple = array(TOUCHES)
    slope_mm: tuple = array(TOUCHES)
    lean_x: float = real(0.0, "1", "D, or its opposite where D jumped: accounts are of places")
    lean_y: float = real(0.0, "1", "the same across")


@dataclass(frozen=True)
class Six:
    """The ring's six equations."""

    matrix: tuple = array(SIX, SIX)
    right: tuple = array(SIX)  # then the solution


class ShaftInRing(NamedTuple):
    """The rotor at the seat, in the ring's axes: place and velocity relative to the ring, axis, spins.

    w1 to w3 are its angular velocity: the rates of its tilts, and the spin about its axis.
    """

    x: float  # m
    y: float
    z: float
    vx: float  # m/s
    vy: float
    vz: float
    ax: float  # of its axis; the third one is 1
    ay: float
    w1: float  # rad/s
    w2: float
    w3: float
    r1: float  # rad/s, of the ring
    r2: float
    r3: float


class OnShaft(NamedTuple):
    """Load of the ring on the rotor in fixed axes, and quantities to report."""

    fx: float  # N
    fy: float
    fz: float
    mx: float  # N m, about the seat, on the tilts
    my: float
    spin: float  # N m, about the rotor's own axis
    bore: float  # W, heat
    faces: float
    sliding: float  # W, normal force times sliding speed, in the bore


@kernel
def tilted_axes(rx, ry):
    """`Axes` of a body with these tilts (rad): the axis, and what a turn from z to it makes of x and y."""
    ax, ay = ry, -rx
    az = math.sqrt(1.0 - ax * ax - ay * ay)
    by = 1.0 / (1.0 + az)
    return Axes(1.0 - ax * ax * by, -ax * ay * by, -ax, -ax * ay * by, 1.0 - ay * ay * by, -ay, ax, ay, az)


@inlined
def into(a, x, y, z):
    """A vector in the `Axes` a."""
    return (
        a.e1x * x + a.e1y * y + a.e1z * z,
        a.e2x * x + a.e2y * y + a.e2z * z,
        a.e3x * x + a.e3y * y + a.e3z * z,
    )


@inlined
def out_of(a, x, y, z):
    """A vector in fixed axes that is (x, y, z) in the `Axes` a."""
    return (
        a.e1x * x + a.e2x * y + a.e3x * z,
        a.e1y * x + a.e2y * y + a.e3y * z,
        a.e1z * x + a.e2z * y + a.e3z * z,
    )


@kernel
def ring_frame(q, axes):
    """The ring's `Frame` in the state q."""
    vx, vy, vz = q[ring.RVX], q[ring.RVY], q[RVZ]
    return Frame(axes, q[ring.RX], q[ring.RY], q[RZ], vx, vy, vz, q[RWX], q[RWY], q[ring.RW])


@kernel
def housing_frame(q):
    """The housing's `Frame` in the state q; it does not tilt."""
    upright = Axes(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)
    vx, vy, vz = q[seat.HVX], q[seat.HVY], q[space.HVZ]
    return Frame(upright, q[seat.HX], q[seat.HY], q[space.HZ], vx, vy, vz, 0.0, 0.0, 0.0)


@kernel
def moved_by(a, axes, h):
    """`BodyChange`: what a kick of h (s) does to the ring with the derivative a of its state."""
    x, y, z = into(axes, h * a[ring.RVX], h * a[ring.RVY], h * a[RVZ])
    return BodyChange(x, y, z, h * a[RWX], h * a[RWY], h * a[ring.RW])


@inlined
def axis_of(q):
    """The rotor's axis, a unit vector in fixed axes."""
    rx, ry = q[space.JRX], q[space.JRY]
    return ry, -rx, math.sqrt(1.0 - rx * rx - ry * ry)


@inlined
def turning_of(ax, ay, az, wx, wy, spin):
    """Angular velocity (rad/s) in fixed axes of a rotor with an axis, rates of its tilts and a spin."""
    return wx / az + spin * ax, wy / az + spin * ay, spin * az


@kernel
def shaft_of(q, axes):
    """The `ShaftInRing` in the state q."""
    x, y, z = into(axes, q[seat.JX] - q[ring.RX], q[seat.JY] - q[ring.RY], q[space.JZ] - q[RZ])
    vx, vy, vz = into(axes, q[seat.JVX] - q[ring.RVX], q[seat.JVY] - q[ring.RVY], q[space.JVZ] - q[RVZ])
    gx, gy, gz = axis_of(q)
    ax, ay, az = into(axes, gx, gy, gz)
    w1, w2, w3 = into(axes, *turning_of(gx, gy, gz, q[space.JWX], q[space.JWY], q[seat.JW]))
    return ShaftInRing(x, y, z, vx, vy, vz, ax / az, ay / az, w1, w2, w3, q[RWX], q[RWY], q[ring.RW])


@kernel
def _find_edges(shaft, p, clearance, t):
    """Set where the journal touches the edges of the bore, wider by `clearance` (m). How many press.

    t: a record of `Touches`.
    """
    pressing = 0
    for k in range(EDGES):
        edge = (k - 0.5) * p.land
        ex, ey = shaft.x + (edge - shaft.z) * shaft.ax, shaft.y + (edge - shaft.z) * shaft.ay
        distance = math.sqrt(ex * ex + ey * ey)
        inverse = 1.0 / distance if distance > 0.0 else 0.0
        nx, ny, reach = ex * inverse, ey * inverse, distance + p.journal_radius
        nz = -(nx * shaft.ax + ny * shaft.ay)
        t.rx[k], t.ry[k], t.rz[k] = reach * nx, reach * ny, edge + p.journal_radius * nz
        t.px[k], t.py[k], t.pz[k] = t.rx[k], t.ry[k], t.rz[k]
        t.nx[k], t.ny[k], t.nz[k] = nx, ny, nz
        t.tx[k], t.ty[k], t.tz[k] = -ny, nx, 0.0
        t.indentation[k] = distance - clearance
        pressing += 1 if t.indentation[k] > 0.0 else 0
    return pressing


@kernel
def _lean(shaft, t):
    """Set where the rotor leans to; its slope that way, below 0 where it leans the opposite way."""
    slope = math.sqrt(shaft.ax * shaft.ax + shaft.ay * shaft.ay)
    if slope == 0.0:
        if t.lean_x == 0.0 and t.lean_y == 0.0:
            t.lean_x = 1.0
        return 0.0
    x, y = shaft.ax / slope, shaft.ay / slope
    way = 1.0 if x * t.lean_x + y * t.lean_y >= 0.0 else -1.0
    t.lean_x, t.lean_y = way * x, way * y
    return way * slope


@kernel
def _find_places(shaft, p, t):
    """Set where the rotor touches a face of the ring, or comes nearest to; as `_find_edges`."""
    shoulder, slope = p.shoulder, _lean(shaft, t)
    pressing, radius, half, dx, dy = 0, shoulder.radius, 0.5 * p.land, t.lean_x, t.lean_y
    middle = shaft.z + shaft.ax * shaft.x + shaft.ay * shaft.y
    longer = math.sqrt(1.0 + slope * slope) - 1.0
    for place in range(PLACES):
        k, angle = EDGES + place, 2.0 * math.pi * place / PLACES
        c, s = math.cos(angle), math.sin(angle)
        side, depth = nearer(middle - slope * radius * c, shoulder)
        depth -= longer * (half + (shoulder.gap_plus if side > 0.0 else shoulder.gap_minus))
        x, y = dx * c - dy * s, dx * s + dy * c
        t.rx[k], t.ry[k], t.rz[k] = radius * x, radius * y, -side * half
        t.px[k], t.py[k], t.pz[k] = radius * c * dx, radius * c * dy, side * (depth - half)
        t.nx[k], t.ny[k], t.nz[k] = side * shaft.ax, side * shaft.ay, side
        t.tx[k], t.ty[k], t.tz[k] = -y, x, shaft.ax * y - shaft.ay * x
        t.indentation[k] = depth
        pressing += 1 if t.indentation[k] > 0.0 else 0
    return pressing


@kernel
def _across(t, k):
    """m = n x t of touch k, in the ring's axes; t: a record of `Touches`."""
    nx, ny, nz, tx, ty, tz = t.nx[k], t.ny[k], t.nz[k], t.tx[k], t.ty[k], t.tz[k]
    return ny * tz - nz * ty, nz * tx - nx * tz, nx * ty - ny * tx


@inlined
def _rubs_at(t, k):
    """Where friction acts at touch k (m)."""
    return t.rx[k], t.ry[k], t.rz[k]


@inlined
def _presses_at(t, k):
    """A point on the line of its normal force (m)."""
    return t.px[k], t.py[k], t.pz[k]


@inlined
def _turning(point, x, y, z):
    """point x (x, y, z)."""
    return point[1] * z - point[2] * y, point[2] * x - point[0] * z, point[0] * y - point[1] * x


@inlined
def _ahead(point, x, y, z, moved):
    """By how much the ring's surface at a point runs ahead along (x, y, z) as the ring is `moved` (m/s)."""
    mx, my, mz = _turning(point, x, y, z)
    return moved.x * x + moved.y * y + moved.z * z + moved.w1 * mx + moved.w2 * my + moved.w3 * mz


@inlined
def _over(shaft, point):
    """Velocity of the rotor over the ring at a point, in the ring's axes (m/s)."""
    x, y, z = point[0] - shaft.x, point[1] - shaft.y, point[2] - shaft.z
    ux = shaft.vx + shaft.w2 * z - shaft.w3 * y - (shaft.r2 * point[2] - shaft.r3 * point[1])
    uy = shaft.vy + shaft.w3 * x - shaft.w1 * z - (shaft.r3 * point[0] - shaft.r1 * point[2])
    uz = shaft.vz + shaft.w1 * y - shaft.w2 * x - (shaft.r1 * point[1] - shaft.r2 * point[0])
    return ux, uy, uz


@kernel
def _press(k, shared, shaft, moved, law, beat, m):
    """Set speeds and normal force of touch k, one of `shared` alike, which shares a law, a record.

    moved: what the kick before did to the ring (`BodyChange`).
    """
    t, parts, foot = m.s.touches, EDGES if k < EDGES else PLACES, _presses_at(m.s.touches, k)
    ux, uy, uz = _over(shaft, _rubs_at(t, k))
    nx, ny, nz = t.nx[k], t.ny[k], t.nz[k]
    mx, my, mz = _across(t, k)
    t.along_t[k] = ux * t.tx[k] + uy * t.ty[k] + uz * t.tz[k]
    t.along_m[k] = ux * mx + uy * my + uz * mz
    ux, uy, uz = _over(shaft, foot)
    t.rate[k] = ux * nx + uy * ny + uz * nz
    depth = t.indentation[k]
    if depth <= 0.0:
        t.normal[k] = t.damped[k] = t.stiffness[k] = t.friction_t[k] = t.friction_m[k] = 0.0
        return
    elastic, damping = elastic_and_damping(depth, law)
    elastic, damping = elastic / parts, damping / parts
    t.stiffness[k] = law.exponent * elastic / depth
    answer = beat.kick * shared / m.p.ring.mass  # of all that press alike
    others = answer * t.normal[k] - _ahead(foot, nx, ny, nz, moved)
    scale = depth / (law.exponent + 1.0)
    elastic = passive(elastic, scale, t.stored[k], t.rate[k], others, answer, beat)
    t.normal[k] = damped_normal(elastic, damping, t.rate[k], answer, others)
    t.damped[k] = t.normal[k] - elastic


@kernel
def _add(six, h, row, column):
    """Add h J' B to the ring's matrix, J and B tuples of six."""
    for i in range(SIX):
        for j in range(SIX):
            six.matrix[i, j] += h * row[i] * column[j]


@kernel
def _push(six, fx, fy, fz, mx, my, mz):
    """Add a force (N) and a moment (N m), in the ring's axes, to the right-hand side."""
    r = six.right
    r[0], r[1], r[2], r[3], r[4], r[5] = r[0] + fx, r[1] + fy, r[2] + fz, r[3] + mx, r[4] + my, r[5] + mz


@kernel
def _rub(k, shared, moved, law, beat, m):
    """Draw the line of friction of touch k, and add the touch to the ring's equations; as `_press`."""
    t, six, h, n = m.s.touches, m.s.six, beat.kick, m.s.touches.normal[k]
    nx, ny, nz = t.nx[k] * n, t.ny[k] * n, t.nz[k] * n
    mx, my, mz = _turning(_presses_at(t, k), nx, ny, nz)
    _push(six, nx, ny, nz, mx, my, mz)
    point = _rubs_at(t, k)
    tx, ty, tz = t.tx[k], t.ty[k], t.tz[k]
    cx, cy, cz = _across(t, k)
    t1, t2, t3 = _turning(point, tx, ty, tz)
    c1, c2, c3 = _turning(point, cx, cy, cz)
    answer = shared * h * (1.0 / m.p.ring.mass + t3 * t3 / m.p.ring.inertia)
    driven_t = -_ahead(point, tx, ty, tz, moved) - answer * t.friction_t[k]
    driven_m = -_ahead(point, cx, cy, cz, moved) - answer * t.friction_m[k]
    line = line_over(
        (t.along_t[k], t.along_m[k]), (t.along_t[k] + driven_t, t.along_m[k] + driven_m), answer, n, law
    )
    t.alone_t[k], t.alone_m[k] = line.alone_t, line.alone_m
    t.slope_tt[k], t.slope_tm[k], t.slope_mm[k] = line.slope_tt, line.slope_tm, line.slope_mm
    a, b, c = line.slope_tt, line.slope_tm, line.slope_mm
    first = (
        a * tx + b * cx,
        a * ty + b * cy,
        a * tz + b * cz,
        a * t1 + b * c1,
        a * t2 + b * c2,
        a * t3 + b * c3,
    )
    other = (
        b * tx + c * cx,
        b * ty + c * cy,
        b * tz + c * cz,
        b * t1 + c * c1,
        b * t2 + c * c2,
        b * t3 + c * c3,
    )
    _add(six, h, (tx, ty, tz, t1, t2, t3), first)
    _add(six, h, (cx, cy, cz, c1, c2, c3), other)
    f, g = -line.alone_t, -line.alone_m
    _push(
        six,
        f * tx + g * cx,
        f * ty + g * cy,
        f * tz + g * cz,
        f * t1 + g * c1,
        f * t2 + g * c2,
        f * t3 + g * c3,
    )


@kernel
def meet_rotor(shaft, moved, beat, m):
    """Find what the rotor touches of the ring, and add it to the ring's equations in m.s.six.

    moved: what the kick before did to the ring (`BodyChange`).
    """
    t, d = m.s.touches, m.d
    law = curve(d.friction)
    pressing = _find_edges(shaft, m.p, m.s.gaps.clearance, t)
    for k in range(EDGES):
        _press(k, pressing, shaft, moved, d.contact, beat, m)
        if t.normal[k] > 0.0:
            _rub(k, pressing, moved, law, beat, m)
    if not has_face(m.p.shoulder):
        return
    pressing = _find_places(shaft, m.p, t)
    for k in range(EDGES, TOUCHES):
        _press(k, pressing, shaft, moved, m.p.shoulder, beat, m)
        if t.normal[k] > 0.0:
            _rub(k, pressing, moved, law, beat, m)


@kernel
def begin_six(q, h, m):
    """Start the ring's equations over a kick of h (s): masses, weight, gyroscopic terms."""
    p, six = m.p, m.s.six
    for i in range(SIX):
        for j in range(SIX):
            six.matrix[i, j] = 0.0
    a, across, gyro = six.matrix, m.d.transverse_inertia, p.ring.inertia * q[ring.RW]
    a[0, 0] = a[1, 1] = a[2, 2] = p.ring.mass
    a[3, 3] = a[4, 4] = across
    a[5, 5] = p.ring.inertia
    a[3, 4], a[4, 3] = 0.5 * h * gyro, -0.5 * h * gyro
    axes = tilted_axes(q[RTX], q[RTY])
    six.right[0], six.right[1], six.right[2] = into(
        axes, 0.0, -p.ring.mass * m.d.gravity, p.ring.mass * m.d.gravity_z
    )
    six.right[3], six.right[4], six.right[5] = -gyro * q[RWY], gyro * q[RWX], 0.0


@kernel
def solve_six(six):
    """Solve the ring's equations in place; the solution, an acceleration in its axes, is in `right`.

    The matrix is positive definite but for what is skew, and needs no pivots.
    """
    a, b = six.matrix, six.right
    for i in range(SIX):
        inverse = 1.0 / a[i, i]
        for r in range(i + 1, SIX):
            f = a[r, i] * inverse
            for c in range(i + 1, SIX):
                a[r, c] -= f * a[i, c]
            b[r] -= f * b[i]
    for i in range(SIX - 1, -1, -1):
        s = b[i]
        for c in range(i + 1, SIX):
            s -= a[i, c] * b[c]
        b[i] = s / a[i, i]


@kernel
def accelerate_ring(q, dq, axes, m):
    """Set the ring's derivatives in dq by its acceleration in m.s.six."""
    a = m.s.six.right
    dq[ring.RX], dq[ring.RY], dq[RZ] = q[ring.RVX], q[ring.RVY], q[RVZ]
    dq[ring.RVX], dq[ring.RVY], dq[RVZ] = out_of(axes, a[0], a[1], a[2])
    dq[RTX], dq[RTY], dq[ring.RANGLE] = q[RWX], q[RWY], q[ring.RW]
    dq[RWX], dq[RWY], dq[ring.RW] = a[3], a[4], a[5]


@inlined
def _from(middle, point):
    """`point` as seen from the `middle` (m)."""
    return point[0] - middle[0], point[1] - middle[1], point[2] - middle[2]


@kernel
def leave_rotor(shaft, axes, moved, q, m):
    """Friction, heat and rates where the rotor touches, and what it gets (`OnShaft`) in the state q.

    moved: what the kick does to the ring (`BodyChange`).
    """
    t = m.s.touches
    fx, fy, fz, mx, my, mz = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    bx, by, bz, b1, b2, b3 = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    bore, faces, sliding = 0.0, 0.0, 0.0
    middle = shaft.x, shaft.y, shaft.z
    for k in range(TOUCHES if has_face(m.p.shoulder) else EDGES):
        nx, ny, nz, point, foot = t.nx[k], t.ny[k], t.nz[k], _rubs_at(t, k), _presses_at(t, k)
        opening = _ahead(foot, nx, ny, nz, moved)
        t.middle[k] = t.rate[k] - 0.5 * opening
        if t.normal[k] <= 0.0:
            continue
        tx, ty, tz = t.tx[k], t.ty[k], t.tz[k]
        cx, cy, cz = _across(t, k)
        ahead_t = _ahead(point, tx, ty, tz, moved)
        ahead_m = _ahead(point, cx, cy, cz, moved)
        f = t.alone_t[k] + t.slope_tt[k] * ahead_t + t.slope_tm[k] * ahead_m
        g = t.alone_m[k] + t.slope_tm[k] * ahead_t + t.slope_mm[k] * ahead_m
        t.friction_t[k], t.friction_m[k] = f, g
        slid_t, slid_m = t.along_t[k] - 0.5 * ahead_t, t.along_m[k] - 0.5 * ahead_m
        loss = t.damped[k] * t.middle[k] - f * slid_t - g * slid_m
        # on the rotor: friction, and what a newton of the normal force does
        hx, hy, hz = f * tx + g * cx, f * ty + g * cy, f * tz + g * cz
        h1, h2, h3 = _turning(_from(middle, point), hx, hy, hz)
        n1, n2, n3 = _turning(_from(middle, foot), -nx, -ny, -nz)
        n, d = t.normal[k], t.damped[k]
        fx, fy, fz = fx + hx - n * nx, fy + hy - n * ny, fz + hz - n * nz
        mx, my, mz = mx + h1 + n * n1, my + h2 + n * n2, mz + h3 + n * n3
        bx, by, bz = bx + hx - d * nx, by + hy - d * ny, bz + hz - d * nz
        b1, b2, b3 = b1 + h1 + d * n1, b2 + h2 + d * n2, b3 + h3 + d * n3
        if k < EDGES:
            bore += loss
            sliding += t.normal[k] * math.sqrt(slid_t * slid_t + slid_m * slid_m)
        else:
            faces += loss
    b = m.s.brake
    b.jx, b.jy, b.jz = out_of(axes, bx, by, bz)
    ax, ay, az = axis_of(q)
    b1, b2, b3 = out_of(axes, b1, b2, b3)
    b.jmx, b.jmy, b.jm = b1 / az, b2 / az, ax * b1 + ay * b2 + az * b3
    fx, fy, fz = out_of(axes, fx, fy, fz)
    mx, my, mz = out_of(axes, mx, my, mz)
    _note(m)
    return OnShaft(fx, fy, fz, mx / az, my / az, ax * mx + ay * my + az * mz, bore, faces, sliding)


@kernel
def _note(m):
    """Keep what peaks and first contacts are found from: the bore as one, and the face."""
    t, bore, face = m.s.touches, m.s.ring, m.s.shoulder
    deeper = 0 if t.indentation[0] >= t.indentation[1] else 1
    bore.normal, bore.indentation, bore.rate = (
        t.normal[0] + t.normal[1],
        t.indentation[deeper],
        t.rate[deeper],
    )
    if has_face(m.p.shoulder):
        normal, depth, rate = 0.0, -math.inf, 0.0
        for k in range(EDGES, TOUCHES):
            normal += t.normal[k]
            if t.indentation[k] > depth:
                depth, rate = t.indentation[k], t.rate[k]
        face.normal, face.indentation, face.rate = normal, depth, rate


@kernel
def settle_touches(q, kick, off, axes, m):
    """Settle the accounts of the rotor's contacts after a `kick` (s); returns what they withheld (J).

    off: by how much the rotor was faster in its middle than forces were found for (`Missed`).
    """
    t, withheld, part = m.s.touches, 0.0, off.part
    seat_x, seat_y, seat_z = into(
        axes, q[seat.JX] - q[ring.RX], q[seat.JY] - q[ring.RY], q[space.JZ] - q[RZ]
    )
    vx, vy, vz = into(axes, off.jx, off.jy, off.jz)
    w1, w2, w3 = into(axes, *turning_of(*axis_of(q), off.jwx, off.jwy, off.jw))
    for k in range(TOUCHES if has_face(m.p.shoulder) else EDGES):
        if t.indentation[k] <= 0.0 and t.stored[k] <= 0.0:
            continue
        x, y, z = t.px[k] - seat_x, t.py[k] - seat_y, t.pz[k] - seat_z
        closing = middle_of(t.rate[k], t.middle[k], part) + (vx + w2 * z - w3 * y) * t.nx[k]
        closing += (vy + w3 * x - w1 * z) * t.ny[k] + (vz + w1 * y - w2 * x) * t.nz[k]
        taken = kick * (t.normal[k] - t.damped[k]) * closing
        t.stored[k], lost = settled_account(t.stored[k], t.indentation[k], taken)
        withheld += lost
    return withheld


@kernel
def fill_touches(m):
    """Have the accounts of the rotor's contacts hold what their laws have stored."""
    t = m.s.touches
    for k in range(TOUCHES if has_face(m.p.shoulder) else EDGES):
        t.stored[k] = energy_of(t, k, m)


@kernel
def energy_of(t, k, m):
    """Energy (J) that touch k has stored by its law."""
    if k < EDGES:
        return elastic_energy(t.indentation[k], m.d.contact) / EDGES
    return elastic_energy(t.indentation[k], m.p.shoulder) / PLACES


@kernel
def stored_in_touches(m):
    """Energy (J) of all contacts of the rotor by their laws."""
    energy = 0.0
    for k in range(TOUCHES if has_face(m.p.shoulder) else EDGES):
        energy += energy_of(m.s.touches, k, m)
    return energy


@kernel
def stiffness_below(m):
    """Stiffness (N/m, N m) of all contacts of the rotor with the ring against its motion and its tilt.

    As they were at the last evaluation.
    """
    t, below, turning = m.s.touches, 0.0, 0.0
    for k in range(TOUCHES if has_face(m.p.shoulder) else EDGES):
        first, second, _ = _turning(_presses_at(t, k), t.nx[k], t.ny[k], t.nz[k])
        below += t.stiffness[k]
        turning += t.stiffness[k] * (first * first + second * second)
    return below, turning


@inlined
def drift(trial, q, mid, h):
    """The ring's place in the state `trial`: that in q and h (s) times its velocity in `mid`."""
    ring.drift(trial, q, mid, h)
    trial[RZ] = q[RZ] + h * mid[RVZ]
    trial[RTX] = q[RTX] + h * mid[RWX]
    trial[RTY] = q[RTY] + h * mid[RWY]
