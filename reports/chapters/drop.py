"""The contact event: under which conditions the rotor fell, and how it moved."""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import partial

import numpy as np

from ...master.common.errors import TouchdownError
from ...master.common.text import UM, joined
from ...master.coupling.connections import Attachment
from ...master.results.recording import NotRecordedError
from ...master.results.summary import relative_orbit
from ...master.results.whirl.verdict import STILL
from ...studies.rotor.whirl_prediction import machine, sensitivities
from ..charts import Series, inline, series
from ..figures.motion import gaps_left, orbits
from ..layout import Absent, Data
from ..motion import motions, moving
from ..numbers import heads, percentage, quantity, speed
from ..series import Line
from ..subject import Subject
from ..timeline import lanes, timeline


def drop(subject: Subject) -> Data:
    """Conditions and events, orbits, displacement over time."""
    subject.need_seats()
    data = {
        "conditions": _conditions(subject),
        "event_heads": heads(EVENTS),
        "events": [[subject.name(a), *subject.cells(a, EVENTS)] for a in subject.seats],
        "timeline": _timeline(subject),
        "whirl": _predicted_whirl(subject),
        "unmoved": "",
    }
    try:
        return {**data, **_moved(subject)}
    except NotRecordedError as error:
        return {**data, "unmoved": f"{error}."}


def _timeline(subject: Subject) -> str:
    """The picture; "" where the rotor's speed was not recorded."""
    try:
        found = lanes(subject)
    except NotRecordedError:
        return ""
    told = ((" ".join(e.words.split()), e.time) for lane in found for e in lane.events)
    said = (f"{words} at {quantity(time, 's')}" for words, time in told)
    draw = partial(timeline, found=found, end=float(subject.run.recording.time[-1]))
    return inline(draw, "timeline", f"What happened in its order: {joined(list(said))}")


def _moved(subject: Subject) -> Data:
    """The drop as a moving picture of the seats that can be drawn, orbits, displacement."""
    shown, why_not = motions(subject)
    names = joined([subject.name(a) for a in subject.seats])
    alt = f"Orbits of the journal in its clearance circle at {names}"
    draw = partial(orbits, run=subject.run, seats=subject.seats)
    return {
        "motion": moving(shown) if shown else None,
        "undrawn": why_not,
        "orbits": inline(draw, "orbits", alt, wide=True),
        "gaps": _gaps(subject),
        "displacements": {subject.name(a): _displacement(subject, a) for a in subject.seats},
    }


def _gaps(subject: Subject) -> str:
    """The gaps over time; "": there are none, or their places were not recorded."""
    names = [gap.name for gap in subject.run.scene.gaps]
    draw = partial(gaps_left, run=subject.run)
    try:
        return inline(draw, "gaps", f"Gaps left over time: {joined(names)}", wide=True) if names else ""
    except NotRecordedError:
        return ""


def _conditions(subject: Subject) -> list[list[str]]:
    system, rows = subject.run.system, list[list[str]]()
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
    return rows


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


FORCE = "contact.force"
LAST = 0.1  # of the run, over which its whirl is read


def _predicted_whirl(subject: Subject) -> Data | None:
    """Whirls that go on at the end beside what is predicted of them at the rotor's speed there."""
    forced = [a for a in subject.seats if subject.has(a, FORCE)]
    there = [a for a in forced if STILL in (subject.seat(a).get("whirl") or "")]
    recording = subject.run.recording
    spins = [float(recording[a.motion("omega")][-1]) for a in there if a.motion("omega") in recording]
    if not spins:
        return None
    try:
        found = machine(subject.run.scene, abs(spins[0])).predicted()
    except TouchdownError as error:
        return {"why_none": f"{error}."}
    if found.settled is None:
        return {"why_none": f"none is predicted: {found.why_none}."}
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
    hanging = sensitivities(found, subject.run.scene)
    return {
        "rows": rows,
        "beyond": "; ".join(found.beyond),
        "hanging": "; ".join(f"with {s.more} {s}" for s in hanging),
    }


def _displacement(subject: Subject, a: Attachment) -> Series:
    x, y = relative_orbit(subject.run.system, a, subject.run.recording)
    curves = [
        Line("sideways (x)", "orange", UM * x),
        Line("upwards (y)", "blue", UM * y),
        Line("from the middle", "grey", UM * np.hypot(x, y)),
    ]
    seat = subject.name(a)
    chart = subject.chart(f"displacement-{seat}", f"Displacement at {seat}", "displacement [µm]", curves)
    return series(chart)


def test_figures(subject: Subject) -> Data:
    """The figures that a drop test can be held against."""
    if subject.first_contact is None:
        raise Absent("nothing touched, so that there is nothing a drop test could be held against.")
    names, rows = ("first_contact_time", "whirl_frequency", "largest_displacement"), []
    for a in subject.seats:
        way, clearance = subject.seat(a).get("largest_displacement"), subject.setting(a, "clearance")
        beyond = way / clearance if way is not None and clearance else None
        rows.append([subject.name(a), *subject.cells(a, names), percentage(beyond, 3), subject.rolls(a)])
    return {"heads": heads(names), "rows": rows}
