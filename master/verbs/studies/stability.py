"""The hard cases of the coupling schemes."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import Any

from touchdown.master.common.errors import STOPPED, TouchdownError
from touchdown.master.scene.schemes import SCHEMES, scheme
from touchdown.master.verbs.arguments import count


def add_to(verbs: Any) -> None:
    """Add the verb to the command."""
    verb = verbs.add_parser(
        "stability",
        help="which macro steps the coupling schemes bear in hard cases, and what the ledger says",
    )
    verb.add_argument("--cases", metavar="A,B", help="cases, by name (default: all that are short)")
    verb.add_argument("--schemes", metavar="A,B", help=f"of {', '.join(SCHEMES)} (default: all)")
    verb.add_argument("--long", action="store_true", help="also the cases that take minutes")
    verb.add_argument("--jobs", default="2", metavar="N", help="runs at a time (default: 2)")
    verb.add_argument("-o", "--output", type=Path, default=Path("runs/stability"), help="folder")
    verb.add_argument("--quiet", action="store_true", help="no progress bar")
    verb.set_defaults(run=execute)


def execute(options: argparse.Namespace) -> int:
    """Do it; returns the exit status."""
    from tqdm import tqdm

    from touchdown.master.results.run import make_writable
    from touchdown.master.studies.stability.cases import chosen
    from touchdown.master.studies.stability.report import lines
    from touchdown.master.studies.stability.study import size, study

    cases = chosen(_names(options.cases, "--cases"), options.long)
    schemes = [scheme(name).name for name in _names(options.schemes, "--schemes")] or list(SCHEMES)
    jobs = count(options.jobs, "--jobs")
    make_writable(options.output)
    with tqdm(total=size(cases, schemes), desc="searches", disable=options.quiet, leave=False) as bar:
        found = study(cases, schemes, options.output, jobs, bar.update)
    print("\n".join(lines(found)))
    print(f"results in {options.output}")
    if found.interrupted:
        print("touchdown: interrupted", file=sys.stderr)
        return 130
    if found.failed:
        print(f"touchdown: {len(found.failed)} searches failed, see the end of the table", file=sys.stderr)
        return STOPPED
    return 0


def _names(text: str | None, option: str) -> list[str]:
    """Names between commas; none where the option is not given. Raises TouchdownError."""
    if text is None:
        return []
    names = [name.strip() for name in text.split(",")]
    if not all(names):
        raise TouchdownError(f"{option} {text}: a name is missing between the commas")
    return list(dict.fromkeys(names))
