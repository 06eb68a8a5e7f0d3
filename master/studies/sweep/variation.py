"""Values a variable takes in a sweep, as people write them.

rotor.speed=6000 rpm,9000 rpm            a list; a unit at its end is everyone's
bearing.clearance=0.2,0.25,0.3 mm
bearing.balls.first_angle=0:315:8 deg    from 0 to 315, both included, 8 values
run.scheme=hold,interface                words, where a setting is a word
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


def parse(text: str) -> Variation:
    """NAME=VALUE,VALUE... or NAME=START:STOP:COUNT, with a unit at the end. Raises TouchdownError."""
    name, equals, right = (part.strip() for part in text.partition("="))
    if not equals or not name:
        raise TouchdownError(f"--vary {text}: write NAME=VALUE,VALUE,... or NAME=START:STOP:COUNT")
    if not right:
        raise TouchdownError(f"--vary {text}: the list of values is empty")
    return Variation(name, _range(text, right) if ":" in right else listed(right, f"--vary {text}"))


def parse_all(texts: Iterable[str]) -> dict[str, tuple[str, ...]]:
    """Values by name. Raises TouchdownError where there are none, or a name comes twice."""
    variations: dict[str, tuple[str, ...]] = {}
    for text in texts:
        variation = parse(text)
        if variation.name in variations:
            raise TouchdownError(
                f"--vary {variation.name} is given twice; write all its values in one list"
            )
        variations[variation.name] = variation.values
    if not variations:
        raise TouchdownError(
            "nothing varies; add --vary NAME=VALUE,VALUE,... or --vary NAME=START:STOP:COUNT"
        )
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


def _range(text: str, right: str) -> tuple[str, ...]:
    head, _, unit = right.partition(" ")
    parts = head.split(":")
    if len(parts) != 3 or ":" in unit:
        raise TouchdownError(f"--vary {text}: write START:STOP:COUNT, then the unit, such as 0:315:8 deg")
    try:
        start, stop, count = (float(part) for part in parts)
    except ValueError:
        raise TouchdownError(f"--vary {text}: START, STOP and COUNT must be numbers") from None
    if not np.isfinite([start, stop, count]).all():
        raise TouchdownError(f"--vary {text}: START, STOP and COUNT must be finite numbers")
    if count != int(count) or not 1 <= count <= MOST:
        raise TouchdownError(f"--vary {text}: COUNT must be a whole number from 1 to {MOST}")
    return tuple(f"{value:.12g} {unit.strip()}".strip() for value in np.linspace(start, stop, int(count)))
