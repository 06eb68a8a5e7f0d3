"""Show the cache, and clean it up."""

from __future__ import annotations

import argparse
import time
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from touchdown.master.common.errors import TouchdownError
from touchdown.master.common.units import to_si
from touchdown.master.verbs.verb import Verb

if TYPE_CHECKING:
    from touchdown.master.common.cache import Entry

EXAMPLES = (
    "touchdown cache",
    "touchdown cache --unused-for 7",
    "touchdown cache --clear",
)


def declare(verb: argparse.ArgumentParser) -> None:
    """Its options."""
    what = verb.add_mutually_exclusive_group()
    what.add_argument(
        "--unused-for", metavar="DAYS", help="remove what was not used for so many days (unasked: 30)"
    )
    what.add_argument(
        "--clear",
        action="store_true",
        help="remove all that is made again when it is missed; runs under way break",
    )


def execute(options: argparse.Namespace) -> int:
    """Do it; returns the exit status."""
    from touchdown.master.common.cache import entries, made_again, outworn, remove
    from touchdown.modelkit.kernel.cache_folder import user_cache

    root = user_cache()
    try:
        held = entries(root)
    except OSError as error:  # something went meanwhile
        raise TouchdownError(f"cannot look at {error.filename}: {error.strerror}; try again") from None
    print("\n".join(_table(str(root), held)))
    if not options.clear and options.unused_for is None:
        return 0
    _require_cache(root)
    chosen = made_again(held) if options.clear else outworn(held, time.time(), _days(options.unused_for))
    try:
        freed = remove(chosen)
    except OSError as error:
        raise TouchdownError(f"cannot remove {error.filename}: {error.strerror}") from None
    print(f"removed {len(chosen)} of {len(held)}, {freed / 1e6:.1f} MB")
    return 0


def _table(root: str, held: Sequence[Entry]) -> Iterator[str]:
    """What is held, a line for each kind."""
    from touchdown.master.common.cache import ABOUT, DAY

    now = time.time()
    yield root
    for kind, about in ABOUT.items():
        own = [entry for entry in held if entry.kind == kind]
        if own:
            unused = max(now - entry.used for entry in own) / DAY
            yield f"{_line(kind, own)}  {about}; unused for {unused:.0f} days at most"
    yield _line("in all", held)


def _line(name: str, held: Sequence[Entry]) -> str:
    return f"  {name:<13}{len(held):>5}{sum(entry.size for entry in held) / 1e6:>10.1f} MB"


def _require_cache(root: Path) -> None:
    from touchdown.modelkit.kernel.cache_folder import is_cache

    if not is_cache(root):
        raise TouchdownError(f"{root} holds other things than the cache; remove by hand what is to go")


def _days(text: str) -> float:
    days = to_si(text.removesuffix("days").removesuffix("d"), "1", "--unused-for")
    if days < 0.0:
        raise TouchdownError(f"--unused-for {text} must not be negative")
    return days


VERB = Verb("cache", "show what is kept between runs, and clean up", EXAMPLES, declare, execute)
