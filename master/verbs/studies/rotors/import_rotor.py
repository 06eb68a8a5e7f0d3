"""Import rotors."""

from __future__ import annotations

import argparse
from pathlib import Path

from touchdown.master.common.errors import TouchdownError
from touchdown.master.verbs.arguments import add_output, assignment
from touchdown.master.verbs.verb import Verb

EXAMPLES = (
    "touchdown import-rotor examples/pump_sections.csv -o runs/pump.toml",
    'touchdown import-rotor examples/pump_sections.csv --at "A=50 mm,B=17" --amb amb_A=7,amb_B=15',
    "touchdown import-rotor examples/spindle_matrices -o runs/fe.toml --at A=2,B=16 --amb amb_A=4,amb_B=14",
    'touchdown import-rotor saved-by-ross.toml -o my-rotor.toml --speed "6000 rpm"',
)


def declare(verb: argparse.ArgumentParser) -> None:
    """Its options."""
    verb.add_argument(
        "file",
        type=Path,
        help="saved by ROSS (.toml, .json), a table of sections (.csv), matrices or modal data (.npz), "
        "or a folder of matrices (.mtx)",
    )
    add_output(verb, "FILE-rotor.toml in this folder", "rotor file")
    for option, meaning in (
        ("--at", "stations that touchdown bearings hold"),
        ("--amb", "stations that levitate the rotor before it drops"),
        ("--sensors", "places whose motion is asked for"),
    ):
        verb.add_argument(
            option,
            action="append",
            default=[],
            metavar="NAME=PLACE,...",
            help=f"{meaning}; a PLACE is a node, from 1, or its name in the file, or a distance from node "
            "1 such as 120 mm",
        )
    verb.add_argument("--force", action="store_true", help="replace a file that is there")
    verb.add_argument("--speed", help="at which ROSS's bearings are taken, where they hang on the speed")


def execute(options: argparse.Namespace) -> int:
    """Do it; returns the exit status."""
    from touchdown.master.api.rotor import Rotor
    from touchdown.master.common.units import to_si
    from touchdown.master.results.run import make_writable

    speed = None if options.speed is None else to_si(options.speed, "rad/s", "--speed")
    rotor = Rotor.imported(
        options.file,
        _places(options.at, "--at"),
        _places(options.amb, "--amb"),
        _places(options.sensors, "--sensors"),
        speed,
    )
    path = options.output or Path(f"{options.file.stem}-rotor.toml")
    make_writable(path.parent)
    rotor.save(path, options.force)
    print(rotor)
    print(rotor.about)
    print(f"written to {path}; what it is like: touchdown rotor {path}")
    return 0


def _places(given: list[str], option: str) -> dict[str, str]:
    """Places by name, as an option gives them. Raises TouchdownError."""
    places: dict[str, str] = {}
    for text in (one for several in given for one in several.split(",")):
        name, place = assignment(text, option)
        if name in places:
            raise TouchdownError(f"{option} {text}: {name} is there twice")
        places[name] = place
    return places


VERB = Verb(
    "import-rotor",
    "import a rotor from ROSS, a table of its sections, matrices or modal data",
    EXAMPLES,
    declare,
    execute,
)
