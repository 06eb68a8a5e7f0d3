"""What the figures of a run tell of whirl, of all its seats in one."""

from __future__ import annotations

import math
from collections.abc import Mapping
from enum import StrEnum

TURNS = "_revolutions"  # behind the key of a seat's verdict: turns of its decisive whirl


class Kind(StrEnum):
    """Verdicts in three classes."""

    SETTLES = "settles"
    TRANSIENT = "transient whirl"
    SUSTAINED = "sustained whirl"


def short_of_one(turns: float) -> str:
    """Turns below one, two digits behind the point, rounded down: never told as the whole one of a whirl.

    >>> short_of_one(0.996), short_of_one(0.29)
    ('0.99', '0.29')
    """
    return f"{math.floor(100.0 * turns + 1e-9) / 100.0:.2f}"


def whirling(summary: Mapping[str, object]) -> str:
    """The verdict on the seat that whirls most, or still does at the end; "" where none does."""
    return max((_rank(summary, seat) for seat in _seats(summary)), default=(False, 0.0, ""))[2]


def has_verdict(summary: Mapping[str, object]) -> bool:
    """Whether one could be given at any seat."""
    return any(summary[seat] is not None for seat in _seats(summary))


def kind(words: str) -> Kind:
    """The class of a verdict in words, as `whirling` gives it."""
    if not words:
        return Kind.SETTLES
    return Kind.SUSTAINED if words.startswith("sustained") else Kind.TRANSIENT


def _seats(summary: Mapping[str, object]) -> list[str]:
    return [key for key in summary if key.startswith("whirl_") and f"{key}{TURNS}" in summary]


def _rank(summary: Mapping[str, object], seat: str) -> tuple[bool, float, str]:
    words, turns = str(summary[seat]), summary[f"{seat}{TURNS}"]
    if not isinstance(turns, float) or turns <= 0.0:
        return False, 0.0, ""
    return words.startswith("sustained"), turns, words
