"""The journal in its bore: parameters of the contact, where the two touch, force and torque.

The bore is a circle around the ring's centre, wider than the journal by `clearance` on radius. The point of
contact is taken on the journal's surface for both bodies, so that forces and moments close exactly: what
the journal loses in linear and angular momentum the ring gains.

The module also checks lengths beside each other, since millimetres are easily read as metres. Clearances of
touchdown bearings are 0.1 to 5 % of the journal's radius, play and indentation are less; in the wrong unit
they are a thousand times that. The limit `MAX_PROPORTION` lies between, and still admits a bearing that is
opened so wide that nothing touches it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

from ...modelkit.kernel import kernel
from ...modelkit.ports import PARTING_TOLERANCE
from ...modelkit.variables import group, real
from . import friction
from .laws import damp
from .line import FROM_GEOMETRY, STEEPEST, is_line, is_narrow, set_line
from .pair import INSIDE, NO_KICK, ContactPlace, contact_heat, contact_in_kick, slip
from .peaks import Largest, PeakMemory, watch_peaks

MAX_PROPORTION = 0.5


def length_problem(name: str, beside: str) -> str:
    """The message for a length `name` that is `out_of_proportion` to `beside`."""
    return (
        f"{name} = {{0:g}} m is out of all proportion to {beside} = {{1:g}} m; it may be half of that "
        "at most. A plain number is in m; write '{0:g} mm' where mm are meant"
    )


@kernel
def out_of_proportion(length, size, numbers):
    """Whether a `length` cannot be meant beside one of `size` (m); numbers: of the message."""
    if abs(length) <= MAX_PROPORTION * size:
        return False
    numbers[0], numbers[1] = length, size
    return True


_LENGTHS = (
    length_problem("clearance", "journal_radius"),
    length_problem("contact.expected_indentation", "journal_radius"),
)
_LINE = (
    "contact.load = {0:g} N makes no line contact of a journal of {1:g} m with a clearance of {2:g} m: "
    "they touch over more than 40 degrees; take a smaller load, or a greater contact.length"
)
_STEEP = (
    "contact.load = {0:g} N makes no power law of a journal of {1:g} m with a clearance of {2:g} m: its "
    "exponent would be above {3:g}; take a smaller load, or a greater contact.length"
)
PROBLEMS = (*_LENGTHS, _LINE, _STEEP, *friction.law_problems("friction"))


@kernel
def bore_problem(p, usual, numbers):
    """The number in `PROBLEMS` of a fault in the journal and its bore, or 0.

    p: a bearing's parameters; usual: static coefficient of friction by default; numbers: of the message.
    """
    found = 0
    if out_of_proportion(p.clearance, p.journal_radius, numbers):
        found = 1
    elif out_of_proportion(p.contact.expected_indentation, p.journal_radius, numbers):
        found = 2
    elif p.contact.law == FROM_GEOMETRY and not is_line(p.contact, p.journal_radius, p.clearance):
        numbers[0], numbers[1], numbers[2], numbers[3] = (
            p.contact.load,
            p.journal_radius,
            p.clearance,
            STEEPEST,
        )
        found = 4 if is_narrow(p.contact, p.journal_radius, p.clearance) else 3
    else:
        found = friction.law_problem(p.friction, usual, numbers)
        found = found + 4 if found != 0 else 0
    return found


@kernel
def derive(d, p, lighter):
    """Set the laws d.contact and d.friction by those in p; lighter: mass of the lighter body (kg)."""
    d.contact = p.contact
    if p.contact.law == FROM_GEOMETRY:
        set_line(d.contact, p.journal_radius, p.clearance)
    damp(d.contact, lighter)
    d.friction = p.friction
    friction.derive(d.friction)


MAX_REACH = 1.0  # s; a contact that is farther off is of no account to a macro step


class Touch(NamedTuple):
    """Contact of journal and ring: force on the journal, moments on both, and what to report."""

    fx: float  # N
    fy: float
    journal_moment: float  # N m
    ring_moment: float
    normal: float  # N
    elastic: float  # N, what of it is not damping
    indentation: float  # m; negative: the gap
    rate: float  # of the indentation, m/s
    loss: float  # W, heat
    sliding: float  # W, normal force times sliding speed


@kernel
def place_in_bore(journal, ring, journal_radius, clearance):
    """`ContactPlace` (m) of a journal of `journal_radius` in the bore of `ring` (Motion), with `clearance`.

    In the very middle it has no direction, and n is zero.
    """
    ex, ey = journal.x - ring.x, journal.y - ring.y
    distance = math.sqrt(ex * ex + ey * ey)
    inverse = 1.0 / distance if distance > 0.0 else 0.0
    reach = distance + journal_radius
    return ContactPlace(ex * inverse, ey * inverse, distance - clearance, journal_radius, reach, 0.0)


@kernel
def time_to_touch(journal, ring, clearance):
    """Time (s) until a journal touches the bore of `ring`, wider by `clearance` (m); both go straight on.

    journal, ring: Motion (m, m/s). 0 where they touch, `MAX_REACH` where that is farther off or never: the
    positive root of |d + v t| = clearance, d and v the journal's place and velocity in the bore.
    """
    dx, dy = journal.x - ring.x, journal.y - ring.y
    vx, vy = journal.vx - ring.vx, journal.vy - ring.vy
    gap2 = clearance * clearance - dx * dx - dy * dy
    outwards, speed2 = dx * vx + dy * vy, vx * vx + vy * vy
    root = math.sqrt(max(outwards * outwards + speed2 * gap2, 0.0))
    if gap2 <= 0.0:
        time = 0.0
    elif outwards + root > gap2 / MAX_REACH:
        time = gap2 / (outwards + root)  # the root without a difference of like numbers
    else:
        time = MAX_REACH
    return time


@kernel
def touch_of(press, indentation, loss, sliding):
    """The `Touch` of a journal that presses (`Press`) its bore, indented by `indentation` (m).

    loss: W; sliding: mean speed of the kick (m/s).
    """
    c = press
    elastic, rubbed = c.normal - c.damped, c.normal * abs(sliding)
    moments = c.first_moment, c.second_moment
    return Touch(c.fx, c.fy, moments[0], moments[1], c.normal, elastic, indentation, c.rate, loss, rubbed)


@kernel
def touch(journal, ring, journal_radius, clearance, law, friction):
    """Contact of a journal of `journal_radius` (m) with the bore of `ring`, wider by `clearance` (m).

    journal, ring: Motion (m, m/s, rad/s); law, friction: records. Returns a `Touch` (N, N m, m, W); the
    force on the ring is the opposite one.
    """
    return touch_at(place_in_bore(journal, ring, journal_radius, clearance), journal, ring, law, friction)


@kernel
def touch_at(place, journal, ring, law, friction):
    """`touch` at a `ContactPlace` in the bore, which moves there as `ring` (Motion) does."""
    if place.indentation <= 0.0:
        _, rate = slip(journal, ring, place, INSIDE)
        return Touch(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, place.indentation, rate, 0.0, 0.0)
    pressed = contact_in_kick(journal, ring, place, INSIDE, law, friction, NO_KICK)
    return touch_of(pressed, place.indentation, contact_heat(pressed, 0.0, 0.0), pressed.sliding)


@dataclass(frozen=True)
class ContactReport:
    """The journal's contact with the ring."""

    force: float = real(0.0, "N", "normal force now", local=True)
    indentation: float = real(0.0, "m", "indentation now; negative: the gap", local=True)
    sliding: float = real(0.0, "m/s", "sliding speed of journal over ring now", local=True)
    peak_force: float = real(0.0, "N", "largest normal force since the start", local=True)
    peak_indentation: float = real(0.0, "m", "largest indentation since the start", local=True)
    first_time: float = real(-1.0, "s", "time of the first contact; -1: none yet", local=True)
    first_speed: float = real(0.0, "m/s", "speed of the journal at the first contact", local=True)
    first_x: float = real(0.0, "m", "journal position at the first contact", local=True)
    first_y: float = real(0.0, "m", "journal position at the first contact", local=True)
    over_time: float = real(
        -1.0,
        "s",
        "time when the first impact was over, the journal free for longer than a rattle; -1: not yet",
        local=True,
    )
    rate: float = real(
        0.0,
        "rad/s",
        "at which the journal swings on its contact, indented as expected",
        constant=True,
    )
    sliding_work: float = real(
        0.0,
        "N.m",
        "normal force times sliding way since the start, which wear goes by",
        local=True,
    )
    reach: float = real(
        0.0,
        "s",
        "time until journal and ring touch if both go straight on; 0: they do; at most 1 s",
        local=True,
    )


