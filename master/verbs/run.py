"""Run a scene."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from touchdown.master.common.errors import STOPPED, TouchdownError
from touchdown.master.common.progress import growing_bar
from touchdown.master.verbs.arguments import (
    add_output,
    add_quiet,
    add_scene,
    add_until,
    chosen_scene,
    count,
)
from touchdown.master.verbs.screen import BROKEN_OFF, complain, say_whose_code_runs, warn
from touchdown.master.verbs.verb import Verb

if TYPE_CHECKING:
    from touchdown.master.results.result import Result

EXAMPLES = (
    "touchdown run disk-caged-simplified",
    "touchdown run disk-caged-simplified --swap bearing=detailed_caged -o runs/detailed",
    'touchdown run rotor1-9000 --macro-step "10 us" --set "rotor.speed=12000 rpm"',
    'touchdown run rotor1-18000-150um --in-process --until settled --duration "2 s"',
    'touchdown run rotor1-9000 --in-process --duration "40 ms" --spread 8',
)


def declare(verb: argparse.ArgumentParser) -> None:
    """Its options."""
    add_scene(verb)
    add_output(verb, "runs/SCENE", "folder for the results")
    verb.add_argument("--in-process", action="store_true", help="step the models without FMUs")
    verb.add_argument(
        "--native", action="store_true", help="take FMUs that need no Python, built on first use"
    )
    verb.add_argument("--isolate", action="store_true", help="step each .fmu in a process of its own")
    add_until(verb)
    verb.add_argument(
        "--spread",
        metavar="N",
        help="also run N siblings, whose starts are nanometres apart, and tell how far peaks lie apart",
    )
    verb.add_argument("--csv", action="store_true", help="also write result.csv")
    verb.add_argument("--no-pictures", action="store_true", help="draw nothing")
    verb.add_argument("--dark", action="store_true", help="pictures on a dark ground")
    add_quiet(verb)


def execute(options: argparse.Namespace) -> int:
    """Do it; returns the exit status."""
    from touchdown.master.common.ended import Ended
    from touchdown.master.components.library.sources import foreign
    from touchdown.master.results.run import natively, run_scene
    from touchdown.master.results.summary import table
    from touchdown.master.results.whirl.evidence import evidence, goes_on, hint
    from touchdown.master.results.whirl.unbalance import unbalanced
    from touchdown.master.studies.rotor.balance import balanced

    chosen = chosen_scene(options)
    files = [name for name, spec in chosen.components.items() if foreign(spec.fmu)]
    if options.isolate:
        chosen = chosen.set({f"{name}.isolate": True for name in files})
    if options.native:
        if options.in_process:
            raise TouchdownError("--native takes FMUs and --in-process takes none; choose one")
        chosen = natively(chosen)
    say_whose_code_runs({name: chosen.components[name].isolate for name in files})
    result = run_scene(
        chosen,
        options.output or Path("runs") / chosen.name,
        in_process=options.in_process,
        csv=options.csv,
        pictures=False if options.no_pictures else "dark" if options.dark else True,
        progress=not options.quiet,
    )
    print("\n".join([table(result.summary), *evidence(result.summary)]))
    told = [*goes_on(result.summary), *_spread(result, options)]
    hints = list(hint(options.scene, result.ending, result.summary))
    if hints and balanced(chosen, unbalanced(result.ending)):
        hints = ["the rotor has no unbalance, so the verdict hangs on no phase of it"]
    print("\n".join([*told, *hints, f"results in {result.folder}"]))
    warn(result.warnings)
    if result.ended is not Ended.COMPLETED:
        complain(f"stopped: {result.stopped_because}; what was recorded is in {result.folder}")
        return BROKEN_OFF if result.ended is Ended.INTERRUPTED else STOPPED
    return 0


def _spread(result: Result, options: argparse.Namespace) -> list[str]:
    """What --spread asks for, in lines; nothing of a run that did not come to its end."""
    from touchdown.master.common.ended import Ended
    from touchdown.master.studies.drop.spread import spread, spread_lines

    if options.spread is None or result.ended is not Ended.COMPLETED:
        return []
    siblings = count(options.spread, "--spread")
    with growing_bar("siblings", options.quiet) as progress:
        warn(spread(result, siblings, progress=progress))
    return list(spread_lines(result.summary))


VERB = Verb("run", "run a scene", EXAMPLES, declare, execute)
