"""Errors that are the user's to mend: one line that names the thing, the value and the remedy."""

from __future__ import annotations

from collections.abc import Iterable
from difflib import get_close_matches

FAILED = 2  # exit status: it could not be done
MOST_BEGUN = 8  # names that a name begins, to be told
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
    near = begun[:MOST_BEGUN] or get_close_matches(name, known, n=3, cutoff=0.5)
    if near:
        return f"did you mean {' or '.join(near)}"
    listed = ", ".join(known[:12]) + (", ..." if len(known) > 12 else "")
    return f"there are: {listed}" if known else "there are none"


def with_remedy(error: Exception, name: str, known: Iterable[str]) -> str:
    """What an error says, and of the names there are, where it is of an unknown `name`, the nearest."""
    names = tuple(known)
    return f"{error}; {one_of(name, names)}" if names else str(error)
