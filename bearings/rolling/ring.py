"""The inner ring of a bearing, in which the journal lands: what every rolling model shares.

Behind the copies of journal and housing (`bearings.seat`) a rolling bearing's state starts with the
ring's seven components; balls and cage follow.
"""

from __future__ import annotations

from dataclasses import dataclass

from touchdown.bearings import seat
from touchdown.bearings.contact.journal import touch, watch_contact
from touchdown.bearings.contact.laws import elastic_energy
from touchdown.bearings.rolling.pitch_circle import Gap
from touchdown.modelkit.kernel import kernel
from touchdown.modelkit.ports import Motion
from touchdown.modelkit.variables import real

RX, RY, RVX, RVY, RANGLE, RW, LOSS = range(seat.INSIDE, seat.INSIDE + 7)
NEXT = seat.INSIDE + 7

SYNCHRONOUS = 0.99  # of the journal's surface speed: the ring has caught up


@dataclass(frozen=True)
class Ring:
    """Inner ring. Defaults: 6004 (filled in; the source does not give them)."""

    mass: float = real(0.015, "kg", "mass of the inner ring", above=0.0)
    inertia: float = real(1.9e-6, "kg.m2", "moment of inertia of the inner ring", above=0.0)


@dataclass(frozen=True)
class RingReport:
    """Motion of the inner ring, and how fast its bore and the journal's surface move."""

    x: float = real(0.0, "m", "horizontal position", local=True)
    y: float = real(0.0, "m", "vertical position", local=True)
    vx: float = real(0.0, "m/s", "horizontal velocity", local=True)
    vy: float = real(0.0, "m/s", "vertical velocity", local=True)
    omega: float = real(0.0, "rad/s", "spin speed", local=True)
    surface_speed: float = real(0.0, "m/s", "circumferential speed of the bore", local=True)
    journal_speed: float = real(0.0, "m/s", "circumferential speed of the journal", local=True)
    sync_time: float = real(
        -1.0, "s", "time when the bore first reached 99 % of the journal's speed; -1: not yet", local=True
    )


@dataclass(frozen=True)
class RaceSpeeds:
    """Half the circumferential speed of the inner race, as it is and as without slip in the bore."""

    rotor: float = real(0.0, "m/s", "half the race's speed if the bore rolled on the journal", local=True)
    ring: float = real(0.0, "m/s", "half the circumferential speed of the inner race", local=True)


@dataclass(frozen=True)
class RingMemory:
    """Contact with the journal at the last evaluation."""

    normal: float = real(0.0, "N", "normal force")
    indentation: float = real(0.0, "m", "indentation")
    rate: float = real(0.0, "m/s", "its rate")


@kernel
def ring_motion(y):
    """Motion of the inner ring."""
    return Motion(y[RX], y[RY], y[RVX], y[RVY], y[RW])


@kernel
def journal_on_ring(y, m, grip=0.0):
    """The journal's `Touch` with the ring, remembered for `observe`."""
    p, journal = m.p, seat.journal_motion(y)
    t = touch(journal, ring_motion(y), p.journal_radius, p.clearance, m.d.contact, m.d.friction, grip)
    r = m.s.ring
    r.normal, r.indentation, r.rate = t.normal, t.indentation, t.rate
    return t


@kernel
def gap(y):
    """The ring as balls on the pitch circle meet it, from the housing's middle (`Gap`)."""
    return Gap(
        y[RX] - y[seat.HX],
        y[RY] - y[seat.HY],
        y[RVX] - y[seat.HVX],
        y[RVY] - y[seat.HVY],
        y[RW],
    )


@kernel
def accelerate(y, dy, m, journal, balls):
    """Derivatives of the ring under the journal's `Touch` and what the balls do to it (`Total`)."""
    p = m.p
    dy[RX] = y[RVX]
    dy[RY] = y[RVY]
    dy[RVX] = (balls.fx - journal.fx) / p.ring.mass
    dy[RVY] = (balls.fy - journal.fy) / p.ring.mass - p.gravity
    dy[RANGLE] = y[RW]
    dy[RW] = (journal.ring_moment + balls.moment) / p.ring.inertia


@kernel
def drift(x, y, v, h):
    """The ring's position in x: that in y and h (s) times the velocity in v (`verlet`)."""
    x[RX] = y[RX] + h * v[RVX]
    x[RY] = y[RY] + h * v[RVY]
    x[RANGLE] = y[RANGLE] + h * v[RW]


@kernel
def report_energy(y, m, kinetic, potential, inertia):
    """Energy of the bearing; `kinetic` and `potential` (J) are those of balls and cage, `inertia` (kg m2)
    is what turns with the ring.
    """
    p, o = m.p, m.o.energy
    speed2 = y[RVX] ** 2 + y[RVY] ** 2
    o.kinetic = kinetic + 0.5 * p.ring.mass * speed2 + 0.5 * inertia * y[RW] ** 2
    o.potential = potential + elastic_energy(m.s.ring.indentation, p.contact)
    o.potential += p.ring.mass * p.gravity * y[RY]
    o.dissipated = y[LOSS]


@kernel
def place(y, dx, dy):
    """Put the ring at rest in its housing, (dx, dy) from the middle (m)."""
    y[RX], y[RY] = y[seat.HX] + dx, y[seat.HY] + dy
    y[RVX], y[RVY] = y[seat.HVX], y[seat.HVY]


@kernel
def watch(t, y, m):
    """First contact, peaks and the time of synchronism, after an accepted micro-step."""
    r = m.s.ring
    time = m.time + t
    watch_contact(time, seat.journal_motion(y), (r.normal, r.indentation, r.rate), m.o.contact, m.s.contact)
    o = m.o.ring
    if o.sync_time < 0.0 and m.o.contact.first_time >= 0.0:
        bore = m.p.journal_radius + m.p.clearance
        journal = y[seat.JW] * m.p.journal_radius
        if abs(y[RW] * bore) >= SYNCHRONOUS * abs(journal) and y[RW] * journal > 0.0:
            o.sync_time = time


@kernel
def report(y, m, race_radius):
    """Outputs of ring and contact at the end of the macro step."""
    o, p = m.o.ring, m.p
    o.x, o.y, o.vx, o.vy, o.omega = y[RX], y[RY], y[RVX], y[RVY], y[RW]
    o.surface_speed = y[RW] * (p.journal_radius + p.clearance)
    o.journal_speed = y[seat.JW] * p.journal_radius
    m.o.speed.ring = 0.5 * y[RW] * race_radius
    m.o.speed.rotor = 0.5 * o.journal_speed * race_radius / (p.journal_radius + p.clearance)
    c = m.o.contact
    c.force, c.indentation = m.s.ring.normal, m.s.ring.indentation
    c.sliding = o.journal_speed - o.surface_speed


def error_weights() -> list[float]:
    """Of the ring's components, in the order of the state; the heat lost is a quadrature."""
    length, speed, spin = 1.0 / seat.POSITION_SCALE, 1.0 / seat.VELOCITY_SCALE, 1.0 / seat.SPIN_SCALE
    return [length, length, speed, speed, spin, spin, 0.0]
