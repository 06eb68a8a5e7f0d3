"""Values with units, as people write them: "0.3 mm", "9000 rpm", "2e8 N/m"."""

from __future__ import annotations

import math
import re
from numbers import Real

# unit as written: (factor, SI unit)
SCALES: dict[str, tuple[float, str]] = {
    "km": (1e3, "m"), "cm": (1e-2, "m"), "mm": (1e-3, "m"), "um": (1e-6, "m"), "nm": (1e-9, "m"),
    "mm/s": (1e-3, "m/s"),
    "min": (60.0, "s"), "ms": (1e-3, "s"), "us": (1e-6, "s"),
    "g": (1e-3, "kg"),
    "g/cm3": (1e3, "kg/m3"),
    "kg.mm2": (1e-6, "kg.m2"), "kg.cm2": (1e-4, "kg.m2"), "g.mm2": (1e-9, "kg.m2"),
    "g.mm": (1e-6, "kg.m"), "g.cm": (1e-5, "kg.m"), "kg.mm": (1e-3, "kg.m"),
    "rpm": (2.0 * math.pi / 60.0, "rad/s"), "krpm": (2000.0 * math.pi / 60.0, "rad/s"),
    "deg": (math.pi / 180.0, "rad"),
    "kN": (1e3, "N"), "mN": (1e-3, "N"),
    "mN.m": (1e-3, "N.m"),
    "N/mm": (1e3, "N/m"), "N/um": (1e6, "N/m"), "kN/m": (1e3, "N/m"), "MN/m": (1e6, "N/m"),
    "N.s/mm": (1e3, "N.s/m"),
    "GPa": (1e9, "Pa"), "MPa": (1e6, "Pa"), "kPa": (1e3, "Pa"),
    "%": (1e-2, "1"),
}  # fmt: skip


NUMBER = re.compile(r"[-+]?((\d+\.?\d*|\.\d+)([eE][-+]?\d+)?(?![\d.])|(nan|inf)\b)", re.IGNORECASE)
MICRO = str.maketrans("\u00b5\u03bc", "uu")  # both signs that people type for micro


class UnitError(ValueError):
    """A value that cannot be read; the message names the variable, the value and the remedy."""


def units_of(unit: str) -> list[str]:
    """Ways to write the SI unit `unit`, itself first."""
    return [unit, *(written for written, (_, si) in SCALES.items() if si == unit)]


def to_si(value: object, unit: str | None, name: str) -> float:
    """`value` (a number, or text "number" or "number unit") in the SI unit `unit` of variable `name`."""
    if isinstance(value, bool) or not isinstance(value, (Real, str)):
        raise UnitError(f"{name} = {value!r} is not a number; write a number or text like '0.3 mm'")
    if not isinstance(value, str):
        number, written = float(value), ""
    else:
        number, written = _split(value, name)
    if written and written != unit:
        factor, si = SCALES.get(written, (1.0, written))
        if si != unit:
            raise UnitError(f"{name} = {value!r} has the unit {written}; it is measured in {unit or '1'}")
        number *= factor
    if not math.isfinite(number):
        raise UnitError(f"{name} = {value!r} is not a finite number")
    return number


def _split(text: str, name: str) -> tuple[float, str]:
    """Number and unit of "0.3 mm", "0.3mm" or "20 \u00b5s"; the unit is "" where there is none."""
    match = NUMBER.match(text.strip())
    try:
        number = float(match[0]) if match else float(text)
    except ValueError:
        raise UnitError(
            f"{name} = {text!r} is not a number; write a number or text like '0.3 mm'"
        ) from None
    written = text.strip()[match.end() :].strip() if match else ""
    return number, written.translate(MICRO)
