"""Values with units, as people write them, and units as FMI and SSP define them."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from numbers import Integral, Real

from ...modelkit.units import to_si as to_si

Scale = tuple[float, float]  # factor and offset
IN_HERTZ = ("bandwidth",)  # variables in rad/s that are no speeds
BASE = ("kg", "m", "s", "A", "K", "mol", "cd", "rad")


@dataclass(frozen=True)
class Unit:
    """A unit by its SI base units: value in SI = factor * value + offset."""

    exponents: Mapping[str, int] = field(default_factory=dict[str, int])  # of BASE; those that are not 0
    factor: float = 1.0
    offset: float = 0.0

    def to(self, other: Unit) -> Scale | None:
        """Factor and offset that turn values into those of `other`; None where the dimensions differ."""
        if dict(self.exponents) != dict(other.exponents):
            return None
        return self.factor / other.factor, (self.offset - other.offset) / other.factor


def then(first: Scale | None, second: Scale | None) -> Scale | None:
    """The scale that does as `first` and then `second`; None leaves a value as it is, to the last bit."""
    if first is None or second is None:
        return first or second
    return second[0] * first[0], second[0] * first[1] + second[1]


def scaled(value: float, scale: Scale | None) -> float:
    """`value` under a scale."""
    return value if scale is None else scale[0] * value + scale[1]


def plain(value: object) -> object:
    """A number of numpy's as one of Python's, anything else as it is."""
    if isinstance(value, (bool, int, float)) or not isinstance(value, Real):
        return value
    return int(value) if isinstance(value, Integral) else float(value)


def spoken(name: str, value: float) -> tuple[float, str]:
    """A variable in rad/s as people speak of it: a speed in rpm, what a control follows in Hz.

    >>> spoken("rotor.speed", 10.0 * math.pi), spoken("amb.bandwidth", 10.0 * math.pi)
    ((300.0, 'rpm'), (5.0, 'Hz'))
    """
    turns = value / (2.0 * math.pi)
    return (turns, "Hz") if name.endswith(IN_HERTZ) else (60.0 * turns, "rpm")


def percent(part: float) -> str:
    """A part of one in per cent, to three digits.

    >>> percent(0.123456), percent(16.4055)
    ('12.3 %', '1640 %')
    """
    return f"{float(f'{100.0 * part:.3g}'):g} %"


def with_unit(value: object, unit: str | None, name: str = "") -> str:
    """The setting `name` as it was given, for people, with its unit; text may have one in it.

    >>> with_unit(20000, "rad/s", "rotor.speed"), with_unit("0.3 mm", "m"), with_unit("0.15", "1")
    ('20000 rad/s (190986 rpm)', '0.3 mm', '0.15')
    """
    try:
        number = float(str(value))
    except ValueError:
        return str(value)
    turns, per = spoken(name, number)
    beside = f" ({turns:.6g} {per})" if unit == "rad/s" and number else ""
    return f"{number:g}" + (f" {unit}" if unit not in (None, "", "1") else "") + beside
