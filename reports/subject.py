"""The subject of a report: a run, and quantities that several chapters use."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import cycle
from typing import Any

import numpy as np

from ..master.common.errors import TouchdownError
from ..master.coupling.connections import Attachment
from ..master.coupling.loop.span import zero_of
from ..master.quantities import FIRST_IMPACTS, INVALID, SPREAD, Item, Owner, first_touch, named, owned
from ..master.results.final_state import Finished
from ..master.results.headline import since_origin
from ..master.results.ratings import Origin
from ..master.results.result import Result
from ..master.results.summary import seat_name, touchdown_seats
from ..master.scene.run_spec import RunSpec
from ..master.scene.scene import Scene
from .layout import Absent
from .numbers import quantity
from .series import Chart, Line, chosen_rows


def run_origin(scene: Scene, key: str) -> Origin:
    """Of a key of [run]."""
    if key in scene.own:
        return Origin.SET
    return Origin.DEFAULT if getattr(scene.run, key) == getattr(RunSpec(), key) else Origin.SCENE


COLOURS = ("blue", "orange", "green", "purple", "grey", "ink")
SHOWN_IMPACT = (0.002, 0.018)  # s before and after the first contact
FIRST_OF = {  # of a peak of the whole drop the one of its first impact
    **{peak.key: first for first, peak in FIRST_IMPACTS.items()},
    "peak_ball_force": "first_impact_ball_force",
    "peak_bending_stress": "first_impact_bending_stress",
}


@dataclass(frozen=True)
class Subject:
    """A run that is over."""

    result: Result

    @cached_property
    def run(self) -> Finished:
        """As pictures take it."""
        return Finished(self.result.scene, self.result.ending, self.result.recording)

    @property
    def summary(self) -> Mapping[str, Any]:
        """The quantities of the run."""
        return self.result.summary

    @cached_property
    def seats(self) -> list[Attachment]:
        """Where a journal can touch down, in the scene's order."""
        return touchdown_seats(self.result.ending)

    @cached_property
    def zero(self) -> float:
        """When the scene's zero was (s on the simulation's clock)."""
        try:
            return zero_of(self.result.scene, self.result.ending)
        except TouchdownError:  # a component that failed tells nothing any more
            return 0.0

    @property
    def length(self) -> float:
        """How long the run was (s): from the scene's zero on, or from its start where it names none."""
        return since_origin(self.run, float(self.run.recording.time[-1]))

    @property
    def fall(self) -> float | None:
        """How long it was until the first contact (s), counted as `length`; None: nothing touched."""
        return None if self.first_contact is None else since_origin(self.run, self.first_contact)

    @property
    def rotor(self) -> str:
        """The body that drops: the first that a touchdown bearing can catch."""
        return self.need_seats()[0].body

    def need_seats(self) -> list[Attachment]:
        """The seats. Raises Absent where there are none."""
        if not self.seats:
            raise Absent("the scene has no touchdown bearing that reports its contact.")
        return self.seats

    def name(self, a: Attachment) -> str:
        """Of a seat, for people, such as A."""
        return seat_name(a, self.seats)

    def seat(self, a: Attachment) -> Mapping[str, Any]:
        """The quantities of a seat."""
        return owned(self.summary, Owner.SEAT).get(self.name(a), {})

    def cells(self, a: Attachment, keys: Sequence[str]) -> list[str]:
        """Quantities of a seat with their units, for a table."""
        units = [named(key)[0].unit for key in keys]
        values = zip(map(self.seat(a).get, keys), units, strict=True)
        shown = [quantity(value, unit, 4 if unit == "s" else 3) for value, unit in values]
        late = self.summary.get(INVALID) or ()
        paths = (f"{Owner.SEAT}.{self.name(a)}.{key}" for key in keys)
        return [
            f"{one} (not valid)" if path in late else one for one, path in zip(shown, paths, strict=True)
        ]

    def firmness(self, item: Item) -> str:
        """The reliability of a peak of the drop: its spread over siblings, or that it has none.

        "": there is no peak.
        """
        spread, one = self.summary.get(SPREAD), item.quantity
        if spread is not None and (over := spread["quantities"].get(item.path)) is not None:
            least, median, most = (quantity(over[key], one.unit) for key in ("least", "median", "most"))
            count = spread["siblings"] + 1
            return f"{least} to {most}, median {median}, over {count} drops started nanometres apart"
        values = owned(self.summary, one.owner)[item.name]
        if values.get(one.key) is None or self.first_contact is None:
            return ""
        if one.key in FIRST_OF.values() or values.get(FIRST_OF.get(one.key, "")) == values[one.key]:
            return "in the first impact"
        return "one draw of a chaotic drop"

    def has(self, a: Attachment, variable: str) -> bool:
        """Whether a bearing's variable was recorded."""
        return f"{a.bearing}.{variable}" in self.run.recording

    def values(self, a: Attachment, variable: str) -> np.ndarray:
        """A bearing's variable over the recorded times, (rows,), in SI."""
        return self.run.recording[f"{a.bearing}.{variable}"]

    def lines(self, seats: Sequence[Attachment], variable: str) -> list[Line]:
        """A variable of the bearings at some seats, each in a colour of its own."""
        colours = zip(seats, cycle(COLOURS), strict=False)
        return [Line(self.name(a), colour, self.values(a, variable)) for a, colour in colours]

    def setting(self, a: Attachment, variable: str) -> float | None:
        """A bearing's parameter or output at the end; None where it has none of that name."""
        name = f"{a.bearing}.{variable}"
        return self.run.system.value(name) if name in self.run.system else None

    @cached_property
    def first_contact(self) -> float | None:
        """The first anywhere, of a journal or a shoulder (s from the zero); None: nothing touched."""
        return first_touch(self.result.summary)

    def rolls(self, a: Attachment) -> str:
        """When the inner ring rolls with the rotor, and until when, for people."""
        sync, seized = map(self.seat(a).get, ("ring_sync_time", "seized_time"))
        words = "not in this run" if sync is None else quantity(sync, "s")
        return words if seized is None else f"{words}, until it seizes at {quantity(seized, 's', 3)}"

    def chart(
        self,
        name: str,
        title: str,
        axis: str,
        curves: list[Line],
        events: Sequence[tuple[float, str]] = (),
    ) -> Chart:
        """A chart of curves that have a value for each recorded time, and of `events` (s, what)."""
        time = self.run.recording.time
        rows = chosen_rows(time, [c.values for c in curves], self.first_contact)
        kept = [replace(c, values=c.values[rows]) for c in curves]
        return Chart(name, title, axis, time[rows], kept, self.impact, events)

    @cached_property
    def impact(self) -> tuple[float, float] | None:
        """The surroundings of the first contact (s)."""
        if self.first_contact is None:
            return None
        before, after = SHOWN_IMPACT
        return self.first_contact - before, self.first_contact + after

    @property
    def interval(self) -> str:
        """From one recorded moment to the next, for people."""
        time = self.run.recording.time
        return quantity(float(np.median(np.diff(time))), "s") if len(time) > 1 else "moment"
