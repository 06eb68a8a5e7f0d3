"""The command `touchdown`."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from master.errors import TouchdownError
from master.schemes import DEFAULT, SCHEMES

FAILED = 2
STOPPED = 3


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; returns the exit status. A user's mistake is one line on stderr."""
    given = list(sys.argv[1:] if arguments is None else arguments)
    options = _parser().parse_args(_joined(given))
    try:
        return options.run(options)
    except TouchdownError as error:
        print(f"touchdown: {error}", file=sys.stderr)
        return FAILED
    except KeyboardInterrupt:
        print("touchdown: interrupted", file=sys.stderr)
        return 130
    except BrokenPipeError:
        return 0


def _joined(arguments: list[str]) -> list[str]:
    """Tie options to their values where these may be negative: argparse would take them for options."""
    found = list(arguments)
    for option in ("--macro-step", "--speed"):
        if option in found[:-1]:
            i = found.index(option)
            found[i : i + 2] = [f"{option}={found[i + 1]}"]
    return found


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="touchdown", description="Rotor drops onto touchdown bearings, co-simulated with FMUs."
    )
    verbs = parser.add_subparsers(required=True, metavar="VERB")

    scenes = verbs.add_parser("scenes", help="list the scenes, or show one")
    scenes.add_argument("scene", nargs="?", help="show this scene's components and settings")
    scenes.set_defaults(run=_scenes)

    run = verbs.add_parser("run", help="run a scene")
    run.add_argument("scene", help="name of a scene, or path of a .toml")
    run.add_argument("-o", "--output", type=Path, help="folder for the results (default: runs/SCENE)")
    run.add_argument("--scheme", help=f"coupling: {', '.join(SCHEMES)} (default: {DEFAULT})")
    run.add_argument("--macro-step", help='macro step, in s or as text such as "20 us"')
    run.add_argument(
        "--set", action="append", default=[], metavar="NAME=VALUE", help="set run.KEY or COMPONENT.VARIABLE"
    )
    run.add_argument(
        "--swap", action="append", default=[], metavar="COMPONENT=FMU", help="replace a component's FMU"
    )
    run.add_argument("--in-process", action="store_true", help="step the models without FMUs")
    run.add_argument("--csv", action="store_true", help="also write result.csv")
    run.add_argument("--no-pictures", action="store_true", help="draw nothing")
    run.add_argument("--quiet", action="store_true", help="no progress bar")
    run.set_defaults(run=_run)

    sweep = verbs.add_parser("sweep", help="run a scene many times with settings that vary")
    sweep.add_argument("scene", help="name of a scene, or path of a .toml")
    sweep.add_argument(
        "--vary",
        action="append",
        default=[],
        metavar="NAME=VALUES",
        help='a list such as "0.2,0.25,0.3 mm", or START:STOP:COUNT such as "0:315:8 deg"; '
        "repeat it for every combination",
    )
    sweep.add_argument(
        "--pick", action="append", default=[], metavar="KEY", help="show this figure; * stands for anything"
    )
    sweep.add_argument(
        "-o", "--output", type=Path, help="folder for the results (default: runs/sweep-SCENE)"
    )
    sweep.add_argument("--jobs", default="2", metavar="N", help="runs at a time (default: 2)")
    sweep.add_argument("--set", action="append", default=[], metavar="NAME=VALUE", help="set in all runs")
    sweep.add_argument("--duration", help='of each run, such as "2 s"')
    sweep.add_argument("--in-process", action="store_true", help="step the models without FMUs")
    sweep.add_argument("--keep", action="store_true", help="keep each run's recording, result.h5")
    sweep.add_argument("--quiet", action="store_true", help="no progress bar")
    sweep.set_defaults(run=_sweep)

    rotor = verbs.add_parser("rotor", help="describe rotors: inertias, frequencies, modes, how they lie")
    rotor.add_argument(
        "rotors", nargs="*", metavar="ROTOR", help="name of a rotor, or path of its .toml (default: all)"
    )
    rotor.add_argument("-o", "--output", type=Path, help="folder (default: runs/rotor-ROTOR)")
    rotor.add_argument(
        "--speed", default="9000 rpm", help='for forward and backward whirl (default: "9000 rpm")'
    )
    rotor.add_argument(
        "--modes",
        default="5",
        metavar="N",
        help="per plane, the two rigid ones included; 0: all (default: 5)",
    )
    rotor.set_defaults(run=_rotor)

    bearings = verbs.add_parser(
        "compare-bearings", help="the four bearing models side by side, against the source's Tables 5 to 7"
    )
    bearings.add_argument("--duration", default="5 s", help='of each drop (default: "5 s")')
    bearings.add_argument("--ensemble", default="5", metavar="N", help="drops per model (default: 5)")
    bearings.add_argument("--options", action="store_true", help="also what the models' options change")
    bearings.add_argument("-o", "--output", type=Path, default=Path("runs/bearings"), help="folder")
    bearings.add_argument("--quiet", action="store_true", help="no progress bar")
    bearings.set_defaults(run=_compare_bearings)

    rotors = verbs.add_parser(
        "compare-rotors", help="drops of the flexible rotors against the source's Figs 14, 15 and Table 4"
    )
    rotors.add_argument("--ensemble", default="4", metavar="N", help="unbalance phases (default: 4)")
    rotors.add_argument("--long", action="store_true", help="also the run-down over 16 s")
    rotors.add_argument("--jobs", default="2", metavar="N", help="runs at a time (default: 2)")
    rotors.add_argument("-o", "--output", type=Path, default=Path("runs/rotors"), help="folder")
    rotors.add_argument("--quiet", action="store_true", help="no progress bar")
    rotors.set_defaults(run=_compare_rotors)

    modes = verbs.add_parser(
        "compare-modes", help="what the number of modes of a flexible rotor costs in error"
    )
    modes.add_argument("scene", help="name of a scene with a flexible rotor, or path of a .toml")
    modes.add_argument(
        "--modes",
        default="3,5,8,12,20",
        help="numbers of modes per plane, the two rigid ones included (default: 3,5,8,12,20)",
    )
    modes.add_argument("--set", action="append", default=[], metavar="NAME=VALUE", help="set in all runs")
    modes.add_argument(
        "--duration",
        help='from the first contact, such as "2 ms" (default: until the first impact is over, '
        "at most 10 ms)",
    )
    modes.add_argument("--macro-step", default="2 us", help='macro step (default: "2 us")')
    modes.add_argument("-o", "--output", type=Path, help="folder (default: runs/modes-SCENE)")
    modes.add_argument("--quiet", action="store_true", help="no progress bar")
    modes.set_defaults(run=_compare_modes)

    build = verbs.add_parser("build", help="build the FMUs")
    build.add_argument(
        "names", nargs="*", help="FMUs to build, or paths of rotor files (.toml) (default: all)"
    )
    build.add_argument("-o", "--output", type=Path, default=Path("build"), help="folder (default: build)")
    build.set_defaults(run=_build)

    check = verbs.add_parser("check", help="check FMUs: validity, contract, a dry run")
    check.add_argument("fmus", nargs="+", help="paths of .fmu files, or names of the project's own")
    check.set_defaults(run=_check)
    return parser


