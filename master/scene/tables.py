"""Kinds of values in a scene's file, and whose file a TOML file is."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Collection, Mapping
from pathlib import Path
from typing import Any, TypeGuard

from ...modelkit.errors import TouchdownError
from ...modelkit.reader import LIST, Kind, number, text_of, toml_of
from ...modelkit.units import NUMBER, to_si

NAME = re.compile(r"\w[\w -]*")  # of a component, of a gap
ROTOR_TABLES = ("element", "superelement", "disc", "point_mass", "unbalance", "stations", "levitated_at")


def is_table(value: object) -> TypeGuard[Mapping[str, Any]]:
    """Whether it is a table, of any values."""
    return isinstance(value, Mapping)


def is_list(value: object) -> TypeGuard[list[object]]:
    """Whether it is a list, of any values."""
    return isinstance(value, list)


def as_table(value: object) -> Mapping[str, Any]:
    """A table, of any values; an empty one for what is not a table."""
    return value if is_table(value) else {}


COUNTED = ("brake", "thrust")  # tables of a rotor, whose length is a parameter


def dotted_keys(table: Mapping[str, Any], prefix: str = "") -> dict[str, object]:
    """Nested tables as dotted names: [set.friction] static = 0.2 is friction.static.

    A list of tables is numbered from 1: event[1].time; of those that are `COUNTED` also how many there are.
    """
    dotted: dict[str, object] = {}
    for key, value in table.items():
        if is_table(value):
            dotted |= dotted_keys(value, f"{prefix}{key}.")
        elif is_list(value) and value and all(map(is_table, value)):
            dotted |= {f"{prefix}{key}_points": len(value)} if key in COUNTED else {}
            for k, point in enumerate(map(as_table, value), 1):
                dotted |= dotted_keys(point, f"{prefix}{key}[{k}].")
        else:
            dotted[f"{prefix}{key}"] = value
    return dotted


def is_scene_file(path: Path) -> bool:
    """Whether a TOML file is a scene's."""
    return not {"components", "extends"}.isdisjoint(_names(path))


def is_of_ross(path: Path) -> bool:
    """Whether ROSS saved a TOML file."""
    return "ross_version" in _names(path)


def _names(path: Path) -> Collection[str]:
    """The names at the top of a TOML file; none where it is not such a file."""
    try:
        return toml_of(text_of(path), str(path)).keys()
    except TouchdownError:
        return ()


def _named(value: Any, name: str) -> str:
    if not isinstance(value, str) or not NAME.fullmatch(value):
        raise ValueError
    return value


NAMED = Kind(_named, "a name of letters, digits, _, - and spaces")


def _is_value(value: object) -> bool:
    """Whether it is a number, or text like "20 ms"."""
    match = NUMBER.match(str(value).strip())
    return match is not None and "." not in str(value).strip()[match.end() :]


def naming(what: str = "a variable", example: str = "amb.shutdown_time") -> Kind:
    """COMPONENT.VARIABLE, or another name with a component's in front, of `what` it is."""

    def take(value: Any, name: str) -> str:
        if _is_value(value) or not all(value.partition(".")):
            raise ValueError
        return value

    return Kind(take, f"the name of {what}, such as {example!r}, not a value")


def _pair(value: Any, name: str) -> tuple[str, str]:
    first, second = LIST.take(value, name)
    if not (isinstance(first, str) and isinstance(second, str)):
        raise TypeError
    return first, second


def _ports(value: Any, name: str) -> tuple[str, str]:
    pair = _pair(value, name)
    if not all("." in one for one in pair):
        raise ValueError
    return pair


COMPONENTS = Kind(_pair, 'a pair such as ["controller", "amb"]')
PORTS = Kind(_ports, 'a pair such as ["bearing.journal", "rotor.A"]')


def time_of(zero: str) -> float | None:
    """The time (s) that a scene's zero is, where it names no variable."""
    return to_si(zero, "s", "zero") if _is_value(zero) else None


def _zero(value: Any, name: str) -> str:
    return f"{to_si(value, 's', name)!r} s" if _is_value(value) else naming().read(value, name)


ZERO = Kind(_zero, 'a time, such as "5 ms", or the name of a variable')  # a time is kept as "0.005 s"


def positive_value(value: object, unit: str, name: str) -> float:
    """A number above 0 in the SI unit `unit`."""
    return number(unit, above=0.0).read(value, name)


BETWEEN = r",(?![^\[(]*[\])])"  # a comma that is not inside brackets, as in A[1,2] and der(x,1)


def _beginnings(value: Any, name: str) -> tuple[str, ...]:
    if isinstance(value, str) and value.lstrip().startswith("["):  # a list as in a file, by --set
        value = tomllib.loads(f"list = {value}")["list"]
    parts = re.split(BETWEEN, value) if isinstance(value, str) else LIST.take(value, name)
    stripped = tuple(part.strip() for part in parts)
    if not all(stripped):
        raise ValueError
    return stripped


BEGINNINGS = Kind(_beginnings, 'a list such as ["rotor.A", "bearing.contact"]')  # of recorded variables