@dataclass(frozen=True)
class Touched:
    """Contact of journal and bore at the last evaluation."""

    normal: float = real(0.0, "N", "normal force")
    indentation: float = real(0.0, "m", "indentation; negative: the gap")
    rate: float = real(0.0, "m/s", "of the indentation")
    elastic: float = real(0.0, "N", "what of the normal force is not damping")
    middle: float = real(0.0, "m/s", "rate of the indentation in the middle of the kick")
    nx: float = real(0.0, "1", "direction of the journal from the middle of the bore")
    ny: float = real(0.0, "1", "direction of the journal from the middle of the bore")
    stored: float = real(0.0, "J", "as `bearings.contact.passivity`")
    bent: float = real(0.0, "W", "heat of the bore's own bending, which the contact's loss contains")


@kernel
def note_touch(touched, contact):
    """Keep a `Touch` (N, m, m/s) in the record `touched` of `Touched`."""
    touched.normal, touched.elastic = contact.normal, contact.elastic
    touched.indentation, touched.rate = contact.indentation, contact.rate


@dataclass(frozen=True)
class ContactMemory:
    """Last accepted micro-step before the first contact, to locate it in time; then the last in contact."""

    time: float = real(0.0, "s", "time")
    gap: float = real(0.0, "m", "gap")
    rate: float = real(0.0, "m/s", "its rate")
    x: float = real(0.0, "m", "journal")
    y: float = real(0.0, "m", "journal")
    vx: float = real(0.0, "m/s", "journal")
    vy: float = real(0.0, "m/s", "journal")
    touching: float = real(0.0, "s", "last micro-step in contact")
    peaks: PeakMemory = group(PeakMemory)


