"""The contact event: under which conditions the rotor fell, and how it moved."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from functools import partial

import numpy as np

from ...master.common.errors import TouchdownError
from ...master.coupling.connections import Attachment
from ...master.results.recording import NotRecordedError
from ...master.results.summary import relative_orbit
from ...master.results.whirl.verdict import STILL
from ...studies.rotor.whirl_prediction import machine, sensitivities
from ..animation import Motion as Moving
from ..animation import motions
from ..blocks import Block, Lacking, Motion, Picture, Series, Table, Text
from ..charts import inline, series
from ..figures.motion import orbits
from ..layout import Absent
from ..numbers import digits, heads, listed, percentage, quantity, speed
from ..series import Line
from ..subject import Subject

UM = 1e6
MOVED = "Where the journal goes"


def drop(subject: Subject) -> list[Block]:
    """Conditions and events, orbits, displacement over time."""
    subject.need_seats()
    blocks: list[Block] = [_conditions(subject), _events(subject), *_predicted_whirl(subject)]
    try:
        blocks += [*_moving(subject), _orbits(subject)]
        blocks += [_displacement(subject, a) for a in subject.seats]
    except NotRecordedError as error:
        blocks.append(Lacking(MOVED, f"{error}."))
    return blocks


def _conditions(subject: Subject) -> Table:
    system, rows = subject.run.system, []
    for name in dict.fromkeys(a.body for a in subject.seats):
        rows += [[f"{what} ({name})", value] for what, value in _of_body(subject, name)]
    for a in system.attachments:
        if f"{a.bearing}.shutdown_time" in system and a not in subject.seats:
            time = system.value(f"{a.bearing}.shutdown_time") - subject.zero
            rows.append([f"{a.bearing} is shut down at", quantity(time, "s")])
    for a in subject.seats:
        clearance = subject.setting(a, "clearance")
        if clearance is not None:
            rows.append([f"Radial clearance of {a.bearing}", quantity(clearance, "m")])
        for side, end in (("minus", "−z"), ("plus", "+z")):
            if gap := subject.setting(a, f"shoulder.gap_{side}"):
                rows.append([f"Gap of {a.bearing} towards {end}", quantity(gap, "m")])
    if subject.run.scene.inclination:
        rows.append(
            [
                "The shaft's +z end over the horizontal",
                f"{math.degrees(subject.run.scene.inclination):g} deg",
            ]
        )
    return Table("Conditions of the drop; times count from the shutdown", ["Condition", "Value"], rows, 1)


def _of_body(subject: Subject, name: str) -> Iterator[tuple[str, str]]:
    system = subject.run.system
    for variable, what in (("mass", "Mass"), ("inertia", "Polar moment of inertia")):
        if f"{name}.{variable}" in system:
            known = system.components[name].variables[variable].unit or "1"
            yield what, quantity(system.value(f"{name}.{variable}"), known)
    spin = next(a.motion("omega") for a in subject.seats if a.body == name)
    if spin in subject.run.recording:
        yield "Speed at the start", speed(float(subject.run.recording[spin][0]))
    for variable, unit in (("eccentricity", "m"), ("unbalance_angle", "rad"), ("unbalance_scale", "1")):
        if f"{name}.{variable}" in system:
            words = variable.replace("_", " ").capitalize()
            yield words, quantity(system.value(f"{name}.{variable}"), unit)


EVENTS = (
    *("first_contact_time", "first_contact_speed", "first_impact_contact_force", "peak_contact_force"),
    *("largest_displacement", "pendulum_frequency"),
)


def _events(subject: Subject) -> Table:
    rows = [[subject.name(a), *subject.cells(a, EVENTS)] for a in subject.seats]
    return Table("What happened, seat by seat", ["Seat", *heads(EVENTS)], rows, numbers=1)


FORCE = "contact.force"
LAST = 0.1  # of the run, over which its whirl is read


def _predicted_whirl(subject: Subject) -> Iterator[Block]:
    """A whirl that goes on at the end beside what is predicted of it at the rotor's speed there."""
    forced = [a for a in subject.seats if subject.has(a, FORCE)]
    there = [a for a in forced if STILL in (subject.seat(a).get("whirl") or "")]
    recording = subject.run.recording
    spins = [float(recording[a.motion("omega")][-1]) for a in there if a.motion("omega") in recording]
    if not spins:
        return
    title = "The whirl at the end of the run, and the whirl predicted from receptances"
    try:
        found = machine(subject.run.scene, abs(spins[0])).predicted()
    except TouchdownError as error:
        yield Lacking(title, f"{error}.")
        return
    if found.settled is None:
        yield Lacking(title, f"none is predicted: {found.why_none}.")
        return
    names, rows = [journal.name for journal in found.machine.journals], list[list[str]]()
    for a in there:
        k, force = names.index(a.bearing), subject.values(a, FORCE)
        rows.append(
            [
                subject.name(a),
                quantity(subject.seat(a)["whirl_frequency"], "Hz", 3),
                quantity(found.frequency, "Hz", 3),
                quantity(float(np.mean(force[-max(1, int(LAST * len(force))) :])), "N", 3),
                quantity(float(found.settled.force[k]), "N", 3),
            ]
        )
    head = ["Seat", "Frequency in the run", "predicted", "Mean force in the run", "predicted"]
    yield Table(title, head, rows, 1)
    if found.beyond:
        yield Text(f"Predicted beyond the limits of the model: {'; '.join(found.beyond)}.")
    if hanging := sensitivities(found, subject.run.scene):
        yield Text("Predicted: " + "; ".join(f"with {s.more} {s}" for s in hanging) + ".")


