"""Run a scene."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import Any

from touchdown.master.common.errors import STOPPED
from touchdown.master.verbs.arguments import add_scene, chosen_scene


def add_to(verbs: Any) -> None:
    """Add the verb to the command."""
    verb = verbs.add_parser("run", help="run a scene")
    add_scene(verb)
    verb.add_argument("-o", "--output", type=Path, help="folder for the results (default: runs/SCENE)")
    verb.add_argument("--in-process", action="store_true", help="step the models without FMUs")
    verb.add_argument("--csv", action="store_true", help="also write result.csv")
    verb.add_argument("--no-pictures", action="store_true", help="draw nothing")
    verb.add_argument("--quiet", action="store_true", help="no progress bar")
    verb.set_defaults(run=execute)


def execute(options: argparse.Namespace) -> int:
    """Do it; returns the exit status."""
    from touchdown.master.common.ended import Ended
    from touchdown.master.results.run import run_scene
    from touchdown.master.results.summary import table

    chosen = chosen_scene(options)
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
    if result.ended is not Ended.COMPLETED:
        print(
            f"touchdown: stopped: {result.stopped_because}; what was recorded is in {result.folder}",
            file=sys.stderr,
        )
        return 130 if result.ended is Ended.INTERRUPTED else STOPPED
    return 0