def _scenes(options: argparse.Namespace) -> int:
    from master import scene as scenes

    if options.scene is None:
        names = scenes.names()
        width = max(len(name) for name in names)
        for name in names:
            print(f"  {name:<{width}}  {scenes.load(name).title}")
        return 0
    chosen = scenes.load(options.scene)
    print(chosen.title)
    print(chosen.about.strip())
    print(
        f"\nrun: {chosen.run.duration:g} s from {chosen.zero or 'the start'}, "
        f"macro step {chosen.run.macro_step:g} s, scheme {chosen.run.scheme}"
    )
    for name, spec in chosen.components.items():
        settings = "".join(f"\n      {key} = {value}" for key, value in spec.set.items())
        kind = f" ({spec.preset})" if spec.preset else ""
        print(f"  {name}: {spec.fmu}{kind}{settings}")
    for bearing, body in chosen.attach:
        print(f"  {bearing} on {body}")
    return 0


def _run(options: argparse.Namespace) -> int:
    from master.run import run_scene
    from master.scene import load
    from master.summary import table

    chosen = load(options.scene)
    for text in options.swap:
        chosen = chosen.with_swap(*_assignment(text, "--swap"))
    for text in options.set:
        chosen = chosen.with_setting(*_assignment(text, "--set"))
    if options.scheme is not None:
        chosen = chosen.with_setting("run.scheme", options.scheme)
    if options.macro_step is not None:
        chosen = chosen.with_setting("run.macro_step", options.macro_step)
    result = run_scene(
        chosen,
        options.output or Path("runs") / chosen.name,
        in_process=options.in_process,
        csv=options.csv,
        pictures=not options.no_pictures,
        progress=not options.quiet,
    )
    print(table(result.summary))
    print(f"results in {result.folder}")
    for warning in result.warnings:
        print(f"touchdown: warning: {warning}", file=sys.stderr)
    if result.stopped_because:
        print(
            f"touchdown: stopped: {result.stopped_because}; what was recorded is in {result.folder}",
            file=sys.stderr,
        )
        return 130 if result.stopped_because == "interrupted" else STOPPED
    return 0


