"""How a run, or a task in a process of its own, came to its end."""

from __future__ import annotations

from enum import Enum


class Ended(Enum):
    """How it ended; the values are for people."""

    COMPLETED = "completed"
    AS_WANTED = "as wanted"  # earlier, since what watched it had seen enough
    INTERRUPTED = "interrupted"  # by Ctrl-C
    STOPPED = "stopped"  # it could not go on
