"""The sources that kernels are compiled from, by a hash of them."""

from __future__ import annotations

import hashlib
from functools import cache
from pathlib import Path

PHYSICS_PACKAGES = ("modelkit", "rotor", "bearings")


@cache
def source_hash(packages: tuple[str, ...] = PHYSICS_PACKAGES) -> str:
    """Hash (16 hex digits) over the Python sources of `packages`, which stand beside `modelkit`."""
    root = Path(__file__).resolve().parents[2]
    digest = hashlib.sha256()
    for package in packages:
        for path in sorted((root / package).rglob("*.py")):
            digest.update(path.relative_to(root).as_posix().encode())
            digest.update(path.read_bytes())
    return digest.hexdigest()[:16]
