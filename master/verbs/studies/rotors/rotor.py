"""Describe rotors."""

from __future__ import annotations

import argparse
from pathlib import Path

from touchdown.master.common.errors import TouchdownError
from touchdown.master.verbs.arguments import add_output
from touchdown.master.verbs.verb import Verb

EXAMPLES = (
    "touchdown rotor rotor_I",
    'touchdown rotor my-rotor.toml --speed "12000 rpm" --modes 8 -o runs/my-rotor',
)


def declare(verb: argparse.ArgumentParser) -> None:
    """Its options."""
    verb.add_argument(
        "rotors", nargs="*", metavar="ROTOR", help="name of a rotor, or path of its .toml (default: all)"
    )
    add_output(verb, "runs/rotor-ROTOR")
    verb.add_argument(
        "--speed", default="9000 rpm", help='for forward and backward whirl (default: "9000 rpm")'
    )
    verb.add_argument(
        "--modes",
        default="5",
        metavar="N",
        help="per plane, the two rigid ones included; 0: all (default: 5)",
    )


def execute(options: argparse.Namespace) -> int:
    """Do it; returns the exit status."""
    from touchdown.master.common.units import to_si
    from touchdown.master.studies.rotor.report import report
    from touchdown.rotor.file import shipped

    speed = to_si(options.speed, "rad/s", "--speed")
    modes = to_si(options.modes, "1", "--modes")
    if modes < 0.0 or modes != int(modes):
        raise TouchdownError(f"--modes {options.modes} must be a whole number, 2 or more, or 0 for all")
    names = options.rotors or list(shipped())
    owns = [Path(name).stem for name in names]
    for own in owns:
        if owns.count(own) > 1:
            raise TouchdownError(f"{owns.count(own)} rotors are called {own}; ask for them one by one")
    for name, own in zip(names, owns, strict=True):
        folder = options.output or Path("runs") / f"rotor-{own}"
        if options.output and len(names) > 1:
            folder = options.output / own
        description = report(name, folder, speed, int(modes))
        print(description.text)
        print(f"pictures in {folder}\n")
    return 0


VERB = Verb(
    "rotor", "describe rotors: inertias, frequencies, modes, how they lie", EXAMPLES, declare, execute
)
