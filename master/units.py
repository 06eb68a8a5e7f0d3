"""Values with units, as people write them; a mistake is the user's to mend."""

from __future__ import annotations

from master.errors import TouchdownError
from modelkit import units


def to_si(value: object, unit: str | None, name: str) -> float:
    """`value` (a number, or text "number" or "number unit") in the SI unit `unit` of variable `name`."""
    try:
        return units.to_si(value, unit, name)
    except units.UnitError as error:
        raise TouchdownError(str(error)) from None
