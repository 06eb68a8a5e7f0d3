"""What a host of FMUs needs here, and whether an FMU runs."""

from __future__ import annotations

import argparse
from pathlib import Path

from touchdown.master.common.errors import FAILED
from touchdown.master.verbs.verb import Verb

EXAMPLES = (
    "touchdown doctor",
    "touchdown doctor build/simplified_caged.fmu",
)


def declare(verb: argparse.ArgumentParser) -> None:
    """Its options."""
    verb.add_argument("fmus", nargs="*", type=Path, metavar="FMU", help="try these in a clean process")


def execute(options: argparse.Namespace) -> int:
    """Do it; returns the exit status."""
    from touchdown.master.interop.doctor import advice, examine, why_not

    good = True
    if not options.fmus:
        for finding in examine():
            print(finding.line, flush=True)
            good = good and finding.good
        print(advice())
    for path in options.fmus:
        reason = why_not(path)
        print(reason or f"{path}: OK", flush=True)
        good = good and not reason
    return 0 if good else FAILED


VERB = Verb("doctor", "what a host of the FMUs needs on this machine; try FMUs", EXAMPLES, declare, execute)