def _sweep(options: argparse.Namespace) -> int:
    from tqdm import tqdm

    from master.scene import load
    from master.sweep import INTERRUPTED, size, sweep
    from master.sweep_report import picked, table, verdict_lines
    from master.variation import parse_all

    chosen = load(options.scene)
    for text in options.set:
        chosen = chosen.with_setting(*_assignment(text, "--set"))
    if options.duration is not None:
        chosen = chosen.with_setting("run.duration", options.duration)
    variations = parse_all(options.vary)
    jobs = _count(options.jobs, "--jobs")
    folder = options.output or Path("runs") / f"sweep-{chosen.name}"
    with tqdm(total=size(variations), desc="runs", disable=options.quiet, leave=False) as bar:
        members = sweep(chosen, variations, folder, jobs, options.in_process, options.keep, bar.update)
    figures, complaints = picked(members, options.pick)
    print("\n".join([table(members, figures), *verdict_lines(members)]))
    print(f"results in {folder}")
    failed = [m for m in members if m.failed]
    if any(m.failed == INTERRUPTED for m in failed):
        print("touchdown: interrupted", file=sys.stderr)
        return 130
    for complaint in complaints:
        print(f"touchdown: warning: {complaint}", file=sys.stderr)
    if failed:
        print(f"touchdown: {len(failed)} of {len(members)} runs failed, see the table", file=sys.stderr)
    return STOPPED if failed else 0


def _rotor(options: argparse.Namespace) -> int:
    from fmus.rotors import rotors
    from master.rotor_report import report
    from master.units import to_si

    speed = to_si(options.speed, "rad/s", "--speed")
    modes = to_si(options.modes, "1", "--modes")
    if modes < 0.0 or modes != int(modes):
        raise TouchdownError(f"--modes {options.modes} must be a whole number, 2 or more, or 0 for all")
    names = options.rotors or rotors()
    owns = [Path(name).stem for name in names]
    for own in owns:
        if owns.count(own) > 1:
            raise TouchdownError(f"{owns.count(own)} rotors are called {own}; ask for them one by one")
    for name, own in zip(names, owns, strict=True):
        folder = options.output or Path("runs") / f"rotor-{own}"
        if options.output and len(names) > 1:
            folder = options.output / own
        found = report(name, folder, speed, int(modes))
        print(found.text)
        print(f"pictures in {folder}\n")
    return 0


