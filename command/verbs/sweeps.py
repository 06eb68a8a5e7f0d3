"""Verbs for many runs of a scene: sweep, survive, choose."""

from __future__ import annotations

import argparse
from functools import reduce
from operator import mul
from pathlib import Path
from typing import TYPE_CHECKING

from ...master.common.errors import STOPPED, TouchdownError
from ...master.common.progress import bar_over
from .arguments import (
    add_jobs,
    add_output,
    add_quiet,
    add_scene_name,
    add_settings,
    add_until,
    chosen_jobs,
    count,
    settings,
    timed,
)
from .verb import Verb, broken_off, complain, warn

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ...master.scene.scene import Scene
    from ...studies.sweep.design import Design


SWEEP_EXAMPLES = (
    'touchdown sweep disk-caged-simplified --vary "bearing.clearance=0.2,0.25,0.3 mm" --duration "0.1 s"',
    'touchdown sweep rotor1-9000 --vary "housing_A.x0=0:150:4 um" --jobs 4 --pick "*whirl*"',
    'touchdown sweep rotor1-9000 --sobol 64 --range "bearing_*.clearance=0.2:0.3 mm" --in-process',
    'touchdown sweep rotor1-9000 --vary "rotor.unbalance_angle=0:345:24 deg" --dask tcp://cluster:8786',
)
SAMPLES = {"random": "drawn at random", "latin": "Latin hypercube", "sobol": "Sobol, 2^k"}


def _declare_sweep(verb: argparse.ArgumentParser) -> None:
    add_scene_name(verb)
    _add_points(verb)
    verb.add_argument("--duration", help='length of each run, such as "2 s"')
    add_until(verb)
    add_settings(verb)
    add_output(verb, "runs/sweep-SCENE", "folder for the results; a sweep continues in it")
    verb.add_argument("--anew", action="store_true", help="delete a sweep that the folder holds")
    add_jobs(verb)
    verb.add_argument("--dask", metavar="ADDRESS", help="run on the workers of this Dask scheduler")
    verb.add_argument("--in-process", action="store_true", help="step the models without FMUs, faster")
    verb.add_argument("--keep", action="store_true", help="keep each run's recording, result.h5")
    _add_maps(verb)
    add_quiet(verb)


def _add_maps(verb: argparse.ArgumentParser) -> None:
    """Add --pick, --all, --over and --no-pictures."""
    verb.add_argument(
        "--pick",
        action="append",
        default=[],
        metavar="KEY",
        help="show this figure of the summary; * stands for anything",
    )
    verb.add_argument("--all", action="store_true", help="show all figures; they are in sweep.csv anyway")
    verb.add_argument(
        "--over",
        action="append",
        default=[],
        metavar="NAME",
        help="draw maps over this setting; repeat it for the second axis (default: the first that vary)",
    )
    verb.add_argument("--no-pictures", action="store_true", help="draw no maps")


def _add_points(verb: argparse.ArgumentParser) -> None:
    points = verb.add_argument_group(
        "points", "NAME is a setting, or several with commas between them, or has * for anything"
    )
    points.add_argument(
        "--vary",
        action="append",
        default=[],
        metavar="NAME=VALUES",
        help='a list such as "0.2,0.25,0.3 mm", or START:STOP:COUNT such as "0:315:8 deg", with :log for '
        "even ratios; repeat the option for all combinations",
    )
    points.add_argument(
        "--tie",
        action="append",
        default=[],
        metavar="NAME=VALUES",
        help="as --vary, but the settings of several --tie vary together, value by value",
    )
    points.add_argument(
        "--list",
        type=Path,
        metavar="FILE",
        help="CSV: a column NAME [UNIT] per setting, a line per point",
    )
    for name, what in SAMPLES.items():
        points.add_argument(f"--{name}", metavar="N", help=f"N points of the --range settings: {what}")
    points.add_argument(
        "--range",
        action="append",
        default=[],
        metavar="NAME=LOW:HIGH UNIT",
        help="range of a setting to draw points from",
    )
    points.add_argument("--seed", default="0", help="seed of the points that are drawn (default: 0)")


