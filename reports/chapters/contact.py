"""Chapters on contact forces, in the bore and on the faces, on stresses and on spectra."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial

import numpy as np

from ...master.coupling.connections import Attachment, housing_port
from ...master.quantities import STRESSES, Owner, owned
from ...master.results.recording import NotRecordedError
from ...master.results.spectra import WINDOW_S, WINDOW_START_S
from ...master.results.stresses import stressed
from ...master.results.summary import is_estimated, relative_orbit
from ...master.results.whirl.evidence import touched_bore
from ..blocks import Block, Lacking, Picture, Series, Table
from ..charts import inline, series
from ..drawings import SECTORS, Presses, contact_map
from ..figures.motion import has_faces
from ..figures.spectra import has_spectrum, spectrum
from ..figures.stress import has_stress, stress
from ..layout import Absent
from ..numbers import capital, heads, listed, quantity
from ..series import Line
from ..subject import COLOURS, Subject

FORCE = "contact.force"
PEAK_RATIO = 1.02  # times the largest recorded value: a larger peak is worth a word


def forces(subject: Subject) -> list[Block]:
    """Contact force over time, and its map."""
    recorded = [a for a in subject.need_seats() if subject.has(a, FORCE)]
    if not recorded:
        raise Absent("no contact force was recorded; see run.record.")
    if subject.first_contact is None:
        raise Absent("nothing touched.")
    lines = [
        Line(subject.name(a), COLOURS[k % len(COLOURS)], subject.values(a, FORCE))
        for k, a in enumerate(recorded)
    ]
    estimated = [a.bearing for a in recorded if is_estimated(subject.run.system, a)]
    means = (
        f" Forces of {', '.join(estimated)} are estimated from means over macro steps." if estimated else ""
    )
    chart = subject.chart("force", "Contact force of the journal", "contact force [N]", lines)
    blocks: list[Block] = [
        series(
            chart,
            f"Normal force between journal and bore, recorded every {subject.interval}."
            f"{_between(subject, recorded)}{means}",
        )
    ]
    return [*blocks, *_map(subject)]


def _between(subject: Subject, recorded: Sequence[Attachment]) -> str:
    """Where a peak fell between recorded moments, that it did."""
    missed = []
    for a in recorded:
        peak, seen = subject.seat(a).get("peak_contact_force"), float(np.max(subject.values(a, FORCE)))
        if peak is not None and peak > PEAK_RATIO * seen:
            missed.append(
                f"{quantity(peak, 'N', 3)} at {subject.name(a)}, of which it has {quantity(seen, 'N', 3)}"
            )
    if not missed:
        return ""
    return (
        f" The largest force of the run fell between recorded moments: {listed(missed)}; a smaller "
        "run.record_every shows more of it."
    )


def _map(subject: Subject) -> list[Block]:
    try:
        bores = [_presses(subject, k) for k, a in enumerate(subject.seats) if subject.has(a, FORCE)]
    except NotRecordedError as error:
        return [Lacking("Where on the bore", f"{error}.")]
    if not any((bore.force > 0.0).any() for bore in bores):
        if not touched_bore(subject.summary):
            return [Lacking("Where on the bore", "the rotor touched none.")]
        return [Lacking("Where on the bore", "no recorded moment has a contact; see run.record_every.")]
    alt = "Maps of the place on the bore where the journal pressed, over time, coloured by the force"
    return [
        Picture(
            inline(partial(contact_map, bores=bores), "contact-map", alt),
            "Where the journal pressed on the bore, and when: the place as it stands in the housing, in "
            f"{SECTORS} sectors, coloured by the largest force. A whirl is a slanting line, a pendulum "
            "swings about the bottom.",
        )
    ]


def _presses(subject: Subject, seat: int) -> Presses:
    a = subject.seats[seat]
    x, y = relative_orbit(subject.run.system, a, subject.run.recording)
    title = f"{subject.name(a)} ({a.bearing})"
    return Presses(title, subject.run.recording.time, np.arctan2(y, x), subject.values(a, FORCE))


def stresses(subject: Subject) -> list[Block]:
    """Bending and shear along the shaft and over time."""
    system = subject.run.system
    rotors = stressed(system)
    if not rotors:
        raise Absent("the rotor has none: it is rigid, or known by its matrices, without diameters.")
    shown = [name for name in rotors if has_stress(system, name)]
    if not shown:
        raise Absent("the rotor kept no stress; set stress.active = 1 on it.")
    blocks: list[Block] = []
    for name in shown:
        draw = partial(stress, run=subject.run, name=name)
        alt = f"Bending and shear stress of {name} along its axis and over time"
        caption = (
            f"Stresses of {name}: along the axis both planes at the kept instant, in front of the largest "
            "resultant of the whole run, and over time the largest anywhere. Nominal: no notch factors."
        )
        blocks.append(Picture(inline(draw, f"stress-{name}", alt, wide=True), caption))
    rows = list(_peaks(subject, shown))
    return [
        Table("Largest stresses", ["Stress", "Value", "at node", "after the shutdown"], rows, 1),
        *blocks,
    ]


def _peaks(subject: Subject, rotors: list[str]) -> Iterator[list[str]]:
    for name in rotors:
        found = owned(subject.summary, Owner.COMPONENT)[name].get
        for kind in STRESSES:
            value, node, time = (found(f"peak_{kind}_stress{tail}") for tail in ("", "_node", "_time"))
            if value is not None:
                sizes = quantity(value, "Pa", 3), quantity(node, "1", 3), quantity(time, "s")
                yield [f"{capital(kind)}, {name}", *sizes]


def spectra(subject: Subject) -> list[Block]:
    """Of the inner rings' vibration after the landing."""
    shown = [a for a in subject.need_seats() if has_spectrum(subject.run.recording, a)]
    if not shown:
        raise Absent(
            f"a spectrum takes {WINDOW_S:.3g} s from {WINDOW_START_S:g} s after the shutdown on, of a "
            "bearing whose "
            "ring is recorded; this run has not that."
        )
    return [_spectrum(subject, a) for a in shown]


