"""The hard cases of the coupling schemes."""

from __future__ import annotations

import argparse
from pathlib import Path

from touchdown.master.common.errors import STOPPED, TouchdownError
from touchdown.master.common.progress import bar_over
from touchdown.master.scene.schemes import SCHEMES, scheme
from touchdown.master.verbs.arguments import add_jobs, add_output, add_quiet, chosen_jobs, results_folder
from touchdown.master.verbs.screen import broken_off, complain
from touchdown.master.verbs.verb import Verb

EXAMPLES = ("touchdown stability --cases bounce,mass-1 --schemes hold,interface -o runs/stability",)


def declare(verb: argparse.ArgumentParser) -> None:
    """Its options."""
    verb.add_argument("--cases", metavar="A,B", help="cases, by name (default: all that are short)")
    verb.add_argument("--schemes", metavar="A,B", help=f"of {', '.join(SCHEMES)} (default: all)")
    verb.add_argument("--long", action="store_true", help="also the cases that take minutes")
    add_jobs(verb)
    add_output(verb, Path("runs/stability"))
    add_quiet(verb)


def execute(options: argparse.Namespace) -> int:
    """Do it; returns the exit status."""
    from touchdown.master.studies.stability.cases import chosen
    from touchdown.master.studies.stability.report import report_lines
    from touchdown.master.studies.stability.study import size, study_stability

    cases = chosen(_names(options.cases, "--cases"), options.long)
    schemes = [scheme(name).name for name in _names(options.schemes, "--schemes")] or list(SCHEMES)
    jobs = chosen_jobs(options)
    folder = results_folder(options)
    with bar_over(size(cases, schemes), "searches", options.quiet) as bar:
        study = study_stability(cases, schemes, folder, jobs, bar.update)
    print("\n".join(report_lines(study)))
    print(f"results in {folder}")
    if study.interrupted:
        return broken_off()
    if study.failed:
        complain(f"{len(study.failed)} searches failed, see the end of the table")
        return STOPPED
    return 0


def _names(text: str | None, option: str) -> list[str]:
    """Names between commas; none where the option is not given. Raises TouchdownError."""
    if text is None:
        return []
    names = [name.strip() for name in text.split(",")]
    if not all(names):
        raise TouchdownError(f"{option} {text}: a name is missing between the commas")
    return list(dict.fromkeys(names))


VERB = Verb(
    "stability",
    "which macro steps the coupling schemes bear in hard cases, and what the ledger says",
    EXAMPLES,
    declare,
    execute,
)
