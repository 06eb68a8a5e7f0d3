"""Verbs that compare: schemes, models, modes, stability, and advice on macro steps."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from ...master.common.errors import STOPPED, TouchdownError
from ...master.common.progress import bar_over, named_progress
from ...master.scene.schemes import SCHEMES, scheme
from .arguments import (
    above_zero,
    add_jobs,
    add_output,
    add_quiet,
    add_scene_name,
    add_settings,
    add_swaps,
    chosen_jobs,
    count,
    names,
    results_folder,
    settings,
    several_above_zero,
    swapped,
)
from .verb import Verb, broken_off, complain, show_findings, warn

if TYPE_CHECKING:
    from ...master.scene.scene import Scene

ADVISE_EXAMPLES = (
    "touchdown advise rotor1-9000",
    "touchdown advise disk-caged-simplified --set bearing.preset=6014",
)


def _declare_advise(verb: argparse.ArgumentParser) -> None:
    add_scene_name(verb)
    add_settings(verb, "set COMPONENT.VARIABLE")


def _execute_advise(options: argparse.Namespace) -> int:
    from ...master.interop.scenes import find_scene
    from ...master.scene.schemes import SCHEMES
    from ...studies.comparison.schemes import advise

    chosen = find_scene(options.scene).set(settings(options))
    advice = advise(chosen, SCHEMES)
    reason = advice[chosen.run.scheme.name].reason
    print(f"{chosen.name}: {reason}")
    print(
        f"The scene takes {1e6 * chosen.run.macro_step:g} us. With the advised steps, peaks of the first "
        "impact are"
    )
    print("within about 1 %; the energy ledger of a run shows what longer steps do.")
    for name, advised in advice.items():
        scheme = SCHEMES[name]
        step, limit = f"{1e6 * advised.macro_step:>10g} us", f"{scheme.angle_limit:>5g} rad"
        print(f"  {name:<18}{step}   {limit}   {scheme.title}")
    return 0


ADVISE = Verb(
    "advise",
    "advise on the largest macro step of each coupling scheme in a scene",
    ADVISE_EXAMPLES,
    _declare_advise,
    _execute_advise,
)


COMPARE_EXAMPLES = (
    'touchdown compare disk-caged-simplified --schemes hold,velocity,interface --macro-steps "5,20,100 us"',
    'touchdown compare disk-caged-simplified --models --repeat 1 --duration "3 ms"',
)


def _declare_compare(verb: argparse.ArgumentParser) -> None:
    add_scene_name(verb)
    verb.add_argument(
        "--models",
        action="store_true",
        help="compare models instead: what the scene could do without, and the error that it makes",
    )
    verb.add_argument("--schemes", help=f"some of {', '.join(SCHEMES)} (default: all)")
    verb.add_argument(
        "--macro-steps", help='macro steps, such as "5,20,100 us" (default: "5,10,20,50,100 us")'
    )
    verb.add_argument(
        "--wanted", help='largest error of the journal that a scheme may have (default: "0.1 um")'
    )
    verb.add_argument(
        "--duration",
        help='time compared from the first contact on, such as "2 ms" (default: until the first impact '
        "is over, at most 5 ms; with --models 20 ms)",
    )
    verb.add_argument(
        "--timed", help='length of the runs that are timed, such as "1 s" (default: as compared)'
    )
    verb.add_argument(
        "--repeat", default="3", metavar="N", help="number of runs that are timed (default: 3)"
    )
    verb.add_argument("--in-process", action="store_true", help="time the models without FMUs")
    add_settings(verb)
    add_swaps(verb)
    add_output(verb, "runs/compare-SCENE")
    add_quiet(verb)


def _execute_compare(options: argparse.Namespace) -> int:
    from ...master.interop.scenes import find_scene
    from ...studies.drop.first_impact import shortened

    given = settings(options)
    _refuse_varied(given, options)
    chosen = shortened(swapped(find_scene(options.scene), options)).set(given)
    return (_models if options.models else _schemes)(chosen, options)


def _schemes(scene: Scene, options: argparse.Namespace) -> int:
    from ...studies.comparison.schemes import STEPS, TARGET_ERROR_M, Options, compare_schemes, pieces
    from ...studies.comparison.schemes_report import findings

    compared = Options(
        schemes=_scheme_names(options.schemes),
        steps=several_above_zero(options.macro_steps, "s", "--macro-steps") or STEPS,
        duration=above_zero(options.duration, "s", "--duration"),
        target=above_zero(options.wanted, "m", "--wanted") or TARGET_ERROR_M,
        repeat=count(options.repeat, "--repeat"),
        timed=above_zero(options.timed, "s", "--timed"),
        in_process=options.in_process,
    )
    folder = results_folder(options, f"compare-{scene.name}")
    with named_progress(pieces(scene, compared), options.quiet) as begin:
        comparison = compare_schemes(scene, compared, begin)
    return show_findings(findings(comparison), folder)


def _models(scene: Scene, options: argparse.Namespace) -> int:
    from ...studies.comparison.models import compare_models, findings, variants

    duration = above_zero(options.duration, "s", "--duration")
    repeat = count(options.repeat, "--repeat")
    folder = results_folder(options, f"compare-models-{scene.name}")
    chosen = variants(scene)
    with named_progress(1 + len(chosen), options.quiet) as begin:
        comparison = compare_models(scene, chosen, duration, repeat, options.in_process, begin)
    return show_findings(findings(comparison), folder)


def _scheme_names(text: str | None) -> tuple[str, ...]:
    """Schemes by the names between commas; all where none are given. Raises TouchdownError."""
    return tuple(dict.fromkeys(scheme(name).name for name in names(text, "--schemes"))) or tuple(SCHEMES)


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


COMPARE = Verb(
    "compare",
    "measure speed against error of coupling schemes, or of --models",
    COMPARE_EXAMPLES,
    _declare_compare,
    _execute_compare,
)


COMPARE_MODES_EXAMPLES = ("touchdown compare-modes rotor1-9000 --modes 5,20",)


def _declare_compare_modes(verb: argparse.ArgumentParser) -> None:
    add_scene_name(verb, "name of a scene with a flexible rotor, or path of a .toml")
    verb.add_argument(
        "--modes",
        default="3,5,8,12,20",
        help="numbers of modes per plane, the two rigid ones included (default: 3,5,8,12,20)",
    )
    add_settings(verb)
    verb.add_argument(
        "--duration",
        help='time compared from the first contact on, such as "2 ms" (default: until the first impact '
        "is over, at most 10 ms)",
    )
    verb.add_argument("--macro-step", default="2 us", help='macro step (default: "2 us")')
    add_output(verb, "runs/modes-SCENE")
    add_quiet(verb)


def _execute_compare_modes(options: argparse.Namespace) -> int:
    from ...master.common.units import to_si
    from ...master.interop.scenes import find_scene
    from ...studies.comparison.modes import compare_modes, findings, parse_modes, refuse_varied, runs

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
    status = show_findings(findings(comparison), folder)
    warn(comparison.warnings)
    return status


COMPARE_MODES = Verb(
    "compare-modes",
    "measure what the number of modes of a flexible rotor costs in error",
    COMPARE_MODES_EXAMPLES,
    _declare_compare_modes,
    _execute_compare_modes,
)


STABILITY_EXAMPLES = (
    "touchdown stability --cases bounce,mass-1 --schemes hold,interface -o runs/stability",
)


def _declare_stability(verb: argparse.ArgumentParser) -> None:
    verb.add_argument("--cases", metavar="A,B", help="cases, by name (default: all that are short)")
    verb.add_argument("--schemes", metavar="A,B", help=f"of {', '.join(SCHEMES)} (default: all)")
    verb.add_argument("--long", action="store_true", help="also the cases that take minutes")
    add_jobs(verb)
    add_output(verb, Path("runs/stability"))
    add_quiet(verb)


def _execute_stability(options: argparse.Namespace) -> int:
    from ...studies.comparison.stability import size, study_stability
    from ...studies.comparison.stability_cases import chosen
    from ...studies.comparison.stability_report import findings

    cases = chosen(names(options.cases, "--cases"), options.long)
    schemes = _scheme_names(options.schemes)
    jobs = chosen_jobs(options)
    folder = results_folder(options)
    with bar_over(size(cases, schemes), "searches", options.quiet) as bar:
        study = study_stability(cases, schemes, jobs, bar.update)
    show_findings(findings(study), folder)
    if study.interrupted:
        return broken_off()
    if study.failed:
        complain(f"{len(study.failed)} searches failed, see the end of the table")
        return STOPPED
    return 0


STABILITY = Verb(
    "stability",
    "find the longest macro step at which each scheme stays right in hard cases",
    STABILITY_EXAMPLES,
    _declare_stability,
    _execute_stability,
)
