"""A row of balls between two grooves in space.

The centres of a groove's arcs lie on a circle: that of the inner race is fixed in the inner ring, that of
the outer race in the housing. Where ball and races just touch, both circles are

    A = (f_i + f_o - 1) D          f: groove radius over ball diameter D

apart at every ball. With the free contact angle a0, and s = +1 where a shaft pushed in +z loads the row,
else -1,

    R_i = d_m/2 + (f_i - 1/2) D cos a0          R_o = d_m/2 - (f_o - 1/2) D cos a0          their radii
    Z_i = z + s ((f_i - 1/2) D sin a0 + p)      Z_o = z - s (f_o - 1/2) D sin a0            along the shaft

with the row at z from the ring's centre and p the approach by preload. A row without a contact angle is a
deep groove: s = 0, and its radial play takes the circles together by as much.

A ball has no inertia across its orbit here: both of its contacts are one spring in series on the line
between the groove centres at its angle. A shift (x, y, z) and a tilt (rx, ry) of the inner ring move that
of the inner race, to first order, by

    outwards    x cos + y sin + Z_i (ry cos - rx sin)
    along       z + R_i (rx sin - ry cos)

Loads are the slopes of the springs' energy, which is convex in the ring's pose.

A row has one shoulder: it is open to the side -s, where a shaft pushed that way leaves it. The springs know
nothing of that; `arrangement.status_on_row` stops a bearing that comes off.

Harris, Kotzalas, Rolling Bearing Analysis, 5th ed., volume 1, chapter 7, and volume 2, chapter 1; de Mul,
Vree, Maas, Journal of Tribology 111 (1989) 142 (five coordinates of the ring). ISO/TS 16281 takes half the
pitch diameter for the lever R_i of a tilt.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

from ...modelkit.kernel import inlined, kernel
from ...modelkit.variables import Choices, real
from ..contact.laws import in_series, race_contact_stiffness
from ..contact.materials import effective_modulus, elastic_of

SINGLE, BACK_TO_BACK, FACE_TO_FACE, TANDEM, SINGLE_REVERSED, TANDEM_REVERSED = range(6)
ARRANGEMENTS = Choices(
    "Arrangement",
    ("single", "back to back", "face to face", "tandem", "single reversed", "tandem reversed"),
    (
        "a row; with a contact angle it carries a shaft pushed in +z, and is open towards -z",
        "a pair whose contact lines meet far apart on the shaft: stiff against tilt",
        "a pair whose contact lines meet close to each other",
        "a pair that shares a thrust in +z, and is open towards -z",
        "a row the other way round: it carries a shaft pushed in -z, and is open towards +z",
        "a pair that shares a thrust in -z, and is open towards +z",
    ),
)
SINGLES = SINGLE, SINGLE_REVERSED  # one row, or several side by side as one
CLAMPED = BACK_TO_BACK, FACE_TO_FACE  # pairs whose rows hold each other: open to neither side
NEWTON_STEPS = 60  # of the search for a contact angle; ten are enough
ROUNDING = 1e-15  # rad
HALVINGS = 100  # of the interval for it, where rings give
# Of balls that roll along the shaft between a ring that moves and one that stays: they go at half its rate,
# and turn. Of their mass that is a quarter, with their spin a tenth more; of their weight it is a half.
ROLLED_MASS = 0.25 + 0.1
ROLLED_WEIGHT = 0.5


class BallRow(NamedTuple):
    """Lengths in m, along the shaft from the ring's centre."""

    inner: float  # R_i
    outer: float  # R_o
    inner_at: float  # Z_i
    outer_at: float  # Z_o
    free: float  # A
    stiffness: float  # N/m^1.5, of both contacts of a ball in series
    lever: float  # at which a tilt moves the inner groove along: R_i
    inner_free: float  # of the inner contact's part of A
    inner_stiffness: float  # N/m^1.5, of a ball on the inner race
    outer_stiffness: float  # likewise on the outer race


@dataclass(frozen=True)
class RowConstants:
    """A `BallRow` in a model's memory."""

    inner: float = real(0.0, "m", "radius of the circle of the inner groove's centres")
    outer: float = real(0.0, "m", "the same of the outer groove")
    inner_at: float = real(0.0, "m", "that circle along the shaft")
    outer_at: float = real(0.0, "m", "the same of the outer groove")
    free: float = real(0.0, "m", "distance of the circles where a ball just touches")
    stiffness: float = real(0.0, "N/m^1.5", "of both contacts of a ball in series")
    lever: float = real(0.0, "m", "at which a tilt moves the inner groove along")
    inner_free: float = real(0.0, "m", "distance of ball and inner groove's centre where they just touch")
    inner_stiffness: float = real(0.0, "N/m^1.5", "of a ball on the inner race")
    outer_stiffness: float = real(0.0, "N/m^1.5", "of a ball on the outer race")


