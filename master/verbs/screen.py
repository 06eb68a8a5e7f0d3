"""What several verbs show: warnings, and that the user broke off."""

from __future__ import annotations

import sys
from collections.abc import Iterable, Mapping

BROKEN_OFF = 130  # exit status: by Ctrl-C


def complain(text: str) -> None:
    """One line on stderr, from `touchdown`."""
    print(f"touchdown: {text}", file=sys.stderr)


def warn(warnings: Iterable[str]) -> None:
    """A line on stderr for each of them."""
    for warning in warnings:
        complain(f"warning: {warning}")


def say_whose_code_runs(fmus: Mapping[str, bool]) -> None:
    """One line, where FMUs of others' are about to run; `fmus` says which have a process of their own."""
    own = [fmu for fmu, isolated in fmus.items() if isolated]
    here = [fmu for fmu, isolated in fmus.items() if not isolated]
    said = [f"in a process of its own: {', '.join(own)}"] if own else []
    said += [f"in the master's process (see --isolate): {', '.join(here)}"] if here else []
    if said:
        print(f"runs code that others wrote, {'; '.join(said)}", flush=True)


def broken_off() -> int:
    """Say that the user interrupted it; returns the exit status."""
    complain("interrupted")
    return BROKEN_OFF
