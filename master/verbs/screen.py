"""What several verbs show: progress, warnings, and that the user broke off."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from tqdm import tqdm

BROKEN_OFF = 130  # exit status: by Ctrl-C


def progress(total: int, what: str, quiet: bool) -> tqdm:
    """A bar over `total` pieces of work, all of them `what`; as a context."""
    from tqdm import tqdm

    return tqdm(total=total, desc=what, disable=quiet, leave=False)


@contextmanager
def named_progress(total: int, quiet: bool) -> Iterator[Callable[[str], None]]:
    """A bar over pieces of work of many kinds: call what it gives with the name of each as it begins."""
    begun = 0
    with progress(total, "", quiet) as bar:

        def begin(what: str) -> None:
            nonlocal begun
            bar.update(1 if begun else 0)
            begun += 1
            bar.set_description(what)

        yield begin


def complain(text: str) -> None:
    """One line on stderr, from `touchdown`."""
    print(f"touchdown: {text}", file=sys.stderr)


def warn(warnings: Iterable[str]) -> None:
    """A line on stderr for each of them."""
    for warning in warnings:
        complain(f"warning: {warning}")


def broken_off() -> int:
    """Say that the user interrupted it; returns the exit status."""
    complain("interrupted")
    return BROKEN_OFF
