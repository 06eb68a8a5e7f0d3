"""Units as FMI and SSP define them."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from numbers import Integral, Real

from ...modelkit.units import to_si as to_si

Scale = tuple[float, float]  # factor and offset
BASE = ("kg", "m", "s", "A", "K", "mol", "cd", "rad")


@dataclass(frozen=True)
class Unit:
    """A unit by its SI base units: value in SI = factor * value + offset."""

    exponents: Mapping[str, int] = field(default_factory=dict[str, int])  # of BASE; those that are not 0
    factor: float = 1.0
    offset: float = 0.0

    def to(self, other: Unit, relative: bool = False) -> Scale | None:
        """Factor and offset that turn values into those of `other`; None where the dimensions differ.

        relative: of a difference, such as one of temperatures, which has no offset.
        """
        if dict(self.exponents) != dict(other.exponents):
            return None
        offset = 0.0 if relative else (self.offset - other.offset) / other.factor
        return self.factor / other.factor, offset


def unbracketed(unit: str) -> str:
    """The name of a unit without the brackets that some tools write around it.

    >>> unbracketed("[m]"), unbracketed("m"), unbracketed("[lb]/[in]")
    ('m', 'm', '[lb]/[in]')
    """
    match = re.fullmatch(r"\[([^\[\]]+)\]", unit.strip())
    return match[1] if match else unit


def then(first: Scale | None, second: Scale | None) -> Scale | None:
    """The scale that does as `first` and then `second`; None leaves a value unchanged, to the last bit."""
    if first is None or second is None:
        return first or second
    return second[0] * first[0], second[0] * first[1] + second[1]


def scaled(value: float, scale: Scale | None) -> float:
    """`value` under a scale."""
    return value if scale is None else scale[0] * value + scale[1]


def plain(value: object) -> object:
    """A number of numpy's as one of Python's, anything else unchanged."""
    if isinstance(value, (bool, int, float)) or not isinstance(value, Real):
        return value
    return int(value) if isinstance(value, Integral) else float(value)
