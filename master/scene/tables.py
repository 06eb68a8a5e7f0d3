"""Checks of a scene's file: tables, pairs, numbers, references.

Every function raises TouchdownError with `where` the mistake stands and what to write there.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Collection, Mapping
from pathlib import Path
from typing import Any, cast

from ...modelkit.units import NUMBER
from ..common.errors import TouchdownError, one_of
from ..common.units import to_si

MAX_DEPTH = 32
NAME = re.compile(r"\w[\w -]*")  # of a component
LINE = re.compile(r"at line (\d+)")  # of a mistake, as the library says it
UNQUOTED = re.compile(r"=\s*([-+]?\d[\d.]*(?:[eE][-+]?\d+)?\s*[A-Za-z%\u00b5\u03bc][^\s,}\]#\"']*)")
ROTOR_TABLES = ("element", "superelement", "disc", "point_mass", "unbalance", "stations", "levitated_at")


def entries(value: object) -> Mapping[str, Any] | None:
    """A table of whatever is in it; None where it is no table."""
    return cast(Mapping[str, Any], value) if isinstance(value, Mapping) else None


def table(value: object, where: str) -> Mapping[str, Any]:
    """A table of whatever is in it."""
    mapping = entries(value)
    if mapping is None:
        raise TouchdownError(f"{where} must be a table")
    return mapping


def items(value: object) -> list[object] | None:
    """A list of whatever is in it; None where it is no list."""
    return cast(list[object], value) if isinstance(value, list) else None


def texts(value: object) -> list[str] | None:
    """A list of text; None where it is no list, or holds something else."""
    listed = items(value)
    if listed is None or not all(isinstance(item, str) for item in listed):
        return None
    return cast(list[str], listed)


def flat(table: Mapping[str, Any], prefix: str = "") -> dict[str, object]:
    """Nested tables as dotted names: [set.friction] static = 0.2 is friction.static."""
    dotted: dict[str, object] = {}
    for key, value in table.items():
        inner = entries(value)
        if inner is not None:
            dotted |= flat(inner, f"{prefix}{key}.")
        else:
            dotted[f"{prefix}{key}"] = value
    return dotted


def refuse_unusable(table: Mapping[str, Any], where: str) -> None:
    """Raise TouchdownError where values lie MAX_DEPTH in each other, or a text holds a NUL.

    No scene needs either; files, folders and recordings cannot have a NUL in their names.
    """
    level: list[object] = [table]
    for _ in range(MAX_DEPTH):
        inner: list[object] = []
        for value in level:
            mapping, listed = entries(value), items(value)
            if mapping is not None:
                inner += [*mapping, *mapping.values()]
            elif listed is not None:
                inner += listed
            elif isinstance(value, str) and "\0" in value:
                raise TouchdownError(f"{where}: {value!r} holds a NUL character; remove it")
        if not inner:
            return
        level = inner
    raise TouchdownError(f"{where}: values lie {MAX_DEPTH} deep in each other; no scene needs that")


def unquoted(error: Exception, text: str) -> str:
    """The remedy for a `text` that is no TOML where a quantity stands without quotes; else "".

    >>> unquoted(ValueError("Expected newline (at line 1, column 17)"), "clearance = 0.3 mm")
    '; write "0.3 mm" in quotes'
    """
    place = LINE.search(str(error))
    found = UNQUOTED.search(text.splitlines()[int(place[1]) - 1]) if place else None
    return f'; write "{found[1]}" in quotes' if found else ""


def mistake_in(path: Path, error: Exception) -> str:
    """The mistake in a TOML file, and the remedy of `unquoted`."""
    try:
        return f"{error}{unquoted(error, path.read_text(encoding='utf-8-sig'))}"
    except (OSError, ValueError):
        return str(error)


def is_scene_file(path: Path) -> bool:
    """Whether a TOML file is a scene's."""
    return not {"components", "extends"}.isdisjoint(_names(path))


def is_of_ross(path: Path) -> bool:
    """Whether ROSS saved a TOML file."""
    return "ross_version" in _names(path)


def _names(path: Path) -> Collection[str]:
    """The names at the top of a TOML file; none of what is no such file."""
    try:
        return tomllib.loads(path.read_text(encoding="utf-8-sig")).keys()
    except (OSError, ValueError, RecursionError):
        return ()


def is_rotor(table: Mapping[str, Any]) -> bool:
    """Whether a file's table is a rotor's, not a scene's."""
    return "components" not in table and any(key in table for key in ROTOR_TABLES)


