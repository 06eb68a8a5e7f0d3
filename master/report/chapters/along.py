"""Along the shaft: landings of the rotor's shoulders on the faces of the bearings."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...coupling.connections import Attachment, housing_port
from ...results.figures.motion import has_faces
from ...results.whirl.evidence import LANDING
from ..blocks import Absent, Block, Series, Table
from ..charts import series
from ..numbers import quantity
from ..series import Line
from ..subject import COLOURS, Subject

UM = 1e6
HEAD = (
    *("Seat", "Gap towards −z", "towards +z", "First landing", "at", "Largest force of a face"),
    *("Heat of the faces", "Ring along the shaft, most"),
)


def along(subject: Subject) -> list[Block]:
    """What happened at the faces, and motion and forces along the shaft over time."""
    faced = [a for a in subject.need_seats() if has_faces(subject.run, a)]
    if not faced:
        raise Absent("no bearing has a face on which a shoulder of the rotor could land.")
    rows = [_landing(subject, a) for a in faced]
    table = Table("Landings of the rotor's shoulders on the faces", list(HEAD), rows, 1)
    return [table, *(_motion(subject, a) for a in faced), _forces(subject, faced)]


def _landing(subject: Subject, a: Attachment) -> list[str]:
    gaps = [subject.setting(a, f"shoulder.gap_{side}") for side in ("minus", "plus")]
    moved = _ring(subject, a)
    return [
        subject.name(a),
        *("no face" if not gap else quantity(gap, "m", 3) for gap in gaps),
        quantity(subject.figure(LANDING, a), "s"),
        quantity(subject.figure("face_landing_speed_m_s", a), "m/s", 3),
        quantity(subject.figure("peak_face_force_N", a), "N", 3),
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


def _motion(subject: Subject, a: Attachment) -> Series:
    z = subject.run.recording[a.motion("z")] - _housing(subject, a)
    ring, seat = _ring(subject, a), subject.name(a)
    curves = [Line("rotor", "ink", UM * z), *([ring] if ring else [])]
    title = f"Along the shaft at {seat}"
    chart = subject.chart(f"along-{seat}", title, "displacement along z [µm]", curves)
    return series(chart, f"Displacement of rotor and ring along the shaft at {seat}, from the housing.")


def _forces(subject: Subject, faced: Sequence[Attachment]) -> Series:
    lines = [
        Line(subject.name(a), COLOURS[k % len(COLOURS)], subject.values(a, "shoulder.force"))
        for k, a in enumerate(faced)
    ]
    chart = subject.chart(
        "face-force", "Force of the faces on the rotor", "force along the shaft [N]", lines
    )
    return series(chart, f"Normal force between shoulder and face, recorded every {subject.interval}.")
