"""The cages of a bearing in space: one a row, each a rigid body that the balls in its pockets guide.

A cage has a place, a velocity, two tilts, an angle and three spins, in axes that tilt with it and do not
turn (`space_ring`, whose equations it has, too). Here tilts may be larger, and so their rates are exact:
with the axis a = (ry, -rx, a_z),

    a' = w_2 e_1 - w_1 e_2

while these axes turn about a by (a_y a_x' - a_x a_y')/(1 + a_z), not a part of the cage's own angle.

A pocket is a sphere around a point that is fixed in the cage, on its pitch circle, wider than its ball by
the clearance on radius; in the plane that is the circle of `bearings.rolling.cage`. Where a ball's centre
is off the pocket's by more than the clearance along n, it presses, at the arm R from the cage's centre, and
rubs along t and m = n x t. Each contact is one alone (`bearings.contact.pair`): what others do in the kick
is taken from the kick before. Its answers to its own forces are those of ball and cage together, to
friction along the direction in which it slides.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

from ....modelkit.kernel import inlined, kernel
from ....modelkit.numerics import squared
from ....modelkit.variables import array, real
from ... import seat
from ...contact.friction import curve
from ...contact.pair import ContactPlace, Kick, normal_over
from ...rolling.ball_contacts import lay, note_apart
from ...rolling.ball_set import MAX_BALLS
from ...rolling.cage import CageBody, CageReport, inertia_of, set_pockets
from ...rolling.micro_step import beat_of
from ...seat import space
from .memory_layout import CAGE_SIZE, FIRST_BALL, SIZE, WX, WY, WZ
from .neighbours import SpaceSides
from .rubbing import lone_friction
from .space_parts import row_ball_mass, rows_as_one
from .space_ring import into, out_of, tilted_axes

# place, velocity, tilts about x and y, angle about its axis, and spins in its axes
X, Y, Z, VX, VY, VZ, RX, RY, ANGLE, W1, W2, SPIN = range(CAGE_SIZE)
SLENDER = (
    "cage.transverse_inertia = {0:g} kg.m2 is below {1:g} kg.m2, half of that about the axis, as no body "
    "is; give more, or 0 for that half"
)
STEEP = 0.9  # of n along the shaft, above which t is square to another axis


@dataclass(frozen=True)
class SpaceCageBody(CageBody):
    """Cage of all rows together; in a pair each row has half of it."""

    transverse_inertia: float = real(
        0.0, "kg.m2", "its moment of inertia about a diameter; 0: half of inertia", minimum=0.0
    )


@dataclass(frozen=True)
class SpaceCageReport(CageReport):
    """Motion of a row's cage."""

    z: float = real(0.0, "m", "position along the shaft", local=True)
    vz: float = real(0.0, "m/s", "velocity along the shaft", local=True)
    rx: float = real(0.0, "rad", "tilt about x", local=True)
    ry: float = real(0.0, "rad", "tilt about y", local=True)


@dataclass(frozen=True)
class CageConstants:
    """Constants of the cage of a row that follow from the parameters."""

    mass: float = real(0.0, "kg", "of a cage")
    inertia: float = real(0.0, "kg.m2", "of a cage about its axis")
    transverse_inertia: float = real(0.0, "kg.m2", "of a cage about a diameter")
    pocket_x: tuple = array(MAX_BALLS)  # m, from the cage's centre, at the start
    pocket_y: tuple = array(MAX_BALLS)


@dataclass(frozen=True)
class PocketSides(SpaceSides):
    """Contact of each ball of a row with its pocket; friction is that on the ball."""

    arm_x: tuple = array(MAX_BALLS)  # m, R
    arm_y: tuple = array(MAX_BALLS)
    arm_z: tuple = array(MAX_BALLS)


@inlined
def cage_at(row, m):
    """Index at which the state of a row's cage starts."""
    return FIRST_BALL + SIZE * m.d.balls + CAGE_SIZE * row


@kernel
def derive(m):
    """Set in m.d.cage what parameters fix but pockets; returns the lighter one of ball and cage (kg)."""
    p, c = m.p, m.d.cage
    c.mass = p.cage.mass * rows_as_one(p) / p.balls.rows
    c.inertia = inertia_of(p, c.mass)
    transverse = p.cage.transverse_inertia * rows_as_one(p) / p.balls.rows
    c.transverse_inertia = transverse if transverse > 0.0 else 0.5 * c.inertia
    return min(row_ball_mass(p), c.mass)


