"""Speed against error of coupling schemes, and what a scene does not need."""

from __future__ import annotations

import argparse
from typing import Any

from touchdown.master.common.errors import TouchdownError
from touchdown.master.common.progress import named_progress
from touchdown.master.scene.schemes import SCHEMES, scheme
from touchdown.master.verbs.arguments import (
    above_zero,
    add_output,
    add_quiet,
    add_scene_name,
    add_settings,
    add_swaps,
    count,
    results_folder,
    settings,
    several_above_zero,
    swapped,
)
from touchdown.master.verbs.verb import Verb

EXAMPLES = (
    'touchdown compare disk-caged-simplified --schemes hold,velocity,interface --macro-steps "5,20,100 us"',
    'touchdown compare disk-caged-simplified --models --repeat 1 --duration "3 ms"',
)


def declare(verb: argparse.ArgumentParser) -> None:
    """Its options."""
    add_scene_name(verb)
    verb.add_argument(
        "--models",
        action="store_true",
        help="instead: what could be left out of the scene, and its price",
    )
    verb.add_argument("--schemes", help=f"some of {', '.join(SCHEMES)} (default: all)")
    verb.add_argument("--macro-steps", help='such as "5,20,100 us" (default: "5,10,20,50,100 us")')
    verb.add_argument("--wanted", help='error of the journal to find a scheme for (default: "0.1 um")')
    verb.add_argument(
        "--duration",
        help='from the first contact, such as "2 ms" (default: until the first impact is over, at most '
        "5 ms; with --models 20 ms)",
    )
    verb.add_argument("--timed", help='of the runs that are timed, such as "1 s" (default: as compared)')
    verb.add_argument("--repeat", default="3", metavar="N", help="runs that are timed (default: 3)")
    verb.add_argument("--in-process", action="store_true", help="time the models without FMUs")
    add_settings(verb)
    add_swaps(verb)
    add_output(verb, "runs/compare-SCENE")
    add_quiet(verb)


def execute(options: argparse.Namespace) -> int:
    """Do it; returns the exit status."""
    from touchdown.master.interop.scenes import find_scene
    from touchdown.master.studies.drop.levitation import shortened

    given = settings(options)
    _refuse_varied(given, options)
    chosen = shortened(swapped(find_scene(options.scene), options)).set(given)
    print("\n".join((_models if options.models else _schemes)(chosen, options)))
    return 0


def _schemes(scene: Any, options: argparse.Namespace) -> list[str]:
    from touchdown.master.studies.schemes.compare import STEPS, WANTED, Asked, compare_schemes, pieces
    from touchdown.master.studies.schemes.report import report_lines, write_report

    asked = Asked(
        schemes=tuple(SCHEMES) if options.schemes is None else _names(options.schemes),
        steps=several_above_zero(options.macro_steps, "s", "--macro-steps") or STEPS,
        duration=above_zero(options.duration, "s", "--duration"),
        wanted=above_zero(options.wanted, "m", "--wanted") or WANTED,
        repeat=count(options.repeat, "--repeat"),
        timed=above_zero(options.timed, "s", "--timed"),
        in_process=options.in_process,
    )
    folder = results_folder(options, f"compare-{scene.name}")
    with named_progress(pieces(scene, asked), options.quiet) as begin:
        comparison = compare_schemes(scene, asked, begin)
    write_report(comparison, folder)
    return [*report_lines(comparison), f"results in {folder}"]


def _models(scene: Any, options: argparse.Namespace) -> list[str]:
    from touchdown.master.studies.models.compare import compare_models
    from touchdown.master.studies.models.report import report_lines, write_report
    from touchdown.master.studies.models.variants import variants

    duration = above_zero(options.duration, "s", "--duration")
    repeat = count(options.repeat, "--repeat")
    folder = results_folder(options, f"compare-models-{scene.name}")
    chosen = variants(scene)
    with named_progress(1 + len(chosen), options.quiet) as begin:
        comparison = compare_models(scene, chosen, duration, repeat, options.in_process, begin)
    write_report(comparison, folder)
    return [*report_lines(comparison), f"results in {folder}"]


def _names(text: str) -> tuple[str, ...]:
    from touchdown.master.studies.sweep.variation import listed

    return tuple(dict.fromkeys(scheme(name).name for name in listed(text, f"--schemes {text}")))


def _refuse_varied(settings: dict[str, str], options: argparse.Namespace) -> None:
    """Raise TouchdownError for settings that the comparison makes itself, and options it does not have."""
    instead = {"run.duration": "--duration"}
    if options.models:
        for option in ("schemes", "macro_steps", "wanted", "timed"):
            if getattr(options, option) is not None:
                raise TouchdownError(f"--{option.replace('_', '-')} does not go with --models")
    else:
        instead |= {"run.macro_step": "--macro-steps", "run.scheme": "--schemes"}
    for name in settings:
        if name in instead:
            raise TouchdownError(f"--set {name}: compare sets it itself; use {instead[name]}")


VERB = Verb(
    "compare", "speed against error of coupling schemes, or of --models", EXAMPLES, declare, execute
)
