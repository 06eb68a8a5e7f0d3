"""Gaps that a rotor must not close: a place on it, and how far it may go there."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import NamedTuple

from ..common.errors import TouchdownError
from .tables import above_zero, items, reference, refuse_unknown, table

EXAMPLE = '[[gap]] with name = "AMB A", at = "rotor.amb_A" and radial = "0.4 mm"'
KEYS = ("name", "at", "radial", "stator")
WORD = re.compile(r"\w[\w -]*")


class Gap(NamedTuple):
    """A radial gap between a port of a rotor and what stands around it."""

    name: str  # "AMB A"
    at: str  # COMPONENT.PORT of the rotor
    radial: float  # m
    stator: str | None = None  # COMPONENT.PORT that it moves with; None: it stands in space

    @property
    def key(self) -> str:
        """Its name as figures of a run have it."""
        return "gap_" + re.sub(r"[ -]", "_", self.name)


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
            reference(given["at"], f"{here}: at"),
            above_zero(given["radial"], "m", f"{here}: radial"),
            None if stator is None else reference(stator, f"{here}: stator"),
        )
