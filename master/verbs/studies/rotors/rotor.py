"""Describe rotors."""

from __future__ import annotations

import argparse
from pathlib import Path

from touchdown.master.common.errors import TouchdownError
from touchdown.master.verbs.arguments import above_zero, add_output, assignment
from touchdown.master.verbs.verb import Verb

EXAMPLES = (
    "touchdown rotor rotor_I",
    'touchdown rotor rotor_II --support "amb_A=20 MN/m" --support "amb_B=20 MN/m" --speed "10000 rpm"',
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
    verb.add_argument(
        "--support",
        action="append",
        default=[],
        metavar="STATION=STIFFNESS",
        help='a spring there, such as "amb_A=20 MN/m", marked in the map of critical speeds',
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
    supports = {name: _stiffness(name, text) for name, text in _given(options.support)}
    names = options.rotors or list(shipped())
    owns = [Path(name).stem for name in names]
    for own in owns:
        if owns.count(own) > 1:
            raise TouchdownError(f"{owns.count(own)} rotors are called {own}; ask for them one by one")
    for name, own in zip(names, owns, strict=True):
        folder = options.output or Path("runs") / f"rotor-{own}"
        if options.output and len(names) > 1:
            folder = options.output / own
        description = report(name, folder, speed, int(modes), supports)
        print(description.text)
        print(f"pictures in {folder}\n")
    return 0


def _given(texts: list[str]) -> list[tuple[str, str]]:
    return [assignment(text, "--support") for text in texts]


def _stiffness(name: str, text: str) -> float:
    value = above_zero(text, "N/m", f"--support {name}")
    assert value is not None
    return value


VERB = Verb(
    "rotor",
    "describe rotors: inertias, frequencies, modes, critical speeds, how they lie",
    EXAMPLES,
    declare,
    execute,
)
