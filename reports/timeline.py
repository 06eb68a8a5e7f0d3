"""What happened in a run, in its order: a strip with a lane for the rotor, for each seat and for gaps."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter

from ..master.common.errors import Ended
from ..master.common.text import UM
from ..master.coupling.connections import Attachment
from ..master.quantities import Owner, owned
from ..master.results.capture import captures
from ..master.results.whirl.contacts import WhirlDirection
from .figures.style import BLACK, BLUE, GREY, ORANGE, PURPLE, RED, apart, label_width, sized
from .numbers import quantity, speed
from .subject import Subject

OF_SEAT = {  # times of a seat, and whether what happens is a fault
    "first_contact_time": ("first contact", False),
    "face_landing_time": ("lands on a face", False),
    "ring_sync_time": ("ring as fast as the rotor", False),
    "stop_reached_time": ("mount at its stop", True),
    "play_used_up_time": ("play used up", True),
    "clearance_closed_time": ("clearance closed", True),
    "runaway_time": ("heat runs away", True),
    "seized_time": ("ring seizes", True),
    "ring_stop_time": ("ring stands still", True),
    "settling_time": ("settled", False),
}
MOST_GAPS = 6  # told
MOST_WHIRLS = 2  # of a seat with words of their own, those with most turns
WHIRL_COLOURS = {WhirlDirection.FORWARD.value: PURPLE, WhirlDirection.BACKWARD.value: ORANGE}
STOOD = 0.01  # of the first speed: a rotor that is slower stands still


@dataclass(frozen=True)
class Event:
    """Something that happens at a time (s)."""

    time: float
    words: str
    grave: bool = False


@dataclass(frozen=True)
class Lane:
    """What happens to the rotor, at a seat or in gaps: in order."""

    name: str
    events: Sequence[Event]
    whirls: Sequence[tuple[float, float, str]] = ()  # s, s, direction
    contacts: np.ndarray | None = None  # (n, 2), s


def lanes(subject: Subject) -> list[Lane]:
    """Of the rotor, of each seat, and of gaps where there are."""
    seats = [_of_seat(subject, a) for a in subject.seats]
    return [Lane("rotor", list(_of_rotor(subject))), *seats, *_of_gaps(subject)]


def _of_rotor(subject: Subject) -> Iterator[Event]:
    """From the shutdown to the end, with the speeds there."""
    time, told = subject.run.recording.time, subject.summary
    spin = subject.run.recording[subject.seats[0].motion("omega")]
    if time[0] <= 0.0:
        yield Event(0.0, f"shutdown\n{speed(float(np.interp(0.0, time, spin)))}")
    if (command := told.get("capture_command_time")) is not None:
        yield Event(command, "to be levitated")
    if (late := told.get("valid_until")) is not None:
        yield Event(late, "no figure is valid from here", True)
    stopped = subject.result.ended in (Ended.STOPPED, Ended.DIED)
    stands = abs(spin[-1]) < STOOD * np.max(np.abs(spin))
    how = "stopped" if stopped else "standstill" if stands else "end"
    yield Event(float(time[-1]), f"{how}\n{speed(float(spin[-1]))}", stopped)


def _of_seat(subject: Subject, a: Attachment) -> Lane:
    """Events, whirls and contacts of a seat."""
    seat, name = subject.seat(a), subject.name(a)
    events = [
        Event(when, words, grave)
        for key, (words, grave) in OF_SEAT.items()
        if (when := seat.get(key)) is not None
    ]
    found = captures(subject.summary).get(name)
    if found is not None and found.after is not None:
        events.append(Event(subject.summary["capture_command_time"] + found.after, "captured"))
    whirls = seat.get("whirl_episodes") or []
    for one in sorted(whirls, key=lambda one: -one["revolutions"])[:MOST_WHIRLS]:
        until = "to the end" if one["goes_on"] else f"until {quantity(one['end'], 's', 3)}"
        words = f"{one['direction']} whirl {until}, {quantity(one['frequency'], 'Hz', 3)}"
        events.append(Event(one["start"], words))
    contacts = _contacts(subject, a)
    count = "" if contacts is None else f"\n{len(contacts)} contacts"
    title = name if name == a.bearing else f"{name} ({a.bearing})"
    spans = [(one["start"], one["end"], one["direction"]) for one in whirls]
    return Lane(f"{title}{count}", sorted(events, key=lambda e: e.time), spans, contacts)


def _contacts(subject: Subject, a: Attachment) -> np.ndarray | None:
    """Spans in which the recorded contact force is above zero (n, 2), s; None: it was not recorded."""
    if not subject.has(a, "contact.force"):
        return None
    edges = np.diff(np.concatenate([[0], subject.values(a, "contact.force") > 0.0, [0]]).astype(int))
    time = np.append(subject.run.recording.time, subject.run.recording.time[-1])
    return np.stack([time[:-1][edges[:-1] > 0], time[np.flatnonzero(edges < 0)]], axis=1)


def _of_gaps(subject: Subject) -> Iterator[Lane]:
    """The tightest gaps, when they were; and when they closed first."""
    gaps = {name: gap for name, gap in owned(subject.summary, Owner.GAP).items() if gap.get("least")}
    events = [
        Event(gap["least_time"], f"{name}\n{UM * gap['least']:.3g} µm left")
        if gap.get("closed_time") is None
        else Event(gap["closed_time"], f"{name} closed", True)
        for name, gap in sorted(gaps.items(), key=lambda one: one[1]["least"])[:MOST_GAPS]
    ]
    if events:
        yield Lane("gaps", sorted(events, key=lambda e: e.time))


WIDTH, LANE = 7.6, 0.84  # inch
WORDS = 18  # letters in a line


def timeline(figure: Figure, found: Sequence[Lane], end: float) -> list[Axes]:
    """The lanes below each other, over the logarithm of time from the first event on, linear before it."""
    axes = sized(figure, 9.4, 0.7 + LANE * len(found)).subplots()
    begin = min([0.0, *(e.time for lane in found for e in lane.events)])
    end = max(end, 2e-6)  # a run may end at the shutdown
    first = min((e.time for lane in found for e in lane.events if e.time > 0.0), default=end)
    linear = 0.7 * max(first, 1e-6)
    axes.set_xscale("symlog", linthresh=linear, linscale=0.4)
    axes.set_xlim(begin, end)
    axes.set_ylim(-len(found) + 0.7, 0.85)
    for k, lane in enumerate(found):
        _draw_lane(axes, lane, -float(k))
    axes.set_yticks(-np.arange(len(found)), [lane.name for lane in found])
    axes.tick_params("y", length=0)
    axes.spines["left"].set_visible(False)
    axes.set_xticks([0.0, *(tick for tick in _round(linear, end) if linear <= tick <= end)])
    axes.minorticks_off()
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: quantity(value, "s", 3)))
    axes.set_xlabel("time from the shutdown")
    return [axes]


def _round(first: float, last: float) -> Iterator[float]:
    """Powers of ten about a range; of a short one twice and five times that, too."""
    low, high = math.floor(math.log10(first)), math.ceil(math.log10(last))
    for decade in range(low, high + 1):
        yield from (step * 10.0**decade for step in ((1.0,) if high - low > 3 else (1.0, 2.0, 5.0)))


def _draw_lane(axes: Axes, lane: Lane, y: float) -> None:
    axes.axhline(y, color=GREY, lw=0.6, zorder=0)
    if lane.contacts is not None:
        spans = [(begin, end - begin) for begin, end in lane.contacts]
        axes.broken_barh(spans, (y - 0.09, 0.18), color=BLUE, alpha=0.5, label="_contacts", rasterized=True)
    for start, stop, direction in lane.whirls:
        colour = WHIRL_COLOURS[direction]
        axes.broken_barh([(start, stop - start)], (y - 0.2, 0.09), color=colour, label=f"_{direction}")
    lines = [[*e.words.split("\n"), quantity(e.time, "s", 3)] for e in lane.events]
    wrapped = ["\n".join(textwrap.fill(line, WORDS) for line in one) for one in lines]
    places = _fraction(axes, np.array([e.time for e in lane.events]))
    moved = apart(places, [label_width(one) / WIDTH for one in wrapped], -0.05, 1.05)
    for event, words, place in zip(lane.events, wrapped, moved, strict=True):
        colour = RED if event.grave else BLACK
        axes.plot(event.time, y, "o", color=colour, ms=4, clip_on=False, zorder=4)
        line = {"arrowstyle": "-", "color": GREY, "lw": 0.5, "shrinkB": 2}
        axes.annotate(
            words, (event.time, y), (place, y + 0.25), textcoords=("axes fraction", "data"), ha="center",
            va="bottom", fontsize="x-small", color=colour, arrowprops=line,
        )  # fmt: skip


def _fraction(axes: Axes, time: np.ndarray) -> np.ndarray:
    """Where times (s) are along the strip, 0 to 1."""
    scale = axes.xaxis.get_transform().transform_non_affine
    low, high = np.asarray(scale(np.array(axes.get_xlim())))
    return (np.asarray(scale(time)) - low) / (high - low)
