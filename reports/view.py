"""The viewer of a run: all of it as it moves, linked to curves, on a page that needs nothing beside it.

Frames are recorded rows, dense where what is drawn moves far or a force changes, sparse elsewhere.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import replace
from itertools import cycle

import numpy as np

from ..master.common.errors import TouchdownError
from ..master.common.text import UM
from ..master.coupling.connections import Attachment
from ..master.results.least_gaps import left_of
from ..master.results.recording import NotRecordedError
from ..master.results.result import Result
from ..master.results.summary import relative_orbit
from ..master.scene.gaps import RotorGap
from .chapters.bearings import RING, speed_lines
from .chapters.contact import FORCE, force_lines, shifted
from .figures.forces import true_peak
from .figures.motion import has_faces
from .layout import Absent
from .motion import LEAD_TIME, TIME_STRETCHES, Pace, motions, moving
from .numbers import quantity
from .page import Page, headed
from .series import Chart, Line, about_impact, chosen_rows
from .subject import COLOURS, Subject
from .timeline import lanes

VIEW = "view.html"
FRAMES = 30_000  # of all seats together, beside those of the first impact
EVENLY = 0.3  # of them: evenly over time, the others by what happens
CALM_LENGTH = 40.0  # s on the screen that a run takes beside its first impact, if no slower than that


def view_of(result: Result) -> Page:
    """The viewer's page. Raises TouchdownError where there is nothing to show."""
    subject = Subject(result)
    try:
        rows = _frames(subject)
        shown, lacking = motions(subject, (subject.run.recording.time[rows], _pace(subject)))
    except (Absent, NotRecordedError) as error:
        shown, lacking = [], [str(error)]
    if not shown:
        raise TouchdownError(f"there is no drop to show: {' '.join(lacking)}")
    data = {
        "moving": moving(shown, _begin(subject)),
        "undrawn": lacking,
        "moments": sorted(_moments(subject)),
        "charts": list(_charts(subject, rows)),
    }
    return headed(subject, "A rotor drop as it moves", template="view.html", data=data)


# -- moments ------------------------------------------------------------------------------------------


def _frames(subject: Subject) -> np.ndarray:
    """The recorded rows that are drawn (ascending)."""
    time = subject.run.recording.time
    count = FRAMES // len(subject.need_seats())
    if len(time) <= count:
        return np.arange(len(time))
    drawn = [column for a in subject.seats for column in _drawn(subject, a)]
    way = np.zeros(len(time))
    way[1:] = np.cumsum(sum(np.abs(np.diff(column)) for column in drawn))
    gone = (time - time[0]) / (time[-1] - time[0])
    share = EVENLY * gone + (1.0 - EVENLY) * way / (way[-1] or 1.0)
    picked = np.searchsorted(share, np.linspace(0.0, share[-1], count))
    peaks = [find(column) for column in drawn for find in (np.argmin, np.argmax)]
    whole = about_impact(time, subject.first_contact)
    return np.unique(np.concatenate([whole, peaks, np.minimum(picked, len(time) - 1)]))


def _drawn(subject: Subject, a: Attachment) -> Iterator[np.ndarray]:
    """What moves at a seat, and the forces, each (rows,), over the most that it does."""
    recording = subject.run.recording
    columns = [*relative_orbit(subject.run.system, a, recording)]
    names = [a.load(f"f{axis}") for axis in "xyz"] + ([a.motion("z")] if has_faces(subject.run, a) else [])
    columns += [recording[name] for name in names if name in recording]
    for column in map(np.nan_to_num, columns):
        yield column / (np.abs(column).max() or 1.0)


def _begin(subject: Subject) -> float:
    """From where it is played (s)."""
    first, start = subject.first_contact, float(subject.run.recording.time[0])
    return start if first is None else max(start, first - LEAD_TIME)


