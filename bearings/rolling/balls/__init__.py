"""The balls of a bearing: what is declared of them, what follows, and where the ring rests on them.

`declarations` is what parameters and outputs hold, `geometry` what follows from it, `rest` the place of the
ring at the start; `watch` looks at the balls while the bearing runs.
"""

from __future__ import annotations

from touchdown.bearings.rolling.balls.declarations import (
    MOST_BALLS,
    BallContacts,
    BallReport,
    BallSet,
    Coordinates,
    FreeBallSet,
    RaceStiffness,
)
from touchdown.bearings.rolling.balls.watch import Total, largest, watch_balls

__all__ = [
    "MOST_BALLS",
    "BallContacts",
    "BallReport",
    "BallSet",
    "Coordinates",
    "FreeBallSet",
    "RaceStiffness",
    "Total",
    "largest",
    "watch_balls",
]
