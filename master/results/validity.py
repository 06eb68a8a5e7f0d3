"""Until when figures of a run are valid: bearings dented, seized or closed, and rubs, are not modelled.

The run goes on with the bearing as it was. Figures of later times are listed, and shown as such.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from ..coupling.connections import Attachment
from ..quantities import (
    FIRST_IMPACT,
    FIRST_IMPACTS,
    INVALID,
    Group,
    Item,
    Owner,
    Summary,
    enter,
    owned,
    summary_items,
)
from ..scene.requirements import limited
from .final_state import Finished
from .least_gaps import unforced
from .ratings import Rated, rated

PEAK, OF_PEAK = "balls.peak_force", ("largest_ball_pressure", "lowest_static_safety", "bearing_ends_by")
EVENTS = {
    "seized_time": "{} seizes",
    "play_used_up_time": "heat and spin use up the play of {}",
    "clearance_closed_time": "heat and spin close the clearance of {}",
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
        limit = one.bearing.pressure_limit
        dented = run.recording[name] > one.load_at(limit)
        if dented.any():
            time = float(run.recording.time[dented.argmax()])
            yield time, f"balls dent the races of {bearing} with more than {1e-9 * limit:g} GPa"


def _later(summary: Summary, run: Finished, seats: Mapping[str, Attachment], until: float) -> Iterator[str]:
    """Paths of the figures that are, or may be, of later times than `until` (s)."""
    late = [
        i
        for i in summary_items(summary)
        if i.of(summary) is not None and _is_late(i, summary, run, seats, until)
    ]
    keys, paths = {item.quantity.key for item in late}, {item.path for item in late}
    for item in late:  # a margin is as valid as what is limited, the verdict as all margins
        names = [item.name] if item.name else owned(summary, Owner.REQUIREMENT)
        invalid = (
            one.path in paths or (not one.name and one.quantity.key in keys) for one in map(limited, names)
        )
        if item.quantity.group is not Group.REQUIREMENTS or any(invalid):
            yield item.path


def _is_late(
    item: Item, summary: Summary, run: Finished, seats: Mapping[str, Attachment], until: float
) -> bool:
    """Whether a figure is not known to be of times up to `until` (s)."""
    one, name, key = item.quantity, item.name, item.quantity.key
    if (one.group in (Group.DROP, Group.NUMERICS) and key != "speed_end") or key == "capture_command_time":
        return False  # a fact of the run itself
    values, timed_by = owned(summary, one.owner)[name], one.timed_by
    if key.startswith("least_gap"):
        values, timed_by = (
            owned(summary, Owner.GAP).get(summary.get("least_gap_at") or "", {}),
            "least_time",
        )
    time = values.get(timed_by)
    if time is not None and one.group is not Group.LEVITATION:  # whose times count from the command
        return time > until
    variable = PEAK if key in OF_PEAK else FIRST_IMPACTS.get(key, one).variable
    if one.owner is Owner.COMPONENT and key.startswith(FIRST_IMPACT):
        variable = f"stress.peak_{key.removeprefix(FIRST_IMPACT).removesuffix('_stress')}"
    source = f"{seats[name].bearing if name in seats else name}.{variable}"
    if source not in run.recording:
        return True
    rows = run.recording[source]
    then = rows[max(np.searchsorted(run.recording.time, until, side="right") - 1, 0)]
    is_first = key.startswith(FIRST_IMPACT) and not one.variable
    return bool(item.of(summary) > then if is_first else rows[-1] != then)


def invalid_from(summary: Mapping[str, Any], said: str = "") -> str:
    """A sentence on figures of later times than those that are valid; empty where all are.

    The reason is left out where it stands in what is `said` before.
    """
    if (until := summary.get("valid_until")) is None:
        return ""
    why = "" if (because := summary["invalid_because"]) in said else f", when {because}"
    return (
        f"Figures are valid until {until:.4g} s after the shutdown{why}; those of later times are marked."
    )
