"""How rows of balls with a contact angle stand beside each other and are clamped."""

from __future__ import annotations

import math
from dataclasses import dataclass

from ...modelkit.kernel import kernel
from ...modelkit.status import OK, ROW_OFF
from ...modelkit.variables import choice, group, real
from ..contact.face import Shoulder
from .angular_row import ARRANGEMENTS, CLAMPED, SINGLE, SINGLES, sides_of

PROBLEMS = (
    "arrangement needs two rows with a contact angle; set balls.rows = 2, not {0:g}, and "
    "balls.contact_angle above 0",
    "balls.rows = {0:g} with a contact angle need an arrangement; set it to back to back, face to face, "
    "tandem or tandem reversed",
    "balls.play = {0:g} m has no meaning with a contact angle; set it to 0, and preload where two rows "
    "are clamped",
    "preload = {0:g} N clamps two rows against each other; set arrangement to back to back or face to face",
    "interference = {0:g} m clamps two rows against each other; set arrangement to back to back or face to "
    "face",
    "preload = {0:g} N and interference = {1:g} m both say how a pair is clamped; set one of them to 0",
)
LATELY = 0.1  # s, more than a rotor flies between faces: through 1 mm and back, against 1 g, takes 0.03 s
WEIGHT = 9.81  # m/s2, whichever way the shaft lies


@dataclass(frozen=True)
class RowsParameters:
    """Rows with a contact angle, and the faces on which a shoulder of the rotor lands."""

    arrangement: int = choice(
        SINGLE, ARRANGEMENTS, "how rows with a contact angle stand, and to which side they are open"
    )
    row_distance: float = real(
        0.0,
        "m",
        "row spacing of a pair, between the middles",
        minimum=0.0,
        needs="arrangement and arrangement != 4",
    )
    preload: float = real(0.0, "N", "axial preload of a pair", minimum=0.0)
    interference: float = real(
        0.0,
        "m",
        "total preload offset by which the rings of a pair are closed, in place of a preload; negative: "
        "their play along the shaft",
        minimum=-1e-3,
        maximum=1e-3,
    )
    shoulder: Shoulder = group(Shoulder)
    land: float = real(
        0.0,
        "m",
        "length of the bore's land, at whose edges a tilted journal touches; 0: it touches in the middle",
        minimum=0.0,
    )


@kernel
def rows_problem(p, numbers):
    """The number in `PROBLEMS` of a fault in the rows' parameters p, or 0; numbers: for its text."""
    b, paired = p.balls, p.arrangement not in SINGLES
    angular, clamped = b.contact_angle > 0.0, p.arrangement in CLAMPED
    numbers[0] = b.rows
    if paired and (b.rows != 2 or not angular):
        return 1
    if angular and b.rows != 1 and not paired:
        return 2
    if angular and b.play != 0.0:
        numbers[0] = b.play
        return 3
    numbers[0] = p.preload
    if p.preload > 0.0 and not clamped:
        return 4
    if p.interference != 0.0 and p.preload > 0.0:
        numbers[1] = p.interference
        return 6
    numbers[0] = p.interference
    return 5 if p.interference != 0.0 and not clamped else 0


@kernel
def status_on_row(status, m, step):
    """`status` of a macro step of `step` (s), or `ROW_OFF` where the rotor presses the ring off its row.

    That is where the most loaded ball touches beyond the bottom of its groove, on the side of the missing
    shoulder, while the rotor pushes the ring there along the shaft, or presses on its bore at all, and has
    not held the ring to its shoulder of late. A ring that flies free may touch there: the low shoulder that
    real rings keep holds its own weight. A rotor that bounces on the shoulder lets the ring swing there,
    too, and hits it meanwhile; but in the mean over `LATELY` its push is towards the shoulder, by far more
    than the ring's weight.
    """
    if m.p.balls.contact_angle == 0.0 or m.p.arrangement in CLAMPED:
        return status
    s, side = m.s, sides_of(m.p.arrangement)[0]
    off = m.o.journal.fz * side  # of the ring on the journal: above 0 where the rotor pushes it off
    s.pushed_off += (off - s.pushed_off) * (1.0 - math.exp(-step / LATELY))
    if status != OK or m.o.along.contact_angle * side >= 0.0 or s.pushed_off < -m.p.ring.mass * WEIGHT:
        return status
    return ROW_OFF if off > 0.0 or m.o.contact.force > 0.0 else status
