"""How a run, or a task in a process of its own, came to its end."""

from __future__ import annotations

from enum import Enum


class Ended(Enum):
    """How it ended; the values are for people.

    >>> scene = touchdown.load("disk-caged-simplified").set({"run.duration": "8 ms"})
    >>> touchdown.run(scene.set({"run.stop_residual": 1e-12}), in_process=True).ended
    <Ended.STOPPED: 'stopped'>
    """

    COMPLETED = "completed"
    AS_WANTED = "as wanted"  # earlier, since what watched it had seen enough
    INTERRUPTED = "interrupted"  # by Ctrl-C
    STOPPED = "stopped"  # it could not go on
