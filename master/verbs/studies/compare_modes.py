"""What the number of modes costs in error."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import Any

from touchdown.master.common.errors import TouchdownError
from touchdown.master.verbs.arguments import settings


def add_to(verbs: Any) -> None:
    """Add the verb to the command."""
    verb = verbs.add_parser(
        "compare-modes", help="what the number of modes of a flexible rotor costs in error"
    )
    verb.add_argument("scene", help="name of a scene with a flexible rotor, or path of a .toml")
    verb.add_argument(
        "--modes",
        default="3,5,8,12,20",
        help="numbers of modes per plane, the two rigid ones included (default: 3,5,8,12,20)",
    )
    verb.add_argument("--set", action="append", default=[], metavar="NAME=VALUE", help="set in all runs")
    verb.add_argument(
        "--duration",
        help='from the first contact, such as "2 ms" (default: until the first impact is over, '
        "at most 10 ms)",
    )
    verb.add_argument("--macro-step", default="2 us", help='macro step (default: "2 us")')
    verb.add_argument("-o", "--output", type=Path, help="folder (default: runs/modes-SCENE)")
    verb.add_argument("--quiet", action="store_true", help="no progress bar")
    verb.set_defaults(run=execute)


def execute(options: argparse.Namespace) -> int:
    """Do it; returns the exit status."""
    from tqdm import tqdm

    from touchdown.master.common.units import to_si
    from touchdown.master.interop.scenes import load
    from touchdown.master.results.run import make_writable
    from touchdown.master.studies.modes.compare import compare, parse_modes, refuse_varied, runs
    from touchdown.master.studies.modes.report import lines, write

    chosen = load(options.scene)
    given = settings(options)
    refuse_varied(given)
    chosen = chosen.set(given)
    modes = parse_modes(options.modes)
    step = to_si(options.macro_step, "s", "--macro-step")
    duration = None if options.duration is None else to_si(options.duration, "s", "--duration")
    for name, value in (("--macro-step", step), ("--duration", duration)):
        if value is not None and not value > 0.0:
            raise TouchdownError(f"{name} = {value:g} s must be above 0")
    folder = options.output or Path("runs") / f"modes-{chosen.name}"
    make_writable(folder)
    with tqdm(total=runs(modes), desc="drops", disable=options.quiet, leave=False) as bar:
        found = compare(chosen, modes, step, duration, bar.update)
    write(found, folder)
    print("\n".join(lines(found)))
    print(f"results in {folder}")
    for warning in found.warnings:
        print(f"touchdown: warning: {warning}", file=sys.stderr)
    return 0
