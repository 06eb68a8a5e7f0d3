"""Bearings of a user's own, in TOML. What is not given is filled in by the rules of `estimate`.

    ["7014 of mine"]
    kind = "angular contact"     # or "deep groove": what the rules take it for
    bore = "70 mm"               # these three must be given, all that follows may be
    outside = "110 mm"
    width = "20 mm"
    balls = 19
    ball_diameter = "12.3 mm"
    static_rating = "43 kN"      # of one row
    # rows = 2, arrangement = "back to back", "face to face", "tandem" or "tandem reversed": a pair, with
    # numbers of both together

    ["7014 of mine".origins]     # where numbers are from; without, this file
    static_rating = "the maker's catalogue, page 12"

All numbers are listed in `NUMBERS`. The file is found beside a scene as `bearings.toml`.
"""

from __future__ import annotations

import json
import tomllib
from collections.abc import Iterable, Mapping
from difflib import get_close_matches
from pathlib import Path
from typing import Any

from ...modelkit.model import ModelError
from ...modelkit.units import UnitError, to_si
from ..angular.row import ARRANGEMENTS, SINGLE, SINGLES
from .entry import NUMBERS, Bearing
from .estimate import ANGULAR, DEEP_GROOVE, filled_in

OWN_FILE = "bearings.toml"
NEEDED = ("bore", "outside", "width")
MAY_BE_ZERO = ("contact_angle", "play", "cage_mass", "damping", "row_distance", "preload")
WHOLE = ("balls", "rows")
KINDS = (DEEP_GROOVE, ANGULAR)


class CatalogueError(ModelError):
    """A bearing that is not there, or a mistake in a file of bearings: one line."""

    def __init__(self, message: str, known: Iterable[str] = ()) -> None:
        super().__init__(message)
        self.known = tuple(known)  # names of the bearings there are, where one was asked for that is not


def read(path: Path) -> dict[str, Bearing]:
    """The bearings of a file by name. Raises CatalogueError for the first mistake."""
    try:
        tables = tomllib.loads(path.read_text(encoding="utf-8-sig"))  # some editors begin files with a mark
    except OSError as error:
        raise CatalogueError(f"{path}: cannot be read: {error.strerror}") from None
    except (ValueError, RecursionError) as error:
        raise CatalogueError(f"{path}: is not valid TOML: {error}") from None
    for name in tables:
        if not name.isprintable():
            raise CatalogueError(f"{path}: a bearing cannot be called {name!r}; leave out line breaks")
    return {name: _bearing(name, table, f"{path}: [{name}]", path.name) for name, table in tables.items()}


def _bearing(name: str, table: Any, where: str, file: str) -> Bearing:
    """A bearing of its table."""
    if not isinstance(table, dict):
        raise CatalogueError(f"{where} must be a table, with {', '.join(NEEDED)} of a bearing")
    kind = table.get("kind", DEEP_GROOVE)
    if kind not in KINDS:
        raise CatalogueError(f"{where}: kind = {kind!r}; write {' or '.join(map(repr, KINDS))}")
    origins = table.get("origins", {})
    numbers = {k: value for k, value in table.items() if k not in ("kind", "arrangement", "origins")}
    _refuse_unknown(numbers, where)
    if not isinstance(origins, dict) or not all(isinstance(text, str) for text in origins.values()):
        raise CatalogueError(f'{where}: origins must be a table such as bore = "the drawing"')
    _refuse_unknown(origins, f"{where}: origins")
    for needed in NEEDED:
        if needed not in numbers:
            raise CatalogueError(f'{where}: {needed} is missing; write such as {needed} = "20 mm"')
    given = {key: _number(key, value, where) for key, value in numbers.items()}
    _check_proportion(given, where)
    arrangement = _arrangement(table, given, kind, where)
    try:
        made = filled_in(name, kind, given, {key: origins.get(key, file) for key in given}, arrangement)
    except ValueError as error:
        raise CatalogueError(f"{where}: {error}") from None
    if not min(made.ring.mass, made.outer_ring) > 0.0:
        raise CatalogueError(
            f"{where}: width = {made.width:g} m leaves nothing of a ring beside its groove"
        )
    return made


