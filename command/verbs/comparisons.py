"""The verb that compares variants of a scene: schemes, models, modes, macro steps, stability."""

from __future__ import annotations

import argparse

from ...master.common.errors import STOPPED, TouchdownError
from ...master.scene.schemes import SCHEMES
from ...studies.comparison import KINDS, STABILITY, check_options
from .arguments import (
    MOST_JOBS,
    above_zero,
    add_output,
    add_quiet,
    add_scene_name,
    add_settings,
    add_swaps,
    count,
    names,
    results_folder,
    settings,
    several_above_zero,
    swapped,
)
from .verb import Verb, broken_off, complain, show_findings, warn

EXAMPLES = (
    'touchdown compare disk-caged-simplified --schemes hold,velocity,interface --macro-steps "5,20,100 us"',
    'touchdown compare disk-caged-simplified --of models --repeat 1 --duration "3 ms"',
    "touchdown compare rotor1-9000 --of modes --modes 5,20",
    "touchdown compare rotor1-9000 --of steps",
    "touchdown compare --of stability --cases bounce,mass-1 --schemes hold,interface",
)
OPTIONS = {  # of each kind as KINDS has it, but for in_process
    "schemes": f"some of {', '.join(SCHEMES)} (default: all)",
    "macro_steps": 'such as "5,20,100 us" (default: "5,10,20,50,100 us"); with modes one (default: "2 us")',
    "wanted": 'largest error of the journal that a scheme may have (default: "0.1 um")',
    "duration": 'time compared from the first contact on, such as "2 ms" (default: until the first impact '
    "is over, at most 5 ms, with modes 10 ms; with models 20 ms)",
    "timed": 'length of the runs that are timed, such as "1 s" (default: as compared)',
    "repeat": "number of runs that are timed (default: 3)",
    "modes": "numbers of modes per plane, the two rigid ones included (default: 3,5,8,12,20)",
    "cases": "of stability, by name; all: also those that take minutes (default: all that are short)",
    "jobs": "runs at a time (default: 2)",
}
INSTEAD = {  # settings that comparisons make themselves, by kind
    "schemes": {
        "run.duration": "--duration",
        "run.macro_step": "--macro-steps",
        "run.scheme": "--schemes",
    },
    "models": {"run.duration": "--duration"},
    "modes": {
        "run.duration": "--duration",
        "run.macro_step": "--macro-steps",
        "modes": "--modes",
        "residual": "none: both ways are run",
        "stress.mode_acceleration": "none: both ways are run",
    },
}


def _declare(verb: argparse.ArgumentParser) -> None:
    add_scene_name(verb, "name of a scene, or path of a .toml; none for stability", nargs="?")
    verb.add_argument(
        "--of",
        default="schemes",
        metavar="KIND",
        help=f"{', '.join(KINDS)}: coupling schemes at several macro steps; models, what the scene could "
        "do without; modes of a flexible rotor; the largest macro step advised for each scheme, without a "
        "run; the longest one that each bears in hard cases (default: schemes)",
    )
    for name, meaning in OPTIONS.items():
        verb.add_argument(f"--{name.replace('_', '-')}", metavar="VALUE", help=meaning)
    verb.add_argument("--in-process", action="store_true", help="time the models without FMUs")
    add_settings(verb)
    add_swaps(verb)
    add_output(verb, "runs/KIND-SCENE")
    add_quiet(verb)


def _execute(options: argparse.Namespace) -> int:
    from ...master.interop.scenes import find_scene
    from ...studies.comparison.modes import mode_counts
    from ..api.studies import compare

    of, given = options.of, settings(options)
    asked = [name for name in (*OPTIONS, "in_process") if getattr(options, name) not in (None, False)]
    if of == STABILITY:
        asked += [name for name in ("set", "swap", "names") if getattr(options, name)]
    check_options(of, options.scene, asked, "--")
    for name in given:
        for key in (name, name.partition(".")[2]):
            if key in INSTEAD.get(of, {}):
                raise TouchdownError(f"--set {name}: compare sets it itself; use {INSTEAD[of][key]}")
    modes, repeat, jobs = options.modes, options.repeat, options.jobs
    read = {
        "schemes": names(options.schemes, "--schemes") or None,
        "macro_steps": several_above_zero(options.macro_steps, "s", "--macro-steps") or None,
        "wanted": above_zero(options.wanted, "m", "--wanted"),
        "duration": above_zero(options.duration, "s", "--duration"),
        "timed": above_zero(options.timed, "s", "--timed"),
        "repeat": None if repeat is None else count(repeat, "--repeat"),
        "modes": None if modes is None else mode_counts(modes.split(","), f"--modes {modes}"),
        "cases": names(options.cases, "--cases") or None,
        "jobs": None if jobs is None else count(jobs, "--jobs", MOST_JOBS),
        "in_process": options.in_process,
    }
    scene = None
    if of != STABILITY:
        scene = swapped(find_scene(options.scene), options).set(given)
    folder = results_folder(options, of if scene is None else f"{of}-{scene.name}")
    found = compare(scene, of, **read, progress=not options.quiet)
    show_findings(found.findings(), folder)
    warn(found.warnings)
    if found.interrupted:
        return broken_off()
    if found.incomplete:
        complain(found.incomplete)
        return STOPPED
    return 0


COMPARE = Verb(
    "compare",
    "measure error and time of schemes, models, modes, macro steps",
    EXAMPLES,
    _declare,
    _execute,
)
