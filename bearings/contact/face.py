"""The shoulder of a rotor on the faces of a ring: what stops a rotor along its shaft.

A ring has a face on either side, a gap away from the rotor's shoulder that is to land on it. The contact
runs around a circle of the mean radius R; where shaft and ring are not tilted against each other, all of
the circle presses alike:

    N = k d^n (1 + eps d') + (c d + v) d'        for an indentation d > 0, never below zero

Under a tilt (rx, ry) each of the places around it has a share of that law, with an indentation of its own,
on the nearer face; places at (X, Y) are moved along the shaft by

    rx Y - ry X

and their forces make the moments (Y, -X) f about the middle.

Friction acts against the sliding velocity s of each point of the circle, which the spin turns and the
motion across carries along. With the places b around it, e_b along the circle, u the journal's velocity
across and w its spin, both relative to the ring,

    s_b = u + w R e_b        F = -N mean(mu(|s_b|) s_b/|s_b|)        M = R e_b . the same

A rotor that spins and does not move across gets the moment alone, one that slides across slowly a force
that is as if viscous. z points along the shaft; the face at the minus side stops a motion towards -z.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

from ...modelkit.kernel import kernel
from ...modelkit.variables import group, real
from .friction import coefficient
from .laws import elastic_and_damping, elastic_energy
from .peaks import Largest, PeakMemory, watch_peaks

PLACES = 12  # around the circle at which friction, and pressure under a tilt, are summed
MINUS, PLUS = -1.0, 1.0  # the side of a face


@dataclass(frozen=True)
class Shoulder:
    """The faces of a ring and the shoulders of the rotor that land on them; 0 gaps: no faces."""

    gap_minus: float = real(
        0.0, "m", "axial gap of the rotor to the face towards -z; 0: no face there", minimum=0.0
    )
    gap_plus: float = real(
        0.0, "m", "axial gap of the rotor to the face towards +z; 0: no face there", minimum=0.0
    )
    radius: float = real(11.2e-3, "m", "mean radius of the faces", above=0.0, needs="gap_minus or gap_plus")
    stiffness: float = real(
        5e8,
        "N/m^n",
        "stiffness of the contact (n is the exponent)",
        above=0.0,
        needs="gap_minus or gap_plus",
    )
    exponent: float = real(
        1.0, "1", "exponent n of the indentation", minimum=1.0, maximum=3.0, needs="gap_minus or gap_plus"
    )
    damping: float = real(
        0.0,
        "N.s/m2",
        "damping: c times indentation times its rate",
        minimum=0.0,
        needs="gap_minus or gap_plus",
    )
    dissipation: float = real(
        0.0,
        "s/m",
        "Hunt-Crossley coefficient epsilon: elastic force times (1 + epsilon d')",
        minimum=0.0,
        needs="gap_minus or gap_plus",
    )
    viscous: float = real(
        0.0, "N.s/m", "linear damping while in contact", minimum=0.0, needs="gap_minus or gap_plus"
    )


@dataclass(frozen=True)
class ShoulderReport:
    """The rotor's landings on the faces of the ring."""

    force: float = real(0.0, "N", "normal force now", local=True)
    indentation: float = real(0.0, "m", "indentation now; negative: the smaller gap", local=True)
    peak_force: float = real(0.0, "N", "largest normal force since the start", local=True)
    peak_indentation: float = real(0.0, "m", "largest indentation since the start", local=True)
    first_time: float = real(-1.0, "s", "time of the first landing on a face; -1: none yet", local=True)
    first_speed: float = real(0.0, "m/s", "axial speed at the first landing on a face", local=True)
    dissipated: float = real(0.0, "J", "heat of the faces since the start", local=True)


@dataclass(frozen=True)
class ShoulderMemory:
    """The faces at the last evaluation, and the last micro-step before the first landing."""

    normal: float = real(0.0, "N", "normal force")
    indentation: float = real(0.0, "m", "indentation; negative: the gap")
    rate: float = real(0.0, "m/s", "of the indentation")
    stored: float = real(0.0, "J", "in the contact")
    time: float = real(0.0, "s", "time of the last micro-step before the first landing")
    gap: float = real(0.0, "m", "gap then")
    peaks: PeakMemory = group(PeakMemory)


class FaceLanding(NamedTuple):
    """Load of the faces on the journal, and what to report; on the ring it is the opposite."""

    fx: float  # N
    fy: float
    fz: float
    moment: float  # N m, about the shaft
    normal: float  # N
    indentation: float  # m; negative: the gap
    rate: float  # of the indentation, m/s
    loss: float  # W, heat
    stored: float  # J, in the contact
    mx: float  # N m, that tilts
    my: float


class Slip(NamedTuple):
    """Motion of the journal relative to the ring: m, m/s, rad/s."""

    z: float
    vz: float
    vx: float
    vy: float
    spin: float


class Tilt(NamedTuple):
    """Tilt of the journal relative to the ring: rad, rad/s."""

    rx: float
    ry: float
    wx: float
    wy: float


NOWHERE = FaceLanding(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)  # where there is no face


@kernel
def has_face(shoulder):
    """Whether there is a face at all; shoulder: a record of `Shoulder`."""
    return shoulder.gap_minus > 0.0 or shoulder.gap_plus > 0.0


