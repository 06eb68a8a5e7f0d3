"""The four bearing models side by side."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from touchdown.master.common.errors import TouchdownError
from touchdown.master.verbs.arguments import count


def add_to(verbs: Any) -> None:
    """Add the verb to the command."""
    verb = verbs.add_parser(
        "compare-bearings", help="the four bearing models side by side, against the source's Tables 5 to 7"
    )
    verb.add_argument("--duration", default="5 s", help='of each drop (default: "5 s")')
    verb.add_argument("--ensemble", default="5", metavar="N", help="drops per model (default: 5)")
    verb.add_argument("--options", action="store_true", help="also what the models' options change")
    verb.add_argument("-o", "--output", type=Path, default=Path("runs/bearings"), help="folder")
    verb.add_argument("--quiet", action="store_true", help="no progress bar")
    verb.set_defaults(run=execute)


def execute(options: argparse.Namespace) -> int:
    """Do it; returns the exit status."""
    from tqdm import tqdm

    from touchdown.master.common.units import to_si
    from touchdown.master.results.run import make_writable
    from touchdown.master.studies.dissertation.bearings import OPTIONS, SCENES, compare

    duration = to_si(options.duration, "s", "--duration")
    members = count(options.ensemble, "--ensemble")
    if duration <= 0.0:
        raise TouchdownError(f"--duration {options.duration} must be above 0 s")
    make_writable(options.output)
    total = members * (len(SCENES) + (len(OPTIONS) if options.options else 0))
    with tqdm(total=total, desc="drops", disable=options.quiet, leave=False) as bar:
        text = compare(duration, members, options.options, options.output, bar.update)
    print(text, end="")
    print(f"results in {options.output}")
    return 0
