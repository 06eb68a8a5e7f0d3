"""Heat of the bearings: which part takes it, how warm it gets, and what that does to the gaps."""

from __future__ import annotations

import numpy as np

from ...bearings.heat.warm_parts import AIR, FIT, SPOT, STEEL_THERMAL, STRIP
from ...master.coupling.connections import Attachment
from ...master.quantities import HEAT_PARTS
from ...master.results.heat import (
    PARTS,
    Warmed,
    has_heat,
    is_thermal,
    largest_absolute,
    warmed,
)
from ..charts import Series, series
from ..layout import Absent, Data
from ..numbers import heads, quantity
from ..series import Line
from ..subject import COLOURS, Subject

HEATS = *(f"bearing_heat_{part}" for part in PARTS), "bearing_sliding_work"
RISES = [f"temperature_rise_{part}" for part in PARTS]
ADIABATIC = [f"{key}_adiabatic" for key in RISES]
DRAWN = ("inner", "balls")  # parts whose temperatures are drawn
EVENTS = {
    "play_used_up_time": "has no play left",
    "runaway_time": "runs away",
    "seized_time": "seizes",
}
MATTERS = 0.02  # of the clearance, from which a change of a gap is worth a word
HOT = 100.0  # K; from about 120 C on rings of common steel change their size for good


def heat(subject: Subject) -> Data:
    """Heat by part, temperatures, gaps, and what they rest on. Raises Absent where none is told."""
    seats = [a for a in subject.need_seats() if has_heat(subject.run.system, a)]
    if not seats:
        raise Absent("no touchdown bearing reports its heat by part.")
    warmed_seats = [(a, one) for a in seats if (one := warmed(subject.run, a)) is not None]
    return {
        "heat_heads": heads(HEATS),
        "heats": [[subject.name(a), *subject.cells(a, HEATS)] for a in seats],
        "temperatures": _chart(subject, warmed_seats) if warmed_seats else None,
        "rise_heads": heads(RISES),
        "rises": [
            [subject.name(a), how, *subject.cells(a, keys)]
            for a, _ in warmed_seats
            for how, keys in (("as it flows", RISES), ("as if none flowed", ADIABATIC))
        ],
        "gaps": [
            [
                subject.name(a),
                *(quantity(largest_absolute(gap), "m", 3) for gap in (one.play, one.clearance)),
            ]
            for a, one in warmed_seats
        ],
        "followed": any(is_thermal(subject.run.system, a) for a, _ in warmed_seats),
        "pressed": [_pressed(subject, a, one) for a, one in warmed_seats],
        "spot": f"{100.0 * SPOT:g}",
        "strip": f"{STRIP:g}",
        "fit": f"{FIT:g}",
        "air": f"{AIR:g}",
        "conductivity": f"{STEEL_THERMAL.conductivity:g}",
        "specific": f"{STEEL_THERMAL.specific:g}",
        "expansion": f"{1e6 * STEEL_THERMAL.expansion:g}",
    }


def _chart(subject: Subject, warmed_seats: list[tuple[Attachment, Warmed]]) -> Series:
    """Temperatures of inner rings and balls over time."""
    lines, time = [], subject.run.recording.time
    for k, (a, part, one) in enumerate((a, part, one) for a, one in warmed_seats for part in DRAWN):
        curve = np.interp(time, one.time, one.warmth[:, PARTS.index(part)])
        label = f"{HEAT_PARTS[part]} at {subject.name(a)}"
        lines.append(Line(label, COLOURS[k % len(COLOURS)], curve))
    events = [
        (when, f"{subject.name(a)} {what}")
        for a, _ in warmed_seats
        for key, what in EVENTS.items()
        if (when := subject.seat(a).get(key)) is not None
    ]
    title, axis = "Temperatures above the start", "temperature rise [K]"
    chart = subject.chart("temperatures", title, axis, lines, events)
    return series(chart)


def _pressed(subject: Subject, a: Attachment, one: Warmed) -> Data:
    """The preload of the balls, and the highest temperature; "": they are no more than side matter."""
    play, rise = largest_absolute(one.play), float(one.rise.max())
    left = (subject.setting(a, "balls.play") or 0.0) + play
    matters = left < 0.0 and -play > MATTERS * one.bodies.clearance
    return {
        "seat": subject.name(a),
        "preload": quantity(-left, "m", 3) if matters else "",
        "rise": quantity(rise, "K", 3) if rise > HOT else "",
    }
