"""What the journal does to its bearings: forces over time, and where on the bore."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

import numpy as np

from touchdown.master.coupling.connections import Attachment
from touchdown.master.report.facts.numbers import listed, quantity
from touchdown.master.report.facts.series import Line
from touchdown.master.report.facts.subject import COLOURS, Subject
from touchdown.master.report.page.blocks import Absent, Block, Lacking, Picture
from touchdown.master.report.pictures.charts import series
from touchdown.master.report.pictures.contact_map import SECTORS, Presses, contact_map
from touchdown.master.report.pictures.svg import inline
from touchdown.master.results.recording import NotRecordedError
from touchdown.master.results.summary import is_heard, relative_orbit

FORCE = "contact.force"
SEEN = 1.02  # times the largest recorded value: a larger peak is worth a word


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
    heard = [a.bearing for a in recorded if is_heard(subject.run.system, a)]
    means = f" Forces of {', '.join(heard)} are heard from means over macro steps." if heard else ""
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
        peak, seen = subject.figure("peak_contact_force_N", a), float(np.max(subject.values(a, FORCE)))
        if peak is not None and peak > SEEN * seen:
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