def _execute_sweep(options: argparse.Namespace) -> int:
    from ...master.common.errors import Ended
    from ...master.interop.scenes import find_scene
    from ...studies.sweep.places import refuse_axes
    from ...studies.sweep.report import report_lines
    from ...studies.sweep.sweep import sweep
    from ...studies.sweep.tasks import Running

    chosen = timed(find_scene(options.scene).set(settings(options)), options)
    design = _design(options)
    refuse_axes(options.over, design.names)
    running = Running(
        chosen_jobs(options), options.dask or "", options.in_process, options.keep, options.anew
    )
    folder = options.output or Path("runs") / f"sweep-{chosen.name}"
    print(f"{len(design)} runs: {design.about}", flush=True)
    with bar_over(len(design), "runs", options.quiet) as bar:
        found = sweep(chosen, design, folder, running, bar.update)
    if kept := sum(member.kept for member in found):
        print(f"{kept} of {len(found)} were finished before and not run again")
    lines, complaints = report_lines(found.members, options.pick, options.all)
    print("\n".join(lines))
    if not options.no_pictures:
        found.plot.save(folder, options.over)
    print(f"results in {folder}")
    warn(complaints)
    if any(m.ended is Ended.INTERRUPTED for m in found):
        return broken_off()
    if failed := sum(bool(m.failed) for m in found):
        complain(f"{failed} of {len(found)} runs failed, see the table")
        return STOPPED
    return 0


def _design(options: argparse.Namespace) -> Design:
    """The points that are asked for: every combination of all that is given. Raises TouchdownError."""
    from ...studies.sweep.design import Design, parse_all, read_points

    designs: list[Design] = []
    if options.list is not None:
        designs.append(read_points(options.list))
    designs += _samples(options)
    if options.tie:
        designs.append(Design.tied(parse_all(options.tie, "--tie")))
    if options.vary:
        designs.append(Design.grid(parse_all(options.vary)))
    if not designs:
        raise TouchdownError(
            "nothing varies; add --vary NAME=VALUE,VALUE,... or --vary NAME=START:STOP:COUNT"
        )
    return reduce(mul, designs)


def _samples(options: argparse.Namespace) -> list[Design]:
    """The points that are drawn: of one kind, or none."""
    from ...studies.sweep.design import MAX_POINTS, Design

    asked = {name: getattr(options, name) for name in SAMPLES if getattr(options, name) is not None}
    if not asked and options.range:
        raise TouchdownError("--range says where to draw points; add how many, such as --sobol 64")
    if len(asked) > 1:
        raise TouchdownError(f"--{' and --'.join(asked)} are different samples; choose one")
    ranges = {}
    for text in options.range:
        name, equals, span = (part.strip() for part in text.partition("="))
        if not equals or not name or name in ranges:
            raise TouchdownError(f"--range {text}: write NAME=LOW:HIGH UNIT, each name once")
        ranges[name] = span
    seed = options.seed.strip()
    if not seed.isdecimal():
        raise TouchdownError(f"--seed {options.seed} must be a whole number, 0 or above")
    return [
        getattr(Design, name)(ranges, count(number, f"--{name}", MAX_POINTS), int(seed))
        for name, number in asked.items()
    ]


SWEEP = Verb(
    "sweep",
    "run a scene many times with settings that vary",
    SWEEP_EXAMPLES,
    _declare_sweep,
    _execute_sweep,
)


SURVIVE_EXAMPLES = (
    "touchdown survive runs/sweep-rotor1-9000",
    'touchdown survive runs/sweep-rotor1-9000 --limit "ball_force=1695 N" --drops 1:20',
)


def _declare_survive(verb: argparse.ArgumentParser) -> None:
    verb.add_argument("folder", metavar="SWEEP", type=Path, help="folder of a sweep, finished or under way")
    verb.add_argument(
        "--limit",
        metavar="NAME=VALUE",
        help="limit that each drop must meet: a column of sweep.csv, or a requirement as in scenes, such "
        'as "ball_force=1695 N" (default: lowest_static_safety=1, a dent)',
    )
    verb.add_argument(
        "--drops", default="1,2,5,10,20", help='numbers of drops, such as "1:20" (default: 1,2,5,10,20)'
    )


def _execute_survive(options: argparse.Namespace) -> int:
    from ...studies.sweep.maps import SURVIVAL_FILE, write_survival
    from ...studies.sweep.results import read
    from ...studies.sweep.survival import DEFAULT, drivers, lines, read_limit, survival, undamped

    found = read(options.folder)
    limit = read_limit(options.limit, found.members) if options.limit else DEFAULT
    survived, drops = survival(found.members, limit), _counts(options.drops)
    print("\n".join(lines(survived, drops, drivers(found.definition, found.members, limit))))
    warn(undamped(found.definition))
    write_survival(survived, range(1, max(drops) + 1), options.folder / SURVIVAL_FILE)
    print(f"{SURVIVAL_FILE} in {options.folder}")
    return 0


