"""A drop as a film."""

from __future__ import annotations

import argparse
from pathlib import Path

from touchdown.master.verbs.arguments import add_output, add_quiet
from touchdown.master.verbs.verb import Verb

EXAMPLES = (
    "touchdown animate runs/disk-caged-simplified -o runs/drop.gif",
    "touchdown animate runs/disk-caged-simplified -o runs/drop.mp4",
)


def declare(verb: argparse.ArgumentParser) -> None:
    """Its options."""
    verb.add_argument("folder", metavar="RUN", type=Path, help="folder that `touchdown run` wrote")
    add_output(verb, "RUN/drop.gif", "film, .gif or .mp4")
    add_quiet(verb)


def execute(options: argparse.Namespace) -> int:
    """Do it; returns the exit status."""
    from touchdown.master.api.report import animate

    print(animate(options.folder, options.output, progress=not options.quiet))
    return 0


VERB = Verb("animate", "a run's drop as a film", EXAMPLES, declare, execute)
