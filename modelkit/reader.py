"""What users write in files, read by declarations: tables of TOML, and rows of `modelkit.sheets`.

The keys of a table are fields of a dataclass, made by `key`: its `Kind` and its default.
A mistake is one line: place = value, what is wrong, what to write.
"""

from __future__ import annotations

import json
import math
import re
import stat
import sys
import tomllib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import MISSING, dataclass, field, fields
from pathlib import Path
from textwrap import shorten
from typing import Any, TypeVar

from .errors import TouchdownError, one_of, require
from .units import display_unit, is_bare, per_display, spellings_of, to_si

Made = TypeVar("Made")


def mistake(name: str, value: object, says: str) -> TouchdownError:
    """The error to raise about what stands at `name`; MISSING: nothing does."""
    return TouchdownError(f"{name}{'' if value is MISSING else f' = {shorten(repr(value), 60)}'} {says}")


MAX_WHOLE = 1e15  # of what is counted; floats hold it exactly


@dataclass(frozen=True)
class Kind:
    """What a value may be: `take(value, name)` reads it; `meant` says it in words, with an example.

    `take` raises TouchdownError with what is wrong, or the errors of Python's
    operations on a value that is not what is meant.
    """

    take: Callable[[Any, str], Any]
    meant: str
    unit: str = ""  # SI, of a number

    def read(self, value: object, name: str) -> Any:
        """A value that stands at `name`. Raises TouchdownError."""
        try:
            return self.take(value, name)
        except (ValueError, TypeError, KeyError, AttributeError):
            raise mistake(name, value, f"must be {self.meant}") from None


def number(
    unit: str = "1",
    *,
    above: float = -math.inf,
    minimum: float = -math.inf,
    below: float = math.inf,
    maximum: float = math.inf,
    size: tuple[float, float] = (0.0, math.inf),
    example: str = "",
    strict: bool = False,
) -> Kind:
    """A number in SI, or text with a unit, within bounds (SI).

    size: of what is not 0; beyond, it is a slip. strict: it must have a unit.
    """
    limits = {"above": above, "at least": minimum, "below": below, "at most": maximum}
    per = "" if unit == "1" else f" {unit}"
    bounds = " and ".join(
        f"{word} {bound:g}{per}" for word, bound in limits.items() if math.isfinite(bound)
    )
    units = (
        f"text with a unit of {unit} ({', '.join(spellings_of(unit))})"
        if strict
        else f"a number{per and f' in{per}'}"
    )
    meant = f"{units}{bounds and f', {bounds}'}{example and f', such as {example!r}'}"

    def take(value: object, name: str) -> float:
        bare = is_bare(value)
        if strict and bare:
            raise mistake(name, value, f"has no unit; write {meant}")
        found = to_si(value, unit, name)
        hint = (
            f"; a number without a unit is in {unit}, write such as {example!r}"
            if bare and per and example
            else ""
        )
        if not (found > above and minimum <= found < below and found <= maximum):
            raise mistake(name, value, f"must be {bounds}{hint}")
        if found != 0.0 and not size[0] <= abs(found) <= size[1]:
            raise mistake(
                name, value, f"is out of proportion; it must be {size[0]:g} to {size[1]:g}{per}{hint}"
            )
        return found

    return Kind(take, meant, unit)


def whole(low: int, high: float = math.inf, what: str = "whole number") -> Kind:
    """A whole number from `low` to `high`."""

    def take(value: object, name: str) -> int:
        found = to_si(value, "1", name)
        if abs(found) > MAX_WHOLE:
            raise mistake(name, value, f"is out of proportion; {MAX_WHOLE:g} is the most")
        if found != int(found) or not low <= found <= high:
            raise ValueError
        return int(found)

    return Kind(take, f"a {what} from {low}{' on' if high == math.inf else f' to {high:g}'}", "1")


def instance(python_type: Any, meant: str) -> Kind:
    """A value of a type of Python's, unchanged."""

    def take(value: object, name: str) -> Any:
        if not isinstance(value, python_type):
            raise TypeError
        return value

    return Kind(take, meant)


TEXT, TABLE, LIST = instance(str, "text"), instance(Mapping, "a table"), instance((list, tuple), "a list")
FLAG = Kind(
    lambda value, name: {"true": True, "1": True, "false": False, "0": False}[str(value).lower()],
    "true or false",
)


def _figure(value: Any, name: str) -> float:
    if type(value) not in (int, float) or not abs(value) < sys.float_info.max:
        raise ValueError
    return value


