"""Numbers as people read them: a few digits, and a unit of a handy size."""

from __future__ import annotations

import math

HANDY = {  # SI unit: factors into other units, largest unit first
    "m": ((1e-3, "mm"), (1e-6, "µm"), (1e-9, "nm")),
    "s": ((1.0, "s"), (1e-3, "ms"), (1e-6, "µs")),
    "N": ((1e3, "kN"), (1.0, "N"), (1e-3, "mN")),
    "Pa": ((1e9, "GPa"), (1e6, "MPa"), (1.0, "Pa")),
    "N/m": ((1e6, "MN/m"), (1e3, "kN/m"), (1.0, "N/m")),
    "J": ((1.0, "J"), (1e-3, "mJ"), (1e-6, "µJ")),
    "rad": ((math.pi / 180.0, "deg"),),
    "kg": ((1.0, "kg"), (1e-3, "g")),
}
WORDED = {"1": "", "kg.m2": "kg m²", "N.s/m": "N s/m", "N.s/m2": "N s/m²", "m/s2": "m/s²", "N.m": "N m",
          "kg/m3": "kg/m³", "N/m^n": "N/mⁿ", "N.m.s/rad": "N m s/rad", "1/(kg.m2)": "1/(kg m²)",
          "1/s2": "1/s²"}  # fmt: skip
RPM = 60.0 / (2.0 * math.pi)
NONE = "–"


def digits(value: float, count: int = 4) -> str:
    """`value` with `count` significant digits; powers of ten only where zeros would mislead."""
    if not math.isfinite(value):
        return NONE if math.isnan(value) else ("∞" if value > 0.0 else "−∞")
    text = f"{value:.{count}g}"
    if "e" in text and 1.0 <= abs(value) < 1e7:
        text = f"{float(text):,.0f}".replace(",", "\N{NARROW NO-BREAK SPACE}")
    if "e" in text:
        mantissa, _, exponent = text.partition("e")
        text = _raised(mantissa, int(exponent))
    return text.replace("-", "\N{MINUS SIGN}")


def _raised(mantissa: str, exponent: int) -> str:
    powers = str(exponent).translate(str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"))
    return f"{mantissa}·10{powers}"


def quantity(value: float | None, unit: str, count: int = 4) -> str:
    """A value in SI with a unit of a handy size; a dash where there is none."""
    if value is None:
        return NONE
    factor, name = _handy(value, unit)
    return f"{digits(value / factor, count)}\N{NO-BREAK SPACE}{name}".strip()


def _handy(value: float, unit: str) -> tuple[float, str]:
    sizes = HANDY.get(unit)
    if sizes is None or not math.isfinite(value):
        return 1.0, WORDED.get(unit, unit)
    fitting = (size for size in sizes if abs(value) >= 0.9999 * size[0])
    return next(fitting, sizes[-1] if value else sizes[0])


def speed(value: float | None) -> str:
    """A spin speed (rad/s) in rpm."""
    return NONE if value is None else f"{digits(RPM * value, 5)} rpm"


def share(value: float | None, count: int = 2) -> str:
    """A share of one in per cent."""
    return NONE if value is None else f"{digits(100.0 * value, count)} %"


def listed(words: list[str]) -> str:
    """'a', 'a and b', 'a, b and c'."""
    return " and ".join(filter(None, (", ".join(words[:-1]), words[-1]))) if words else ""
