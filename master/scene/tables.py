"""What a scene's file may hold, checked: tables, pairs, numbers, references.

Every function raises TouchdownError with `where` the mistake stands and what to write there.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from touchdown.master.common.errors import TouchdownError, one_of
from touchdown.master.common.units import to_si


def table(value: object, where: str) -> Mapping[str, Any]:
    """A table of whatever is in it."""
    if not isinstance(value, Mapping):
        raise TouchdownError(f"{where} must be a table")
    return value


def flat(table: Mapping[str, Any], prefix: str = "") -> dict[str, object]:
    """Nested tables as dotted names: [set.friction] static = 0.2 is friction.static."""
    found: dict[str, object] = {}
    for key, value in table.items():
        if isinstance(value, Mapping):
            found |= flat(value, f"{prefix}{key}.")
        else:
            found[f"{prefix}{key}"] = value
    return found


def refuse_unknown(table: Mapping[str, Any], known: tuple[str, ...], where: str) -> None:
    """Raise TouchdownError for a key that is none of those known."""
    for key in table:
        if key not in known:
            raise TouchdownError(f"{where} has an unknown key {key}; {one_of(key, known)}")


def pairs(value: object, where: str) -> tuple[tuple[str, str], ...]:
    """A list of pairs of dotted names."""
    if not isinstance(value, list) or not all(
        isinstance(p, list) and len(p) == 2 and all(isinstance(s, str) and "." in s for s in p)
        for p in value
    ):
        raise TouchdownError(f'{where} must be a list of pairs such as ["bearing.journal", "rotor.A"]')
    return tuple((p[0], p[1]) for p in value)


def reference(value: object, where: str) -> str:
    """COMPONENT.VARIABLE."""
    if not isinstance(value, str) or not all(value.partition(".")):
        raise TouchdownError(f'{where} = {value!r} must name a variable, such as "amb.shutdown_time"')
    return value


def references(value: object, where: str) -> tuple[str, ...]:
    """A list of COMPONENT.VARIABLE."""
    if not isinstance(value, list):
        raise TouchdownError(f'{where} = {value!r} must be a list of variables, such as ["rotor.mass"]')
    return tuple(reference(item, where) for item in value)


def whole(value: object, name: str) -> int:
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


def beginnings(value: object) -> tuple[str, ...]:
    """Of recorded variables: a list of text, or text with commas."""
    parts = value.split(",") if isinstance(value, str) else value
    if not isinstance(parts, list) or not all(isinstance(part, str) and part.strip() for part in parts):
        raise TouchdownError(
            f'run.record = {value!r} must be a list such as ["rotor.A", "bearing.contact"]'
        )
    return tuple(part.strip() for part in parts)
