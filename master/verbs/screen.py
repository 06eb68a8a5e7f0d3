"""What several verbs show: warnings, and that the user broke off."""

from __future__ import annotations

import sys
from collections.abc import Iterable

BROKEN_OFF = 130  # exit status: by Ctrl-C


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
