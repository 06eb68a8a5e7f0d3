"""The report of a run."""

from __future__ import annotations

import argparse
from pathlib import Path

from touchdown.master.verbs.arguments import add_output
from touchdown.master.verbs.verb import Verb

EXAMPLES = (
    "touchdown report runs/disk-caged-simplified",
    "touchdown report runs/disk-caged-simplified -o runs/drop.html --pdf",
    "touchdown report runs/sweep-disk-caged-simplified",
)


def declare(verb: argparse.ArgumentParser) -> None:
    """Its options."""
    meant = "folder that `touchdown run` or `touchdown sweep` wrote"
    verb.add_argument("folder", metavar="RUN|SWEEP", type=Path, help=meant)
    add_output(verb, "RUN/report.html", "file")
    verb.add_argument("--pdf", action="store_true", help="print it as PDF, too, by a Chromium on the PATH")


def execute(options: argparse.Namespace) -> int:
    """Do it; returns the exit status."""
    from touchdown.master.api.report import report

    for path in report(options.folder, options.output, pdf=options.pdf):
        print(path)
    return 0


VERB = Verb("report", "a run or a sweep as a page to hand on", EXAMPLES, declare, execute)