MOST_DROPS = 10_000


def _counts(text: str) -> list[int]:
    """Numbers of drops, as a list or FIRST:LAST. Raises TouchdownError."""
    first, colon, last = text.partition(":")
    if colon:
        start, end = count(first, "--drops", MOST_DROPS), count(last, "--drops", MOST_DROPS)
        if start > end:
            raise TouchdownError(f"--drops {text} must go up, such as 1:20")
        return list(range(start, end + 1))
    return sorted({count(one, "--drops", MOST_DROPS) for one in text.split(",")})


SURVIVE = Verb(
    "survive",
    "tell from a sweep how many drops a machine survives",
    SURVIVE_EXAMPLES,
    _declare_survive,
    _execute_survive,
)


CHOOSE_EXAMPLES = (
    'touchdown choose my-machine/required.toml --bearings "7014,6014,61914" --duration "0.2 s"',
    'touchdown choose my-machine/required.toml --bearings "7014" --mount soft.toml --mount stiff.toml',
)


def _declare_choose(verb: argparse.ArgumentParser) -> None:
    add_scene_name(verb)
    verb.add_argument(
        "--bearings",
        required=True,
        metavar="BEARING,...",
        help="names in the catalogue, or in files of your own",
    )
    verb.add_argument(
        "--mount",
        action="append",
        default=[],
        type=Path,
        metavar="FILE",
        help="TOML file whose [set] describes the housings; all bearings are tried in it (default: the "
        "scene's)",
    )
    verb.add_argument(
        "--drops", default="12", help="number of drops of each bearing in each mount (default: 12)"
    )
    verb.add_argument(
        "--friction", default="0.3", help="fraction by which friction varies to either side (default: 0.3)"
    )
    verb.add_argument(
        "--clearance",
        default="0.1",
        help="fraction by which the clearance varies to either side (default: 0.1)",
    )
    verb.add_argument("--duration", help='length of each drop, such as "2 s"')
    add_until(verb)
    add_settings(verb)
    add_output(verb, "runs/choose-SCENE", "folder for the results; a ranking continues in it")
    add_jobs(verb)
    verb.add_argument("--fmus", action="store_true", help="step the FMUs, slower; the numbers are the same")
    add_quiet(verb)


def _execute_choose(options: argparse.Namespace) -> int:
    from ...master.common.errors import Ended
    from ...master.common.units import to_si
    from ...master.interop.scenes import find_scene
    from ...studies.machine.choose import Spread, choose, lines, notes, write_table
    from ...studies.sweep.design import MAX_POINTS
    from ...studies.sweep.sweep import Sweep, sweep
    from ...studies.sweep.tasks import Running
    from ..api.machines import report

    chosen = timed(find_scene(options.scene).set(settings(options)), options)
    folder = options.output or Path("runs") / f"choose-{chosen.name}"
    spread = Spread(
        count(options.drops, "--drops", MAX_POINTS),
        to_si(options.friction, "1", "--friction"),
        to_si(options.clearance, "1", "--clearance"),
    )
    running = Running(chosen_jobs(options), in_process=not options.fmus)

    def run(scene: Scene, design: Design) -> Sweep:
        print(f"{len(design)} drops", flush=True)
        with bar_over(len(design), "drops", options.quiet) as bar:
            return sweep(scene, design, folder, running, bar.update)

    names = [name.strip() for name in options.bearings.split(",") if name.strip()]
    found = choose(chosen, names, _mounts(options.mount), spread, run)
    if any(m.ended is Ended.INTERRUPTED for one in found for m in one.members):
        return broken_off()
    print("\n".join([*lines(found), *notes(found)]))
    write_table(found, folder)
    page = report(folder, None)[0]
    print(f"results in {folder}, its page is {page}")
    return STOPPED if any(one.failed for one in found) else 0


def _mounts(paths: Sequence[Path]) -> dict[str, dict[str, object]]:
    """Settings by the files' names without ending. Raises TouchdownError where two are the same."""
    from ...master.scene.file import read_settings

    found: dict[str, dict[str, object]] = {}
    for path in paths:
        if path.stem in found:
            raise TouchdownError(f"--mount {path}: there is a mount {path.stem} already; rename one")
        found[path.stem] = read_settings(path)
    return found


CHOOSE = Verb(
    "choose",
    "rank touchdown bearings and mounts by what a scene requires",
    CHOOSE_EXAMPLES,
    _declare_choose,
    _execute_choose,
)
