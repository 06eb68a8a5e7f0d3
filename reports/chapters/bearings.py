"""Chapters on the bearings: speeds, ball loads, static safety, drops until a limit; and their mounts."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from ...bearings import rating
from ...bearings.catalogue import Bearing
from ...bearings.catalogue.load_sharing import WORTH_BENDING, gain_by_bending
from ...bearings.catalogue.spinning import spun
from ...master.common.text import RPM, UM, joined
from ...master.coupling.connections import Attachment, housing_port
from ...master.quantities import MOUNT_HEATS
from ...master.results.clamped_pairs import clampings
from ...master.results.heat import AT_REST
from ...master.results.mount_loads import MountedSeat, mounted_seat
from ...master.results.ratings import FEW_DROPS, Rated, catalogued, rated
from ..charts import Series, series
from ..layout import Absent, Data
from ..numbers import NONE, digits, percentage, quantity, speed
from ..series import Line
from ..subject import COLOURS, Subject

RING, BALL, FORCE = "ring.omega", "balls.force", "contact.force"
CAGE = "speed.cage", "speed.orbit"  # m/s, of the balls' middles
GPA = 1e-9
WHEN = "at rest", "at the shutdown's speed"  # a pair is told of


def run_up(subject: Subject) -> Data:
    """Speeds of rotor, inner rings and cages over time, in rpm."""
    turning = _rolling(subject, RING, "ring that turns")
    chart = subject.chart(
        "run-up", "Speeds of rotor, rings and balls", "speed [rpm]", speed_lines(subject, turning)
    )
    return {"speeds": series(chart), "rows": [_synchronous(subject, a) for a in turning]}


def speed_lines(subject: Subject, turning: Sequence[Attachment]) -> list[Line]:
    """Over time, of the rotor, of the rings that turn, and of the balls round two of them (rpm)."""
    spin, lines = subject.seats[0].motion("omega"), list[Line]()
    if spin in subject.run.recording:
        lines.append(Line("rotor", "ink", RPM * subject.run.recording[spin]))
    for k, a in enumerate(turning):
        colour = COLOURS[k % len(COLOURS)]
        lines.append(Line(f"inner ring {subject.name(a)}", colour, RPM * subject.values(a, RING)))
    for k, a in enumerate(turning[:2]):
        orbit = _orbit_speed(subject, a)
        if orbit is not None:
            lines.append(Line(f"balls' orbit {subject.name(a)}", ("green", "purple")[k], RPM * orbit))
    return lines


def _orbit_speed(subject: Subject, a: Attachment) -> np.ndarray | None:
    """Of the balls round the bearing (rad/s, with the rotor's sign)."""
    pitch = subject.setting(a, "balls.pitch_diameter")
    known = next((name for name in CAGE if subject.has(a, name)), None)
    if known is None or not pitch:
        return None
    return subject.values(a, known) / (0.5 * pitch)


def _synchronous(subject: Subject, a: Attachment) -> list[str]:
    ring = subject.values(a, RING)
    spin = a.motion("omega")
    rotor = subject.run.recording[spin] if spin in subject.run.recording else np.zeros(1)
    turns = abs(rotor[-1]) > AT_REST * np.abs(rotor).max()
    slip = round(float(ring[-1] / rotor[-1]), 6) if turns else None
    return [subject.name(a), subject.rolls(a), speed(float(ring[-1]), 4), percentage(slip, 3)]


def balls(subject: Subject) -> Data:
    """Loads of the balls, pressure on the races."""
    loaded = _rolling(subject, BALL, "ball")
    if subject.first_contact is None:
        raise Absent("nothing touched.")
    lines = subject.lines(loaded, BALL)
    chart = subject.chart("ball-load", "Load of the most loaded ball", "ball load [N]", lines)
    ratings = {subject.name(a): rated(subject.run, a) for a in loaded}
    found = {seat: one for seat, one in ratings.items() if isinstance(one, Rated)}
    return {
        "loads": series(chart),
        "pressure": _pressure(subject, found) if found else None,
        "rows": _pressures(found),
        "clamped": list(_clamped(subject, loaded)),
        "unrated": {seat: why for seat, why in ratings.items() if isinstance(why, str)},
    }


def _clamped(subject: Subject, seats: Sequence[Attachment]) -> Iterator[list[str]]:
    """Preload of pairs, and interference along the shaft or, below 0, play."""
    for a in seats:
        for one, when in zip(clampings(subject.run, a), WHEN, strict=False):
            values = zip(one, ("N", "m", "N"), strict=True)
            yield [subject.name(a), when, *(quantity(value, unit, 3) for value, unit in values)]


def _pressure(subject: Subject, found: dict[str, Rated]) -> Series:
    lines = [
        Line(seat, COLOURS[k % len(COLOURS)], GPA * one.pressure(rating.INNER))
        for k, (seat, one) in enumerate(found.items())
    ]
    title = "Hertz pressure on the inner race"
    return series(subject.chart("pressure", title, "largest pressure [GPa]", lines))


def _pressures(found: dict[str, Rated]) -> list[list[str]]:
    return [
        [
            seat,
            quantity(one.loads.peak, "N"),
            quantity(one.peak_pressure(rating.INNER), "Pa", 3),
            quantity(one.peak_pressure(rating.OUTER), "Pa", 3),
            " by ".join(quantity(axis, "m", 3) for axis in one.half_axes),
        ]
        for seat, one in found.items()
    ]


def _rolling(subject: Subject, variable: str, what: str) -> Sequence[Attachment]:
    """The seats whose bearings tell of a variable. Raises Absent where none does."""
    found = [a for a in subject.need_seats() if subject.has(a, variable)]
    if not found:
        names = joined(
            [f"{a.bearing} ({subject.result.scene.components[a.bearing].fmu})" for a in subject.seats]
        )
        raise Absent(f"{names} has no {what}, or it was not recorded.")
    return found


def left_out(subject: Subject) -> Iterator[Data]:
    """What a run leaves out of the inner rings of the catalogue's bearings, and how much that is."""
    for a in subject.seats:
        entry = catalogued(subject.run.scene.components[a.bearing].preset)
        radius, clearance, force = (
            subject.setting(a, name) for name in ("journal_radius", "clearance", "contact.peak_force")
        )
        if entry is None or not radius or not clearance or not force:
            continue
        entry = replace(entry, bore=2.0 * (radius + clearance))
        gain = _bending_left_out(subject, a, entry, force)
        yield {
            "seat": subject.name(a),
            "gain": percentage(gain, 3) if gain else "",
            "force": quantity(force, "N", 3),
            "grown": _growth_left_out(subject, a, entry),
        }


def _bending_left_out(subject: Subject, a: Attachment, entry: Bearing, force: float) -> float | None:
    """The part by which bending would load the most loaded ball more; None: not worth a word."""
    if subject.setting(a, "ring.harmonics") not in (None, 0.0, 1.0) or not subject.has(a, BALL):
        return None
    gain = gain_by_bending(entry, force)
    return gain if gain > WORTH_BENDING else None


def _growth_left_out(subject: Subject, a: Attachment, entry: Bearing) -> str | None:
    """By how much spin would make the ring grow; None: not worth a word."""
    if subject.setting(a, "ring.growth") != 0.0 or not all(subject.has(a, n) for n in (RING, FORCE)):
        return None
    landed = subject.run.recording.time >= (subject.seat(a)["first_contact_time"] or 0.0)
    weight = float(np.mean(subject.values(a, FORCE)[landed])) if landed.any() else 0.0
    grown = spun(entry, float(np.abs(subject.values(a, RING)).max()), weight)
    return grown.words() if grown.matters else None


USUAL_STATIC_SAFETY = 2.0  # s_0 that makers ask for under shocks
NO_DAMAGE = 1e-6  # of a life, below which a run takes none


def life(subject: Subject) -> Data:
    """Static safety and fatigue."""
    ratings = {subject.name(a): rated(subject.run, a) for a in subject.need_seats()}
    found = {seat: one for seat, one in ratings.items() if isinstance(one, Rated)}
    if not found:
        raise Absent(f"{joined([str(why) for why in ratings.values()])}.")
    if subject.first_contact is None:
        raise Absent("nothing touched.")
    safeties = {seat: one.pressure_safety for seat, one in found.items()}
    return {
        "static": _static(found),
        "fatigue": _fatigue(found),
        "dented": joined([seat for seat, safety in safeties.items() if safety < 1.0]),
        "close": joined([seat for seat, safety in safeties.items() if 1.0 <= safety < USUAL_STATIC_SAFETY]),
        "usual": f"{USUAL_STATIC_SAFETY:g}",
        "undamaged": all(one.damage < NO_DAMAGE for one in found.values()),
        "unrated": {seat: why for seat, why in ratings.items() if isinstance(why, str)},
    }


def _static(found: dict[str, Rated]) -> list[list[str]]:
    return [
        [
            seat,
            quantity(one.capacity.static, "N", 3),
            one.stated.static,
            quantity(one.equivalent_load, "N", 3),
            digits(one.static_safety, 3),
            digits(one.pressure_safety, 3),
            f"{1e-9 * one.bearing.pressure_limit:g} GPa",
        ]
        for seat, one in found.items()
    ]


def _fatigue(found: dict[str, Rated]) -> list[list[str]]:
    return [
        [
            seat,
            quantity(one.capacity.dynamic, "N", 3),
            one.stated.dynamic,
            digits(one.turns, 3),
            percentage(one.damage),
            _drops(one),
        ]
        for seat, one in found.items()
    ]


def _drops(one: Rated) -> str:
    """How many such drops until fatigue, where nothing else is nearer."""
    if one.safety < 1.0:
        return "dented before"
    return digits(one.drops, 2) if one.drops < FEW_DROPS else f"more than {FEW_DROPS:g}; a dent is nearer"


def mounts(subject: Subject) -> Data:
    """Strokes over time, what the stop did, heat by element. Raises Absent without a mount."""
    seats = [(a, mounted_seat(subject.run.system, a, subject.zero)) for a in subject.need_seats()]
    found = [(a, one) for a, one in seats if one is not None]
    if not found:
        raise Absent("no bearing sits in a mount; a housing on linear springs reports only its position.")
    chart = None
    if lines := [line for k, (a, one) in enumerate(found) if (line := _stroke(subject, a, one, k))]:
        chart = series(subject.chart("stroke", "Stroke of the mounts", "stroke [µm]", lines))
    kinds = [name for name in MOUNT_HEATS if any(name in one.heat for _, one in found)]
    return {
        "strokes": chart,
        "rows": [_mount_row(subject, a, one) for a, one in found],
        "hit": joined([subject.name(a) for a, one in found if one.reached is not None]),
        "kinds": [MOUNT_HEATS[kind] for kind in kinds],
        "heats": [
            [subject.name(a), *(quantity(one.heat.get(name), "J", 3) for name in kinds)] for a, one in found
        ],
    }


def _stroke(subject: Subject, a: Attachment, one: MountedSeat, k: int) -> Line | None:
    """The stroke over time (um); None where the place was not recorded."""
    port, system = housing_port(subject.run.system, a.bearing), subject.run.system
    names = [f"{port}.{axis}" for axis in "xy"]
    if not all(name in subject.run.recording for name in names):
        return None
    x, y = (
        subject.run.recording[name] - (system.value(zero) if zero in system else 0.0)
        for name, zero in zip(names, (f"{one.name}.x0", f"{one.name}.y0"), strict=True)
    )
    return Line(subject.name(a), COLOURS[k % len(COLOURS)], UM * np.hypot(x, y))


def _mount_row(subject: Subject, a: Attachment, one: MountedSeat) -> list[str]:
    seat = [subject.name(a), one.name, quantity(one.stroke, "m", 3)]
    if one.gap is None:
        return [*seat, "no stop", NONE, NONE, NONE]
    reached = "not reached" if one.reached is None else quantity(one.reached, "s")
    force = NONE if one.reached is None else quantity(one.stop_force, "N", 3)
    return [*seat, quantity(one.gap, "m", 3), reached, f"{one.hits:d}", force]