@kernel
def land_on_face(slip, shoulder, friction):
    """`FaceLanding` of a rotor in motion `slip` (`Slip`) on the nearer face; the others are records."""
    if not has_face(shoulder):
        return NOWHERE
    side, indentation = nearer(slip.z, shoulder)
    rate = side * slip.vz
    if indentation <= 0.0:
        return FaceLanding(0.0, 0.0, 0.0, 0.0, 0.0, indentation, rate, 0.0, 0.0, 0.0, 0.0)
    elastic, damping = elastic_and_damping(indentation, shoulder)
    normal = max(elastic + damping * rate, 0.0)
    fx, fy, moment = face_friction(slip, normal, shoulder.radius, friction)
    loss = (normal - elastic) * rate - fx * slip.vx - fy * slip.vy - moment * slip.spin
    stored = elastic_energy(indentation, shoulder)
    return FaceLanding(fx, fy, -side * normal, moment, normal, indentation, rate, loss, stored, 0.0, 0.0)


@kernel
def nearer(z, shoulder):
    """(Side of the nearer face, indentation (m) of what stands at z (m) relative to the ring)."""
    minus = -z - shoulder.gap_minus if shoulder.gap_minus > 0.0 else -math.inf
    plus = z - shoulder.gap_plus if shoulder.gap_plus > 0.0 else -math.inf
    return (PLUS, plus) if plus > minus else (MINUS, minus)


@kernel
def land_tilted(slip, tilt, shoulder, friction):
    """`FaceLanding` of a rotor in motion `slip` that is tilted (`Tilt`); the rest as for `land_on_face`."""
    if tilt.rx == 0.0 and tilt.ry == 0.0 and tilt.wx == 0.0 and tilt.wy == 0.0:
        return land_on_face(slip, shoulder, friction)
    if not has_face(shoulder):
        return NOWHERE
    fx, fy, fz, mx, my, moment = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    normal, deepest, closing, loss, stored = 0.0, -math.inf, 0.0, 0.0, 0.0
    for k in range(PLACES):
        angle = 2.0 * math.pi * k / PLACES
        c, s = math.cos(angle), math.sin(angle)
        x, y = shoulder.radius * c, shoulder.radius * s
        side, indentation = nearer(slip.z + tilt.rx * y - tilt.ry * x, shoulder)
        rate = side * (slip.vz + tilt.wx * y - tilt.wy * x)
        if indentation > deepest:
            deepest, closing = indentation, rate
        if indentation <= 0.0:
            continue
        elastic, damping = elastic_and_damping(indentation, shoulder)
        pressed = max(elastic + damping * rate, 0.0) / PLACES
        stored += elastic_energy(indentation, shoulder) / PLACES
        normal += pressed
        fz -= side * pressed
        mx -= side * pressed * y
        my += side * pressed * x
        sx, sy = slip.vx - slip.spin * y, slip.vy + slip.spin * x
        speed = math.sqrt(sx * sx + sy * sy)
        share = pressed * coefficient(speed, friction) / speed if speed > 0.0 else 0.0
        fx -= share * sx
        fy -= share * sy
        moment -= share * (x * sy - y * sx)
        loss += (pressed - elastic / PLACES) * rate + share * speed * speed
    return FaceLanding(fx, fy, fz, moment, normal, deepest, closing, loss, stored, mx, my)


@kernel
def face_friction(slip, normal, radius, friction):
    """Friction of a face under the force `normal` (N): (N, N, N m) on the journal; friction: a record."""
    turning = slip.spin * radius
    if slip.vx == 0.0 and slip.vy == 0.0:
        return 0.0, 0.0, -normal * radius * coefficient(turning, friction)
    fx, fy, moment = 0.0, 0.0, 0.0
    for k in range(PLACES):
        angle = 2.0 * math.pi * k / PLACES
        ex, ey = -math.sin(angle), math.cos(angle)
        sx, sy = slip.vx + turning * ex, slip.vy + turning * ey
        speed = math.sqrt(sx * sx + sy * sy)
        if speed > 0.0:
            share = normal / PLACES * coefficient(speed, friction) / speed
            fx -= share * sx
            fy -= share * sy
            moment -= share * radius * (sx * ex + sy * ey)
    return fx, fy, moment


@kernel
def note_landing(memory, landing):
    """Keep a `FaceLanding` in the record `memory` of `ShoulderMemory`."""
    memory.normal, memory.indentation, memory.rate = landing.normal, landing.indentation, landing.rate
    memory.stored = landing.stored


@kernel
def watch_faces(time, shoulder, report, memory):
    """Keep the peaks and the first landing, after each accepted micro-step that ends at `time` (s).

    shoulder, report, memory: records.
    """
    if not has_face(shoulder):
        return
    watch_peaks(time, Largest(memory.normal, memory.indentation, 0, 0), report, memory.peaks)
    if report.first_time >= 0.0:
        return
    if memory.indentation >= 0.0:
        h, met = time - memory.time, memory.indentation + memory.gap
        share = memory.gap / met if memory.gap > 0.0 and met > 0.0 else 1.0
        report.first_time = time - (1.0 - share) * h
        report.first_speed = abs(memory.rate)
    memory.time, memory.gap = time, -memory.indentation


@kernel
def report_faces(heat, shoulder, report, memory):
    """Fill what is wanted once per macro step; returns the energy stored in the contact (J).

    heat: of the faces since the start (J); shoulder, report, memory: records.
    """
    if not has_face(shoulder):
        return 0.0
    report.force, report.indentation, report.dissipated = memory.normal, memory.indentation, heat
    return memory.stored
