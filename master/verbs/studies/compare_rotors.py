"""Drops of the flexible rotors against the source."""

from __future__ import annotations

import argparse
from pathlib import Path

from touchdown.master.common.progress import growing_bar
from touchdown.master.verbs.arguments import (
    add_jobs,
    add_output,
    add_phases,
    add_quiet,
    angle,
    chosen_jobs,
    count,
    results_folder,
)
from touchdown.master.verbs.verb import Verb

EXAMPLES = (
    "touchdown compare-rotors --ensemble 2 -o runs/rotors",
    "touchdown compare-rotors --long",
)


def declare(verb: argparse.ArgumentParser) -> None:
    """Its options."""
    verb.add_argument("--ensemble", default="8", metavar="N", help="unbalance phases (default: 8)")
    add_phases(verb)
    verb.add_argument("--long", action="store_true", help="also the run-down over 16 s")
    add_jobs(verb)
    add_output(verb, Path("runs/rotors"))
    add_quiet(verb)


def execute(options: argparse.Namespace) -> int:
    """Do it; returns the exit status."""
    from touchdown.master.studies.dissertation.rotors import compare_rotors
    from touchdown.master.studies.verdict.study import Plan

    members = count(options.ensemble, "--ensemble")
    jobs = chosen_jobs(options)
    plan = Plan(angle(options.grid, "--grid"), angle(options.resolution, "--resolution"))
    folder = results_folder(options)
    with growing_bar("drops", options.quiet) as progress:
        text = compare_rotors(members, plan, folder, options.long, jobs, progress)
    print(text, end="")
    print(f"results in {folder}")
    return 0


VERB = Verb(
    "compare-rotors",
    "drops of the flexible rotors against the source's Figs 14, 15 and Table 4",
    EXAMPLES,
    declare,
    execute,
)
