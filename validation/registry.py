"""The cases by name, in the order of the page, and what could not be made one yet."""

from __future__ import annotations

import importlib
from collections.abc import Mapping, Sequence

from .case import Case, Row, UnavailableError

MODULES = (
    *("contacts", "mounts", "rings", "statics", "at_speed", "rotors", "rig", "pulled", "loops", "drops"),
    *("coupled", "references"),
)

MISSING = """## Not yet possible

- A measured drop onto rolling touchdown bearings. `rotor-pulled` is the nearest: contacts of a rotor with a
  plain stator. Published drops, such as of L. Hawkins et al., ASME GT2007-28290, or M. Caprio et al., Spin
  Commissioning and Drop Tests of a 130 kW-hr Composite Flywheel, were within reach by their beginnings
  only, without mounts, friction and orbits in numbers.
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
