"""Arguments that may be several."""

from __future__ import annotations

import os
from collections.abc import Iterable
from typing import TypeVar

Name = TypeVar("Name", bound="str | os.PathLike[str]")


def several(given: Name | Iterable[Name]) -> list[Name]:
    """All that are given; a single text or path is one, not its letters."""
    return [given] if isinstance(given, (str, os.PathLike)) else list(given)
