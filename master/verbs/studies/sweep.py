"""Run a scene over ranges of its settings."""

from __future__ import annotations

import argparse
from functools import reduce
from operator import mul
from pathlib import Path
from typing import TYPE_CHECKING

from touchdown.master.common.errors import STOPPED, TouchdownError
from touchdown.master.common.progress import bar_over
from touchdown.master.verbs.arguments import (
    add_jobs,
    add_maps,
    add_output,
    add_quiet,
    add_scene_name,
    add_settings,
    add_until,
    chosen_jobs,
    count,
    settings,
    show_sweep,
    timed,
)
from touchdown.master.verbs.screen import broken_off, complain
from touchdown.master.verbs.verb import Verb

if TYPE_CHECKING:
    from touchdown.master.studies.sweep.design import Design

EXAMPLES = (
    'touchdown sweep disk-caged-simplified --vary "bearing.clearance=0.2,0.25,0.3 mm" --duration "0.1 s"',
    'touchdown sweep rotor1-9000 --vary "housing_A.x0=0:150:4 um" --jobs 4 --pick "*whirl*"',
    'touchdown sweep rotor1-9000 --sobol 64 --range "bearing_*.clearance=0.2:0.3 mm" --in-process',
    'touchdown sweep rotor1-9000 --vary "rotor.unbalance_angle=0:345:24 deg" --shard 3/8 -o runs/part-3',
)
SAMPLES = {"random": "drawn at random", "latin": "Latin hypercube", "sobol": "Sobol, 2^k"}


def declare(verb: argparse.ArgumentParser) -> None:
    """Its options."""
    add_scene_name(verb)
    _add_points(verb)
    verb.add_argument("--duration", help='of each run, such as "2 s"')
    add_until(verb)
    add_settings(verb)
    add_output(verb, "runs/sweep-SCENE", "folder for the results, in which a sweep goes on")
    verb.add_argument("--anew", action="store_true", help="throw away a sweep that the folder holds")
    add_jobs(verb)
    verb.add_argument(
        "--shard",
        metavar="K/N",
        help="run every Nth point from the Kth on; `touchdown merge` joins them",
    )
    verb.add_argument("--dask", metavar="ADDRESS", help="run on the workers of this Dask scheduler")
    verb.add_argument("--in-process", action="store_true", help="step the models without FMUs, faster")
    verb.add_argument("--keep", action="store_true", help="keep each run's recording, result.h5")
    add_maps(verb)
    add_quiet(verb)


def _add_points(verb: argparse.ArgumentParser) -> None:
    points = verb.add_argument_group(
        "points", "NAME is a setting, or several with commas between them, or has * for anything"
    )
    points.add_argument(
        "--vary",
        action="append",
        default=[],
        metavar="NAME=VALUES",
        help='a list such as "0.2,0.25,0.3 mm", or START:STOP:COUNT such as "0:315:8 deg"; '
        "repeat it for every combination",
    )
    points.add_argument(
        "--tie",
        action="append",
        default=[],
        metavar="NAME=VALUES",
        help="the same; what several --tie give varies together, value by value",
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
        "--range", action="append", default=[], metavar="NAME=LOW:HIGH UNIT", help="to draw points from"
    )
    points.add_argument("--seed", default="0", help="of the points that are drawn (default: 0)")


def execute(options: argparse.Namespace) -> int:
    """Do it; returns the exit status."""
    from touchdown.master.common.ended import Ended
    from touchdown.master.interop.scenes import find_scene
    from touchdown.master.studies.sweep.maps.field import refuse_axes
    from touchdown.master.studies.sweep.sweep import Running, sweep

    chosen = timed(find_scene(options.scene).set(settings(options)), options)
    design = _design(options)
    refuse_axes(options.over, design.names)
    running = Running(
        chosen_jobs(options), options.dask or "", options.in_process, options.keep, options.anew
    )
    folder = options.output or Path("runs") / f"sweep-{chosen.name}{_tail(design)}"
    shard = f", shard {options.shard} of" if options.shard else ":"
    print(f"{len(design)} runs{shard} {design.about}", flush=True)
    with bar_over(len(design), "runs", options.quiet) as bar:
        found = sweep(chosen, design, folder, running, bar.update)
    if kept := sum(member.kept for member in found):
        print(f"{kept} of {len(found)} were finished before and not run again")
    show_sweep(found, folder, options)
    if any(m.ended is Ended.INTERRUPTED for m in found):
        return broken_off()
    if failed := sum(bool(m.failed) for m in found):
        complain(f"{failed} of {len(found)} runs failed, see the table")
        return STOPPED
    return 0


def _tail(design: Design) -> str:
    """Of the folder's name: each shard has one of its own."""
    number, of = design.part
    return f"-{number}-of-{of}" if of > 1 else ""


def _design(options: argparse.Namespace) -> Design:
    """The points that are asked for: every combination of all that is given. Raises TouchdownError."""
    from touchdown.master.studies.sweep.design import Design
    from touchdown.master.studies.sweep.listing import read_points
    from touchdown.master.studies.sweep.variation import parse_all

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
    return _sharded(reduce(mul, designs), options.shard)


def _samples(options: argparse.Namespace) -> list[Design]:
    """The points that are drawn: of one kind, or none."""
    from touchdown.master.studies.sweep.design import MOST, Design

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
        getattr(Design, name)(ranges, count(number, f"--{name}", MOST), int(seed))
        for name, number in asked.items()
    ]


def _sharded(design: Design, shard: str | None) -> Design:
    if shard is None:
        return design
    number, slash, of = shard.partition("/")
    if not slash or not number.strip().isdecimal() or not of.strip().isdecimal():
        raise TouchdownError(f"--shard {shard}: write K/N, such as 3/8")
    return design.shard(int(number), int(of))


VERB = Verb("sweep", "run a scene many times with settings that vary", EXAMPLES, declare, execute)
