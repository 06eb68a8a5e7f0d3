"""Gaps that a rotor must not close: a place on it, and how far it may go there.

A gap is watched only. One that knows the rotor's radius there, `journal_radius`, acts as well: the scene
gets a `bushing` of that clearance at the same places, by the gap's key.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

from ..common.errors import TouchdownError
from .tables import above_zero, entries, items, reference, refuse_unknown, table, without_unit

EXAMPLE = '[[gap]] with name = "AMB A", at = "rotor.amb_A" and radial = "0.4 mm"'
KEYS = ("name", "at", "radial", "stator", "journal_radius")
ACTS_AS = "bushing"
WIDEST = 0.02  # m, of a gap that can be meant
WORD = re.compile(r"\w[\w -]*")


class Gap(NamedTuple):
    """A radial gap between a port of a rotor and what stands around it."""

    name: str  # "AMB A"
    at: str  # COMPONENT.PORT of the rotor
    radial: float  # m
    stator: str | None = None  # COMPONENT.PORT that it moves with; None: it stands in space
    journal_radius: float | None = None  # m, of the rotor there; None: the gap is watched only

    @property
    def key(self) -> str:
        """Its name as figures of a run have it."""
        return _key(self.name)

    @property
    def acts(self) -> bool:
        """Whether the scene has a bushing there; else the gap is watched only."""
        return self.journal_radius is not None


def _key(name: str) -> str:
    return "gap_" + re.sub(r"[ -]", "_", name)


def gaps(value: object, where: str) -> tuple[Gap, ...]:
    """The [[gap]] tables of a scene. Raises TouchdownError."""
    listed = items(value)
    if listed is None:
        raise TouchdownError(f"{where} must be tables, such as {EXAMPLE}")
    found = tuple(_gaps(listed, where))
    twice = [one.name for one in found if [other.key for other in found].count(one.key) > 1]
    if twice:
        raise TouchdownError(f"{where}: {twice[0]} is there twice; give each gap a name of its own")
    return found


def _gaps(listed: list[object], where: str) -> Iterator[Gap]:
    for number, entry in enumerate(listed, start=1):
        here = f"{where} {number}"
        given = table(entry, here)
        refuse_unknown(given, KEYS, here)
        lacking = [key for key in KEYS[:3] if key not in given]
        if lacking:
            raise TouchdownError(f"{here} lacks {lacking[0]}; write such as {EXAMPLE}")
        name = given["name"]
        if not isinstance(name, str) or not WORD.fullmatch(name):
            raise TouchdownError(f"{here}: name = {name!r}; take letters, digits, _, - and spaces")
        stator = given.get("stator")
        yield Gap(
            name,
            reference(given["at"], f"{here}: at", "a place on a rotor", "rotor.amb_A"),
            _radial(given["radial"], f"{here}: radial"),
            None if stator is None else reference(stator, f"{here}: stator", "a place", "housing_A.seat"),
            above_zero(given["journal_radius"], "m", f"{here}: journal_radius")
            if "journal_radius" in given
            else None,
        )


def _radial(value: object, where: str) -> float:
    """A radial gap (m)."""
    gap = above_zero(value, "m", where)
    if gap > WIDEST:
        raise without_unit(where, value, gap, "m", "0.4 mm")
    return gap


def of_rotor(component: str, value: object) -> list[object]:
    """The [[gap]] tables of a rotor's file as a scene has them, at stations of the `component`.

    One with a node or a position has a station of its own there, of the gap's key.
    """
    found: list[object] = []
    for one in items(value) or []:
        given = entries(one) or {}
        place = given.get("station", _key(str(given.get("name"))))  # what is wrong the rotor's reader says
        rest = {key: item for key, item in given.items() if key not in ("station", "node", "position")}
        found.append(rest | {"at": f"{component}.{place}"})
    return found


def laid_over(before: object, over: object) -> object:
    """The [[gap]] tables `before`, of the file that is extended, and those `over` them, by their names."""
    there, given = items(before), items(over)
    if there is None or given is None:
        return over
    names = [(entries(one) or {}).get("name") for one in given]
    return [one for one in there if (entries(one) or {}).get("name") not in names] + given


def contacts(found: Sequence[Gap]) -> tuple[dict[str, Mapping[str, object]], list[tuple[str, str]]]:
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
