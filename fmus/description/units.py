"""Units as FMI describes them: by exponents of SI's base units."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from xml.etree.ElementTree import Element, SubElement

from touchdown.modelkit.model import Slot
from touchdown.modelkit.units import DISPLAYED, per_display
from touchdown.modelkit.variables import Scalar

_SYMBOLS = {
    "m": {"m": 1},
    "kg": {"kg": 1},
    "s": {"s": 1},
    "rad": {"rad": 1},
    "N": {"kg": 1, "m": 1, "s": -2},
    "J": {"kg": 1, "m": 2, "s": -2},
    "W": {"kg": 1, "m": 2, "s": -3},
    "Pa": {"kg": 1, "m": -1, "s": -2},
    "1": {},
}


def base_unit(unit: str) -> dict[str, int] | None:
    """SI exponents of a unit such as "N.s/m2"; None where it has none (N/m^n)."""
    if "^" in unit:
        return None
    exponents: dict[str, int] = {}
    sign = 1
    tokens = re.findall(r"[A-Za-z]+-?\d*|1|[/.()]", unit)
    if "".join(tokens) != unit:
        raise ValueError(f"unknown unit {unit!r}")
    for token in tokens:
        if token == "/":
            sign = -1
            continue
        if token in ".()":
            continue
        match = re.fullmatch(r"([A-Za-z]+|1)(-?\d*)", token)
        if match is None or match[1] not in _SYMBOLS:
            raise ValueError(f"unknown unit {unit!r}")
        power = int(match[2] or 1) * sign
        for symbol, count in _SYMBOLS[match[1]].items():
            exponents[symbol] = exponents.get(symbol, 0) + count * power
    return {symbol: count for symbol, count in exponents.items() if count}


def add_units(root: Element, exposed: Sequence[Slot], more: Iterable[str] = ()) -> None:
    """The units of some variables, and those that they are shown in; either version's XML."""
    definitions = SubElement(root, "UnitDefinitions")
    used = {s.variable.spec.unit for s in exposed if s.variable.spec.kind is Scalar.REAL}
    for unit in sorted(used.union(more)):
        element = SubElement(definitions, "Unit", {"name": unit})
        exponents = base_unit(unit)
        if exponents is not None:
            SubElement(element, "BaseUnit", {k: str(v) for k, v in exponents.items()})
        for shown in DISPLAYED.get(unit, ()):
            if shown != unit:
                factor = repr(per_display(unit, shown))
                SubElement(element, "DisplayUnit", {"name": shown, "factor": factor})
