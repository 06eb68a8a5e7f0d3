"""Run a scene over ranges of its settings."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import Any

from touchdown.master.common.errors import STOPPED
from touchdown.master.verbs.arguments import count, settings


def add_to(verbs: Any) -> None:
    """Add the verb to the command."""
    verb = verbs.add_parser("sweep", help="run a scene many times with settings that vary")
    verb.add_argument("scene", help="name of a scene, or path of a .toml")
    verb.add_argument(
        "--vary",
        action="append",
        default=[],
        metavar="NAME=VALUES",
        help='a list such as "0.2,0.25,0.3 mm", or START:STOP:COUNT such as "0:315:8 deg"; '
        "repeat it for every combination",
    )
    verb.add_argument(
        "--pick", action="append", default=[], metavar="KEY", help="show this figure; * stands for anything"
    )
    verb.add_argument(
        "-o", "--output", type=Path, help="folder for the results (default: runs/sweep-SCENE)"
    )
    verb.add_argument("--jobs", default="2", metavar="N", help="runs at a time (default: 2)")
    verb.add_argument("--set", action="append", default=[], metavar="NAME=VALUE", help="set in all runs")
    verb.add_argument("--duration", help='of each run, such as "2 s"')
    verb.add_argument("--in-process", action="store_true", help="step the models without FMUs")
    verb.add_argument("--keep", action="store_true", help="keep each run's recording, result.h5")
    verb.add_argument("--quiet", action="store_true", help="no progress bar")
    verb.set_defaults(run=execute)


def execute(options: argparse.Namespace) -> int:
    """Do it; returns the exit status."""
    from tqdm import tqdm

    from touchdown.master.common.processes import INTERRUPTED
    from touchdown.master.interop.scenes import load
    from touchdown.master.studies.sweep.report import picked, table, verdict_lines
    from touchdown.master.studies.sweep.sweep import size, sweep
    from touchdown.master.studies.sweep.variation import parse_all

    chosen = load(options.scene).set(settings(options))
    if options.duration is not None:
        chosen = chosen.set({"run.duration": options.duration})
    variations = parse_all(options.vary)
    jobs = count(options.jobs, "--jobs")
    folder = options.output or Path("runs") / f"sweep-{chosen.name}"
    with tqdm(total=size(variations), desc="runs", disable=options.quiet, leave=False) as bar:
        members = sweep(chosen, variations, folder, jobs, options.in_process, options.keep, bar.update)
    figures, complaints = picked(members, options.pick)
    print("\n".join([table(members, figures), *verdict_lines(members)]))
    print(f"results in {folder}")
    failed = [m for m in members if m.failed]
    if any(m.failed == INTERRUPTED for m in failed):
        print("touchdown: interrupted", file=sys.stderr)
        return 130
    for complaint in complaints:
        print(f"touchdown: warning: {complaint}", file=sys.stderr)
    if failed:
        print(f"touchdown: {len(failed)} of {len(members)} runs failed, see the table", file=sys.stderr)
    return STOPPED if failed else 0
