"""Run a scene."""

from __future__ import annotations

import argparse
from pathlib import Path

from touchdown.master.common.errors import STOPPED, TouchdownError
from touchdown.master.verbs.arguments import add_output, add_quiet, add_scene, chosen_scene
from touchdown.master.verbs.screen import BROKEN_OFF, complain, say_whose_code_runs, warn
from touchdown.master.verbs.verb import Verb

EXAMPLES = (
    "touchdown run disk-caged-simplified",
    "touchdown run disk-caged-simplified --swap bearing=detailed_caged -o runs/detailed",
    'touchdown run rotor1-9000 --macro-step "10 us" --set "rotor.speed=12000 rpm"',
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
    from touchdown.master.results.whirl.evidence import evidence, hint
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
    told = list(hint(options.scene, result.ending, result.summary))
    if told and balanced(chosen, unbalanced(result.ending)):
        told = ["the rotor has no unbalance, so the verdict hangs on no phase of it"]
    print("\n".join([*told, f"results in {result.folder}"]))
    warn(result.warnings)
    if result.ended is not Ended.COMPLETED:
        complain(f"stopped: {result.stopped_because}; what was recorded is in {result.folder}")
        return BROKEN_OFF if result.ended is Ended.INTERRUPTED else STOPPED
    return 0


VERB = Verb("run", "run a scene", EXAMPLES, declare, execute)
