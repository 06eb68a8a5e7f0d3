"""Until when figures of a run are valid: bearings dented, seized or closed, and rubs, are not modelled.

The run goes on with the bearing as it was. Figures of later times are listed, and shown as such.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from ..coupling.connections import Attachment
from ..quantities import INVALID, Owner, Summary, enter, owned, summary_items
from .final_state import Finished
from .least_gaps import unforced
from .ratings import Rated, rated

PLASTIC = 4.6e9  # Pa, the most of ISO 76, of self-aligning balls; others keep 1e-4 of a ball from 4.2 on
PEAK, OF_PEAK = "balls.peak_force", ("largest_ball_pressure", "lowest_static_safety")
EVENTS = {
    "seized_time": "{} seizes",
    "play_used_up_time": "heat and spin use up the play of {}",
    "clearance_closed_time": "heat closes the clearance of {}",
}


def add_validity(summary: Summary, run: Finished, seats: Mapping[str, Attachment]) -> None:
    """Add until when figures are valid, why, and those of later times; `seats` by name, times in s."""
    if len(run.recording.time) < 2:  # broken off before its first step
        return
    ends = [end for name, a in seats.items() for end in _ends(run, a, name, summary[Owner.SEAT][name])]
    time, why = min([*ends, *unforced(run.scene, summary)], default=(None, None))
    enter(summary, {"valid_until": time, "invalid_because": why})
    if time is not None:
        enter(summary, {INVALID: list(_later(summary, run, seats, time))})


def _ends(
    run: Finished, a: Attachment, seat: str, values: Mapping[str, Any]
) -> Iterator[tuple[float, str]]:
    """When the bearing at a seat is no longer what it is modelled as (s), and why."""
    bearing = f"the bearing at {seat}"
    for key, words in EVENTS.items():
        if (time := values.get(key)) is not None:
            yield time, words.format(bearing)
    name = f"{a.bearing}.{PEAK}"
    one = rated(run, a) if name in run.recording else None
    if isinstance(one, Rated):
        dented = run.recording[name] > one.load_at(PLASTIC)
        if dented.any():
            time = float(run.recording.time[dented.argmax()])
            yield time, f"balls dent the races of {bearing} with more than {1e-9 * PLASTIC:g} GPa"


def _later(summary: Summary, run: Finished, seats: Mapping[str, Attachment], until: float) -> Iterator[str]:
    """Paths of the figures that are of later times than `until` (s)."""
    for item in summary_items(summary):
        one, value = item.quantity, item.of(summary)
        if value is None or one.key in EVENTS or one.owner is Owner.RUN:
            continue
        of_same = owned(summary, one.owner)[item.name]
        time = value if one.key.endswith("_time") else of_same.get(f"{one.key}_time")
        variable = PEAK if one.key in OF_PEAK else one.variable
        name = f"{seats[item.name].bearing}.{variable}" if one.owner is Owner.SEAT and variable else ""
        if time is not None:
            late = time > until
        elif late := name in run.recording:
            at = np.searchsorted(run.recording.time, until, side="right") - 1
            late = bool(run.recording[name][-1] != run.recording[name][max(at, 0)])
        if late:
            yield item.path


def invalid_from(summary: Mapping[str, Any]) -> str:
    """A sentence on figures of later times than those that are valid; empty where all are."""
    if (until := summary.get("valid_until")) is None:
        return ""
    return (
        f"Figures are valid until {until:.4g} s after the shutdown, when {summary['invalid_because']}; "
        "those of later times are marked."
    )