@kernel
def keep_row(kept, row, abreast):
    """Put a `BallRow` into `kept`, a record of `RowConstants`, its balls for those of `abreast` rows."""
    kept.inner, kept.outer, kept.inner_at, kept.outer_at = row.inner, row.outer, row.inner_at, row.outer_at
    kept.free, kept.inner_free, kept.lever = row.free, row.inner_free, row.lever
    kept.stiffness = abreast * row.stiffness
    kept.inner_stiffness, kept.outer_stiffness = (
        abreast * row.inner_stiffness,
        abreast * row.outer_stiffness,
    )


class Pose(NamedTuple):
    """Of the inner ring from where it is concentric with the outer one. A positive tilt `ry` moves the +z
    end to +x, a positive `rx` moves it to -y.
    """

    x: float  # m
    y: float
    z: float
    rx: float  # rad
    ry: float


class PressedBall(NamedTuple):
    """A ball between the rings."""

    force: float  # N, along the line between the groove centres
    outwards: float  # N, of the ball on the outer ring
    along: float  # N, likewise
    slope: float  # N/m, of `force` over the distance of the groove centres
    length: float  # m, that distance
    cosine: float  # of the contact angle
    sine: float


@kernel
def race_stiffness(b, rings, angle):
    """Stiffness (N/m^1.5) of a ball on the inner and on the outer race, at a contact `angle` (rad).

    b: a record of `BallSet`; rings: `Elastic`.
    """
    modulus = effective_modulus(elastic_of(b), rings)
    middle = 0.5 * b.pitch_diameter / math.cos(angle)
    outer_groove = b.outer_conformity if b.outer_conformity != 0.0 else b.conformity
    inner = race_contact_stiffness(b.diameter, middle - 0.5 * b.diameter, b.conformity, modulus, b.hertz)
    outer = race_contact_stiffness(b.diameter, -middle - 0.5 * b.diameter, outer_groove, modulus, b.hertz)
    return inner, outer


@kernel
def series_stiffness(b, rings, angle):
    """Stiffness (N/m^1.5) of a ball on both races, as `race_stiffness`."""
    inner, outer = race_stiffness(b, rings, angle)
    return in_series(inner, outer)


@kernel
def sides_of(arrangement):
    """s of both rows of an `arrangement`; a single row is the first one."""
    if arrangement == BACK_TO_BACK:
        return 1.0, -1.0
    if arrangement == FACE_TO_FACE:
        return -1.0, 1.0
    side = -1.0 if arrangement in (SINGLE_REVERSED, TANDEM_REVERSED) else 1.0
    return side, side


@kernel
def ball_row(b, rings, angle, side, z, approach):
    """`BallRow` of the balls `b`, a record of `BallSet`, in rings of a material (`Elastic`).

    angle: contact angle (rad); side: s, of no account where the angle is 0; z, approach: z and p (m).
    """
    outer_groove = b.outer_conformity if b.outer_conformity != 0.0 else b.conformity
    inner_arc, outer_arc = 0.5 * (b.conformity - 1.0) * b.diameter, 0.5 * (outer_groove - 1.0) * b.diameter
    on_inner, on_outer = race_stiffness(b, rings, angle)
    middle, free, play = 0.5 * b.pitch_diameter, inner_arc + outer_arc, b.play if angle == 0.0 else 0.0
    inner = middle + inner_arc * math.cos(angle) - play
    return BallRow(
        inner,
        middle - outer_arc * math.cos(angle),
        z + side * (inner_arc * math.sin(angle) + approach),
        z - side * outer_arc * math.sin(angle),
        free,
        in_series(on_inner, on_outer),
        inner,
        inner_arc,
        on_inner,
        on_outer,
    )


@kernel
def outwards_at_rest(row, closed):
    """Load (N) outwards of a ball of a `BallRow`, the ring in the middle and its race `closed` (m)."""
    out, along = row.inner - row.outer - closed, row.inner_at - row.outer_at
    length = math.sqrt(out * out + along * along)
    depth = max(length - row.free, 0.0)
    return row.stiffness * depth * math.sqrt(depth) * out / length