@kernel
def derive_pockets(m):
    """Set in m.d.cage where pockets are: on the pitch circle, with a contact angle where balls start."""
    d, b = m.d, m.p.balls
    angular = b.contact_angle > 0.0  # preload has balls start beside the pitch circle
    radius = math.sqrt(d.x[0] * d.x[0] + d.y[0] * d.y[0]) if angular else 0.5 * b.pitch_diameter
    set_pockets(d.cage, b, radius)


@kernel
def place_cages(q, m):
    """Put the cages in the state q at rest, in the middle of their rows."""
    for row in range(m.d.rows):
        i = cage_at(row, m)
        for k in range(CAGE_SIZE):
            q[i + k] = 0.0
        q[i + X], q[i + Y], q[i + Z] = q[seat.HX], q[seat.HY], q[space.HZ] + m.d.z[row * m.p.balls.count]
        q[i + VX], q[i + VY], q[i + VZ] = q[seat.HVX], q[seat.HVY], q[space.HVZ]


class Moving(NamedTuple):
    """A cage's motion, or its acceleration, in fixed axes."""

    vx: float  # m/s
    vy: float
    vz: float
    wx: float  # rad/s
    wy: float
    wz: float


@kernel
def _moving(q, i, axes):
    """`Moving` by the state q, or its derivative, of the cage whose components start at i."""
    wx, wy, wz = out_of(axes, q[i + W1], q[i + W2], q[i + SPIN])
    return Moving(q[i + VX], q[i + VY], q[i + VZ], wx, wy, wz)


@kernel
def meet_pockets(q, dq, m):
    """All balls against their pockets: adds to their accelerations in m.s.balls, sets the cages' in dq."""
    for row in range(m.d.rows):
        i, side = cage_at(row, m), m.s.side[row]
        axes = tilted_axes(q[i + RX], q[i + RY])
        _find(side, q, i, row, axes, m)
        if side.touching > 0:
            _rub(side, row, m)
        _accelerate(side, q, dq, i, axes, m)


@kernel
def _find(c, q, i, row, axes, m):
    """Balls of a `row` that press their pockets, how hard, and what their friction depends on, in c.

    i: where the cage's state starts; c: `PocketSides`.
    """
    s, d, clearance, count = m.s.balls, m.d, m.p.cage.clearance, m.p.balls.count
    cosine, sine = math.cos(q[i + ANGLE]), math.sin(q[i + ANGLE])
    moving, before = _moving(q, i, axes), _moving(m.s.before, i, axes)
    c.touching = 0
    for b in range(count):
        k, px, py = row * count + b, d.cage.pocket_x[b], d.cage.pocket_y[b]
        rx, ry, rz = out_of(axes, cosine * px - sine * py, sine * px + cosine * py, 0.0)
        ex, ey, ez = s.x[k] - (q[i + X] + rx), s.y[k] - (q[i + Y] + ry), s.z[k] - (q[i + Z] + rz)
        distance = math.sqrt(ex * ex + ey * ey + ez * ez)
        if distance <= clearance:
            note_apart(c, b)
            c.tangential_m[b] = 0.0
            continue
        last = _friction(c, b) if c.indentation[b] > 0.0 else (0.0, 0.0, 0.0)
        n, reach = (ex / distance, ey / distance, ez / distance), distance + d.ball_radius
        c.arm_x[b], c.arm_y[b], c.arm_z[b] = rx + reach * n[0], ry + reach * n[1], rz + reach * n[2]
        place = ContactPlace(n[0], n[1], distance - clearance, d.ball_radius, reach, 0.0)
        c.nz[b] = n[2]
        _press(c, b, k, n, place, (moving, before), last, axes, m)


@kernel
def _friction(c, b):
    """Friction (N) on the ball at contact b, in fixed axes."""
    tx, ty, tz, mx, my, mz = _tangents(c.nx[b], c.ny[b], c.nz[b])
    f, g = c.tangential[b], c.tangential_m[b]
    return f * tx + g * mx, f * ty + g * my, f * tz + g * mz