def refuse_unknown(table: Mapping[str, Any], known: tuple[str, ...], where: str) -> None:
    """Raise TouchdownError for a key that is none of those known."""
    for key in table:
        if key not in known:
            raise TouchdownError(f"{where} has an unknown key {key}; {one_of(key, known)}")


def pairs(value: object, where: str) -> tuple[tuple[str, str], ...]:
    """A list of pairs of dotted names."""
    listed = items(value)
    parsed = [] if listed is None else [_pair(item) for item in listed]
    if listed is None or None in parsed:
        raise TouchdownError(f'{where} must be a list of pairs such as ["bearing.journal", "rotor.A"]')
    return tuple(pair for pair in parsed if pair is not None)


def components(value: object, where: str) -> tuple[tuple[str, str], ...]:
    """A list of pairs of components, such as a controller and what it controls."""
    listed = items(value)
    parsed = [] if listed is None else [texts(item) for item in listed]
    found = [(names[0], names[1]) for names in parsed if names is not None and len(names) == 2]
    if listed is None or len(found) < len(parsed):
        raise TouchdownError(f'{where} must be a list of pairs such as ["controller", "amb"]')
    return tuple(found)


def _pair(value: object) -> tuple[str, str] | None:
    names = texts(value)
    if names is None or len(names) != 2 or not all("." in name for name in names):
        return None
    return names[0], names[1]


def _is_value(value: object) -> bool:
    """Whether it is a number, or text like "20 ms"."""
    match = NUMBER.match(str(value).strip())
    return match is not None and "." not in str(value).strip()[match.end() :]


def reference(
    value: object, where: str, what: str = "a variable", example: str = "amb.shutdown_time"
) -> str:
    """COMPONENT.VARIABLE, or another name with a component's in front, for `what` it is."""
    if _is_value(value):
        raise TouchdownError(f"{where} = {value!r} is a value; it must name {what}, such as {example!r}")
    if not isinstance(value, str) or not all(value.partition(".")):
        raise TouchdownError(f"{where} = {value!r} must name {what}, such as {example!r}")
    return value


def time_of(zero: str) -> float | None:
    """The time (s) that a scene's zero is, where it names no variable."""
    return to_si(zero, "s", "zero") if _is_value(zero) else None


def zero(value: object, where: str) -> str:
    """The zero of times: a time, such as "5 ms", or COMPONENT.VARIABLE. A time is returned as "0.005 s"."""
    if _is_value(value):
        return f"{to_si(value, 's', where)!r} s"
    return reference(value, where)


def references(value: object, where: str) -> tuple[str, ...]:
    """A list of COMPONENT.VARIABLE."""
    listed = items(value)
    if listed is None:
        raise TouchdownError(f'{where} = {value!r} must be a list of variables, such as ["rotor.mass"]')
    return tuple(reference(item, where) for item in listed)


def above_zero(value: object, unit: str, name: str) -> float:
    """A number above 0 in the SI unit `unit`."""
    number = to_si(value, unit, name)
    if number <= 0.0:
        raise TouchdownError(f"{name} = {value} must be above 0")
    return number


def without_unit(name: str, value: object, number: float, unit: str, example: str) -> TouchdownError:
    """The message about a `value`, in SI a `number`, that lacks its unit since nobody can mean it."""
    return TouchdownError(
        f"{name} = {value} is {number:g} {unit}; a number without a unit is in {unit}, "
        f'write such as "{example}"'
    )


def component_name(name: str, where: str) -> str:
    """The name of a component, which variables, recordings and packages contain."""
    if not NAME.fullmatch(name):
        raise TouchdownError(
            f"{where}: no component can be called {name!r}; take letters, digits, _, - and spaces"
        )
    return name


def step_count(value: object, name: str) -> int:
    """A number of macro steps."""
    number = to_si(value, "1", name)
    if number < 1.0 or number != int(number):
        raise TouchdownError(f"{name} = {value} must be a whole number of macro steps")
    return int(number)


def switch(value: object, name: str) -> bool:
    """True or false, as TOML or the command line writes it."""
    known = {"true": True, "1": True, "false": False, "0": False}
    try:
        return known[str(value).lower()]
    except KeyError:
        raise TouchdownError(f"{name} = {value} must be true or false") from None


def beginnings(value: object, name: str) -> tuple[str, ...]:
    """Of recorded variables: a list of text, or text with commas."""
    parts = value.split(",") if isinstance(value, str) else texts(value)
    if parts is None or not all(part.strip() for part in parts):
        raise TouchdownError(f'{name} = {value!r} must be a list such as ["rotor.A", "bearing.contact"]')
    return tuple(part.strip() for part in parts)
