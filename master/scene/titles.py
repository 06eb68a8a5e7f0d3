"""Titles of scenes whose components are swapped or set otherwise."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import PurePath

MOST = 3  # changes that a title names
_DIGEST = re.compile(r"_[0-9a-f]{16}$")  # of a rotor made in Python


def retitled(title: str, component: str, before: str, after: str, alone: bool) -> str:
    """A scene's title once `component` is the FMU `after` in place of `before`.

    Where the title names `before`, and that is the only component of its kind (`alone`), it names `after`
    instead; else what was swapped is added.

    >>> retitled("A disk on a simplified caged bearing", "bearing", "simplified_caged", "bushing", True)
    'A disk on a bushing bearing'
    >>> retitled("Two bearings", "bearing_A", "amb", "my/own.fmu", False)
    'Two bearings (bearing_A: own)'
    """
    old, new = _words(before), _words(after)
    if old == new:
        return title
    added = f" ({component}: {{}})"
    if added.format(old) in title:
        return title.replace(added.format(old), added.format(new))
    found = re.search(rf"\b{re.escape(old)}\b", title, re.IGNORECASE) if alone else None
    if found is None:
        return title + added.format(new)
    capital = found[0][0].isupper() and not old[0].isupper()
    return title[: found.start()] + (new[0].upper() + new[1:] if capital else new) + title[found.end() :]


def amended(title: str, changes: Sequence[str]) -> str:
    """A scene's title with what was set beside the scene, which the title may deny.

    >>> amended("A disk at 9000 rpm", ["rotor.speed = 12000 rpm"])
    'A disk at 9000 rpm, but with rotor.speed = 12000 rpm'
    """
    if not changes:
        return title
    more = f" and {len(changes) - MOST} more" if len(changes) > MOST else ""
    return f"{title}, but with {', '.join(changes[:MOST])}{more}"


def _words(fmu: str) -> str:
    """What an FMU is called, for people: the name of its file without underscores."""
    return _DIGEST.sub("", PurePath(fmu).stem).replace("_", " ")