FIGURE = Kind(_figure, "a finite number")  # unchanged, of no unit


def maybe(kind: Kind) -> Kind:
    """What `kind` is, or null."""
    return Kind(
        lambda value, name: None if value is None else kind.take(value, name), f"{kind.meant}, or null"
    )


def row(*columns: Kind) -> Kind:
    """A list of as many values, each of its kind, as a tuple."""

    def take(value: object, name: str) -> tuple[Any, ...]:
        pairs = zip(columns, LIST.take(value, name), strict=True)
        return tuple(kind.read(one, f"{name}[{i}]") for i, (kind, one) in enumerate(pairs, 1))

    return Kind(take, f"a list of {len(columns)} values")


def word(known: Sequence[str]) -> Kind:
    """One of the `known` words."""

    def take(value: object, name: str) -> str:
        if value not in known:
            raise mistake(name, value, f"is not known; {one_of(str(value), known)}")
        return str(value)

    return Kind(take, f"one of {', '.join(known)}")


def listed(kind: Kind) -> Kind:
    """A list, as a tuple."""

    def take(value: object, name: str) -> tuple[Any, ...]:
        return tuple(kind.read(one, name) for one in LIST.take(value, name))

    return Kind(take, f"a list, each of {kind.meant}")


def key(kind: Kind, default: Any = MISSING, says: str = "") -> Any:
    """Declare a key of a table; required without a default. says: what it is, for people."""
    return field(default=default, metadata={"kind": kind, "says": says})


def kinds(declared: type) -> dict[str, Kind]:
    """The keys that a dataclass declares, and what each may be."""
    return {f.name: f.metadata["kind"] for f in fields(declared) if "kind" in f.metadata}


def described_keys(declared: type) -> list[tuple[str, str, str, str]]:
    """The keys that a dataclass declares, for people: name, what each may be, its default, what it is.

    The default is "" where there is none, and "required" where there must be a value.
    """
    return [
        (f.name, f.metadata["kind"].meant, _default(f.default, f.metadata["kind"].unit), f.metadata["says"])
        for f in fields(declared)
        if "kind" in f.metadata
    ]


def _default(value: Any, unit: str) -> str:
    if value is MISSING:
        return "required"
    if isinstance(value, bool):
        return str(value).lower()
    if value is None or value in ("", ()):
        return ""
    if not isinstance(value, (int, float)):
        return str(getattr(value, "name", value))
    if value == 0.0 or unit in ("", "1"):
        return f"{value:g}"
    written = display_unit(unit, value)
    read = per_display(unit, written) * value
    return f"{read:g} {written}" if read >= 1.0 else f"{value:g} {unit}"


@dataclass(frozen=True)
class Table:
    """A table of a file; `where` stands before its keys in messages, such as "mine.toml: element[2]."."""

    where: str
    values: Mapping[str, Any]

    def name(self, key: str) -> str:
        """The place of the value of a key in the file."""
        return self.where + (key if re.fullmatch(r"[\w-]+", key) else repr(key))

    def error(self, key: str, says: str) -> TouchdownError:
        """The error to raise about the value of a key."""
        return mistake(self.name(key), self.values.get(key, MISSING), says)

    def require(self, holds: object, key: str, says: str) -> None:
        """Raise TouchdownError about the value of a key unless the condition holds."""
        if not holds:
            raise self.error(key, says)

    def only(self, known: Sequence[str]) -> None:
        """Raise TouchdownError for the first key that is not known."""
        for found in self.values:
            if found not in known:
                raise TouchdownError(f"{self.name(found)} is not a known key; {one_of(found, known)}")

    def get(self, key: str, kind: Kind, default: Any = MISSING) -> Any:
        """The value of a key; required unless there is a default. Raises TouchdownError."""
        if key in self.values:
            return kind.read(self.values[key], self.name(key))
        if default is MISSING:
            raise TouchdownError(f"{self.name(key)} is missing; it must be {kind.meant}")
        return default

    def read(self, declared: type[Made], *others: str, **more: Any) -> Made:
        """What the table says, by its declaration; `others`: keys that are read elsewhere, to `more`."""
        known = kinds(declared)
        self.only((*known, *others))
        defaults = {f.name: f.default for f in fields(declared)}  # type: ignore[arg-type]
        return declared(**{n: self.get(n, known[n], defaults[n]) for n in known if n not in more}, **more)

    def table(self, key: str) -> Table:
        """A table within this one; an empty one where there is none."""
        return Table(f"{self.name(key)}.", self.get(key, TABLE, {}))

    def tables(self, key: str) -> list[Table]:
        """A list of tables, written [[key]]; none where there is none."""
        meant = f"a list of tables, each written [[{key}]]"
        found = self.get(key, Kind(listed(Kind(TABLE.take, meant)).take, meant), ())
        return [Table(f"{self.name(key)}[{i}].", values) for i, values in enumerate(found, 1)]


