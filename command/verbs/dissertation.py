"""Verbs for the source's figures and tables."""

from __future__ import annotations

import argparse
from pathlib import Path

from ...master.common.errors import STOPPED, TouchdownError
from ...master.common.progress import growing_bar
from .arguments import (
    add_jobs,
    add_output,
    add_quiet,
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
    "touchdown figure bearings --ensemble 1",
    "touchdown figure all -o docs",
)


def _declare_figure(verb: argparse.ArgumentParser) -> None:
    names = "such as 25 or bearings; all: the source's, as a page; list, or nothing: which there are"
    complete(verb.add_argument("name", metavar="NAME", nargs="?", default="list", help=names), figures)
    verb.add_argument("--dark", action="store_true", help="pictures on a dark ground")
    verb.add_argument(
        "--ensemble",
        metavar="N",
        help="drops behind a median of table7, bearings, options and rotors (default: 5, rotors 8)",
    )
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

    members = None if options.ensemble is None else count(options.ensemble, "--ensemble")
    jobs, folder = chosen_jobs(options), results_folder(options)
    with growing_bar("drops", options.quiet) as progress, dropping(jobs, progress, members) as drops:
        exhibit = make(chosen, drops, options.dark)
        files = page.write(chosen, exhibit, folder)
    print(page.text(chosen, exhibit))
    print(f"results in {', '.join(map(str, files))}")
    return 0


def _all(options: argparse.Namespace) -> int:
    """Every figure and table, and the page; the exit status says whether one failed."""
    from ...studies.dissertation.exhibits import page
    from ...studies.dissertation.exhibits.registry import ENTRIES, dropping, make_all

    members = None if options.ensemble is None else count(options.ensemble, "--ensemble")
    jobs, folder = chosen_jobs(options), results_folder(options)
    with growing_bar("drops", options.quiet) as progress, dropping(jobs, progress, members) as drops:
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
