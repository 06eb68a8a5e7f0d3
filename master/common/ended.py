"""How a run, or a task in a process of its own, came to its end."""

from __future__ import annotations

from enum import Enum


class Ended(Enum):
    """How it ended; the values are for people.

    >>> scene = touchdown.load("disk-caged-simplified").set({"run.duration": "10 ms"})
    >>> strict = scene.set({"run.warn_residual": 1e-9, "run.stop_residual": 1e-9})
    >>> touchdown.run(strict, in_process=True).ended
    <Ended.STOPPED: 'stopped'>
    """

    COMPLETED = "completed"
    AS_WANTED = "as wanted"  # earlier, since what watched it had seen enough
    INTERRUPTED = "interrupted"  # by Ctrl-C, SIGTERM, SIGHUP or SIGQUIT
    STOPPED = "stopped"  # it could not go on
    DIED = "died"  # its process was killed, or crashed
