"""The one decorator behind every compiled kernel, its variants, and where machine code is kept.

numba is imported when one of them is asked for: the folder of the cache (`cache_folder`) can do without.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .compiled import PHYSICS_PACKAGES, inlined, interpret, kernel, kernel_of, source_hash

__all__ = ["PHYSICS_PACKAGES", "inlined", "interpret", "kernel", "kernel_of", "source_hash"]


def __getattr__(name: str) -> object:
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    globals()[name] = value = getattr(import_module(f"{__name__}.compiled"), name)
    return value
