"""The cases by name, in the order of the page, and what could not be made one yet."""

from __future__ import annotations

import importlib
from collections.abc import Mapping, Sequence

from .case import Case, Row, UnavailableError

MODULES = (
    *("contacts", "mounts", "rings", "statics", "at_speed", "rotors", "rig", "loops", "drops"),
    *("coupled", "references"),
)

MISSING = """## Not yet possible

- A measured drop of a rotor: none published with all that a run needs is among the cases.
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
