"""Verbs for the source's figures and tables."""

from __future__ import annotations

import argparse
from pathlib import Path

from ...master.common.errors import STOPPED
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
    from ...validation import page
    from ...validation.case import figures, find_figure, make, make_all
    from ...validation.dissertation.drop_cache import dropping

    if options.name == "list":
        print(f"{page.listing(figures(studies=True).values())}\n  not here: {page.absent()}")
        return 0
    chosen = None if options.name == "all" else find_figure(options.name)
    members = None if options.ensemble is None else count(options.ensemble, "--ensemble")
    jobs, folder = chosen_jobs(options), results_folder(options)
    with growing_bar("drops", options.quiet) as progress, dropping(jobs, progress, members) as drops:
        if chosen:
            found = make(chosen, drops, dark=options.dark)
            made, files = {chosen: found}, page.write(chosen, found, folder)
        else:
            made = make_all(figures().values(), drops, dark=options.dark)
            files = [page.write_page("reproduction", made, folder)]
    print("\n".join(page.text(case, found) for case, found in made.items()))
    print(f"results in {', '.join(map(str, files))}")
    return STOPPED if page.failed(made) else 0


FIGURE = Verb(
    "figure",
    "draw figures and tables of the source by name, beside its values",
    FIGURE_EXAMPLES,
    _declare_figure,
    _execute_figure,
)
