"""The machine: drawn to scale, and its parts."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import fields, replace
from functools import partial

import numpy as np

from ...bearings.contact.line import EXAMPLE_TILT, FROM_GEOMETRY, BoreContact, indentations
from ...master.common.errors import TouchdownError
from ...master.common.text import joined
from ...master.coupling.connections import Attachment
from ...master.quantities import INVALID, Owner, values_of
from ...master.results.recording import NotRecordedError
from ...master.results.stresses import stressed
from ...master.results.summary import relative_orbit
from ...rotor.beams.element import Element
from ...rotor.beams.shaft import Shaft
from ...studies.rotor.supports import scene_shaft
from ..charts import inline
from ..drawings import Section, SideView, Support, draw_side, sections
from ..layout import Data
from ..numbers import quantity
from ..subject import Subject

SECTION = ("journal_radius", "clearance")
BALLS = ("balls.count", "balls.diameter", "balls.pitch_diameter")
STEEL_DENSITY = 7830.0  # kg/m3, of the disc that stands for a rigid rotor
SHAFT_OVERHANG = 0.012  # m, of its shaft beyond the last bearing
MAGNETIC, TOUCHDOWN, SENSOR, GAP = "magnetic", "touchdown", "sensor", "gap"


def machine(subject: Subject) -> Data:
    """Side view, bearings along their axes, parts."""
    return {
        **_side_view(subject),
        **_sections(subject),
        "tilt": f"{1e3 * EXAMPLE_TILT:g}",
        "bores": [row for a in subject.seats if (row := _bore(subject, a)) is not None],
        "parts": _parts(subject),
    }


# -- from the side -----------------------------------------------------------------------------------


def _side_view(subject: Subject) -> Data:
    """The drawing, and sizes of a flexible `shaft` or of the `disc` that stands for a rigid rotor."""
    try:
        view, sizes = _view(subject)
    except TouchdownError as error:
        return {"view": "", "why": f"{error}."}
    names = joined([s.label for s in view.supports])
    svg = inline(partial(draw_side, view=view), "machine", f"Side view of the rotor with {names}")
    return {"view": svg, "gaps": any(s.gap for s in view.supports), **sizes}


def _view(subject: Subject) -> tuple[SideView, Data]:
    """The drawing, and sizes. Raises TouchdownError where the rotor's shape is not known."""
    if not subject.run.system.attachments:
        raise TouchdownError("nothing is attached to a rotor")
    body = subject.rotor if subject.seats else subject.run.system.attachments[0].body
    if "stress.peak_bending" in subject.run.system.components[body].variables or stressed(
        subject.run.system
    ):
        shaft = scene_shaft(subject.result.scene, body)
        position = shaft.positions()
        length = quantity(float(position[-1]), "m")
        sizes = {"elements": len(shaft.elements), "mass": quantity(shaft.mass, "kg"), "length": length}
        stations = {s.name: float(position[s.node - 1]) for s in (*shaft.stations, *shaft.sensors)}
        view = SideView(shaft, list(_supports(subject, body, stations)))
        return view, {"shaft": {"title": shaft.title, **sizes}}
    return _rigid(subject, body)


def _rigid(subject: Subject, body: str) -> tuple[SideView, Data]:
    """A disc of steel with the rotor's mass and inertia. Raises TouchdownError where it states neither."""
    system = subject.run.system
    sizes = [f"{body}.{name}" for name in ("mass", "inertia")]
    if not all(name in system for name in sizes):
        raise TouchdownError(f"{body} ({subject.result.scene.components[body].fmu}) states no geometry")
    diameter, width = _disc(*(system.value(name) for name in sizes))
    ports = {a.body_port: 0.0 for a in system.attachments if a.body == body}
    supports = list(_supports(subject, body, ports))
    journal = next((s.inner for s in supports if s.kind == TOUCHDOWN and s.inner), 0.3 * diameter)
    arm = (
        SHAFT_OVERHANG
        + max([0.0, *(abs(s.position) for s in _side_by_side(supports, width))])
        - 0.5 * width
    )
    middle = arm + 0.5 * width
    pieces = [(arm, journal), (width, diameter), (arm, journal)]
    steel = partial(Element, modulus=207e9, density=STEEL_DENSITY, poisson=0.3)
    shaft = Shaft("disc", tuple(steel(length=length, outer_diameter=outer) for length, outer in pieces))
    placed = [replace(s, position=middle + s.position) for s in _side_by_side(supports, width)]
    sizes = {"diameter": quantity(diameter, "m", 3), "width": quantity(width, "m", 3)}
    return SideView(shaft, placed), {"shaft": None, "disc": sizes}


def _disc(mass: float, inertia: float) -> tuple[float, float]:
    """Diameter and width (m) of a steel disc with a mass (kg) and a polar inertia (kg m2)."""
    radius = math.sqrt(2.0 * inertia / mass)
    return 2.0 * radius, mass / (STEEL_DENSITY * math.pi * radius**2)