@kernel
def _tangents(nx, ny, nz):
    """t and m, square to n and to each other; in the plane t is that of `bearings.contact.pair`."""
    if abs(nz) < STEEP:
        by = 1.0 / math.sqrt(nx * nx + ny * ny)
        tx, ty, tz = -ny * by, nx * by, 0.0
    else:
        by = 1.0 / math.sqrt(ny * ny + nz * nz)
        tx, ty, tz = 0.0, -nz * by, ny * by
    return tx, ty, tz, ny * tz - nz * ty, nz * tx - nx * tz, nx * ty - ny * tx


@kernel
def _relative(c, b, n, radius, v, w, cage):
    """Rate of the indentation and sliding along t and m (m/s) of a ball at contact b over its pocket.

    n: direction; v, w: velocity and spin of the ball; cage: `Moving`; or accelerations of both.
    """
    tx, ty, tz, mx, my, mz = _tangents(n[0], n[1], n[2])
    ux = v[0] - cage.vx - (cage.wy * c.arm_z[b] - cage.wz * c.arm_y[b])
    uy = v[1] - cage.vy - (cage.wz * c.arm_x[b] - cage.wx * c.arm_z[b])
    uz = v[2] - cage.vz - (cage.wx * c.arm_y[b] - cage.wy * c.arm_x[b])
    along_t = ux * tx + uy * ty + uz * tz + radius * (w[0] * mx + w[1] * my + w[2] * mz)
    along_m = ux * mx + uy * my + uz * mz - radius * (w[0] * tx + w[1] * ty + w[2] * tz)
    return ux * n[0] + uy * n[1] + uz * n[2], along_t, along_m


@kernel
def _answer(c, b, axes, x, y, z, d):
    """How the cage's surface at contact b answers along (x, y, z) to a force there (1/kg)."""
    kx, ky = c.arm_y[b] * z - c.arm_z[b] * y, c.arm_z[b] * x - c.arm_x[b] * z
    k1, k2, k3 = into(axes, kx, ky, c.arm_x[b] * y - c.arm_y[b] * x)
    return 1.0 / d.cage.mass + (k1 * k1 + k2 * k2) / d.cage.transverse_inertia + k3 * k3 / d.cage.inertia


@kernel
def _press(c, b, k, n, place, cage, last, axes, m):
    """Set in c what presses ball k at contact b, along n at a `ContactPlace`, and its sliding over a kick.

    cage: its motion and its acceleration in the kick before; last: friction then (N).
    """
    s, d, law, beat, balls = m.s.balls, m.d, m.d.side_contact, beat_of(m), m.d.balls
    h, first = beat.kick, FIRST_BALL + k
    v, w = (s.vx[k], s.vy[k], s.vz[k]), (s.wx[k], s.wy[k], s.wz[k])
    rate, sliding_t, sliding_m = _relative(c, b, n, d.ball_radius, v, w, cage[0])
    v = s.bx[k], s.by[k], s.bz[k]
    a = m.s.before
    w = a[first + WX * balls], a[first + WY * balls], a[first + WZ * balls]
    faster, driven_t, driven_m = _relative(c, b, n, d.ball_radius, v, w, cage[1])
    tx, ty, tz, mx, my, mz = _tangents(n[0], n[1], n[2])
    to_t, to_m = sliding_t + h * driven_t, sliding_m + h * driven_m
    size = math.sqrt(to_t * to_t + to_m * to_m)
    to_t, to_m = (to_t / size, to_m / size) if size > 0.0 else (1.0, 0.0)
    x, y, z = to_t * tx + to_m * mx, to_t * ty + to_m * my, to_t * tz + to_m * mz
    of_ball = 1.0 / d.mass + d.ball_radius * d.ball_radius / d.inertia
    across = h * (of_ball + _answer(c, b, axes, x, y, z, d))
    along = h * (1.0 / d.mass + _answer(c, b, axes, n[0], n[1], n[2], d))
    by_t = h * driven_t - across * (last[0] * tx + last[1] * ty + last[2] * tz)
    c.driven_m[b] = h * driven_m - across * (last[0] * mx + last[1] * my + last[2] * mz)
    kick = Kick(beat, across, along, by_t, h * faster + along * c.normal[b])
    c.normal[b], c.damped[b] = normal_over(place.indentation, rate, law, kick, c.stored[b])
    c.sliding_m[b] = sliding_m
    lay(c, b, place, sliding_t, rate, kick, law)