def _arrangement(table: Mapping[str, Any], given: Mapping[str, float], kind: str, where: str) -> int:
    """How two rows with a contact angle stand; those of a row alone, or without that, are single."""
    word, words = table.get("arrangement", ARRANGEMENTS.words[SINGLE]), ARRANGEMENTS.words
    if word not in words:
        raise CatalogueError(f"{where}: arrangement = {word!r}; write {' or '.join(map(repr, words))}")
    angled, number = given.get("contact_angle", 1.0 if kind == ANGULAR else 0.0) > 0.0, words.index(word)
    rows, named = (1, "a row") if number in SINGLES else (2, "a pair")
    if number != SINGLE and (given.get("rows", 1) != rows or not angled):
        raise CatalogueError(
            f"{where}: arrangement = {word!r} is of {named}: rows = {rows}, with a contact angle"
        )
    return number


def _refuse_unknown(table: Mapping[str, Any], where: str) -> None:
    for key in table:
        if key not in NUMBERS:
            near = get_close_matches(key, NUMBERS, n=1)
            remedy = f"did you mean {near[0]}" if near else f"there are: {', '.join(NUMBERS)}"
            raise CatalogueError(f"{where}: {key} is not known of a bearing; {remedy}")


def _number(key: str, value: Any, where: str) -> float:
    """A number in SI: text with a unit, but for counts and ratios."""
    unit = NUMBERS[key][0]
    if unit != "1" and not isinstance(value, str):
        raise CatalogueError(f"{where}: {key} = {value!r} has no unit; it is measured in {unit}")
    try:
        number = to_si(value, unit, f"{where}: {key}")
    except UnitError as error:
        raise CatalogueError(str(error)) from None
    if key in WHOLE and (number != int(number) or not 1.0 <= number <= 64.0):
        raise CatalogueError(f"{where}: {key} = {value!r} must be a whole number above 0, at most 64")
    if (number <= 0.0 and key not in MAY_BE_ZERO) or (number < 0.0 and key != "play"):
        raise CatalogueError(f"{where}: {key} = {value!r} must be above 0")
    return int(number) if key in WHOLE else number


def _check_proportion(given: Mapping[str, float], where: str) -> None:
    """Balls between the bore and the outside. What a model makes of the rest, it says itself."""
    bore, outside = given["bore"], given["outside"]
    if not bore < outside:
        raise CatalogueError(f"{where}: outside = {outside:g} m must be above bore = {bore:g} m")
    ball, pitch = given.get("ball_diameter", 0.0), given.get("pitch_diameter", 0.5 * (bore + outside))
    if not bore < pitch - ball or not pitch + ball < outside:
        raise CatalogueError(
            f"{where}: balls of {ball:g} m on a pitch of {pitch:g} m do not fit between bore and outside"
        )


def as_file(bearing: Bearing) -> str:
    """A bearing as a file of the user's: what `read` takes, each number with its origin."""
    kind = ANGULAR if bearing.contact_angle > 0.0 else DEEP_GROOVE
    name = json.dumps(bearing.designation, ensure_ascii=False)
    lines = [f"[{name}]", f'kind = "{kind}"']
    if bearing.arrangement != SINGLE:
        lines.append(f'arrangement = "{ARRANGEMENTS.words[bearing.arrangement]}"')
    for number, value in bearing.numbers().items():
        unit, meaning = NUMBERS[number]
        text = f"{value:g}" if unit == "1" else f'"{value:.6g} {unit}"'
        lines.append(f"{number} = {text}  # {meaning}")
    lines += ["", f"[{name}.origins]"]
    lines += [f"{number} = {json.dumps(of, ensure_ascii=False)}" for number, of in bearing.origins.items()]
    return "\n".join(lines) + "\n"
