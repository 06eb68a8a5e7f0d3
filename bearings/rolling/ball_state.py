"""How all balls of a bearing lie in its state: component by component, behind the ring.

Loops over the balls hold no branches and no calls of the mathematical library, so that the compiler turns
them into vector code. That takes `LANES` balls at a time and is slow on what is left over, so the loops
may run past the last ball (`rounded`); what lies there does not matter, but there must be room for it.
"""

from __future__ import annotations

from touchdown.bearings.rolling import ring
from touchdown.bearings.rolling.balls import MOST_BALLS
from touchdown.modelkit.kernel import kernel, woven

BALLS = ring.NEXT  # from here each component of all balls in turn
LANES = 16  # as compiled for 512 bit; half of it is in use at 256
SPARE = 2  # balls left over that are quicker alone than with company
MOST_STATES = BALLS + 6 * (MOST_BALLS + 1) + LANES  # with a cage, and room to run past the last ball


@kernel
def part(q, component, m):
    """(count,) view of one component of all balls in the state q, or in its derivative."""
    count = m.p.balls.count
    return q[BALLS + component * count : BALLS + (component + 1) * count]


@kernel
def rounded(count):
    """How many balls the loops run over for `count`; all arrays have room for `MOST_BALLS`."""
    left = count % LANES
    return count if left <= SPARE else count - left + LANES


@woven
def drift(trial, q, mid, h, place, rate, n):
    """Set n places in the state `trial`: those in q and h (s) times their rates in `mid`.

    place, rate: numbers of the first ones in the state.
    """
    to, start, by = trial[place : place + n], q[place : place + n], mid[rate : rate + n]
    for b in range(len(to)):
        to[b] = start[b] + h * by[b]


@woven
def copy(given, to):
    """Set `to` (n,) to what is `given` (n,)."""
    for b in range(len(to)):
        to[b] = given[b]
