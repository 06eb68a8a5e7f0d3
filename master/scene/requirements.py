"""Requirements of a scene: limits of quantities of its summary."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

from ...modelkit.reader import TEXT, Kind, Table, number
from ..common.errors import TouchdownError, one_of
from ..quantities import Group, Item, Owner, Quantity, Worse, named
from .tables import is_table


class RequirementKind(NamedTuple):
    """A requirement by the quantity that it limits."""

    quantity: Quantity  # of all bearings or gaps
    size: tuple[float, float] = (0.0, math.inf)  # SI, of a limit that can be meant
    example: str = ""
    says: str = ""  # for people
    single: Quantity | None = None  # of one bearing or gap; None: it has no name to be limited by

    @property
    def limit(self) -> Kind:
        """What its limit may be."""
        return number(self.quantity.unit, minimum=0.0, size=self.size, example=self.example)


def _kind(
    key: str, example: str, says: str, size: tuple[float, float] = (0.0, math.inf), single: str = ""
) -> RequirementKind:
    """Of a quantity of the run and, where it has one, of a seat; `single`: of what is limited by a name."""
    return RequirementKind(named(key)[0], size, example, says, named(single or key)[-1])


SENSITIVITY = "sensitivity"  # of loops, which no drop tells
KINDS = {
    "least_gap": _kind("least_gap", "20 um", "what is left of the gaps", (0.0, 0.02), "least"),
    "contact_force": _kind("peak_contact_force", "2 kN", "journal in bore"),
    "ball_force": _kind("peak_ball_force", "1 kN", "the most loaded ball"),
    "ball_pressure": _kind("largest_ball_pressure", "4 GPa", "of a ball on a race (Hertz)", (1e6, 1e11)),
    "static_safety": _kind("lowest_static_safety", "1", "against dents in races"),
    "drops": _kind("drops_until_fatigue", "10", "runs until one in ten bearings fails"),
    "settling_time": _kind("settling_time", "1 s", "until the rotor rests"),
    "stroke": _kind("housing_stroke", "100 um", "of the housing in its mount", (0.0, 0.02)),
    "heat": _kind("bearing_heat", "500 J", "friction in a bearing"),
    "temperature": _kind("largest_temperature_rise", "80 K", "of the hottest part of a bearing"),
    "contact_temperature": _kind(
        "contact_temperature", "300 K", "where the journal slides in the bore, rise"
    ),
    "whirl_turns": _kind("whirl_revolutions", "5", "of the rotor around its bearings"),
    SENSITIVITY: RequirementKind(
        Quantity("sensitivity_peak", "peak of the loops' sensitivity", "1", Group.LEVITATION, Owner.RUN),
        example="3",
        says="zone A is below 3, B to 4, C to 5; `touchdown amb-margins` judges it",
    ),
}
SIDES = {Worse.SMALLER: "at least", Worse.LARGER: "at most"}


class Requirement(NamedTuple):
    """A limit; `kind` is its name in `KINDS`."""

    kind: str
    limit: float  # SI
    clause: str = ""  # of the document that asks for it
    of: str = ""  # the one bearing or gap that it is of; "": all

    @property
    def key(self) -> str:
        """Its name in a summary."""
        return f"{self.kind}.{self.of}" if self.of else self.kind


def limited(key: str) -> Item:
    """What a requirement limits, by its `key`."""
    kind, _, of = key.partition(".")
    return Item((KINDS[kind].single if of else None) or KINDS[kind].quantity, of)


def read_requirements(table: Table) -> tuple[Requirement, ...]:
    """The [requirements] of a scene. Raises TouchdownError."""
    table.only((*KINDS,))
    return tuple(one for kind in table.values for one in _read(table, kind, kind))


def _read(t: Table, key: str, kind: str, of: str = "") -> Iterator[Requirement]:
    """A limit, or a table of limit and clause, of all bearings or gaps, and of some by their names."""
    if not is_table(t.values[key]):
        yield Requirement(kind, t.get(key, KINDS[kind].limit), of=of)
        return
    one = t.table(key)
    names = (
        [] if of or KINDS[kind].single is None else [n for n in one.values if n not in ("limit", "clause")]
    )
    one.only(("limit", "clause", *names))
    if "limit" in one.values or "clause" in one.values or not names:
        yield Requirement(kind, one.get("limit", KINDS[kind].limit), one.get("clause", TEXT, ""), of)
    for name in names:
        yield from _read(one, name, kind, name)


def refuse_unknown(requirements: Iterable[Requirement], owner: Owner, there: Sequence[str]) -> None:
    """Raise TouchdownError for one of a seat or gap, as `owner` says which, that is not `there`."""
    for one in requirements:
        if one.of not in ("", *there) and limited(one.key).quantity.owner is owner:
            raise TouchdownError(f"requirements.{one.kind}: there is no {one.of}; {one_of(one.of, there)}")
