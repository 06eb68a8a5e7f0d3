"""Heat of the bearings: which part takes it, how warm it gets, and what that does to the gaps."""

from __future__ import annotations

import numpy as np

from ...bearings.heat.bodies import AIR, FIT, SPOT, STEEL_THERMAL, STRIP
from ...master.coupling.connections import Attachment
from ...master.quantities import HEAT_PARTS
from ...master.results.heat import (
    PARTS,
    Warmed,
    has_heat,
    heat_warnings,
    is_thermal,
    largest,
    warmed,
)
from ..blocks import Block, Folded, Points, Remark, Series, Table, Text
from ..charts import series
from ..layout import Absent
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
NOT_FOLLOWED = (
    "The run's own gaps stayed as they were at the start; with thermal = 1 of a bearing they follow its "
    "temperatures."
)
FOLLOWED = "Where thermal = 1, the gaps followed these temperatures in the run."
ASSUMED = (
    "Each contact shares its heat alike between the two parts that touch: rolling heats the inner ring "
    "with a quarter, the balls with half, and the outer ring with a quarter.",
    "Each part is as warm all through; a race under its balls is warmer than the ring behind it.",
    "The journal takes up heat over the width of the bearing; the shaft leads it away over two diameters "
    "on either side, which stay cold.",
    "The outer ring has the inner one's section.",
    f"Half of the balls touch either race, in spots with a radius of {100.0 * SPOT:g} % of a ball's "
    f"diameter; the journal touches its bore all the time, along a strip of half-width {STRIP:g} of its "
    "radius.",
    f"The outer ring's fit passes {FIT:g} W/(m² K), the housing's surface, a cube of steel of its mass, "
    f"{AIR:g} W/(m² K); a housing held fixed stays cold. No heat leaves by the air in the bearing.",
    f"Thermal constants are rounded, and from memory: steel {STEEL_THERMAL.conductivity:g} W/(m K), "
    f"{STEEL_THERMAL.specific:g} J/(kg K), {1e6 * STEEL_THERMAL.expansion:g}·10⁻⁶ 1/K.",
    "The housing lets the outer ring grow.",
)


def heat(subject: Subject) -> list[Block]:
    """Heat by part, temperatures, gaps, and what they rest on. Raises Absent where none is told."""
    seats = [a for a in subject.need_seats() if has_heat(subject.run.system, a)]
    if not seats:
        raise Absent("no touchdown bearing reports its heat by part.")
    rows = [[subject.name(a), *subject.cells(a, HEATS)] for a in seats]
    blocks: list[Block] = [Table("Heat by the part that takes it", ["Seat", *heads(HEATS)], rows, 1)]
    warmed_seats = [(a, one) for a in seats if (one := warmed(subject.run, a)) is not None]
    if not warmed_seats:
        return [*blocks, Text("Temperatures need a bearing with balls whose heat was recorded.")]
    rows = [
        [subject.name(a), how, *subject.cells(a, keys)]
        for a, _ in warmed_seats
        for how, keys in (("as it flows", RISES), ("as if none flowed", ADIABATIC))
    ]
    return [
        *blocks,
        _chart(subject, warmed_seats),
        Table("Highest temperatures above the start", ["Seat", "Heat", *heads(RISES)], rows, 2),
        Table(
            "Largest change of the gaps by these temperatures",
            ["Seat", "Radial play of the balls", "Radial clearance of the journal"],
            [
                [subject.name(a), *(quantity(largest(gap), "m", 3) for gap in (one.play, one.clearance))]
                for a, one in warmed_seats
            ],
            1,
        ),
        Text(FOLLOWED if any(is_thermal(subject.run.system, a) for a, _ in warmed_seats) else NOT_FOLLOWED),
        *(Remark(f"{text}.", grave=True) for text in heat_warnings(subject.run, seats)),
        *_gap_warnings(subject, warmed_seats),
        Folded("What the temperatures rest on: assumptions, none of them measured", [Points(ASSUMED)]),
    ]


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
    return series(chart, "Temperatures of inner rings and balls above the start, worked out from the heat.")


def _gap_warnings(subject: Subject, warmed_seats: list[tuple[Attachment, Warmed]]) -> list[Block]:
    """Where gaps or temperatures are no side matter."""
    blocks: list[Block] = []
    for a, one in warmed_seats:
        play = largest(one.play)
        left = (subject.setting(a, "balls.play") or 0.0) + play
        if left < 0.0 and -play > MATTERS * one.bodies.clearance:
            blocks.append(
                Remark(
                    f"At {subject.name(a)} the balls would be pressed between the rings by "
                    f"{quantity(-left, 'm', 3)} of preload, which brakes them and warms them further."
                )
            )
        if (rise := float(one.rise.max())) > HOT:
            blocks.append(
                Remark(f"At {subject.name(a)} a part gets warmer by {quantity(rise, 'K', 3)}.", grave=True)
            )
    return blocks
