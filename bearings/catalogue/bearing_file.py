"""Bearings of a user's own, in TOML (docs/bearings.md): what is not given is filled in by `estimate`."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from pathlib import Path

from ...modelkit.errors import TouchdownError, require
from ...modelkit.reader import TEXT, Kind, Table, number, text_of, toml_of, whole, word
from ..angular.angular_row import ARRANGEMENTS, SINGLE, SINGLES
from .entry import NUMBERS, Bearing
from .estimate import ANGULAR, DEEP_GROOVE, filled_in

OWN_FILE = "bearings.toml"
NEEDED = ("bore", "outside", "width")
MAY_BE_ZERO = ("contact_angle", "cage_mass", "damping", "row_distance", "preload")


def _kind(name: str, unit: str) -> Kind:
    if name in ("balls", "rows"):
        return whole(1, 64)
    low = -math.inf if name == "play" or name in MAY_BE_ZERO else 0.0
    least = 0.0 if name in MAY_BE_ZERO else -math.inf
    return number(unit, strict=unit != "1", above=low, minimum=least, size=(1e-15, 1e15))


KINDS = {name: _kind(name, unit) for name, (unit, _) in NUMBERS.items()}


def read_bearings(path: Path) -> dict[str, Bearing]:
    """The bearings of a file by name. Raises TouchdownError for the first mistake."""
    top = Table(f"{path}: ", toml_of(text_of(path), str(path)))
    for name in top.values:
        require(name.isprintable(), f"{path}: a bearing cannot be called {name!r}; leave out line breaks")
    return {name: _bearing(name, top.table(name), path.name) for name in top.values}


def _bearing(name: str, t: Table, file: str) -> Bearing:
    """A bearing of its table."""
    t.only((*NUMBERS, "kind", "arrangement", "origins"))
    kind = t.get("kind", word((DEEP_GROOVE, ANGULAR)), DEEP_GROOVE)
    origin_table = t.table("origins")
    origin_table.only((*NUMBERS,))
    origins = {name: origin_table.get(name, TEXT) for name in origin_table.values}
    known = {
        number: t.get(number, KINDS[number]) for number in NUMBERS if number in t.values or number in NEEDED
    }
    bore, outside = known["bore"], known["outside"]
    t.require(bore < outside, "outside", f"must be above bore = {bore:g} m")
    ball, pitch = known.get("ball_diameter", 0.0), known.get("pitch_diameter", 0.5 * (bore + outside))
    require(
        bore < pitch - ball and pitch + ball < outside,
        f"{t.where}balls of {ball:g} m on a pitch of {pitch:g} m do not fit between bore and outside",
    )
    arrangement = _arrangement(t, known, kind)
    try:
        entry = filled_in(name, kind, known, {key: origins.get(key, file) for key in known}, arrangement)
    except ValueError as error:
        raise TouchdownError(f"{t.where[:-1]}: {error}") from None
    t.require(
        min(entry.ring.mass, entry.outer_ring) > 0.0, "width", "leaves nothing of a ring beside its groove"
    )
    return entry


def _arrangement(t: Table, known: Mapping[str, float], kind: str) -> int:
    """How two rows with a contact angle stand; those of a row alone, or without that, are single."""
    words = ARRANGEMENTS.words
    found = words.index(t.get("arrangement", word(words), words[SINGLE]))
    angled = known.get("contact_angle", 1.0 if kind == ANGULAR else 0.0) > 0.0
    rows, named = (1, "a row") if found in SINGLES else (2, "a pair")
    t.require(
        not (found != SINGLE and (known.get("rows", 1) != rows or not angled)),
        "arrangement",
        f"is of {named}: rows = {rows}, with a contact angle",
    )
    return found


def bearing_file_text(bearing: Bearing) -> str:
    """A bearing as a file of the user's: what `read_bearings` takes, each number with its origin."""
    kind = ANGULAR if bearing.contact_angle > 0.0 else DEEP_GROOVE
    name = json.dumps(bearing.designation, ensure_ascii=False)
    lines = [f"[{name}]", f'kind = "{kind}"']
    if bearing.arrangement != SINGLE:
        lines.append(f'arrangement = "{ARRANGEMENTS.words[bearing.arrangement]}"')
    for key, value in bearing.numbers().items():
        unit, meaning = NUMBERS[key]
        text = f"{value:g}" if unit == "1" else f'"{value:.6g} {unit}"'
        lines.append(f"{key} = {text}  # {meaning}")
    lines += ["", f"[{name}.origins]"]
    lines += [f"{key} = {json.dumps(note, ensure_ascii=False)}" for key, note in bearing.origins.items()]
    return "\n".join(lines) + "\n"
