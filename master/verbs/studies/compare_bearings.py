"""The four bearing models side by side."""

from __future__ import annotations

import argparse
from pathlib import Path

from touchdown.master.common.errors import TouchdownError
from touchdown.master.common.progress import bar_over
from touchdown.master.verbs.arguments import add_output, add_quiet, count, results_folder
from touchdown.master.verbs.verb import Verb

EXAMPLES = (
    "touchdown compare-bearings --ensemble 1",
    'touchdown compare-bearings --options --duration "2 s" -o runs/options',
)


def declare(verb: argparse.ArgumentParser) -> None:
    """Its options."""
    verb.add_argument("--duration", default="5 s", help='of each drop (default: "5 s")')
    verb.add_argument("--ensemble", metavar="N", help="drops per model (default: 5, as the page has)")
    verb.add_argument("--options", action="store_true", help="also what the models' options change")
    add_output(verb, Path("runs/bearings"))
    add_quiet(verb)


def execute(options: argparse.Namespace) -> int:
    """Do it; returns the exit status."""
    from touchdown.master.common.units import to_si
    from touchdown.master.studies.dissertation.bearings import MEMBERS, OPTIONS, READINGS, compare_bearings

    duration = to_si(options.duration, "s", "--duration")
    members = MEMBERS if options.ensemble is None else count(options.ensemble, "--ensemble")
    if duration <= 0.0:
        raise TouchdownError(f"--duration {options.duration} must be above 0 s")
    folder = results_folder(options)
    total = members * (len(READINGS) + (len(OPTIONS) if options.options else 0))
    with bar_over(total, "drops", options.quiet) as bar:
        text = compare_bearings(duration, members, options.options, folder, bar.update)
    print(text, end="")
    print(f"results in {folder}")
    return 0


VERB = Verb(
    "compare-bearings",
    "the four bearing models side by side, against the source's Tables 5 to 7",
    EXAMPLES,
    declare,
    execute,
)
