"""Verbs about whirls: whirl, verdict."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from ...master.common.errors import STOPPED
from ...master.common.progress import bar_over, growing_bar
from .arguments import (
    above_zero,
    add_jobs,
    add_output,
    add_quiet,
    add_scene_name,
    add_settings,
    add_swaps,
    add_until,
    angle,
    chosen_jobs,
    settings,
    several_above_zero,
    swapped,
    timed,
)
from .verb import Verb, broken_off, complain, show_findings, warn

if TYPE_CHECKING:
    from ...master.scene.scene import Scene
    from ...studies.rotor.whirl_prediction import Machine
    from ...studies.sweep.design import Design


WHIRL_EXAMPLES = (
    "touchdown whirl rotor1-18000-225um",
    'touchdown whirl rotor1-18000-225um --speed "12000 rpm" --set "housing_*.damping=10000 N.s/m"',
    'touchdown whirl rotor1-18000-225um --vary "housing_*.stiffness=2:250:12:log MN/m" '
    '--vary "housing_*.damping=100:10000:10:log N.s/m"',
)


def _declare_whirl(verb: argparse.ArgumentParser) -> None:
    add_scene_name(verb)
    verb.add_argument("--speed", help="speed of the rotor (default: the scene's, at the start)")
    verb.add_argument(
        "--vary",
        action="append",
        default=[],
        metavar="NAME=VALUES",
        help='as for sweep, such as "housing_*.stiffness=2:250:20:log MN/m"; two make a map',
    )
    add_settings(verb)
    add_swaps(verb)
    add_output(verb, "runs/whirl-SCENE", "folder for the table and the map of --vary")
    add_quiet(verb)


def _execute_whirl(options: argparse.Namespace) -> int:
    from ...master.interop.scenes import find_scene
    from ...studies.rotor.whirl_prediction import ASSUMPTIONS, FORWARD, lines, machine, sensitivities
    from ...studies.sweep.design import Design, parse_all

    design = Design.grid(parse_all(options.vary)) if options.vary else None  # mistakes in it come first
    scene = swapped(find_scene(options.scene), options).set(settings(options))
    known = machine(scene, above_zero(options.speed, "rad/s", "--speed"))
    backward = known.predicted()
    texts = [*lines(backward), *(f"  with {s.more}: {s}" for s in sensitivities(backward, scene))]
    print("\n".join([*texts, *lines(known.predicted(FORWARD)), *ASSUMPTIONS]))
    if design is not None:
        _map_whirl(known, scene, design, options)
    return 0


def _map_whirl(known: Machine, scene: Scene, design: Design, options: argparse.Namespace) -> None:
    from ...master.common.files import make_writable
    from ...studies.rotor.whirl_figure import PICTURE, axis, write_map
    from ...studies.rotor.whirl_prediction import TABLE, over, write_table

    folder = options.output or Path("runs") / f"whirl-{scene.name}"
    make_writable(folder)
    with bar_over(len(design), "mounts", options.quiet) as bar:
        found = over(
            known,
            scene,
            [dict(zip(design.names, point, strict=True)) for point in design.points],
            bar.update,
            above_zero(options.speed, "rad/s", "--speed"),
        )
    write_table(design, found, folder)
    drawn = len(design.names) == 2 and any(one.settled for one in found)
    if drawn:
        x, y = (axis(name, [point[k] for point in design.points]) for k, name in enumerate(design.names))
        write_map(x, y, found, folder / PICTURE, f"Predicted backward whirl: {scene.name}")
    elif not any(one.settled for one in found):
        print("no whirl with any of these settings")
    print(f"{TABLE}{f' and {PICTURE}' if drawn else ''} in {folder}")


WHIRL = Verb(
    "whirl",
    "predict the whirl without running a drop: how fast, how hard, on which mounts",
    WHIRL_EXAMPLES,
    _declare_whirl,
    _execute_whirl,
)


VERDICT_EXAMPLES = (
    'touchdown verdict rotor1-18000-150um --duration "0.2 s" --in-process',
    'touchdown verdict rotor1-18000-150um --duration "0.2 s" --macro-steps "10,20,40 us" --reference',
)


def _declare_verdict(verb: argparse.ArgumentParser) -> None:
    add_scene_name(verb)
    verb.add_argument(
        "--grid",
        default="12 deg",
        metavar="ANGLE",
        help="distance between the phases of the unbalance that are run first; narrower windows may be "
        "missed (default: 12 deg)",
    )
    verb.add_argument(
        "--resolution",
        default="4 deg",
        metavar="ANGLE",
        help="largest distance left between phases of different verdicts (default: 4 deg)",
    )
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
        help='length of each run, such as "0.2 s" (default: until it has settled, at most 4 times the '
        "scene's)",
    )
    add_until(verb)
    verb.add_argument("--in-process", action="store_true", help="step the models without FMUs")
    add_quiet(verb)


def _execute_verdict(options: argparse.Namespace) -> int:
    from ...master.interop.scenes import find_scene
    from ...studies.sweep.tasks import Running
    from ...studies.verdict.report import findings
    from ...studies.verdict.study import Plan, study_verdict

    chosen = timed(find_scene(options.scene).set(settings(options)), options)
    plan = Plan(
        spacing=angle(options.grid, "--grid"),
        resolution=angle(options.resolution, "--resolution"),
        macro_steps=several_above_zero(options.macro_steps, "s", "--macro-steps"),
        reference=above_zero(options.reference, "s", "--reference"),
    )
    running = Running(chosen_jobs(options), in_process=options.in_process)
    folder = options.output or Path("runs") / f"verdict-{chosen.name}"
    with growing_bar("runs", options.quiet) as progress:
        study = study_verdict(chosen, plan, folder, running, progress)
    show_findings(findings(study), folder)
    warn(study.remarks)
    if study.interrupted:
        return broken_off()
    if failed := sum(len(circle.failed) for circle in study.circles):
        complain(f"{failed} runs failed, see above")
    return STOPPED if failed else 0


VERDICT = Verb(
    "verdict",
    "find the phases of the unbalance at which the rotor whirls, and their edges",
    VERDICT_EXAMPLES,
    _declare_verdict,
    _execute_verdict,
)
