"""The models of the project by name, without importing any."""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
_DECLARED = re.compile(r'^MODEL = Model\(\s+name="(\w+)"', re.MULTILINE)


@cache
def models() -> dict[str, str]:
    """The modules of the project's models, such as bearings.supports.mount, by name; none is imported."""
    found: dict[str, str] = {}
    for path in sorted(
        path for package in ("bearings", "rotor") for path in (ROOT / package).rglob("*.py")
    ):
        if declared := _DECLARED.search(path.read_text(encoding="utf-8")):
            found[declared[1]] = ".".join(path.relative_to(ROOT).with_suffix("").parts)
    return found
