"""The first impact in a recording: what it did is repeatable; what comes after it may be chaotic.

Where rings and balls rattle, later impacts amplify every difference, of rounding too, so that the peaks of
a whole drop are one draw of many. The first impact's depend alone on the state in which the journal comes.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...modelkit.ports import PARTING_TOLERANCE
from ..quantities import FIRST_IMPACTS
from .final_state import ReadableSystem
from .recording import Recording

COARSE_ROWS = 1e-3  # s; of rows farther apart, one may lie beyond the next impact


def over_after(time: np.ndarray, force: np.ndarray, first: float) -> int | None:
    """The row at which the first impact is over: the journal has parted for longer than a rattle.

    time: s, force: contact force (N), each (rows,); first: the first contact (s). The last row where it
    never parts; None where rows are too far apart to tell.
    """
    apart = float(np.median(np.diff(time))) if len(time) > 1 else np.inf
    if apart > COARSE_ROWS or first > time[-1]:
        return None
    free = PARTING_TOLERANCE + apart  # between two loaded rows
    loaded = np.flatnonzero((force > 0.0) & (time >= first))
    begin = min(int(np.searchsorted(time, first)), len(time) - 1)
    if len(loaded) == 0 or time[loaded[0]] > first + free:
        return begin  # it lies between two rows
    gaps = np.flatnonzero(np.diff(time[loaded]) > free)
    last = int(loaded[gaps[0]] if len(gaps) else loaded[-1])
    return min(last + 1, len(time) - 1)


def over_at(system: ReadableSystem, bearing: str, zero: float, recording: Recording) -> int | None:
    """The row at which it is over in a bearing; None where there was none, or it cannot be told.

    zero: the scene's, s on the simulation's clock.
    """
    name, touched = f"{bearing}.contact.force", system.value(f"{bearing}.contact.first_time")
    if touched == -1.0 or name not in recording:
        return None
    known = f"{bearing}.contact.over_time"
    if known in system and system.value(known) >= 0.0:
        return free_row(recording.time, recording[name], system.value(known) - zero)
    return over_after(recording.time, recording[name], touched - zero)


def free_row(time: np.ndarray, force: np.ndarray, over: float) -> int | None:
    """The last row before `over` (s), where the journal has been free for PARTING_TOLERANCE.

    All figures of that row are of the impact that the bearing itself kept a ball's force of. Rows that are
    farther apart may have none then; the next tells as much where the journal is still free. Else None.
    """
    row = int(np.searchsorted(time, over, side="right")) - 1
    if time[row] >= over - PARTING_TOLERANCE:
        return row
    near = row + 1 < len(time) and time[row + 1] - time[row] <= COARSE_ROWS
    return row + 1 if near and force[row + 1] == 0.0 else None


def latest(rows: Sequence[int | None]) -> int | None:
    """The row at which it is over at all seats of `rows`; None where it cannot be told of one."""
    known = [row for row in rows if row is not None]
    return max(known) if known and len(known) == len(rows) else None


def values_at(
    row: int | None, system: ReadableSystem, bearing: str, recording: Recording
) -> dict[str, object]:
    """The peaks that a bearing reported at a row; None where there is no row, or it was not recorded."""
    variables = system.components[bearing].variables
    found: dict[str, object] = {}
    for first, peak in FIRST_IMPACTS.items():
        if peak.variable in variables:
            found[first] = value_at(row, f"{bearing}.{peak.variable}", recording)
    return found


def value_at(row: int | None, name: str, recording: Recording) -> float | None:
    """The value of COMPONENT.VARIABLE at a row; None where there is no row, or it was not recorded."""
    return None if row is None or name not in recording else float(recording[name][row])
