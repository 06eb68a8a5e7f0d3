"""List the bearings there are, or show one."""

from __future__ import annotations

import argparse
from pathlib import Path

from touchdown.master.verbs.arguments import above_zero
from touchdown.master.verbs.verb import Verb

EXAMPLES = (
    'touchdown catalogue --bore "70 mm"',
    "touchdown catalogue 7014",
    "touchdown catalogue 7014 --toml",
)


def declare(verb: argparse.ArgumentParser) -> None:
    """Its options."""
    verb.add_argument(
        "bearing",
        nargs="?",
        help="show this one: its designation, a name in bearings.toml, or FILE.toml:NAME",
    )
    verb.add_argument("--bore", metavar="LENGTH", help='list those of this bore, such as "70 mm"')
    verb.add_argument("--toml", action="store_true", help="show it as it stands in a file of one's own")


def execute(options: argparse.Namespace) -> int:
    """Do it; returns the exit status."""
    from touchdown.master.studies.machine.bearings import as_file, described, find_bearing, known, listed

    here = Path()
    if options.bearing is None:
        print(listed(known(here), above_zero(options.bore, "m", "--bore")))
        return 0
    bearing = find_bearing(options.bearing, here)
    print(as_file(bearing) if options.toml else described(bearing), end="" if options.toml else "\n")
    return 0


VERB = Verb("catalogue", "list the bearings there are, or show one", EXAMPLES, declare, execute)