@inlined
def grooves_apart(row, pose, cosine, sine):
    """(Way outwards, along the shaft (m)) between the grooves' centres at a ball of a `row`."""
    tilt = pose.ry * cosine - pose.rx * sine
    outwards = row.inner - row.outer + pose.x * cosine + pose.y * sine + row.inner_at * tilt
    return outwards, row.inner_at - row.outer_at + pose.z - row.lever * tilt


@inlined
def pressed(row, pose, cosine, sine, grown):
    """`PressedBall` of a `BallRow` at an angle around the shaft, of this cosine and sine; pose: `Pose`.

    grown: by how much its diameter has grown (m).
    """
    outwards, along = grooves_apart(row, pose, cosine, sine)
    length = math.sqrt(outwards * outwards + along * along)
    depth = max(length - row.free + grown, 0.0)
    root = math.sqrt(depth)
    force = row.stiffness * depth * root
    radial, axial = outwards / length, along / length
    return PressedBall(
        force, force * radial, force * axial, 1.5 * row.stiffness * root, length, radial, axial
    )


@kernel
def thrust_angle(angle, load):
    """Contact angle a (rad) of balls at the free `angle` a0 (rad) that carry a thrust, Harris' equation

        load = sin a (cos a0/cos a - 1)^1.5

    load: F/(Z K A^1.5), without unit.
    """
    low, high = angle, 0.5 * math.pi - 1e-9
    a = min(angle + 0.1, 0.5 * (low + high))
    for _ in range(NEWTON_STEPS):
        c, s = math.cos(a), math.sin(a)
        depth = max(math.cos(angle) / c - 1.0, 0.0)
        root = math.sqrt(depth)
        off = s * depth * root - load
        if off > 0.0:
            high = a
        else:
            low = a
        slope = c * depth * root + 1.5 * s * root * math.cos(angle) * s / (c * c)
        new = a - off / slope if slope > 0.0 else 0.5 * (low + high)
        if not low < new < high:
            new = 0.5 * (low + high)
        if abs(new - a) <= ROUNDING:
            return new
        a = new
    return a


@kernel
def preload_approach(b, rings, angle, preload, hoop):
    """p (m) by which a `preload` (N) takes the rings of each row of a pair together along the shaft.

    A sin(a - a0)/cos a, with A the distance of the grooves' centres and a of `thrust_angle`, where rings
    are stiff. Where both rows' balls close the race by `hoop` (m/N) times their load outwards, 2 F/tan a,
    the angle is that at which the row's length L = A + (F/(Z K sin a))^(2/3) reaches across:

        L cos a = A cos a0 - 2 hoop F/tan a
    """
    outer_groove = b.outer_conformity if b.outer_conformity != 0.0 else b.conformity
    distance = (0.5 * b.conformity + 0.5 * outer_groove - 1.0) * b.diameter
    stiffness = b.count * series_stiffness(b, rings, angle)
    if hoop == 0.0 or preload == 0.0:
        a = thrust_angle(angle, preload / (stiffness * distance * math.sqrt(distance)))
        return distance * math.sin(a - angle) / math.cos(a)
    low, high, length = angle, 0.5 * math.pi, distance
    for _ in range(HALVINGS):
        a = 0.5 * (low + high)
        length = distance + (preload / (stiffness * math.sin(a))) ** (2.0 / 3.0)
        short = length * math.cos(a) < distance * math.cos(angle) - 2.0 * hoop * preload / math.tan(a)
        low, high = (low, a) if short else (a, high)
    return length * math.sin(low) - distance * math.sin(angle)


@kernel
def ball_rows(b, rings, angle, arrangement, distance, clamped):
    """Both rows (`BallRow`) of a pair as mounted; of a single row the second has no stiffness.

    b: a record of `BallSet`; rings: `Elastic`; angle: contact angle (rad); arrangement: of `ARRANGEMENTS`;
    distance: of the rows (m); clamped: against each other, by a preload (N), and by an interference (m) of
    both together, of rings that give by a compliance (m/N, see `preload_approach`).
    """
    left, right = sides_of(arrangement)
    if arrangement in SINGLES:
        row = ball_row(b, rings, angle, left, 0.0, 0.0)
        size, far = (row.inner, row.outer, row.inner_at, row.outer_at), (row.free, 0.0)
        return row, BallRow(*size, *far, row.lever, row.inner_free, 0.0, 0.0)
    preload, interference, hoop = clamped
    approach = 0.0
    if arrangement in CLAMPED:
        approach = preload_approach(b, rings, angle, preload, hoop) + 0.5 * interference
    return (
        ball_row(b, rings, angle, left, -0.5 * distance, approach),
        ball_row(b, rings, angle, right, 0.5 * distance, approach),
    )
