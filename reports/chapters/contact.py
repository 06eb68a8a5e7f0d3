"""Chapters on contact forces, in the bore and on the faces, on stresses and on spectra."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

import numpy as np

from ...master.common.errors import TouchdownError
from ...master.common.text import UM
from ...master.coupling.connections import Attachment, housing_port
from ...master.quantities import STRESSES, Owner, owned
from ...master.results.recording import NotRecordedError
from ...master.results.stresses import stressed
from ...master.results.summary import is_estimated, relative_orbit
from ...master.results.whirl.evidence import touched_bore
from ...studies.rotor.rotor_report import described
from ...studies.rotor.supports import scene_shaft
from ..charts import Series, inline, series
from ..drawings import SECTORS, Presses, contact_map
from ..figures.forces import true_peak
from ..figures.motion import has_faces
from ..figures.spectra import MIN_TIME_S, Mark, has_waterfall, motion_waterfall
from ..figures.stress import has_stress, stress
from ..layout import Absent, Data
from ..numbers import capital, heads, quantity
from ..series import Line
from ..subject import Subject

FORCE = "contact.force"
MODES = 4  # of the free rotor per plane, the rigid ones included, whose frequencies are marked


def forces(subject: Subject) -> Data:
    """Contact force over time, and its map."""
    recorded = [a for a in subject.need_seats() if subject.has(a, FORCE)]
    if not recorded:
        raise Absent("no contact force was recorded; see run.record.")
    if subject.first_contact is None:
        raise Absent("nothing touched.")
    title, axis = "Contact force of the journal", "contact force [N]"
    chart = subject.chart("force", title, axis, force_lines(subject, recorded))
    return {
        "force": series(chart),
        "interval": subject.interval,
        "estimated": ", ".join(a.bearing for a in recorded if is_estimated(subject.run.system, a)),
        "sectors": SECTORS,
        **_map(subject),
    }


def force_lines(subject: Subject, recorded: list[Attachment]) -> list[Line]:
    """The contact force over time at seats where it was recorded, with its largest as a dot."""
    lines = subject.lines(recorded, FORCE)
    return lines + [dot for a, line in zip(recorded, lines, strict=True) for dot in _peak(subject, a, line)]


def _peak(subject: Subject, a: Attachment, line: Line) -> Iterator[Line]:
    """The largest force of a seat as a dot, where that was recorded."""
    if (found := true_peak(subject.run.recording, a.bearing, FORCE)) is not None:
        row, peak = found
        values = np.where(np.arange(len(line.values)) == row, peak, np.nan)
        yield Line(f"largest at {line.label}, {quantity(peak, 'N', 3)}", line.colour, values, dot=True)


def _map(subject: Subject) -> Data:
    """The map of the contacts; an empty one where there is none: not recorded, or no bore was `touched`."""
    data = {"map": "", "unrecorded": "", "touched": touched_bore(subject.summary)}
    try:
        bores = [_presses(subject, k) for k, a in enumerate(subject.seats) if subject.has(a, FORCE)]
    except NotRecordedError as error:
        return {**data, "unrecorded": f"{error}."}
    if not any((bore.force > 0.0).any() for bore in bores):
        return data
    alt = "Maps of the place on the bore where the journal pressed, over time, coloured by the force"
    return {**data, "map": inline(partial(contact_map, bores=bores), "contact-map", alt)}


def _presses(subject: Subject, seat: int) -> Presses:
    a = subject.seats[seat]
    x, y = relative_orbit(subject.run.system, a, subject.run.recording)
    title = f"{subject.name(a)} ({a.bearing})"
    return Presses(title, subject.run.recording.time, np.arctan2(y, x), subject.values(a, FORCE))


def stresses(subject: Subject) -> Data:
    """Bending and shear along the shaft and over time."""
    system = subject.run.system
    rotors = stressed(system)
    if not rotors:
        raise Absent("the rotor has none: it is rigid, or known by its matrices, without diameters.")
    shown = [name for name in rotors if has_stress(system, name)]
    if not shown:
        raise Absent("the rotor kept no stress; set stress.active = 1 on it.")
    return {
        "rows": list(_peaks(subject, shown)),
        "pictures": {name: _stress(subject, name) for name in shown},
    }


def _stress(subject: Subject, name: str) -> str:
    alt = f"Bending and shear stress of {name} along its axis and over time"
    return inline(partial(stress, run=subject.run, name=name), f"stress-{name}", alt, wide=True)


def _peaks(subject: Subject, rotors: list[str]) -> Iterator[list[str]]:
    for name in rotors:
        found = owned(subject.summary, Owner.COMPONENT)[name].get
        for kind in STRESSES:
            value, node, time = (found(f"peak_{kind}_stress{tail}") for tail in ("", "_node", "_time"))
            if value is not None:
                sizes = quantity(value, "Pa", 3), quantity(node, "1", 3), quantity(time, "s")
                yield [f"{capital(kind)}, {name}", *sizes]


def spectra(subject: Subject) -> Data:
    """Of the rotor's motion at each seat, over time."""
    recording = subject.run.recording
    seats, marks = subject.need_seats(), _natural(subject)
    falls = {subject.name(a): _waterfall(subject, a, marks) for a in seats if has_waterfall(recording, a)}
    if not falls:
        raise Absent(
            f"a waterfall takes {MIN_TIME_S:g} s or more of a rotor whose motion is recorded; this run has "
            "not that."
        )
    return {"pictures": falls, "modes": bool(marks)}


