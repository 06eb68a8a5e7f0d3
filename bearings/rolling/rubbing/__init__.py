"""Friction of the balls at both races and of the journal in the bore, over a kick.

`lines` is the force at each contact that presses, by the speed that the kick leaves; `together` solves for
the speeds of balls and ring, which all of them share.
"""

from __future__ import annotations

from touchdown.bearings.rolling.rubbing.lines import FrictionLines
from touchdown.bearings.rolling.rubbing.together import (
    Answers,
    Around,
    Bore,
    Inner,
    Moved,
    Push,
    Rubbed,
    RubbedRace,
    over_ring,
    rub,
    rubbed_of,
)

__all__ = [
    "Answers",
    "Around",
    "Bore",
    "FrictionLines",
    "Inner",
    "Moved",
    "Push",
    "Rubbed",
    "RubbedRace",
    "over_ring",
    "rub",
    "rubbed_of",
]
