"""Values with units, as people write them: "0.3 mm", "9000 rpm", "2e8 N/m"."""

from __future__ import annotations

import math
import re
from difflib import get_close_matches
from numbers import Real

from .errors import TouchdownError

# unit as written: (factor, SI unit)
UNIT_SCALES: dict[str, tuple[float, str]] = {
    "km": (1e3, "m"), "cm": (1e-2, "m"), "mm": (1e-3, "m"), "um": (1e-6, "m"), "nm": (1e-9, "m"),
    "mm/s": (1e-3, "m/s"),
    "min": (60.0, "s"), "ms": (1e-3, "s"), "us": (1e-6, "s"),
    "g": (1e-3, "kg"),
    "g/cm3": (1e3, "kg/m3"),
    "kg.mm2": (1e-6, "kg.m2"), "kg.cm2": (1e-4, "kg.m2"), "g.mm2": (1e-9, "kg.m2"),
    "g.mm": (1e-6, "kg.m"), "g.cm": (1e-5, "kg.m"), "kg.mm": (1e-3, "kg.m"),
    "rpm": (2.0 * math.pi / 60.0, "rad/s"), "krpm": (2000.0 * math.pi / 60.0, "rad/s"),
    "1/min": (2.0 * math.pi / 60.0, "rad/s"), "Hz": (2.0 * math.pi, "rad/s"),
    "kHz": (2000.0 * math.pi, "rad/s"), "deg": (math.pi / 180.0, "rad"), "mrad": (1e-3, "rad"),
    "kN": (1e3, "N"), "mN": (1e-3, "N"),
    "mN.m": (1e-3, "N.m"),
    "N/mm": (1e3, "N/m"), "N/um": (1e6, "N/m"), "kN/m": (1e3, "N/m"), "MN/m": (1e6, "N/m"),
    "kN/mm": (1e6, "N/m"),
    "N.s/mm": (1e3, "N.s/m"),
    "GPa": (1e9, "Pa"), "MPa": (1e6, "Pa"), "kPa": (1e3, "Pa"),
    "mm2": (1e-6, "m2"), "cm2": (1e-4, "m2"),
    "mA": (1e-3, "A"), "mV": (1e-3, "V"), "kV": (1e3, "V"), "mOhm": (1e-3, "Ohm"),
    "mF": (1e-3, "F"), "uF": (1e-6, "F"), "kW": (1e3, "W"),
    "A/mm": (1e3, "A/m"), "A/um": (1e6, "A/m"),
    "%": (1e-2, "1"),
}  # fmt: skip


# units that values are shown in, from small to large; of what is 0 at the start, where it is not the first
DISPLAY_UNITS: dict[str, tuple[str, ...]] = {
    "m": ("um", "mm", "m"),
    "m/s": ("mm/s", "m/s"),
    "s": ("us", "ms", "s"),
    "rad": ("deg",),
    "rad/s": ("rpm",),
    "kg": ("g", "kg"),
    "kg/m3": ("g/cm3",),
    "kg.m": ("g.mm", "kg.m"),
    "kg.m2": ("kg.mm2", "kg.cm2", "kg.m2"),
    "N": ("N", "kN"),
    "N.m": ("mN.m", "N.m"),
    "N/m": ("N/m", "kN/m", "MN/m"),
    "N.s/m": ("N.s/m", "N.s/mm"),
    "Pa": ("MPa", "GPa"),
}
UNIT_OF_ZERO = {"s": "ms", "m/s": "m/s", "kg": "kg", "kg.m": "kg.m", "kg.m2": "kg.m2", "N.m": "N.m"}

NUMBER = re.compile(r"[-+]?((\d+\.?\d*|\.\d+)([eE][-+]?\d+)?(?![\d.])|(nan|inf)\b)", re.IGNORECASE)
SIGNS = str.maketrans("\u00b5\u03bc\u00b2\u00b3\u00b7\u22c5", "uu23..", "^") | {
    0xB0: "deg"
}  # for those here


