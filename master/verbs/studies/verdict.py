"""How the verdict on a drop hangs on the phase of the unbalance."""

from __future__ import annotations

import argparse
from pathlib import Path

from touchdown.master.common.errors import STOPPED
from touchdown.master.common.progress import growing_bar
from touchdown.master.verbs.arguments import (
    above_zero,
    add_jobs,
    add_output,
    add_phases,
    add_quiet,
    add_scene_name,
    add_settings,
    add_until,
    angle,
    chosen_jobs,
    settings,
    several_above_zero,
    timed,
)
from touchdown.master.verbs.screen import broken_off, complain, warn
from touchdown.master.verbs.verb import Verb

EXAMPLES = (
    'touchdown verdict rotor1-18000-150um --duration "0.2 s" --in-process',
    'touchdown verdict rotor1-18000-150um --duration "0.2 s" --macro-steps "10,20,40 us" --reference',
)


def declare(verb: argparse.ArgumentParser) -> None:
    """Its options."""
    add_scene_name(verb)
    add_phases(verb)
    verb.add_argument("--macro-steps", help='such as "5,10,20,40 us" (default: the scene\'s own)')
    verb.add_argument(
        "--reference",
        nargs="?",
        const="5 us",
        metavar="STEP",
        help='also with adaptive steps inside the bearings, at this macro step (as it stands: "5 us")',
    )
    add_output(verb, "runs/verdict-SCENE", "folder for the results")
    add_jobs(verb)
    add_settings(verb)
    verb.add_argument(
        "--duration",
        help='of each run, such as "0.2 s" (default: until it has settled, at most 4 times the scene\'s)',
    )
    add_until(verb)
    verb.add_argument("--in-process", action="store_true", help="step the models without FMUs")
    add_quiet(verb)


def execute(options: argparse.Namespace) -> int:
    """Do it; returns the exit status."""
    from touchdown.master.interop.scenes import find_scene
    from touchdown.master.studies.verdict.report import report_lines, write_report
    from touchdown.master.studies.verdict.study import Plan, Running, study_verdict

    chosen = timed(find_scene(options.scene).set(settings(options)), options)
    plan = Plan(
        spacing=angle(options.grid, "--grid"),
        resolution=angle(options.resolution, "--resolution"),
        macro_steps=several_above_zero(options.macro_steps, "s", "--macro-steps"),
        reference=above_zero(options.reference, "s", "--reference"),
    )
    running = Running(chosen_jobs(options), options.in_process)
    folder = options.output or Path("runs") / f"verdict-{chosen.name}"
    with growing_bar("runs", options.quiet) as progress:
        study = study_verdict(chosen, plan, folder, running, progress)
    write_report(study, folder)
    print("\n".join(report_lines(study)))
    print(f"results in {folder}")
    warn(study.remarks)
    if study.interrupted:
        return broken_off()
    if failed := sum(len(circle.failed) for circle in study.circles):
        complain(f"{failed} runs failed, see above")
    return STOPPED if failed else 0


VERB = Verb(
    "verdict", "which phases of the unbalance whirl, and where the edges are", EXAMPLES, declare, execute
)