def _compare_bearings(options: argparse.Namespace) -> int:
    from tqdm import tqdm

    from master.bearing_comparison import OPTIONS, SCENES, compare
    from master.run import make_writable
    from master.units import to_si

    duration = to_si(options.duration, "s", "--duration")
    members = _count(options.ensemble, "--ensemble")
    if duration <= 0.0:
        raise TouchdownError(f"--duration {options.duration} must be above 0 s")
    make_writable(options.output)
    total = members * (len(SCENES) + (len(OPTIONS) if options.options else 0))
    with tqdm(total=total, desc="drops", disable=options.quiet, leave=False) as bar:
        text = compare(duration, members, options.options, options.output, bar.update)
    print(text, end="")
    print(f"results in {options.output}")
    return 0


def _compare_rotors(options: argparse.Namespace) -> int:
    from tqdm import tqdm

    from master.rotor_comparison import compare, runs
    from master.run import make_writable

    members = _count(options.ensemble, "--ensemble")
    make_writable(options.output)
    with tqdm(total=runs(members), desc="drops", disable=options.quiet, leave=False) as bar:
        text = compare(members, options.output, options.long, _count(options.jobs, "--jobs"), bar.update)
    print(text, end="")
    print(f"results in {options.output}")
    return 0


def _count(text: str, option: str) -> int:
    from master.units import to_si

    number = to_si(text, "1", option)
    if number < 1.0 or number != int(number):
        raise TouchdownError(f"{option} {text} must be a whole number above 0")
    return int(number)


def _compare_modes(options: argparse.Namespace) -> int:
    from tqdm import tqdm

    from master.mode_comparison import compare, parse_modes, refuse_varied, runs, write
    from master.mode_report import lines
    from master.run import make_writable
    from master.scene import load
    from master.units import to_si

    chosen = load(options.scene)
    settings = [_assignment(text, "--set") for text in options.set]
    refuse_varied(name for name, _ in settings)
    for name, value in settings:
        chosen = chosen.with_setting(name, value)
    modes = parse_modes(options.modes)
    step = to_si(options.macro_step, "s", "--macro-step")
    duration = None if options.duration is None else to_si(options.duration, "s", "--duration")
    for name, value in (("--macro-step", step), ("--duration", duration)):
        if value is not None and not value > 0.0:
            raise TouchdownError(f"{name} = {value:g} s must be above 0")
    folder = options.output or Path("runs") / f"modes-{chosen.name}"
    make_writable(folder)
    with tqdm(total=runs(modes), desc="drops", disable=options.quiet, leave=False) as bar:
        found = compare(chosen, modes, step, duration, bar.update)
    write(found, folder)
    print("\n".join(lines(found)))
    print(f"results in {folder}")
    for warning in found.warnings:
        print(f"touchdown: warning: {warning}", file=sys.stderr)
    return 0


def _build(options: argparse.Namespace) -> int:
    from fmus.build import build
    from fmus.recipes import Recipe, names
    from master.library import locate

    found = [locate(name) for name in options.names or names()]
    for name, one in zip(options.names, found, strict=False):
        if not isinstance(one, Recipe):
            raise TouchdownError(f"{name} is an FMU already; give the name of one or a rotor's .toml")
    for one in found:
        assert isinstance(one, Recipe)
        try:
            print(build(one, options.output))
        except OSError as error:
            raise TouchdownError(
                f"cannot write to {options.output}: {error.strerror}; choose another folder with -o"
            ) from None
    return 0


def _check(options: argparse.Namespace) -> int:
    from master.check import check_fmu

    failed = 0
    for name in options.fmus:
        report = check_fmu(name)
        print(report.text)
        failed += bool(report.problems)
    return FAILED if failed else 0


def _assignment(text: str, option: str) -> tuple[str, str]:
    name, equals, value = text.partition("=")
    if not equals or not name or not value:
        raise TouchdownError(f"{option} {text}: write NAME=VALUE")
    return name.strip(), value.strip()