@kernel
def _rub(c, row, m):
    """Friction of contacts c that touch, and the accelerations of the balls by all their forces."""
    s, law, radius = m.s.balls, curve(m.d.side_friction), m.d.ball_radius
    by_mass, by_inertia = 1.0 / m.d.mass, radius / m.d.inertia
    for b in range(m.p.balls.count):
        if c.indentation[b] <= 0.0:
            continue
        k, n = row * m.p.balls.count + b, c.normal[b]
        sliding, driven = (c.sliding[b], c.sliding_m[b]), (c.driven[b], c.driven_m[b])
        f, g = lone_friction(sliding, driven, c.across[b], n, law)
        c.tangential[b], c.tangential_m[b] = f, g
        c.highest[b] = max(n, m.d.side_contact.viscous * c.rate[b])
        x, y, z = _force(c, b)
        s.ax[k], s.ay[k], s.az[k] = s.ax[k] + x * by_mass, s.ay[k] + y * by_mass, s.az[k] + z * by_mass
        tx, ty, tz, mx, my, mz = _tangents(c.nx[b], c.ny[b], c.nz[b])
        s.px[k] += by_inertia * (f * mx - g * tx)
        s.py[k] += by_inertia * (f * my - g * ty)
        s.pz[k] += by_inertia * (f * mz - g * tz)


@kernel
def _force(c, b):
    """Force (N) on the ball at contact b."""
    x, y, z = _friction(c, b)
    n = c.normal[b]
    return x - n * c.nx[b], y - n * c.ny[b], z - n * c.nz[b]


@kernel
def _accelerate(c, q, dq, i, axes, m):
    """Set the part of dq of the cage whose components start at i, by its contacts c and its weight.

    Gyroscopic terms take the mean of both spins across over the kick, and do no work.
    """
    d = m.d.cage
    fx, fy, fz, mx, my, mz = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for b in range(m.p.balls.count):
        if c.indentation[b] > 0.0:
            x, y, z = _force(c, b)
            fx, fy, fz = fx - x, fy - y, fz - z
            mx -= c.arm_y[b] * z - c.arm_z[b] * y
            my -= c.arm_z[b] * x - c.arm_x[b] * z
            mz -= c.arm_x[b] * y - c.arm_y[b] * x
    m1, m2, m3 = into(axes, mx, my, mz)
    by_x, by_y, about = _turning(axes, q[i + W1], q[i + W2])
    gyro = d.inertia * q[i + SPIN] - d.transverse_inertia * about
    half, across = 0.5 * m.s.kick * gyro, d.transverse_inertia
    m1, m2 = m1 - gyro * q[i + W2], m2 + gyro * q[i + W1]
    by = 1.0 / (across * across + half * half)
    dq[i + X], dq[i + Y], dq[i + Z] = q[i + VX], q[i + VY], q[i + VZ]
    dq[i + RX], dq[i + RY], dq[i + ANGLE] = by_x, by_y, q[i + SPIN] - about
    dq[i + VX], dq[i + VY] = fx / d.mass, fy / d.mass - m.d.gravity
    dq[i + VZ] = fz / d.mass + m.d.gravity_z
    dq[i + W1], dq[i + W2] = (across * m1 - half * m2) * by, (across * m2 + half * m1) * by
    dq[i + SPIN] = m3 / d.inertia


@kernel
def _turning(a, w1, w2):
    """Rates (rad/s) of the tilts about x and y of the `Axes` a, and how fast these turn about their own."""
    ax, ay = w2 * a.e1x - w1 * a.e2x, w2 * a.e1y - w1 * a.e2y  # of the axis
    return -ay, ax, (a.e3y * ax - a.e3x * ay) / (1.0 + a.e3z)


@kernel
def drift(trial, q, mid, h, m):
    """The cages' places in the state `trial`: those in q and h (s) times the velocities in `mid`.

    How tilts follow spins depends on the tilts: on those in the middle.
    """
    for row in range(m.d.rows):
        i = cage_at(row, m)
        for k in (X, Y, Z):
            trial[i + k] = q[i + k] + h * mid[i + VX + k]
        w1, w2 = mid[i + W1], mid[i + W2]
        by_x, by_y, _ = _turning(tilted_axes(q[i + RX], q[i + RY]), w1, w2)
        middle = tilted_axes(q[i + RX] + 0.5 * h * by_x, q[i + RY] + 0.5 * h * by_y)
        by_x, by_y, about = _turning(middle, w1, w2)
        trial[i + RX], trial[i + RY] = q[i + RX] + h * by_x, q[i + RY] + h * by_y
        trial[i + ANGLE] = q[i + ANGLE] + h * (mid[i + SPIN] - about)


