"""Errors that are the user's to correct, how a run ended, and arguments of which there may be several."""

from __future__ import annotations

import os
from collections.abc import Iterable
from difflib import get_close_matches
from enum import Enum
from typing import TypeVar, cast

FAILED = 2  # exit status: it could not be done
MAX_SUGGESTIONS = 8  # names that a name begins, to be told
STOPPED = 3  # exit status: it began, and stopped on the way


class TouchdownError(Exception):
    """Something the user asked for cannot be done; the message says what, which value, and what to do.

    >>> try:
    ...     touchdown.load("rotor1-9001")
    ... except touchdown.TouchdownError as error:
    ...     print(error)
    unknown scene rotor1-9001; did you mean rotor1-9000 or ...
    """


def one_of(name: str, known: Iterable[str]) -> str:
    """The tail of a message about an unknown name: those it begins, the nearest, or all there are."""
    known = sorted(known)
    begun = [other for other in known if name and other.startswith(name)]
    near = begun[:MAX_SUGGESTIONS] or get_close_matches(name, known, n=3, cutoff=0.5)
    if near:
        return f"did you mean {' or '.join(near)}"
    listed = ", ".join(known[:12]) + (", ..." if len(known) > 12 else "")
    return f"there are: {listed}" if known else "there are none"


def with_remedy(error: Exception, name: str, known: Iterable[str]) -> str:
    """The message of an error; for an unknown `name`, with the nearest of the names that exist."""
    names = tuple(known)
    return f"{error}; {one_of(name, names)}" if names else str(error)


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


def as_list(given: Item | Iterable[Item]) -> list[Item]:
    """All that are given; a number, a text or a path is one by itself."""
    if isinstance(given, (str, os.PathLike)) or not isinstance(given, Iterable):
        return [cast(Item, given)]
    return list(cast(Iterable[Item], given))