def _side_by_side(supports: list[Support], width: float) -> list[Support]:
    """Bearings of one plane apart from each other, left and right of the disc (m)."""
    placed, side = [], 1.0
    for k, s in enumerate(supports):
        away = 0.5 * width + (k // 2 + 1) * max(1.2 * (s.width or 0.4 * width), 0.008)
        placed.append(replace(s, position=side * away))
        side = -side
    return placed


def _supports(subject: Subject, body: str, stations: dict[str, float]) -> Iterator[Support]:
    """What is attached to a body, sensors and gaps, at the places (m) of its ports."""
    seats, gaps = set(subject.seats), subject.result.scene.gaps
    acting = {gap.key for gap in gaps if gap.acts}
    for a in subject.run.system.attachments:
        if a.body == body and a.body_port in stations and a.bearing not in acting:
            kind = TOUCHDOWN if a in seats else MAGNETIC
            place = stations[a.body_port]
            yield Support(place, kind, a.bearing, *_size(subject, a, kind), *_room(subject, a, kind))
    for _, end in subject.result.scene.sense:
        component, _, port = end.partition(".")
        if component == body and port in stations:
            yield Support(stations[port], SENSOR, "sensor")
    left, late = values_of(subject.summary, "least", Owner.GAP), subject.summary.get(INVALID) or ()
    for gap in gaps:
        component, _, port = gap.at.partition(".")
        if component == body and port in stations:
            size = 2.0 * (gap.journal_radius or gap.radius or 0.0)
            axial = gap.axial is not None
            room = {"gap": gap.size, "left": left.get(gap.name), "axial": axial}
            room["late"] = f"{Owner.GAP}.{gap.name}.least" in late
            yield Support(stations[port], GAP, gap.name, size, size if axial else 0.0, **room)


def _room(subject: Subject, a: Attachment, kind: str) -> tuple[float, float | None]:
    """The gap around the journal (m), and what is left of it: of a bearing's bore, or to the magnets."""
    if kind == MAGNETIC:
        size, left = (subject.setting(a, name) for name in ("magnet.gap", "least_gap"))
        return size or 0.0, left
    size, recording = subject.setting(a, "clearance"), subject.run.recording
    try:
        x, y = relative_orbit(subject.run.system, a, recording)
    except NotRecordedError:
        return size or 0.0, None
    return size or 0.0, (size or 0.0) - float(np.hypot(x, y)[recording.time >= 0.0].max(initial=0.0))


def _size(subject: Subject, a: Attachment, kind: str) -> tuple[float, float, float]:
    """Inner and outer diameter and width (m); 0 where the component states none."""
    if kind != TOUCHDOWN or (radius := subject.setting(a, "journal_radius")) is None:
        return 0.0, 0.0, 0.0
    pitch, ball = (subject.setting(a, f"balls.{d}") for d in ("pitch_diameter", "diameter"))
    if pitch is None or ball is None:
        return 2.0 * radius, 0.0, 0.0
    rows = subject.setting(a, "balls.rows") or 1.0
    return 2.0 * radius, pitch + 1.9 * ball, 1.7 * ball * rows


# -- along the axis ----------------------------------------------------------------------------------


def _sections(subject: Subject) -> Data:
    found = [s for a in subject.seats if (s := _section(subject, a)) is not None]
    if not found:
        return {"sections": ""}
    alt = f"Touchdown bearings along their axes: {joined([s.label for s in found])}"
    return {
        "sections": inline(partial(sections, bearings=found), "sections", alt),
        "clearances": joined([f"{quantity(s.clearance, 'm')} at {s.label}" for s in found]),
    }


def _section(subject: Subject, a: Attachment) -> Section | None:
    journal, clearance = (subject.setting(a, name) for name in SECTION)
    if journal is None or clearance is None:
        return None
    count, ball, pitch = (subject.setting(a, name) for name in BALLS)
    if count is None or ball is None or pitch is None:
        return Section(a.bearing, journal, clearance)
    first = subject.setting(a, "balls.first_angle") or 0.0
    return Section(a.bearing, journal, clearance, 0.5 * pitch, 0.5 * ball, int(count), first)


# -- journals in their bores -------------------------------------------------------------------------


def _bore(subject: Subject, a: Attachment) -> list[str] | None:
    """By which law a journal is pressed into its bore, and what the other one would make of it."""
    names = [field.name for field in fields(BoreContact)]
    found = {name: subject.setting(a, f"contact.{name}") for name in names}
    radius, clearance = (subject.setting(a, name) for name in SECTION)
    force = subject.seat(a).get("peak_contact_force")
    stated = {name: value for name, value in found.items() if value is not None}
    if len(stated) < len(names) or radius is None or clearance is None or not force:
        return None
    depths = indentations(BoreContact(**stated), radius, clearance, force)  # type: ignore[arg-type]
    power, line, tilted = (quantity(depth, "m", 3) for depth in depths)
    if stated["law"] == FROM_GEOMETRY:
        law, chosen, other = "line contact, from geometry", line, power
    else:
        law, chosen, other = f"power law as set, exponent {stated['exponent']:.4g}", power, line
    return [subject.name(a), law, quantity(force, "N", 3), chosen, other, tilted]


# -- as a list ---------------------------------------------------------------------------------------


def _parts(subject: Subject) -> list[list[str]]:
    rows = []
    for name, spec in subject.result.scene.components.items():
        seats = [
            f"{a.bearing_port} on {a.body_end.title}"
            for a in subject.run.system.attachments
            if a.bearing == name
        ]
        rows.append([name, spec.fmu, spec.preset or "", joined(seats)])
    return rows
