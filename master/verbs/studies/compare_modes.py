"""What the number of modes costs in error."""

from __future__ import annotations

import argparse

from touchdown.master.common.errors import TouchdownError
from touchdown.master.common.progress import bar_over
from touchdown.master.verbs.arguments import (
    add_output,
    add_quiet,
    add_scene_name,
    add_settings,
    results_folder,
    settings,
)
from touchdown.master.verbs.screen import warn
from touchdown.master.verbs.verb import Verb

EXAMPLES = ("touchdown compare-modes rotor1-9000 --modes 5,20",)


def declare(verb: argparse.ArgumentParser) -> None:
    """Its options."""
    add_scene_name(verb, "name of a scene with a flexible rotor, or path of a .toml")
    verb.add_argument(
        "--modes",
        default="3,5,8,12,20",
        help="numbers of modes per plane, the two rigid ones included (default: 3,5,8,12,20)",
    )
    add_settings(verb)
    verb.add_argument(
        "--duration",
        help='from the first contact, such as "2 ms" (default: until the first impact is over, '
        "at most 10 ms)",
    )
    verb.add_argument("--macro-step", default="2 us", help='macro step (default: "2 us")')
    add_output(verb, "runs/modes-SCENE")
    add_quiet(verb)


def execute(options: argparse.Namespace) -> int:
    """Do it; returns the exit status."""
    from touchdown.master.common.units import to_si
    from touchdown.master.interop.scenes import find_scene
    from touchdown.master.studies.modes.compare import compare_modes, parse_modes, refuse_varied, runs
    from touchdown.master.studies.modes.report import report_lines, write_report

    chosen = find_scene(options.scene)
    given = settings(options)
    refuse_varied(given)
    chosen = chosen.set(given)
    modes = parse_modes(options.modes)
    step = to_si(options.macro_step, "s", "--macro-step")
    duration = None if options.duration is None else to_si(options.duration, "s", "--duration")
    for name, value in (("--macro-step", step), ("--duration", duration)):
        if value is not None and not value > 0.0:
            raise TouchdownError(f"{name} = {value:g} s must be above 0")
    folder = results_folder(options, f"modes-{chosen.name}")
    with bar_over(runs(modes), "drops", options.quiet) as bar:
        comparison = compare_modes(chosen, modes, step, duration, bar.update)
    write_report(comparison, folder)
    print("\n".join(report_lines(comparison)))
    print(f"results in {folder}")
    warn(comparison.warnings)
    return 0


VERB = Verb(
    "compare-modes",
    "what the number of modes of a flexible rotor costs in error",
    EXAMPLES,
    declare,
    execute,
)
