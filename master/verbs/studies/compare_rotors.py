"""Drops of the flexible rotors against the source."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from touchdown.master.verbs.arguments import count


def add_to(verbs: Any) -> None:
    """Add the verb to the command."""
    verb = verbs.add_parser(
        "compare-rotors", help="drops of the flexible rotors against the source's Figs 14, 15 and Table 4"
    )
    verb.add_argument("--ensemble", default="4", metavar="N", help="unbalance phases (default: 4)")
    verb.add_argument("--long", action="store_true", help="also the run-down over 16 s")
    verb.add_argument("--jobs", default="2", metavar="N", help="runs at a time (default: 2)")
    verb.add_argument("-o", "--output", type=Path, default=Path("runs/rotors"), help="folder")
    verb.add_argument("--quiet", action="store_true", help="no progress bar")
    verb.set_defaults(run=execute)


def execute(options: argparse.Namespace) -> int:
    """Do it; returns the exit status."""
    from tqdm import tqdm

    from touchdown.master.results.run import make_writable
    from touchdown.master.studies.dissertation.rotors import compare, runs

    members = count(options.ensemble, "--ensemble")
    make_writable(options.output)
    with tqdm(total=runs(members), desc="drops", disable=options.quiet, leave=False) as bar:
        text = compare(members, options.output, options.long, count(options.jobs, "--jobs"), bar.update)
    print(text, end="")
    print(f"results in {options.output}")
    return 0
