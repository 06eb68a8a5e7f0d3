"""How rows of balls with a contact angle stand beside each other and are clamped."""

from __future__ import annotations

from dataclasses import dataclass

from ...modelkit.kernel import kernel
from ...modelkit.status import OK, ROW_OFF
from ...modelkit.variables import choice, group, real
from ..contact.face import Shoulder
from .row import ARRANGEMENTS, CLAMPED, SINGLE, SINGLES, sides_of

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
        "total preload offset by which the rings of a pair are closed, in place of a preload",
        minimum=0.0,
    )
    shoulder: Shoulder = group(Shoulder)


@kernel
def problem(p, numbers):
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
    if p.interference > 0.0 and p.preload > 0.0:
        numbers[1] = p.interference
        return 6
    numbers[0] = p.interference
    return 5 if p.interference > 0.0 and not clamped else 0


@kernel
def checked(status, m):
    """`status` of a macro step, or `ROW_OFF` where the rotor has pressed the ring to its open side.

    That is where the most loaded ball touches beyond the bottom of its groove, on the side of the missing
    shoulder, while the rotor pushes the ring there along the shaft, or presses on its bore at all. A ring
    that flies free may touch there: the low shoulder that real rings keep holds its own weight.
    """
    if status != OK or m.p.balls.contact_angle == 0.0 or m.p.arrangement in CLAMPED:
        return status
    side, pushed = sides_of(m.p.arrangement)[0], m.o.journal.fz  # of the ring on the journal
    if m.o.along.contact_angle * side < 0.0 and (pushed * side > 0.0 or m.o.contact.force > 0.0):
        return ROW_OFF
    return status
