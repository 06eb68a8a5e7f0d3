"""Run a scene over ranges of its settings."""

from __future__ import annotations

import argparse
from pathlib import Path

from touchdown.master.common.errors import STOPPED
from touchdown.master.common.progress import bar_over
from touchdown.master.verbs.arguments import (
    add_jobs,
    add_output,
    add_quiet,
    add_scene_name,
    add_settings,
    chosen_jobs,
    settings,
)
from touchdown.master.verbs.screen import broken_off, complain, warn
from touchdown.master.verbs.verb import Verb

EXAMPLES = (
    'touchdown sweep disk-caged-simplified --vary "bearing.clearance=0.2,0.25,0.3 mm" --duration "0.1 s"',
    'touchdown sweep rotor1-9000 --vary "housing_A.x0=0:150:4 um" --jobs 4 --pick "*whirl*"',
)


def declare(verb: argparse.ArgumentParser) -> None:
    """Its options."""
    add_scene_name(verb)
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
    add_output(verb, "runs/sweep-SCENE", "folder for the results")
    add_jobs(verb)
    add_settings(verb)
    verb.add_argument("--duration", help='of each run, such as "2 s"')
    verb.add_argument("--in-process", action="store_true", help="step the models without FMUs")
    verb.add_argument("--keep", action="store_true", help="keep each run's recording, result.h5")
    add_quiet(verb)


def execute(options: argparse.Namespace) -> int:
    """Do it; returns the exit status."""
    from touchdown.master.common.ended import Ended
    from touchdown.master.interop.scenes import find_scene
    from touchdown.master.studies.sweep.report import picked, table, verdict_lines
    from touchdown.master.studies.sweep.sweep import Execution, size, sweep
    from touchdown.master.studies.sweep.variation import parse_all

    chosen = find_scene(options.scene).set(settings(options))
    if options.duration is not None:
        chosen = chosen.set({"run.duration": options.duration})
    variations = parse_all(options.vary)
    jobs = chosen_jobs(options)
    folder = options.output or Path("runs") / f"sweep-{chosen.name}"
    execution = Execution(options.in_process, options.keep)
    with bar_over(size(variations), "runs", options.quiet) as bar:
        members = sweep(chosen, variations, folder, jobs, execution, bar.update)
    figures, complaints = picked(members, options.pick)
    print("\n".join([table(members, figures), *verdict_lines(members)]))
    if there := sum(member.kept for member in members):
        print(f"{there} of {len(members)} were finished before and not run again")
    print(f"results in {folder}")
    failed = [m for m in members if m.failed]
    if any(m.ended is Ended.INTERRUPTED for m in failed):
        return broken_off()
    warn(complaints)
    if failed:
        complain(f"{len(failed)} of {len(members)} runs failed, see the table")
    return STOPPED if failed else 0


VERB = Verb("sweep", "run a scene many times with settings that vary", EXAMPLES, declare, execute)