# -- files -------------------------------------------------------------------------------------------

MAX_BYTES = 128e6  # bytes of a file
MAX_DEPTH = 32  # of tables and lists in each other
LINE = re.compile(r"at line (\d+)")  # of a mistake, as the library says it
UNQUOTED = re.compile(r"=\s*([-+]?\d[\d.]*(?:[eE][-+]?\d+)?\s*[A-Za-z%\u00b5\u03bc][^\s,}\]#\"']*)")


def text_of(path: Path, what: str = "", most: float = MAX_BYTES) -> str:
    """The text of a file of at most so many bytes. `what`: of which kind. Raises TouchdownError."""
    name = f"{what} {path}".strip()
    try:
        return content_of(path, name, most).decode("utf-8-sig")  # some editors begin files with a mark
    except UnicodeDecodeError as error:
        raise TouchdownError(
            f"{name} is not text in UTF-8 (byte {error.start}); save it as UTF-8"
        ) from None


def content_of(path: Path, name: str, most: float = MAX_BYTES) -> bytes:
    """The bytes of a file, `most` of them at most; `name`: of it, in messages. Raises TouchdownError.

    A named pipe or a device, which may never end, is refused before it is opened.
    """
    try:
        kind = path.stat().st_mode
        require(stat.S_ISREG(kind) or stat.S_ISDIR(kind), f"cannot read {name}: it is a pipe or a device")
        with path.open("rb") as file:
            content = file.read(int(most) + 1)
    except OSError as error:
        raise TouchdownError(f"cannot read {name}: {error.strerror}") from None
    except ValueError as error:  # of a path that no file can have
        raise TouchdownError(f"cannot read {name!r}: {error}") from None
    require(len(content) <= most, f"{name} is larger than {most / 1e6:.0f} MB; it must be something else")
    return content


def toml_of(text: str, name: str) -> dict[str, Any]:
    """The tables in the text of the TOML file `name`. Raises TouchdownError."""
    try:
        data = tomllib.loads(text)
    except RecursionError:
        raise TouchdownError(f"{name}: is not valid TOML: its values lie too deep in each other") from None
    except ValueError as error:  # of TOML's syntax, of an integer with thousands of digits
        place = LINE.search(str(error))
        found = UNQUOTED.search(text.splitlines()[int(place[1]) - 1]) if place else None
        remedy = f'; write "{found[1]}" in quotes' if found else ""
        raise TouchdownError(f"{name}: is not valid TOML: {error}{remedy}") from None
    return _plain(data, name)


def json_of(text: str | bytes, name: str) -> dict[str, Any]:
    """The table in the text of the JSON file `name`. Raises TouchdownError."""
    try:
        data = json.loads(text)
    except RecursionError:
        raise TouchdownError(f"{name} is not valid JSON: its values lie too deep in each other") from None
    except ValueError as error:  # of the syntax, of an integer with thousands of digits, of bytes
        raise TouchdownError(f"{name} is not valid JSON: {error}") from None
    require(isinstance(data, dict), f"{name} holds a {type(data).__name__}, and must hold an object")
    return _plain(data, name)


def _plain(data: dict[str, Any], name: str) -> dict[str, Any]:
    """What a file holds, which is not deep. Raises TouchdownError, also for NUL characters."""
    level: list[Any] = [data]
    for _ in range(MAX_DEPTH):
        texts = [value for value in level if isinstance(value, str) and "\0" in value]
        if texts:  # files, folders and recordings cannot have it in their names
            raise TouchdownError(f"{name}: {texts[0]!r} holds a NUL character; remove it")
        inner = [
            [*v, *v.values()] if isinstance(v, Mapping) else v for v in level if isinstance(v, (dict, list))
        ]
        if not inner:
            return data
        level = [value for values in inner for value in values]
    raise TouchdownError(f"{name}: values lie {MAX_DEPTH} deep in each other; no file needs that")
