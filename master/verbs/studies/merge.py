"""Put the shards of a sweep together, or read one that was broken off."""

from __future__ import annotations

import argparse
from pathlib import Path

from touchdown.master.verbs.arguments import add_maps, add_output, show_sweep
from touchdown.master.verbs.screen import complain
from touchdown.master.verbs.verb import Verb

EXAMPLES = (
    "touchdown merge runs/part-1 runs/part-2 runs/part-3 -o runs/whole",
    "touchdown merge runs/sweep-rotor1-9000 -o runs/so-far --over bearing_A.clearance",
)


def declare(verb: argparse.ArgumentParser) -> None:
    """Its options."""
    verb.add_argument(
        "folders", nargs="+", type=Path, metavar="FOLDER", help="of a sweep, or of its shards"
    )
    add_output(verb, Path("runs/merged"), "folder for all of it, in which the sweep can go on")
    add_maps(verb)


def execute(options: argparse.Namespace) -> int:
    """Do it; returns the exit status."""
    from touchdown.master.studies.sweep.results import merge

    found = merge(options.folders, options.output)
    show_sweep(found, options.output, options)
    if failed := sum(bool(m.failed) for m in found):
        complain(f"{failed} of {len(found)} runs failed, or were not run yet, see the table")
    return 0


VERB = Verb(
    "merge", "put the shards of a sweep together, or read one that is under way", EXAMPLES, declare, execute
)
