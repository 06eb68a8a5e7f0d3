"""Arguments of which there may be several."""

from __future__ import annotations

import os
from collections.abc import Iterable
from typing import TypeVar, cast

Item = TypeVar("Item")


def several(given: Item | Iterable[Item]) -> list[Item]:
    """All that are given; a number, a text or a path is one by itself."""
    if isinstance(given, (str, os.PathLike)) or not isinstance(given, Iterable):
        return [cast(Item, given)]
    return list(cast(Iterable[Item], given))
