"""The error that is the user's to correct, and the nearest of known names."""

from __future__ import annotations

from collections.abc import Iterable
from difflib import get_close_matches

MAX_SUGGESTIONS = 8  # names that a name begins, to be told
MAX_COMPARED, MAX_KNOWN = 200, 10_000  # characters of a name, and names, that are compared


class TouchdownError(Exception):
    """Something the user asked for cannot be done; the message says what, which value, and what to do.

    >>> try:
    ...     touchdown.load("rotor1-9001")
    ... except touchdown.TouchdownError as error:
    ...     print(error)
    unknown scene rotor1-9001; did you mean rotor1-9000 or ...
    """


def require(holds: object, message: str) -> None:
    """Raise TouchdownError with a message unless the condition holds."""
    if not holds:
        raise TouchdownError(message)


def nearest(name: str, known: Iterable[str]) -> str:
    """The tail of a message about an unknown name: those it begins, or the nearest; "" of none."""
    known = sorted(known)
    name = name[:MAX_COMPARED]
    begun = [other for other in known if name and other.startswith(name)]
    near = begun[:MAX_SUGGESTIONS] or get_close_matches(name, known[:MAX_KNOWN], n=3, cutoff=0.5)
    return f"did you mean {' or '.join(near)}" if near else ""


def one_of(name: str, known: Iterable[str]) -> str:
    """The tail of a message about an unknown name: the `nearest`, or all there are."""
    known = sorted(known)
    if near := nearest(name, known):
        return near
    listed = ", ".join(known[:12]) + (", ..." if len(known) > 12 else "")
    return f"there are: {listed}" if known else "there are none"
