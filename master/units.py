"""Values with units, as people write them: "0.3 mm", "9000 rpm", "2e8 N/m"."""

from __future__ import annotations

import math

from master.errors import TouchdownError

# unit as written: (factor, SI unit)
SCALES: dict[str, tuple[float, str]] = {
    "km": (1e3, "m"), "cm": (1e-2, "m"), "mm": (1e-3, "m"), "um": (1e-6, "m"), "nm": (1e-9, "m"),
    "mm/s": (1e-3, "m/s"),
    "min": (60.0, "s"), "ms": (1e-3, "s"), "us": (1e-6, "s"),
    "g": (1e-3, "kg"),
    "rpm": (2.0 * math.pi / 60.0, "rad/s"), "krpm": (2000.0 * math.pi / 60.0, "rad/s"),
    "deg": (math.pi / 180.0, "rad"),
    "kN": (1e3, "N"), "mN": (1e-3, "N"),
    "mN.m": (1e-3, "N.m"),
    "N/mm": (1e3, "N/m"), "N/um": (1e6, "N/m"), "kN/m": (1e3, "N/m"), "MN/m": (1e6, "N/m"),
    "N.s/mm": (1e3, "N.s/m"),
    "GPa": (1e9, "Pa"), "MPa": (1e6, "Pa"), "kPa": (1e3, "Pa"),
    "%": (1e-2, "1"),
}  # fmt: skip


def to_si(value: object, unit: str | None, name: str) -> float:
    """`value` (a number, or text "number" or "number unit") in the SI unit `unit` of variable `name`."""
    if isinstance(value, bool) or not isinstance(value, (int, float, str)):
        raise TouchdownError(f"{name} = {value!r} is not a number; write a number or text like '0.3 mm'")
    if not isinstance(value, str):
        number, written = float(value), ""
    else:
        head, _, written = value.strip().partition(" ")
        written = written.strip()
        try:
            number = float(head)
        except ValueError:
            raise TouchdownError(
                f"{name} = {value!r} is not a number; write a number or text like '0.3 mm'"
            ) from None
    if written and written != unit:
        factor, si = SCALES.get(written, (1.0, written))
        if si != unit:
            raise TouchdownError(
                f"{name} = {value!r} has the unit {written}; it is measured in {unit or '1'}"
            )
        number *= factor
    if not math.isfinite(number):
        raise TouchdownError(f"{name} = {value!r} is not a finite number")
    return number
