"""What the figures of a run tell of whirl, of all its seats in one."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from enum import StrEnum

TURNS = "_revolutions"  # behind the key of a seat's verdict: turns of its decisive whirl
TREND = "_trend"  # behind it: how a whirl goes on at the end
AT_THE_END = ", still so at the end"
STILL, OVER = re.compile(r", at \S+ s still whirling.*"), re.compile(r", \S+ to \S+ s$")


class Kind(StrEnum):
    """Verdicts in three classes."""

    SETTLES = "settles"
    TRANSIENT = "transient whirl"
    SUSTAINED = "whirls at the end"


def still(verdict: str, end: float, trend: str) -> str:
    """The words on a whirl that goes on when the run ends (s), and how.

    >>> still("backward whirl", 0.5, "decaying")
    'backward whirl, at 0.5 s still whirling, decaying'
    """
    return f"{verdict}, at {end:.4g} s still whirling, {trend}"


def over(verdict: str, start: float, end: float) -> str:
    """The words on a whirl that was over (s) before the run's end.

    >>> over("backward whirl", 0.134, 0.526)
    'transient backward whirl, 0.134 to 0.526 s'
    """
    return f"transient {verdict}, {start:.3g} to {end:.3g} s"


def verdict_class(words: str) -> str:
    """What verdicts in words have in common that differ in times and turns only.

    >>> verdict_class("backward whirl, at 0.5 s still whirling, decaying")
    'backward whirl, still so at the end'
    >>> verdict_class("transient backward whirl, 0.134 to 0.526 s")
    'transient backward whirl'
    """
    return OVER.sub("", STILL.sub(AT_THE_END, words)).partition(":")[0]


def short_of_one(turns: float) -> str:
    """Turns below one, two digits behind the point, rounded down: never told as the whole one of a whirl.

    >>> short_of_one(0.996), short_of_one(0.29)
    ('0.99', '0.29')
    """
    return f"{math.floor(100.0 * turns + 1e-9) / 100.0:.2f}"


def whirling(summary: Mapping[str, object]) -> str:
    """The verdict on the seat that whirls most, or still does at the end; "" where none does.

    As `verdict_class` has it: drops compare.
    """
    return max((_rank(summary, seat) for seat in _seats(summary)), default=(False, 0.0, ""))[2]


def how_it_goes_on(summary: Mapping[str, object]) -> str:
    """How the whirl goes on of the seat at which it does, the one that turns most; "" where none does."""
    going = [
        (_rank(summary, seat)[1], str(trend))
        for seat in _seats(summary)
        if (trend := summary.get(f"{seat}{TREND}")) is not None
    ]
    return max(going, default=(0.0, ""))[1]


def has_verdict(summary: Mapping[str, object]) -> bool:
    """Whether one could be given at any seat."""
    return any(summary[seat] is not None for seat in _seats(summary))


def kind(words: str) -> Kind:
    """The class of a verdict in words, as `whirling` gives it."""
    if not words:
        return Kind.SETTLES
    return Kind.SUSTAINED if _goes_on(words) else Kind.TRANSIENT


def _seats(summary: Mapping[str, object]) -> list[str]:
    return [key for key in summary if key.startswith("whirl_") and f"{key}{TURNS}" in summary]


def _rank(summary: Mapping[str, object], seat: str) -> tuple[bool, float, str]:
    words, turns = verdict_class(str(summary[seat])), summary[f"{seat}{TURNS}"]
    if not isinstance(turns, float) or turns <= 0.0:
        return False, 0.0, ""
    return _goes_on(words), turns, words


def _goes_on(words: str) -> bool:
    """Whether a verdict's class is of a whirl that goes on at the end."""
    return words.endswith(AT_THE_END)
