"""The cases by name, in the order of the page, and what could not be made one yet."""

from __future__ import annotations

import importlib
from collections.abc import Mapping, Sequence

from .case import Case, Row, UnavailableError

MODULES = ("contacts", "mounts", "rings", "statics", "rotors", "rig")

MISSING = """## Not yet possible

- The 218 bearing at speed, whose inner and outer contact angles part as its balls are thrown outwards:
  here a ball has no inertia across its orbit (`bearings/angular`). It takes balls as bodies in space,
  with a gyroscopic moment and an assumption which race controls their spin.
"""


def cases() -> Mapping[str, Case]:
    """All cases by name."""
    found: dict[str, Case] = {}
    for module in MODULES:
        home = importlib.import_module(f"{__package__}.{module}")
        found |= {one.name: one for one in vars(home).values() if isinstance(one, Case)}
    return found


def computed(one: Case) -> Sequence[Row] | str:
    """The rows of a case, or why there are none."""
    try:
        return one.rows()
    except UnavailableError as why:
        return str(why)
