"""Build FMUs."""

from __future__ import annotations

import argparse
from pathlib import Path

from touchdown.master.common.errors import TouchdownError
from touchdown.master.verbs import completion
from touchdown.master.verbs.arguments import add_output
from touchdown.master.verbs.completion import complete
from touchdown.master.verbs.verb import Verb

EXAMPLES = (
    "touchdown build -o build",
    "touchdown build simplified_caged housing --link-python -o build/linked",
    "touchdown build my-rotor.toml",
    "touchdown build simplified_caged rotor_I --modes 5 -o build/five-modes",
    "touchdown build --native -o build/native",
    "touchdown build housing --native --target linux-x86_64 windows-x86_64 -o build/native",
    "touchdown build housing --native --fmi 3 -o build/fmi3",
    "touchdown build --native examples/rubber_ring.py -o build/native",
)


def declare(verb: argparse.ArgumentParser) -> None:
    """Its options."""
    names = verb.add_argument(
        "names",
        nargs="*",
        help="FMUs to build, rotor files (.toml), or models in C (.py, which is run) (default: all)",
    )
    complete(names, completion.fmus)
    add_output(verb, Path("build"))
    verb.add_argument(
        "--link-python",
        action="store_true",
        help="for hosts without Python on this machine: the FMUs name this interpreter's libpython",
    )
    verb.add_argument("--native", action="store_true", help="FMUs that need no Python anywhere")
    verb.add_argument(
        "--fmi",
        type=int,
        choices=(2, 3),
        default=2,
        help="version of FMI; 3.0 with --native only (default: 2)",
    )
    targets = verb.add_argument(
        "--target",
        nargs="+",
        action="extend",
        default=[],
        metavar="TARGET",
        help="machines that native FMUs are for, all in one file (default: this one)",
    )
    complete(targets, completion.targets)
    verb.add_argument(
        "--modes",
        metavar="N",
        help="modes per plane that rotors start with, the two rigid ones included; seats have connectors "
        "for what they then carry (2: none); native rotors hold constants for several, N,N,... "
        "(default: 2,5,10)",
    )


def execute(options: argparse.Namespace) -> int:
    """Do it; returns the exit status."""
    from touchdown.master.api.fmus import built_one_by_one

    if not options.native and options.target:
        raise TouchdownError("--target is for native FMUs; add --native")
    made = built_one_by_one(
        options.names or None,
        options.output,
        link_python=options.link_python,
        native=options.native,
        targets=options.target,
        modes=None if options.modes is None else _counts(options.modes),
        fmi=options.fmi,
    )
    for path in made:
        print(path, flush=True)
    return 0


def _counts(text: str) -> list[int]:
    """Numbers of modes in a text such as "2,5,10"."""
    try:
        return [int(part) for part in text.split(",")]
    except ValueError:
        raise TouchdownError(f"--modes {text}: give whole numbers with commas between, as in 2,5") from None


VERB = Verb("build", "build the FMUs", EXAMPLES, declare, execute)
