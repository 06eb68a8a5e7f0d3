"""Numbers and quantities in words and units that people read."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable

from ..master.common.text import RPM
from ..master.quantities import Item, named
from ..modelkit.units import DISPLAY_UNITS, per_display

UNIT_NAMES = {"1": "", "kg.m2": "kg m²", "N.s/m": "N s/m", "N.s/m2": "N s/m²", "m/s2": "m/s²", "N.m": "N m",
          "kg/m3": "kg/m³", "N/m^n": "N/mⁿ", "N.m.s/rad": "N m s/rad", "1/(kg.m2)": "1/(kg m²)",
          "1/s2": "1/s²", "um": "µm", "us": "µs"}  # fmt: skip
SIZES = {"m": ("nm", "um", "mm"), "N": ("mN", "N", "kN"), "Pa": ("Pa", "kPa", "MPa", "GPa")}  # of reports
WRITTEN = {unit: DISPLAY_UNITS[unit] for unit in ("s", "N/m", "rad", "kg")} | SIZES
UNIT_SCALES: dict[str, list[tuple[float, str]]] = {  # SI unit: factors into other units, largest unit first
    unit: [(1.0 / per_display(unit, one), UNIT_NAMES.get(one, one)) for one in reversed(written)]
    for unit, written in WRITTEN.items()
} | {"J": [(1.0, "J"), (1e-3, "mJ"), (1e-6, "µJ")]}
NONE = "–"
_MICRO, _MINUS = re.compile(r" um\b"), re.compile(r"(?<![^\s(])-(?=\d)")
ROUNDING = 1e-6  # of a unit's smallest handy size: less is a zero that was computed
STANDSTILL_RPM = 1e-3  # likewise, of a speed
ROUNDING_RATIO = 1e-12  # likewise, of the largest of some figures


def digits(value: float, count: int = 4) -> str:
    """`value` with `count` significant digits; powers of ten only where zeros would mislead."""
    if not math.isfinite(value):
        return NONE if math.isnan(value) else ("∞" if value > 0.0 else "−∞")
    text = f"{value:.{count}g}"
    if "e" in text and 1.0 <= abs(value) < 1e7:
        text = f"{float(text):,.0f}".replace(",", "\N{NARROW NO-BREAK SPACE}")
    if "e" in text:
        mantissa, _, exponent = text.partition("e")
        powers = str(int(exponent)).translate(str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"))
        text = f"{mantissa}·10{powers}"
    return text.replace("-", "\N{MINUS SIGN}")


def digits_of(values: Iterable[float], count: int = 3) -> tuple[str, ...]:
    """Some figures with `count` digits each; zero where one is nothing beside the largest."""
    known = [float(value) for value in values]
    least = ROUNDING_RATIO * max(map(abs, known))
    return tuple(digits(value if abs(value) > least else 0.0, count) for value in known)


def quantity(value: float | None, unit: str, count: int = 4) -> str:
    """A value in SI with a unit of a handy size; a dash where there is none."""
    if value is None:
        return NONE
    if unit in UNIT_SCALES and abs(value) < ROUNDING * UNIT_SCALES[unit][-1][0]:
        value = 0.0
    factor, name = _handy(value, unit)
    return f"{digits(value / factor, count)} {name}".strip().replace(" ", "\N{NO-BREAK SPACE}")


def _handy(value: float, unit: str) -> tuple[float, str]:
    sizes = UNIT_SCALES.get(unit)
    if sizes is None or not math.isfinite(value):
        return 1.0, UNIT_NAMES.get(unit, unit)
    fitting = (size for size in sizes if abs(value) >= 0.9999 * size[0])
    return next(fitting, sizes[-1] if value else sizes[0])


def speed(value: float | None, count: int = 5) -> str:
    """A spin speed (rad/s) in rpm."""
    if value is None:
        return NONE
    return f"{digits(RPM * value if abs(RPM * value) >= STANDSTILL_RPM else 0.0, count)} rpm"


def percentage(value: float | None, count: int = 2) -> str:
    """A share of one in per cent."""
    return NONE if value is None else f"{digits(100.0 * value, count)} %"


def spelt(text: str) -> str:
    """A line of the console with units as reports spell them."""
    return _MINUS.sub("\N{MINUS SIGN}", _MICRO.sub("\N{NO-BREAK SPACE}µm", text))


def capital(words: str) -> str:
    """With a capital first letter."""
    return words[:1].upper() + words[1:]


def heads(keys: Iterable[str]) -> list[str]:
    """Of columns of quantities whose values have their units with them."""
    return [capital(named(key)[0].words) for key in keys]


def head(item: Item) -> str:
    """Of a column of bare numbers: words, of what, and the unit."""
    unit = UNIT_NAMES.get(item.quantity.read_in, item.quantity.read_in)
    return capital(f"{item.words} [{unit}]" if unit else item.words)