@kernel
def cages_heat(q, dq, m):
    """Heat (W) of all pockets over the kick whose accelerations are in dq and in m.s.balls."""
    s, loss, count, h = m.s.balls, 0.0, m.p.balls.count, m.s.kick
    for row in range(m.d.rows):
        c, i = m.s.side[row], cage_at(row, m)
        if c.touching == 0:
            continue
        faster = _moving(dq, i, tilted_axes(q[i + RX], q[i + RY]))
        for b in range(count):
            if c.indentation[b] <= 0.0:
                continue
            k, n = row * count + b, (c.nx[b], c.ny[b], c.nz[b])
            v, w = (s.ax[k], s.ay[k], s.az[k]), (s.px[k], s.py[k], s.pz[k])
            rate, slid_t, slid_m = _relative(c, b, n, m.d.ball_radius, v, w, faster)
            c.middle[b] = c.rate[b] + 0.5 * h * rate
            loss += c.damped[b] * c.middle[b]
            loss -= c.tangential[b] * (c.sliding[b] + 0.5 * h * slid_t)
            loss -= c.tangential_m[b] * (c.sliding_m[b] + 0.5 * h * slid_m)
    return loss


@kernel
def cage_frequency_squared(m):
    """Squared frequency (rad2/s2) of the fastest cage on its balls, at the last evaluation."""
    d, square = m.d.cage, 0.0
    lever = d.pocket_x[0] * d.pocket_x[0] + d.pocket_y[0] * d.pocket_y[0]  # m2
    for row in range(m.d.rows):
        c, total = m.s.side[row], 0.0
        for b in range(m.p.balls.count):
            along = c.nz[b] * c.nz[b]
            turning = (1.0 - along) / d.inertia + along / d.transverse_inertia
            total += c.stiffness[b] * (1.0 / d.mass + lever * turning)
        square = max(square, total)
    return square


@kernel
def _tell(o, q, i, m):
    """Set the outputs o of the cage whose components start at i; returns its energies (J) as `report`."""
    d = m.d.cage
    o.x, o.y, o.z, o.vx, o.vy, o.vz = q[i + X], q[i + Y], q[i + Z], q[i + VX], q[i + VY], q[i + VZ]
    o.rx, o.ry, o.omega = q[i + RX], q[i + RY], q[i + SPIN]
    kinetic = 0.5 * d.mass * (squared(o.vx) + squared(o.vy) + squared(o.vz)) + 0.5 * d.inertia * squared(
        o.omega
    )
    kinetic += 0.5 * d.transverse_inertia * (squared(q[i + W1]) + squared(q[i + W2]))
    return kinetic, d.mass * (m.d.gravity * o.y - m.d.gravity_z * o.z)


@kernel
def report(q, m):
    """Outputs of the cages from the state q; returns their kinetic and their potential energy (J)."""
    kinetic, potential = _tell(m.o.cage, q, cage_at(0, m), m)
    m.o.speed.cage = m.o.cage.omega * 0.5 * m.p.balls.pitch_diameter
    if m.d.rows > 1:
        also, higher = _tell(m.o.second_cage, q, cage_at(1, m), m)
        kinetic, potential = kinetic + also, potential + higher
    return kinetic, potential


@kernel
def set_weights(m):
    """Set the error weights of the cages' components, behind the m.n others, and count them.

    Angles matter where the pockets are.
    """
    w, lever = m.weight, 0.5 * m.p.balls.pitch_diameter
    for row in range(m.d.rows):
        i = cage_at(row, m)
        w[i + X] = w[i + Y] = w[i + Z] = 1.0 / seat.POSITION_SCALE
        w[i + VX] = w[i + VY] = w[i + VZ] = 1.0 / seat.VELOCITY_SCALE
        w[i + RX] = w[i + RY] = w[i + ANGLE] = lever / seat.POSITION_SCALE
        w[i + W1] = w[i + W2] = w[i + SPIN] = 1.0 / seat.SPIN_SCALE
    m.n += m.d.rows * CAGE_SIZE
