"""Run a scene."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import Any

from master.errors import STOPPED
from master.schemes import DEFAULT, SCHEMES
from master.verbs.arguments import assignment


def add_to(verbs: Any) -> None:
    """Add the verb to the command."""
    verb = verbs.add_parser("run", help="run a scene")
    verb.add_argument("scene", help="name of a scene, or path of a .toml")
    verb.add_argument("-o", "--output", type=Path, help="folder for the results (default: runs/SCENE)")
    verb.add_argument("--scheme", help=f"coupling: {', '.join(SCHEMES)} (default: {DEFAULT})")
    verb.add_argument("--macro-step", help='macro step, in s, as text such as "20 us", or auto')
    verb.add_argument(
        "--set", action="append", default=[], metavar="NAME=VALUE", help="set run.KEY or COMPONENT.VARIABLE"
    )
    verb.add_argument(
        "--swap", action="append", default=[], metavar="COMPONENT=FMU", help="replace a component's FMU"
    )
    verb.add_argument("--in-process", action="store_true", help="step the models without FMUs")
    verb.add_argument("--csv", action="store_true", help="also write result.csv")
    verb.add_argument("--no-pictures", action="store_true", help="draw nothing")
    verb.add_argument("--quiet", action="store_true", help="no progress bar")
    verb.set_defaults(run=execute)


def execute(options: argparse.Namespace) -> int:
    """Do it; returns the exit status."""
    from master.advisor import advise
    from master.run import run_scene
    from master.scene import load
    from master.summary import table

    chosen = load(options.scene)
    for text in options.swap:
        chosen = chosen.with_swap(*assignment(text, "--swap"))
    for text in options.set:
        chosen = chosen.with_setting(*assignment(text, "--set"))
    if options.scheme is not None:
        chosen = chosen.with_setting("run.scheme", options.scheme)
    if options.macro_step == "auto":
        advice = advise(chosen)[chosen.run.scheme]
        print(f"macro step {1e6 * advice.macro_step:g} us: {advice.reason}")
        chosen = chosen.with_setting("run.macro_step", advice.macro_step)
    elif options.macro_step is not None:
        chosen = chosen.with_setting("run.macro_step", options.macro_step)
    result = run_scene(
        chosen,
        options.output or Path("runs") / chosen.name,
        in_process=options.in_process,
        csv=options.csv,
        pictures=not options.no_pictures,
        progress=not options.quiet,
    )
    print(table(result.summary))
    print(f"results in {result.folder}")
    for warning in result.warnings:
        print(f"touchdown: warning: {warning}", file=sys.stderr)
    if result.stopped_because:
        print(
            f"touchdown: stopped: {result.stopped_because}; what was recorded is in {result.folder}",
            file=sys.stderr,
        )
        return 130 if result.stopped_because == "interrupted" else STOPPED
    return 0
