"""What an installation brings along, as the cache would hold it: a wheel for a platform carries it.

Its machine code was compiled for a plain processor, and is taken where that one's instructions are to be
had, for the very sources, numba and Python that it was made of. It lies beside the sources of the installed
`touchdown`, where what travels in an FMU finds the code of its own sources, too. Who can change it can
change the sources, so it is trusted as they are. Its results are those of code compiled here, to the last
bit: nothing is reassociated or contracted, and wider instructions round as plain ones do.
"""

from __future__ import annotations

import platform
import sys
from importlib.util import find_spec
from pathlib import Path

PACKAGE, FOLDER = "touchdown", "shipped"
MADE_FOR = "made_for.txt"  # beside the code: what `made_for` said

_V3 = "avx avx2 bmi bmi2 cx16 f16c fma lzcnt movbe popcnt sahf sse3 sse4.1 sse4.2 ssse3 xsave"
_PLAIN = {"x86_64": "x86-64-v3", "AMD64": "x86-64-v3"}  # by machine, as LLVM calls it
_NEEDED = {"x86-64-v3": frozenset(f"+{feature}" for feature in _V3.split())}


def plain_processor() -> str:
    """The least processor that portable code for this kind of machine is made for, as LLVM calls it."""
    return _PLAIN.get(platform.machine(), "generic")


def made_for(numba: str) -> str:
    """What code made here fits, for people: a version of numba, this Python, and a processor."""
    return f"numba {numba}, {sys.implementation.cache_tag}, {plain_processor()}"


def plainer(processor: tuple[str, str, str]) -> tuple[str, str, str] | None:
    """The plain processor in the place of another, whose code that one runs; None: it lacks instructions.

    Both are LLVM's triple, the name of the processor, and its features as numba lists them.
    """
    triple, _, features = processor
    plain = plain_processor()
    return (triple, plain, "") if _NEEDED.get(plain, frozenset()) <= {*features.split(",")} else None


def folder(kind: str) -> Path | None:
    """Where the installed package has what the cache holds as `kind`; None where it brought none."""
    try:
        spec = find_spec(PACKAGE)
    except (ImportError, ValueError):
        return None
    if spec is None or not spec.origin:
        return None
    found = Path(spec.origin).parent / FOLDER / kind
    return found if found.is_dir() else None