def _waterfall(subject: Subject, a: Attachment, marks: list[Mark]) -> str:
    alt = f"Motion of the rotor at {subject.name(a)} over time and frequency, with the spin and against it"
    pendulum = subject.seat(a).get("pendulum_frequency")
    known = [] if pendulum is None else [(pendulum, f"pendulum, {quantity(pendulum, 'Hz', 3)}")]
    draw = partial(motion_waterfall, run=subject.run, a=a, marks=[*known, *marks])
    return inline(draw, f"waterfall-{a.bearing}", alt, wide=True)


def _natural(subject: Subject) -> list[Mark]:
    """Bending modes of the free rotor at rest (Hz), where it is one of elements or matrices."""
    try:
        found = described(scene_shaft(subject.result.scene, subject.rotor), 0.0, MODES)
    except TouchdownError:
        return []
    bending = zip(found.frequencies, found.kinds, strict=True)
    return [(float(hertz), f"{kind}, {quantity(hertz, 'Hz', 3)}") for hertz, kind in bending if hertz > 0.0]


LANDINGS = "face_landing_time", "face_landing_speed", "peak_face_force"


def along(subject: Subject) -> Data:
    """Landings on the faces, and motion and forces along the shaft over time."""
    faced = [a for a in subject.need_seats() if has_faces(subject.run, a)]
    if not faced:
        raise Absent("no bearing has a face on which a shoulder of the rotor could land.")
    title, axis = "Force of the faces on the rotor", "force along the shaft [N]"
    return {
        "heads": heads(LANDINGS),
        "rows": [_landing(subject, a) for a in faced],
        "motions": {subject.name(a): _motion_along(subject, a) for a in faced},
        "force": series(subject.chart("face-force", title, axis, subject.lines(faced, "shoulder.force"))),
        "interval": subject.interval,
    }


def _landing(subject: Subject, a: Attachment) -> list[str]:
    gaps = [subject.setting(a, f"shoulder.gap_{side}") for side in ("minus", "plus")]
    moved = _ring(subject, a)
    return [
        subject.name(a),
        *("no face" if not gap else quantity(gap, "m", 3) for gap in gaps),
        *subject.cells(a, LANDINGS),
        quantity(subject.setting(a, "shoulder.dissipated"), "J", 3),
        quantity(None if moved is None else float(abs(moved.values).max()) / UM, "m", 3),
    ]


def shifted(subject: Subject, a: Attachment) -> np.ndarray:
    """The rotor along the shaft (m, (rows,)), against its housing."""
    return subject.run.recording[a.motion("z")] - _housing(subject, a)


def _ring(subject: Subject, a: Attachment) -> Line | None:
    """The ring along the shaft [µm]; None where the faces are fixed in the housing."""
    if not subject.has(a, "along.z"):
        return None
    return Line("inner ring", "orange", UM * (subject.values(a, "along.z") - _housing(subject, a)))


def _housing(subject: Subject, a: Attachment) -> np.ndarray | float:
    """Of the housing along the shaft (m), (rows,) or 0."""
    port = housing_port(subject.run.system, a.bearing)
    recorded = port and f"{port}.z" in subject.run.recording
    return subject.run.recording[f"{port}.z"] if recorded else 0.0


def _motion_along(subject: Subject, a: Attachment) -> Series:
    ring, seat = _ring(subject, a), subject.name(a)
    curves = [Line("rotor", "ink", UM * shifted(subject, a)), *([ring] if ring else [])]
    title = f"Along the shaft at {seat}"
    chart = subject.chart(f"along-{seat}", title, "displacement along z [µm]", curves)
    return series(chart)
