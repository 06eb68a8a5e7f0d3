"""Swings to and fro along the bore, also those that pass a turn.

A free pendulum turns back at its ends, where its speed goes through zero, and stays within a turn from side
to side. A driven one may go over the top and come back: one way by up to FURTHEST is still a swing if it
turns back into a like one, and slows down before it does.
"""

from __future__ import annotations

import numpy as np

from touchdown.master.results.whirl.contacts import TURN, March
from touchdown.master.results.whirl.stretches import Stretch, stretches

SWING = TURN / 36.0  # from side to side; less is what is left of a pendulum, or play
FURTHEST = 2.0 * TURN  # of a swing from side to side: a turn to either side
LIKE = 0.5  # of a swing's turn: least of the one it turns back into; swings decay
GROWS = 1.25  # times the one before it: most of a swing that turns back into none such
LAST_PART = 1.0 / 8.0  # of a swing's turn, at an end at which it turns back, takes of its time
LINGERS = 0.17  # at least: 0.23 in harmonic motion, 0.125 at constant speed, when something hit it back
STAYS = 0.45  # at most; more where it came to rest in between


def to_and_fro(march: March) -> bool:
    """Whether it advances either way while in contact: a loop on one side goes back in flight."""
    advanced = [
        s.turn for s in stretches(march.angle, SWING) if march.touched(s.first, s.last) * s.turn > 0.0
    ]
    return any(turn > 0.0 for turn in advanced) and any(turn < 0.0 for turn in advanced)


def is_swing(time: np.ndarray, angle: np.ndarray, ways: list[Stretch], i: int) -> bool:
    """Whether stretch i of `ways` is one way of a swing: it turns back into a like one, and slowly.

    time: s, of each of `angle` (rad). Where the recording cuts a swing short it need not turn back.
    """
    whole = ways[i]
    before = ways[i - 1] if i > 0 else None
    after = ways[i + 1] if i + 1 < len(ways) else None
    if abs(whole.turn) >= FURTHEST or not _is_like(before, whole, after):
        return False
    shares = zip((before, after), _last_parts(time, angle, whole), strict=True)
    return all(other is None or LINGERS <= share <= STAYS for other, share in shares)


def _is_like(before: Stretch | None, whole: Stretch, after: Stretch | None) -> bool:
    """Whether it turns back into a like swing; or came out of one, where the recording may end too soon."""
    decays = after is not None and abs(after.turn) >= LIKE * abs(whole.turn)
    return decays or (before is not None and abs(whole.turn) <= GROWS * abs(before.turn))


def _last_parts(time: np.ndarray, angle: np.ndarray, whole: Stretch) -> tuple[float, float]:
    """Parts of a stretch's time that it spends in the first and the last part of its turn."""
    turned = np.abs(angle[whole.first : whole.last + 1] - angle[whole.first]) / abs(whole.turn)
    within = time[whole.first : whole.last + 1] - time[whole.first]
    left = within[np.flatnonzero(turned <= LAST_PART)[-1]]
    neared = within[np.argmax(turned >= 1.0 - LAST_PART)]
    return float(left / within[-1]), float(1.0 - neared / within[-1])
