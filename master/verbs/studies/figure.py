"""Figures and tables of the source by name."""

from __future__ import annotations

import argparse
from pathlib import Path

from touchdown.master.common.errors import STOPPED, TouchdownError
from touchdown.master.common.progress import growing_bar
from touchdown.master.verbs.arguments import add_jobs, add_output, add_quiet, chosen_jobs, results_folder
from touchdown.master.verbs.completion import complete, figures
from touchdown.master.verbs.verb import Verb

EXAMPLES = (
    "touchdown figure",
    "touchdown figure 22 -o runs/figures",
    "touchdown figure table7",
    "touchdown figure all -o docs",
)


def declare(verb: argparse.ArgumentParser) -> None:
    """Its options."""
    names = "such as 25 or table7; all: each of them, as a page; list, or nothing: which there are"
    complete(verb.add_argument("name", nargs="?", default="list", help=names), figures)
    verb.add_argument("--dark", action="store_true", help="pictures on a dark ground")
    add_jobs(verb)
    add_output(verb, Path("runs/figures"))
    add_quiet(verb)


def execute(options: argparse.Namespace) -> int:
    """Do it; returns the exit status."""
    from touchdown.master.studies.dissertation.exhibits import page
    from touchdown.master.studies.dissertation.exhibits.registry import entry

    if options.name == "list":
        print(page.listing())
        return 0
    if options.name == "all":
        return _all(options)
    chosen = entry(options.name)
    from touchdown.master.studies.dissertation.exhibits.make import dropping, make

    folder = results_folder(options)
    with growing_bar("drops", options.quiet) as progress, dropping(chosen_jobs(options), progress) as drops:
        exhibit = make(chosen, drops, options.dark)
        files = page.write(chosen, exhibit, folder)
    print(page.text(chosen, exhibit))
    print(f"results in {', '.join(map(str, files))}")
    return 0


def _all(options: argparse.Namespace) -> int:
    """Every figure and table, and the page; the exit status says whether one failed."""
    from touchdown.master.studies.dissertation.exhibits import page
    from touchdown.master.studies.dissertation.exhibits.make import dropping, make_all
    from touchdown.master.studies.dissertation.exhibits.registry import ENTRIES

    folder = results_folder(options)
    with growing_bar("drops", options.quiet) as progress, dropping(chosen_jobs(options), progress) as drops:
        made = make_all(ENTRIES, drops, options.dark)
        path = page.write_page(made, folder)
    for entry, exhibit in made.items():
        failed = isinstance(exhibit, TouchdownError)
        print(f"{entry.heading}: failed: {exhibit}" if failed else page.text(entry, exhibit))
    print(f"results in {path}")
    return STOPPED if any(isinstance(exhibit, TouchdownError) for exhibit in made.values()) else 0


VERB = Verb(
    "figure", "figures and tables of the source by name, beside its values", EXAMPLES, declare, execute
)