def _spectrum(subject: Subject, a: Attachment) -> Picture:
    alt = f"Amplitude spectra of the inner ring's horizontal velocity at {subject.name(a)}"
    svg = inline(partial(spectrum, run=subject.run, a=a), f"spectrum-{a.bearing}", alt, wide=True)
    return Picture(svg, f"Horizontal velocity of the inner ring at {subject.name(a)}, window by window.")


UM = 1e6
LANDINGS = "face_landing_time", "face_landing_speed", "peak_face_force"


def along(subject: Subject) -> list[Block]:
    """Landings on the faces, and motion and forces along the shaft over time."""
    faced = [a for a in subject.need_seats() if has_faces(subject.run, a)]
    if not faced:
        raise Absent("no bearing has a face on which a shoulder of the rotor could land.")
    rows = [_landing(subject, a) for a in faced]
    head = ["Seat", "Gap towards −z", "towards +z", *heads(LANDINGS)]
    head += ["Heat of the faces", "Ring along the shaft, most"]
    table = Table("Landings of the rotor's shoulders on the faces", head, rows, 1)
    return [table, *(_motion_along(subject, a) for a in faced), _face_forces(subject, faced)]


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
    z = subject.run.recording[a.motion("z")] - _housing(subject, a)
    ring, seat = _ring(subject, a), subject.name(a)
    curves = [Line("rotor", "ink", UM * z), *([ring] if ring else [])]
    title = f"Along the shaft at {seat}"
    chart = subject.chart(f"along-{seat}", title, "displacement along z [µm]", curves)
    return series(chart, f"Displacement of rotor and ring along the shaft at {seat}, from the housing.")


def _face_forces(subject: Subject, faced: Sequence[Attachment]) -> Series:
    lines = [
        Line(subject.name(a), COLOURS[k % len(COLOURS)], subject.values(a, "shoulder.force"))
        for k, a in enumerate(faced)
    ]
    chart = subject.chart(
        "face-force", "Force of the faces on the rotor", "force along the shaft [N]", lines
    )
    return series(chart, f"Normal force between shoulder and face, recorded every {subject.interval}.")
