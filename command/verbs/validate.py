"""The verb that holds the project's figures against those of others."""

from __future__ import annotations

import argparse
from pathlib import Path

from ...master.common.errors import STOPPED, TouchdownError
from ...master.common.progress import bar_over
from .arguments import add_quiet, results_folder
from .verb import Verb

PAGE = "validation.md"
EXAMPLES = (
    "touchdown validate",
    "touchdown validate hertz-impact",
    "touchdown validate --list",
    "touchdown validate -o docs",
)


def _declare(verb: argparse.ArgumentParser) -> None:
    verb.add_argument("name", metavar="CASE", nargs="?", help="name of a case (default: all of them)")
    verb.add_argument("--list", action="store_true", help="list the cases")
    verb.add_argument(
        "-o", "--output", type=Path, help=f"folder for {PAGE}, the page of all cases, and its pictures"
    )
    add_quiet(verb)


def _execute(options: argparse.Namespace) -> int:
    """Do it; the exit status says whether a row left its tolerance without a known reason."""
    from ...validation import page
    from ...validation.case import cases, find_case, make_all

    if options.list:
        print(page.listing(cases().values()))
        return 0
    chosen = list(cases().values()) if options.name is None else [find_case(options.name)]
    if options.name and options.output:
        raise TouchdownError("-o writes the page of all cases; name none of them")
    folder = results_folder(options) if options.output else None
    with bar_over(len(chosen), "cases", options.quiet) as bar:
        made = make_all(chosen, done=bar.update)
    print("\n".join(page.text(case, found) for case, found in made.items()))
    print(page.summary(made))
    if folder:
        print(f"results in {page.write_page('validation', made, folder)}")
    return STOPPED if page.failed(made) else 0


VALIDATE = Verb(
    "validate",
    "recompute closed forms, other programs and measurements, within tolerances",
    EXAMPLES,
    _declare,
    _execute,
)
