"""What the journal does to its bearings: forces over time, and where on the bore."""

from __future__ import annotations

from functools import partial

import numpy as np

from touchdown.master.report.blocks import Absent, Block, Lacking, Picture
from touchdown.master.report.chapters.charts import series
from touchdown.master.report.numbers import quantity
from touchdown.master.report.pictures.contact_map import SECTORS, Presses, contact_map
from touchdown.master.report.series import Line
from touchdown.master.report.subject import COLOURS, Subject
from touchdown.master.report.svg import inline
from touchdown.master.results.recording import NotRecordedError
from touchdown.master.results.summary import is_heard, relative_orbit

FORCE = "contact.force"


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
    step = quantity(float(np.median(np.diff(subject.run.recording.time))), "s")
    chart = subject.chart("force", "Contact force of the journal", "contact force [N]", lines)
    blocks: list[Block] = [
        series(
            chart,
            f"Normal force between journal and bore, recorded every {step}. The largest forces in tables "
            f"count what happened between recorded moments, too, and may be a little larger.{means}",
        )
    ]
    return [*blocks, *_map(subject)]


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
            f"{SECTORS} sectors, coloured by the largest force. A whirl is a slanting line, a pendulum swings "
            "about the bottom.",
        )
    ]


def _presses(subject: Subject, seat: int) -> Presses:
    a = subject.seats[seat]
    x, y = relative_orbit(subject.run.system, a, subject.run.recording)
    title = f"{subject.name(a)} ({a.bearing})"
    return Presses(title, subject.run.recording.time, np.arctan2(y, x), subject.values(a, FORCE))
