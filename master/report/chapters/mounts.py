"""What the bearings sit in: stroke, stop, and the heat of each element."""

from __future__ import annotations

import numpy as np

from ...coupling.connections import Attachment, housing_port
from ...results.mounts import HEATS, Mounted, mounted
from ..blocks import Absent, Block, Remark, Table
from ..charts import series
from ..numbers import NONE, listed, quantity
from ..series import Line
from ..subject import COLOURS, Subject

UM = 1e6
HEAD = (
    "Seat",
    "Mount",
    "Largest stroke",
    "Stop at",
    "First reached after",
    "Times",
    "Largest force of the stop",
)


def mounts(subject: Subject) -> list[Block]:
    """Strokes over time, what the stop did, heat by element. Raises Absent without a mount."""
    told = [(a, mounted(subject.run.system, a, subject.zero)) for a in subject.need_seats()]
    found = [(a, one) for a, one in told if one is not None]
    if not found:
        raise Absent("no bearing sits in a mount; a housing on linear springs reports only its position.")
    blocks: list[Block] = []
    if lines := [line for k, (a, one) in enumerate(found) if (line := _stroke(subject, a, one, k))]:
        chart = subject.chart("stroke", "Stroke of the mounts", "stroke [µm]", lines)
        blocks.append(series(chart, "Distance of the carrier from where its mount is relaxed."))
    rows = [_row(subject, a, one) for a, one in found]
    blocks.append(Table("Strokes and stops", list(HEAD), rows, 2))
    hit = [subject.name(a) for a, one in found if one.reached is not None]
    if hit:
        blocks.append(
            Remark(
                f"At {listed(hit)} the stop was reached: from there on the mount is as stiff as its stop, "
                "and forces rest on the stop's stiffness and dissipation.",
                grave=True,
            )
        )
    if any(one.heat for _, one in found):
        blocks.append(_heat(subject, found))
    return blocks


def _stroke(subject: Subject, a: Attachment, one: Mounted, k: int) -> Line | None:
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


def _row(subject: Subject, a: Attachment, one: Mounted) -> list[str]:
    seat = [subject.name(a), one.name, quantity(one.stroke, "m", 3)]
    if one.gap is None:
        return [*seat, "no stop", NONE, NONE, NONE]
    reached = "not reached" if one.reached is None else quantity(one.reached, "s")
    force = NONE if one.reached is None else quantity(one.stop_force, "N", 3)
    return [*seat, quantity(one.gap, "m", 3), reached, f"{one.hits:d}", force]


def _heat(subject: Subject, found: list[tuple[Attachment, Mounted]]) -> Table:
    kinds = [name for name in HEATS if any(name in one.heat for _, one in found)]
    rows = [
        [subject.name(a), *(quantity(one.heat.get(name), "J", 3) for name in kinds)] for a, one in found
    ]
    return Table("Heat in the mounts, by what makes it", ["Seat", *(HEATS[k] for k in kinds)], rows, 1)
