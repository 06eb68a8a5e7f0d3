"""How a run ended, its exit status, and arguments of which there may be several."""

from __future__ import annotations

import os
from collections.abc import Iterable
from enum import Enum
from typing import TypeVar, cast

from ...modelkit.errors import TouchdownError as TouchdownError
from ...modelkit.errors import one_of as one_of

FAILED = 2  # exit status: it could not be done
STOPPED = 3  # exit status: it began, and stopped on the way


class Ended(Enum):
    """How it ended; the values are for people.

    >>> scene = touchdown.load("disk-caged-simplified").set({"run.duration": "10 ms"})
    >>> coarse = scene.set({"run.scheme": "hold", "run.macro_step": "0.5 ms"})
    >>> touchdown.run(coarse, in_process=True).ended
    <Ended.STOPPED: 'stopped'>
    """

    COMPLETED = "completed"
    AS_WANTED = "as wanted"  # earlier, since what watched it had seen enough
    INTERRUPTED = "interrupted"  # by Ctrl-C, SIGTERM, SIGHUP or SIGQUIT
    STOPPED = "stopped"  # it could not go on
    DIED = "died"  # its process was killed, or crashed


Item = TypeVar("Item")


def as_list(items: Item | Iterable[Item]) -> list[Item]:
    """All that are given; a number, a text or a path is one by itself."""
    if isinstance(items, (str, os.PathLike)) or not isinstance(items, Iterable):
        return [cast(Item, items)]
    return list(cast(Iterable[Item], items))
