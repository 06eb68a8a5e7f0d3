"""The verb that holds the project's figures against those of others."""

from __future__ import annotations

import argparse
from pathlib import Path

from ...master.common.errors import STOPPED, TouchdownError, one_of
from ...master.common.progress import bar_over
from ...modelkit.kernel.writing import write
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
    from ...validation.case import Verdict, cases, computed

    known = cases()
    if options.list:
        print(page.listing(known.values()))
        return 0
    chosen = _chosen(options, list(known))
    folder = results_folder(options) if options.output else None
    shown = {}
    with bar_over(len(chosen), "cases", options.quiet) as bar:
        for name in chosen:
            shown[name] = computed(known[name])
            bar.update()
    print("\n".join(page.text(known[name], rows) for name, rows in shown.items()))
    print(page.summary(known, shown))
    if folder:
        for one in known.values():
            if one.drawn and not isinstance(shown[one.name], str):
                page.draw_picture(one.drawn(), folder / page.picture_path(one))
        write(folder / PAGE, page.page(known, shown))
        print(f"results in {folder / PAGE}")
    return STOPPED if page.counted(known, shown)[Verdict.DIFFERS] else 0


def _chosen(options: argparse.Namespace, names: list[str]) -> list[str]:
    """The cases that are asked for. Raises TouchdownError where there is no such case."""
    if options.name is None:
        return names
    if options.name not in names:
        raise TouchdownError(f"unknown case {options.name}; {one_of(options.name, names)}")
    if options.output:
        raise TouchdownError("-o writes the page of all cases; name none of them")
    return [options.name]


VALIDATE = Verb(
    "validate",
    "recompute closed forms, other programs and measurements, within tolerances",
    EXAMPLES,
    _declare,
    _execute,
)
