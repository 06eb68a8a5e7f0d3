"""Where ring and balls of a bearing in space lie in its state.

Behind the copies of journal and housing come the components of a ring in the plane
(`bearings.rolling.ring`), those that it has in space, the balls of both rows, component by component, and
the cage of each row.
"""

from __future__ import annotations

from ....modelkit.kernel import inlined
from ...rolling.ball_set import MAX_BALLS
from ...rolling.ring import LANES
from .. import inner_ring

RZ, RVZ, RTX, RTY = inner_ring.Z, inner_ring.VZ, inner_ring.RX, inner_ring.RY
RWX, RWY, FACE_LOSS = inner_ring.WX, inner_ring.WY, inner_ring.FACE_LOSS
FIRST_BALL = inner_ring.NEXT

ROWS = 2
ROOM = ROWS * MAX_BALLS
X, Y, Z, VX, VY, VZ, WX, WY, WZ = range(9)  # components of a ball, in this order
SIZE = 9
CAGE_SIZE = 12  # components of a cage; those of each row's lie behind the balls
MAX_STATES = FIRST_BALL + SIZE * ROOM + ROWS * CAGE_SIZE + LANES


@inlined
def component(q, which, m):
    """(balls,) view of one component of all balls in the state q, or in its derivative."""
    n = m.d.balls
    return q[FIRST_BALL + which * n : FIRST_BALL + (which + 1) * n]