def spellings_of(unit: str) -> list[str]:
    """Ways to write the SI unit `unit`, itself first."""
    return [unit, *(written for written, (_, si) in UNIT_SCALES.items() if si == unit)]


def display_unit(unit: str, size: float) -> str:
    """The unit in which people read values of about `size`, in the SI unit `unit`: mm, um, rpm and so on.

    size = 0: it is not known.
    """
    written = DISPLAY_UNITS.get(unit, (unit,))
    if size == 0.0:
        return UNIT_OF_ZERO.get(unit, written[0])
    fitting = [w for w in written if per_display(unit, w) * abs(size) >= 1.0]
    return fitting[-1] if fitting else written[0]


def per_display(unit: str, written: str) -> float:
    """How many of the unit `written` are one of the SI unit `unit`."""
    return 1.0 if written == unit else 1.0 / UNIT_SCALES[written][0]


def is_bare(value: object) -> bool:
    """Whether `value` is a number, or text of one, that says no unit."""
    if value is None or not isinstance(value, str):
        return value is not None
    try:
        return not _split(value, "")[1]
    except TouchdownError:  # no number at all, of which others complain
        return False


def to_si(value: object, unit: str | None, name: str) -> float:
    """`value` (a number, or text "number" or "number unit") in the SI unit `unit` of variable `name`.

    Raises TouchdownError with the variable, the value and the remedy.
    """
    if isinstance(value, bool) or not isinstance(value, (Real, str)):
        raise TouchdownError(f"{name} = {value!r} is not a number; write a number or text like '0.3 mm'")
    try:
        number, written = _split(value, name) if isinstance(value, str) else (float(value), "")
    except OverflowError:  # an integer beyond what a real number can be
        raise TouchdownError(
            f"{name} is an integer of more than 308 digits; write a smaller number"
        ) from None
    if written and written != unit:
        factor, si = UNIT_SCALES.get(written, (1.0, written))
        if si != unit:
            remedy = (
                "has a comma; write a decimal point, such as '0.3 mm'"
                if written.startswith(",")
                else f"has the unit {written}; it is measured in {unit or '1'}{_units_taken(written, unit)}"
            )
            raise TouchdownError(f"{name} = {value!r} {remedy}")
        number *= factor
    if not math.isfinite(number):
        raise TouchdownError(f"{name} = {value!r} is not a finite number")
    return number


def _units_taken(written: str, unit: str | None) -> str:
    """How a quantity in `unit` may be written, where it is given with another."""
    taken = spellings_of(unit) if unit else []
    if len(taken) < 2:
        return ""
    others = {si for _, si in UNIT_SCALES.values()} | UNIT_SCALES.keys()
    near = [] if written in others or len(written) < 3 else get_close_matches(written, taken, n=2)
    return f"; did you mean {' or '.join(near)}" if near else f"; write it in {' or '.join(taken)}"


def _split(text: str, name: str) -> tuple[float, str]:
    """Number and unit of "0.3 mm", "0.3mm" or "20 \u00b5s"; the unit is "" where there is none."""
    match = NUMBER.match(text.strip())
    try:
        number = float(match[0]) if match else float(text)
    except ValueError:
        remedy = "write a number or text like '0.3 mm'"
        if re.match(r"\s*G\s*\d", text):  # a balance quality grade
            remedy = "a rotor's eccentricity or unbalance_scale takes grades, in a scene or by --set"
        raise TouchdownError(f"{name} = {text!r} is not a number; {remedy}") from None
    written = text.strip()[match.end() :].strip() if match else ""
    written = re.sub("N(?=[ms])", "N.", written.translate(SIGNS))  # Nm is N.m
    if written[:1].isalpha():  # "N s/m" and "N*s/m" are N.s/m
        written = ".".join(written.replace("*", " ").split())
    return number, written
