"""Gaps that a rotor must not close: a place on it, and how far it may go there.

A gap is watched only. One that knows the rotor's radius there, `journal_radius`, acts as well: the scene
gets a `bushing` of that clearance at the same places, by the gap's key.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from ...modelkit.reader import Table, key, number
from .tables import NAMED, as_table, is_list, naming

ACTS_AS = "bushing"
SIZE = number("m", above=0.0, size=(0.0, 0.02), example="0.4 mm")  # above 20 mm it cannot be meant


@dataclass(frozen=True)
class RotorGap:
    """A gap between a port of a rotor and what stands around it, across the shaft or along it."""

    name: str = key(NAMED)
    at: str = key(naming("a place on a rotor", "rotor.amb_A"))
    radial: float | None = key(SIZE, None, "across the shaft; or axial")
    stator: str | None = key(
        naming("a place", "housing_A.seat"), None, "the part that it moves with; else it stands in space"
    )
    journal_radius: float | None = key(
        number("m", above=0.0), None, "of the rotor there: touching acts; else the gap is watched only"
    )
    axial: float | None = key(SIZE, None, "along the shaft, in both directions; in place of radial")
    radius: float | None = key(
        number("m", above=0.0), None, "of the face of an axial gap, at which tilt closes it, too"
    )

    @property
    def size(self) -> float:
        """Across the shaft or along it (m)."""
        return self.radial or self.axial or 0.0

    @property
    def motions(self) -> tuple[str, ...]:
        """What closes it, by the names of a port's variables."""
        along = ("z",) if self.radius is None else ("z", "rx", "ry")
        return ("x", "y") if self.axial is None else along

    @property
    def key(self) -> str:
        """The component that it is where it acts."""
        return _key(self.name)

    @property
    def acts(self) -> bool:
        """Whether the scene has a bushing there; else the gap is watched only."""
        return self.journal_radius is not None


def _key(name: str) -> str:
    return "gap_" + re.sub(r"[ -]", "_", name)


def read_gaps(tables: Iterable[Table]) -> tuple[RotorGap, ...]:
    """The [[gap]] tables of a scene. Raises TouchdownError."""
    found: dict[str, RotorGap] = {}
    for t in tables:
        gap = t.read(RotorGap)
        t.require((gap.radial is None) != (gap.axial is None), "name", "needs one of radial and axial")
        t.require(gap.axial is None or not gap.acts, "journal_radius", "is of a radial gap; leave it out")
        t.require(gap.axial is not None or gap.radius is None, "radius", "is of an axial gap; leave it out")
        t.require(gap.key not in found, "name", "is there twice; give each gap a name of its own")
        found[gap.key] = gap
    return tuple(found.values())


def of_rotor(component: str, value: object) -> list[object]:
    """The [[gap]] tables of a rotor's file as a scene has them, at stations of the `component`.

    One with a node or a position has a station of its own there, of the gap's key.
    """
    found: list[object] = []
    for one in value if is_list(value) else []:
        table = as_table(one)
        place = table.get("station", _key(str(table.get("name"))))  # what is wrong the rotor's reader says
        rest = {key: item for key, item in table.items() if key not in ("station", "node", "position")}
        found.append(rest | {"at": f"{component}.{place}"})
    return found


def laid_over(before: object, over: object) -> object:
    """The [[gap]] tables `before`, of the file that is extended, and those `over` them, by their names."""
    if not is_list(before) or not is_list(over):
        return over
    names = [as_table(one).get("name") for one in over]
    return [one for one in before if as_table(one).get("name") not in names] + over


def contacts_of(found: Sequence[RotorGap]) -> tuple[dict[str, Mapping[str, object]], list[tuple[str, str]]]:
    """Components of the gaps that act, as [components] has them, and what they are attached to."""
    acting = [gap for gap in found if gap.acts]
    components: dict[str, Mapping[str, object]] = {
        gap.key: {
            "fmu": ACTS_AS,
            "set": {"clearance": gap.radial, "journal_radius": gap.journal_radius},
        }
        for gap in acting
    }
    attached = [(f"{gap.key}.journal", gap.at) for gap in acting]
    return components, attached + [(f"{g.key}.housing", g.stator) for g in acting if g.stator]