_LINE_FROM = ("length", "depth", "load", "modulus", "poisson", "journal_modulus", "journal_poisson", "tilt")
RATE_FROM = (
    *(f"contact.{name}" for name in ("stiffness", "exponent", "expected_indentation", "law", *_LINE_FROM)),
    *("journal_radius", "clearance", "journal.inv_m"),
)


@kernel
def swing_rate(law, inv_m):
    """Angular frequency (rad/s) of a journal of `inv_m` (1/kg) on a contact indented as expected."""
    slope = law.exponent * law.stiffness * law.expected_indentation ** (law.exponent - 1.0)
    return math.sqrt(slope * inv_m)


@kernel
def hermite(f0, d0, f1, d1, h, s):
    """Cubic through values f and slopes d at the ends of an interval of length h, at s in [0, 1].

    h in s, f in any unit, d in that per second; returns what f is in.
    """
    r = 1.0 - s
    return r * r * ((1.0 + 2.0 * s) * f0 + s * h * d0) + s * s * ((3.0 - 2.0 * s) * f1 - r * h * d1)


@kernel
def _crossing(f0, d0, f1, d1, h):
    """Where in [0, 1] that cubic, positive at 0 and not at 1, crosses zero (bisection); units as there."""
    low, high = 0.0, 1.0
    for _ in range(60):
        middle = 0.5 * (low + high)
        if hermite(f0, d0, f1, d1, h, middle) > 0.0:
            low = middle
        else:
            high = middle
    return high


@kernel
def watch_contact(time, journal, touched, report, memory):
    """Keep the peaks, the first contact and the first impact's end; called after each accepted micro-step.

    time: s; journal: Motion (m, m/s) at that time; touched, report, memory: records of `Touched`,
    `ContactReport` and `ContactMemory`.
    """
    indentation, rate = touched.indentation, touched.rate
    watch_peaks(time, Largest(touched.normal, indentation, 0, 0), report, memory.peaks)
    if indentation >= 0.0:
        memory.touching = time
    if report.first_time >= 0.0:
        if report.over_time < 0.0 and time - memory.touching > PARTING_TOLERANCE:
            report.over_time = time
        return
    if indentation >= 0.0:
        h = time - memory.time
        if memory.gap > 0.0 and h > 0.0:
            s = _crossing(memory.gap, memory.rate, -indentation, -rate, h)
        else:  # it starts in contact
            s = 1.0
        report.first_time = time - (1.0 - s) * h
        report.first_x = hermite(memory.x, memory.vx, journal.x, journal.vx, h, s)
        report.first_y = hermite(memory.y, memory.vy, journal.y, journal.vy, h, s)
        vx = (1.0 - s) * memory.vx + s * journal.vx
        vy = (1.0 - s) * memory.vy + s * journal.vy
        report.first_speed = math.sqrt(vx * vx + vy * vy)
    memory.time = time
    memory.gap = -indentation
    memory.rate = -rate
    memory.x, memory.y = journal.x, journal.y
    memory.vx, memory.vy = journal.vx, journal.vy
