"""Verbs for the source's figures and tables."""

from __future__ import annotations

import argparse
from pathlib import Path

from ...master.common.errors import STOPPED, TouchdownError
from ...master.common.progress import bar_over, growing_bar
from .arguments import (
    add_jobs,
    add_output,
    add_phases,
    add_quiet,
    angle,
    chosen_jobs,
    count,
    results_folder,
)
from .completion import complete, figures
from .verb import Verb

FIGURE_EXAMPLES = (
    "touchdown figure",
    "touchdown figure 22 -o runs/figures",
    "touchdown figure table7",
    "touchdown figure all -o docs",
)


def _declare_figure(verb: argparse.ArgumentParser) -> None:
    names = "such as 25 or table7; all: each of them, as a page; list, or nothing: which there are"
    complete(verb.add_argument("name", metavar="NAME", nargs="?", default="list", help=names), figures)
    verb.add_argument("--dark", action="store_true", help="pictures on a dark ground")
    add_jobs(verb)
    add_output(verb, Path("runs/figures"))
    add_quiet(verb)


def _execute_figure(options: argparse.Namespace) -> int:
    from ...studies.dissertation.exhibits import page
    from ...studies.dissertation.exhibits.registry import entry

    if options.name == "list":
        print(page.listing())
        return 0
    if options.name == "all":
        return _all(options)
    chosen = entry(options.name)
    from ...studies.dissertation.exhibits.registry import dropping, make

    folder = results_folder(options)
    with growing_bar("drops", options.quiet) as progress, dropping(chosen_jobs(options), progress) as drops:
        exhibit = make(chosen, drops, options.dark)
        files = page.write(chosen, exhibit, folder)
    print(page.text(chosen, exhibit))
    print(f"results in {', '.join(map(str, files))}")
    return 0


def _all(options: argparse.Namespace) -> int:
    """Every figure and table, and the page; the exit status says whether one failed."""
    from ...studies.dissertation.exhibits import page
    from ...studies.dissertation.exhibits.registry import ENTRIES, dropping, make_all

    folder = results_folder(options)
    with growing_bar("drops", options.quiet) as progress, dropping(chosen_jobs(options), progress) as drops:
        made = make_all(ENTRIES, drops, options.dark)
        path = page.write_page(made, folder)
    for entry, exhibit in made.items():
        failed = isinstance(exhibit, TouchdownError)
        print(f"{entry.heading}: failed: {exhibit}" if failed else page.text(entry, exhibit))
    print(f"results in {path}")
    return STOPPED if any(isinstance(exhibit, TouchdownError) for exhibit in made.values()) else 0


FIGURE = Verb(
    "figure",
    "draw figures and tables of the source by name, beside its values",
    FIGURE_EXAMPLES,
    _declare_figure,
    _execute_figure,
)


COMPARE_BEARINGS_EXAMPLES = (
    "touchdown compare-bearings --ensemble 1",
    'touchdown compare-bearings --options --duration "2 s" -o runs/options',
)


def _declare_compare_bearings(verb: argparse.ArgumentParser) -> None:
    verb.add_argument("--duration", default="5 s", help='length of each drop (default: "5 s")')
    verb.add_argument("--ensemble", metavar="N", help="drops per model (default: 5, as the page has)")
    verb.add_argument("--options", action="store_true", help="also what the models' options change")
    add_output(verb, Path("runs/bearings"))
    add_quiet(verb)


def _execute_compare_bearings(options: argparse.Namespace) -> int:
    from ...master.common.units import to_si
    from ...studies.dissertation.bearings import MEMBERS, OPTIONS, READINGS, compare_bearings

    duration = to_si(options.duration, "s", "--duration")
    members = MEMBERS if options.ensemble is None else count(options.ensemble, "--ensemble")
    if duration <= 0.0:
        raise TouchdownError(f"--duration {options.duration} must be above 0 s")
    folder = results_folder(options)
    total = members * (len(READINGS) + (len(OPTIONS) if options.options else 0))
    with bar_over(total, "drops", options.quiet) as bar:
        text = compare_bearings(duration, members, options.options, folder, bar.update)
    print(text, end="")
    print(f"results in {folder}")
    return 0


COMPARE_BEARINGS = Verb(
    "compare-bearings",
    "compare the four bearing models with the source's Tables 5 to 7",
    COMPARE_BEARINGS_EXAMPLES,
    _declare_compare_bearings,
    _execute_compare_bearings,
)


COMPARE_ROTORS_EXAMPLES = (
    "touchdown compare-rotors --ensemble 2 -o runs/rotors",
    "touchdown compare-rotors --long",
)


def _declare_compare_rotors(verb: argparse.ArgumentParser) -> None:
    verb.add_argument("--ensemble", default="8", metavar="N", help="unbalance phases (default: 8)")
    add_phases(verb)
    verb.add_argument("--long", action="store_true", help="also the run-down over 16 s")
    add_jobs(verb)
    add_output(verb, Path("runs/rotors"))
    add_quiet(verb)


def _execute_compare_rotors(options: argparse.Namespace) -> int:
    from ...studies.dissertation.rotors import compare_rotors
    from ...studies.verdict.study import Plan

    members = count(options.ensemble, "--ensemble")
    jobs = chosen_jobs(options)
    plan = Plan(angle(options.grid, "--grid"), angle(options.resolution, "--resolution"))
    folder = results_folder(options)
    with growing_bar("drops", options.quiet) as progress:
        text = compare_rotors(members, plan, folder, options.long, jobs, progress)
    print(text, end="")
    print(f"results in {folder}")
    return 0


COMPARE_ROTORS = Verb(
    "compare-rotors",
    "compare drops of the flexible rotors with the source's Figs 14, 15 and Table 4",
    COMPARE_ROTORS_EXAMPLES,
    _declare_compare_rotors,
    _execute_compare_rotors,
)