def _moving(subject: Subject) -> Iterator[Block]:
    """The drop as a moving picture, of the seats that can be drawn."""
    shown, lacking = motions(subject)
    if shown:
        factors = listed(list(dict.fromkeys(f"{digits(m.shape.magnified, 2)} times" for m in shown)))
        data = f"[{','.join(m.for_page() for m in shown)}]"
        yield Motion(
            data,
            "The drop: slowly through the first impact, then faster. Displacements and clearance are "
            f"magnified {factors}; the arrow is the bearing's force on the journal, the lines on journal "
            f"and ring turn with them. Balls are carried on by their mean orbit.{_from_the_side(shown)}",
        )
    yield from (Lacking("The drop as a moving picture", why) for why in lacking)


def _from_the_side(shown: Sequence[Moving]) -> str:
    """A sentence on views from the side, where there are any."""
    sides = [m.side for m in shown if m.side is not None]
    if not sides:
        return ""
    factors = listed(list(dict.fromkeys(f"{digits(side.magnified[1], 2)} times" for side in sides)))
    return (
        f" From the side, in the plane of y and z, displacements along the shaft are magnified {factors}; "
        "the arrow is the force of the faces on the rotor."
    )


def _orbits(subject: Subject) -> Picture:
    names = listed([subject.name(a) for a in subject.seats])
    alt = f"Orbits of the journal in its clearance circle at {names}"
    draw = partial(orbits, run=subject.run, seats=subject.seats, impact=subject.impact)
    return Picture(
        inline(draw, "orbits", alt, wide=True),
        "Orbit of the journal as it lies to its housing, all to one scale, the clearance about where the "
        "housing is at the start.",
    )


def _displacement(subject: Subject, a: Attachment) -> Series:
    x, y = relative_orbit(subject.run.system, a, subject.run.recording)
    curves = [
        Line("sideways (x)", "orange", UM * x),
        Line("upwards (y)", "blue", UM * y),
        Line("from the middle", "grey", UM * np.hypot(x, y)),
    ]
    seat = subject.name(a)
    chart = subject.chart(f"displacement-{seat}", f"Displacement at {seat}", "displacement [µm]", curves)
    return series(chart, f"Displacement of the journal at {seat} from its housing.")


def test_figures(subject: Subject) -> list[Block]:
    """The figures that a drop test can be held against."""
    if subject.first_contact is None:
        raise Absent("nothing touched, so that there is nothing a drop test could be held against.")
    told, rows = ("first_contact_time", "whirl_frequency", "largest_displacement"), []
    for a in subject.seats:
        way, clearance = subject.seat(a).get("largest_displacement"), subject.setting(a, "clearance")
        beyond = way / clearance if way is not None and clearance else None
        rows.append([subject.name(a), *subject.cells(a, told), percentage(beyond, 3), subject.rolls(a)])
    head = ["Seat", *heads(told), "over the clearance", "Ring rolls with the rotor after"]
    return [
        Table("What proximity probes and a speed pickup on the ring would show", head, rows, 1),
        Text(
            "Displacements are of the journal from its place at the shutdown; they include misalignment "
            "and the motion of the housing."
        ),
    ]
