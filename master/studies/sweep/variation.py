"""Values a variable takes in a sweep, as people write them.

rotor.speed=6000 rpm,9000 rpm            a list; a unit at its end is everyone's
bearing.clearance=0.2,0.25,0.3 mm
bearing.balls.first_angle=0:315:8 deg    from 0 to 315, both included, 8 values
run.scheme=hold,interface                words, where a setting is a word
a.mass,b.mass=1,2 kg                     several settings have the same value
bearing_*.friction.dynamic=0.1,0.2       so do all that match

A range to draw from has two ends, and the unit of both:

rotor.speed=6000:12000 rpm
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from touchdown.master.common.errors import TouchdownError

MOST = 100_000  # values of one variable; more is a slip of the pen


@dataclass(frozen=True)
class Variation:
    """A setting of a scene, COMPONENT.VARIABLE or run.KEY, and its values: text, with a unit if any."""

    name: str
    values: tuple[str, ...]


def parse(text: str, option: str = "--vary") -> Variation:
    """NAME=VALUE,VALUE... or NAME=START:STOP:COUNT, with a unit at the end. Raises TouchdownError."""
    what = f"{option} {text}"
    name, equals, right = (part.strip() for part in text.partition("="))
    if not equals or not name:
        raise TouchdownError(f"{what}: write NAME=VALUE,VALUE,... or NAME=START:STOP:COUNT")
    if not right:
        raise TouchdownError(f"{what}: the list of values is empty")
    is_range = ":" in right and ".toml:" not in right  # a preset may be FILE.toml:NAME
    return Variation(name, _evenly(right, what) if is_range else listed(right, what))


def parse_all(texts: Iterable[str], option: str = "--vary") -> dict[str, tuple[str, ...]]:
    """Values by name, given with `option`. Raises TouchdownError where a name comes twice."""
    variations: dict[str, tuple[str, ...]] = {}
    for text in texts:
        variation = parse(text, option)
        if variation.name in variations:
            raise TouchdownError(
                f"{option} {variation.name} is given twice; write all its values in one list"
            )
        variations[variation.name] = variation.values
    return variations


def number_and_unit(value: object) -> tuple[float, str] | None:
    """Both parts of a value; None for a word."""
    head, _, unit = str(value).strip().partition(" ")
    try:
        return float(head), unit.strip()
    except ValueError:
        return None


def listed(text: str, what: str) -> tuple[str, ...]:
    """Values with commas between them; a unit at the end is everyone's. `what`: for a complaint."""
    items = [item.strip() for item in text.split(",")]
    if not all(items):
        raise TouchdownError(f"{what}: a value is missing between the commas")
    parts = [number_and_unit(item) for item in items]
    last = parts[-1]
    if last is None or not last[1]:
        return tuple(items)
    bare = [part is not None and not part[1] for part in parts]
    return tuple(f"{item} {last[1]}" if alone else item for item, alone in zip(items, bare, strict=True))


@dataclass(frozen=True)
class Range:
    """Values from `low` to `high`, in `unit` ("": SI)."""

    low: float
    high: float
    unit: str

    def at(self, part: float) -> str:
        """The value at a part (0 to 1) of the way, as text with its unit."""
        return with_unit(self.low + part * (self.high - self.low), self.unit)


def parse_range(text: str, what: str) -> Range:
    """LOW:HIGH, with a unit at the end. `what`: for a complaint. Raises TouchdownError."""
    head, _, unit = text.strip().partition(" ")
    try:
        low, high = (float(part) for part in head.split(":"))
    except ValueError:
        raise TouchdownError(f"{what}: write LOW:HIGH, then the unit, such as 6000:12000 rpm") from None
    if not np.isfinite([low, high]).all() or not low < high:
        raise TouchdownError(f"{what}: LOW must be below HIGH, and both finite")
    return Range(low, high, unit.strip())


def with_unit(number: float, unit: str) -> str:
    """As text, in twelve digits."""
    return f"{number:.12g} {unit}".strip()


def _evenly(right: str, what: str) -> tuple[str, ...]:
    head, _, unit = right.partition(" ")
    parts = head.split(":")
    if len(parts) != 3 or ":" in unit:
        raise TouchdownError(f"{what}: write START:STOP:COUNT, then the unit, such as 0:315:8 deg")
    try:
        start, stop, count = (float(part) for part in parts)
    except ValueError:
        raise TouchdownError(f"{what}: START, STOP and COUNT must be numbers") from None
    if not np.isfinite([start, stop, count]).all():
        raise TouchdownError(f"{what}: START, STOP and COUNT must be finite numbers")
    if count != int(count) or not 1 <= count <= MOST:
        raise TouchdownError(f"{what}: COUNT must be a whole number from 1 to {MOST}")
    return tuple(with_unit(value, unit.strip()) for value in np.linspace(start, stop, int(count)))
