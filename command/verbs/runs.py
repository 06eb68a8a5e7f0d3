"""Verbs for one run: run, report, animate."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from ...master.common.errors import STOPPED, TouchdownError
from ...master.common.progress import growing_bar
from .arguments import add_output, add_quiet, add_scene, add_until, chosen_scene, count
from .verb import BROKEN_OFF, Verb, complain, say_whose_code_runs, warn

if TYPE_CHECKING:
    from ...master.results.result import Result
    from ...master.scene.scene import Scene


RUN_EXAMPLES = (
    "touchdown run disk-caged-simplified",
    "touchdown run disk-caged-simplified --swap bearing=detailed_caged -o runs/detailed",
    'touchdown run rotor1-9000 --macro-step "10 us" --set "rotor.speed=12000 rpm"',
    'touchdown run rotor1-18000-150um --in-process --until settled --duration "2 s"',
    'touchdown run rotor1-9000 --in-process --duration "40 ms" --spread 8',
)


WAYS = AUTO, NATIVE, IN_PYTHON, IN_PROCESS = ("auto", "native", "python", "process")


def _declare_run(verb: argparse.ArgumentParser) -> None:
    add_scene(verb)
    add_output(verb, "runs/SCENE", "folder for the results")
    verb.add_argument(
        "--by",
        choices=WAYS,
        help="how models are stepped, with identical recordings: as native FMUs, as FMUs in Python, or in "
        "the master's process without FMUs; auto takes native FMUs where all of a scene's are built, else "
        "FMUs in Python (default: auto)",
    )
    verb.add_argument("--in-process", action="store_true", help="--by process: without FMUs")
    verb.add_argument("--native", action="store_true", help="--by native: FMUs built on first use")
    verb.add_argument(
        "--isolate",
        action=argparse.BooleanOptionalAction,
        help="step third-party FMUs in processes of their own, or unsupervised in the master's, which is "
        "faster (default: as the scene says, else isolated)",
    )
    add_until(verb)
    verb.add_argument(
        "--spread",
        metavar="N",
        help="also run N siblings (the same drop, its start shifted by nanometres) and show how far the "
        "peaks spread",
    )
    verb.add_argument("--csv", action="store_true", help="also write result.csv")
    verb.add_argument("--no-pictures", action="store_true", help="do not draw pictures")
    verb.add_argument(
        "--all", action="store_true", help="print all results, also energies, steps and what did not happen"
    )
    verb.add_argument(
        "--require", action="store_true", help="fail where the scene's [requirements] are not met"
    )
    verb.add_argument("--dark", action="store_true", help="pictures on a dark background")
    add_quiet(verb)


def _execute_run(options: argparse.Namespace) -> int:
    from ...master.common.errors import Ended
    from ...master.components.loading import foreign
    from ...master.results.gaps import unforced
    from ...master.results.requirements import judged
    from ...master.results.run import natively, natively_where_built, run_scene
    from ...master.results.table import table
    from ...master.results.whirl.evidence import evidence, goes_on, hint, unbalanced
    from ...studies.rotor.supports import balanced
    from ..api.run import drawing, start_warnings

    chosen = chosen_scene(options)
    files = [name for name, spec in chosen.components.items() if foreign(spec.fmu)]
    if options.isolate is not None:
        chosen = chosen.set({f"{name}.isolate": options.isolate for name in files})
    by = _chosen_way(options)
    if by == NATIVE:
        chosen = natively(chosen)
    elif by == AUTO:
        chosen = natively_where_built(chosen)
    say_whose_code_runs(files)
    result = run_scene(
        chosen,
        options.output or Path("runs") / chosen.name,
        in_process=by == IN_PROCESS,
        csv=options.csv,
        draw=drawing(False if options.no_pictures else "dark" if options.dark else True),
        progress=not options.quiet,
        remarks=start_warnings(chosen),
    )
    without = [line for line in [unforced(result.scene, result.summary)] if line]
    print("\n".join([*without, table(result.summary, options.all), *evidence(result.summary)]))
    wanted = judged(chosen.requirements, result.summary)
    lines = [*goes_on(result.summary), *_spread(result, options), *(one.words() for one in wanted)]
    hints = list(hint(options.scene, result.ending, result.summary))
    if hints and balanced(chosen, unbalanced(result.ending)):
        hints = ["the rotor has no unbalance, so the verdict does not depend on its phase"]
    print("\n".join([*lines, *hints, _way(by, chosen, files), f"results in {result.folder}"]))
    warn(result.warnings)
    if result.ended is not Ended.COMPLETED:
        complain(f"stopped: {result.stopped_because}; what was recorded is in {result.folder}")
        return BROKEN_OFF if result.ended is Ended.INTERRUPTED else STOPPED
    return STOPPED if options.require and not all(one.met for one in wanted) else 0


def _chosen_way(options: argparse.Namespace) -> str:
    """One of WAYS. Raises TouchdownError where the options name two."""
    named = {
        options.by: bool(options.by),
        NATIVE: options.native or options.by == NATIVE,
        IN_PROCESS: options.in_process or options.by == IN_PROCESS,
    }
    ways = [way for way, is_named in named.items() if is_named]
    if len(ways) > 1:
        raise TouchdownError(
            f"--by {ways[0]} and --by {ways[1]} exclude each other (--native, --in-process are short for "
            "--by); give one"
        )
    return ways[0] if ways else AUTO


def _way(by: str, scene: Scene, files: list[str]) -> str:
    """How components were stepped, and what would be quicker."""
    if by == IN_PROCESS:
        others = f"; FMUs: {', '.join(files)}" if files else ""
        return f"stepped in process, without FMUs{others}"
    if not files and all(spec.native for spec in scene.components.values()):
        chosen = " (--by auto: all were built)" if by == AUTO else ""
        return f"stepped as native FMUs, which need no Python{chosen}"
    if files:
        return "stepped as FMUs in Python, and those of others; --in-process steps the own ones faster"
    return (
        "stepped as FMUs in Python; --in-process gives the same rows faster, --native builds FMUs that do, "
        "which later runs take by themselves"
    )


def _spread(result: Result, options: argparse.Namespace) -> list[str]:
    """The lines that --spread asks for; none for a run that did not come to its end."""
    from ...master.common.errors import Ended
    from ...studies.drop.spread import spread, spread_lines

    if options.spread is None or result.ended is not Ended.COMPLETED:
        return []
    siblings = count(options.spread, "--spread")
    with growing_bar("siblings", options.quiet) as progress:
        warn(spread(result, siblings, progress=progress))
    return list(spread_lines(result.summary))


RUN = Verb("run", "run a scene", RUN_EXAMPLES, _declare_run, _execute_run)


REPORT_EXAMPLES = (
    "touchdown report runs/disk-caged-simplified",
    "touchdown report runs/disk-caged-simplified -o runs/drop.html --pdf",
    "touchdown report runs/sweep-disk-caged-simplified",
)


def _declare_report(verb: argparse.ArgumentParser) -> None:
    meant = "folder that `touchdown run` or `touchdown sweep` wrote"
    verb.add_argument("folder", metavar="RUN|SWEEP", type=Path, help=meant)
    add_output(verb, "RUN/report.html", "file")
    verb.add_argument(
        "--pdf", action="store_true", help="also print it to PDF, with a Chromium on the PATH"
    )


def _execute_report(options: argparse.Namespace) -> int:
    from ..api.machines import report

    for path in report(options.folder, options.output, pdf=options.pdf):
        print(path)
    return 0


REPORT = Verb(
    "report",
    "write the report of a run or a sweep as one HTML page",
    REPORT_EXAMPLES,
    _declare_report,
    _execute_report,
)


ANIMATE_EXAMPLES = (
    "touchdown animate runs/disk-caged-simplified -o runs/drop.gif",
    "touchdown animate runs/disk-caged-simplified -o runs/drop.mp4",
)


def _declare_animate(verb: argparse.ArgumentParser) -> None:
    verb.add_argument("folder", metavar="RUN", type=Path, help="folder that `touchdown run` wrote")
    add_output(verb, "RUN/drop.gif", "film, .gif or .mp4")
    add_quiet(verb)


def _execute_animate(options: argparse.Namespace) -> int:
    from ..api.machines import animate

    print(animate(options.folder, options.output, progress=not options.quiet))
    return 0


ANIMATE = Verb("animate", "make a film of a run", ANIMATE_EXAMPLES, _declare_animate, _execute_animate)