def _pace(subject: Subject) -> Pace:
    """As of a film through the first impact, and faster before and after it."""
    time, first = subject.run.recording.time, subject.first_contact
    last = float(time[-1])
    calm = max(1.0, CALM_LENGTH / max(last - float(time[0]), CALM_LENGTH / TIME_STRETCHES[-1][0]))
    pace = [(calm, last)]
    if first is not None:
        slow = ((factor, first + after) for factor, after in TIME_STRETCHES)
        pace = [(calm, first - LEAD_TIME), *slow, (calm, max(last, first + TIME_STRETCHES[-1][1]))]
    return tuple(pace)


def _moments(subject: Subject) -> Iterator[tuple[float, str, bool]]:
    """When (s) something happens, what, and whether it is a fault."""
    for lane in lanes(subject):
        name = re.split(r" \(|\n", lane.name)[0]
        for event in lane.events:
            yield event.time, f"{name}: {' '.join(event.words.split())}", event.grave
    for a in subject.seats:
        if (found := true_peak(subject.run.recording, a.bearing, FORCE)) is not None:
            row, peak = found
            when = float(subject.run.recording.time[row])
            yield when, f"{subject.name(a)}: largest force, {quantity(peak, 'N', 3)}", False


# -- curves -------------------------------------------------------------------------------------------


def _charts(subject: Subject, frames: np.ndarray) -> Iterator[Chart]:
    """Forces, displacements, gaps and speeds, where recorded, at the frames and their extremes."""
    time = subject.run.recording.time
    for name, title, axis, find in (
        ("force", "Contact force", "contact force [N]", _forces),
        ("displacement", "Displacement of the rotor", "displacement [µm]", _displacements),
        ("gaps", "Gaps left", "gap [µm]", _gaps),
        ("speeds", "Speeds", "speed [rpm]", _speeds),
    ):
        try:
            lines = find(subject)
        except NotRecordedError:
            continue
        if lines:
            columns = [one.values for one in lines]
            rows = np.union1d(frames, chosen_rows(time, columns, subject.first_contact))
            kept = [replace(one, values=one.values[rows]) for one in lines]
            yield Chart(name, title, axis, time[rows], kept, subject.impact)


def _forces(subject: Subject) -> list[Line]:
    """Of the bores, with their peaks, and of the faces."""
    faced = [a for a in subject.seats if has_faces(subject.run, a)]
    faces = [(f"{subject.name(a)}, along", subject.values(a, "shoulder.force")) for a in faced]
    lines = force_lines(subject, [a for a in subject.seats if subject.has(a, FORCE)])
    return lines + _coloured(faces, len(subject.seats))


def _displacements(subject: Subject) -> list[Line]:
    """From the bearing's middle, and along the shaft."""
    found = []
    for a in subject.seats:
        x, y = relative_orbit(subject.run.system, a, subject.run.recording)
        found.append((f"{subject.name(a)}, from the middle", UM * np.hypot(x, y)))
    faced = [a for a in subject.seats if has_faces(subject.run, a)]
    return _coloured(found + [(f"{subject.name(a)}, along", UM * shifted(subject, a)) for a in faced])


def _gaps(subject: Subject) -> list[Line]:
    """At the scene's gaps."""
    return _coloured([(gap.name, UM * _least_left(subject, gap)) for gap in subject.run.scene.gaps])


def _least_left(subject: Subject, gap: RotorGap) -> np.ndarray:
    """The size of a gap (m, (rows,)), the least until the next recorded time."""
    left, rows = left_of(gap, subject.run.recording).left, len(subject.run.recording.time)
    return np.minimum.reduceat(left, np.arange(rows) * ((len(left) - 1) // max(1, rows - 1)))


def _speeds(subject: Subject) -> list[Line]:
    """Of rotor, rings and balls."""
    return speed_lines(subject, [a for a in subject.seats if subject.has(a, RING)])


def _coloured(named: list[tuple[str, np.ndarray]], first: int = 0) -> list[Line]:
    """Curves in colours of their own, from the `first` on."""
    colours = cycle(COLOURS[first % len(COLOURS) :] + COLOURS[:first])
    return [Line(name, colour, values) for (name, values), colour in zip(named, colours, strict=False)]
