"""Describe rotors."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from touchdown.master.common.errors import TouchdownError
from touchdown.master.verbs import completion
from touchdown.master.verbs.arguments import (
    above_zero,
    add_output,
    add_settings,
    add_swaps,
    assignment,
    settings,
    swapped,
)
from touchdown.master.verbs.completion import complete
from touchdown.master.verbs.screen import warn
from touchdown.master.verbs.verb import Verb

if TYPE_CHECKING:
    from touchdown.master.studies.rotor.report import Report

EXAMPLES = (
    "touchdown rotor rotor_I",
    'touchdown rotor rotor_II --support "amb_A=20 MN/m" --support "amb_B=20 MN/m" --speed "10000 rpm"',
    'touchdown rotor my-rotor.toml --speed "12000 rpm" --modes 8 -o runs/my-rotor',
    "touchdown rotor rotor1-9000 --set amb_*.stiffness=4e5 -o runs/stiffer",
    "touchdown rotor rotor1-9000 --load 10",
)


def declare(verb: argparse.ArgumentParser) -> None:
    """Its options."""
    names = verb.add_argument(
        "rotors",
        nargs="*",
        metavar="ROTOR",
        help="name of a rotor, or path of its .toml; or a scene, whose rotor is described in its bearings, "
        "too (default: all rotors)",
    )
    complete(names, completion.scenes)
    add_output(verb, "runs/rotor-ROTOR")
    verb.add_argument(
        "--speed",
        help='for forward and backward whirl; Campbell diagrams reach twice as far (default: "9000 rpm", '
        "of a scene its own); of a scene's rotor, below 0: clockwise",
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
        help='a spring there, such as "amb_A=20 MN/m", which holds the rotor; not for scenes',
    )
    verb.add_argument(
        "--load",
        metavar="TIMES",
        help="of a scene: what presses the rotor on its touchdown bearings, over its weight (default: 1)",
    )
    add_settings(verb, "of a scene: set COMPONENT.VARIABLE")
    add_swaps(verb)


def execute(options: argparse.Namespace) -> int:
    """Do it; returns the exit status."""
    from touchdown.rotor.file import shipped

    names = options.rotors or list(shipped())
    owns = [Path(name).stem for name in names]
    for own in owns:
        if owns.count(own) > 1:
            raise TouchdownError(f"{owns.count(own)} rotors are called {own}; ask for them one by one")
    for name, own in zip(names, owns, strict=True):
        folder = options.output or Path("runs") / f"rotor-{own}"
        if options.output and len(names) > 1:
            folder = options.output / own
        found = _described(name, folder, options)
        print(found.text)
        print(f"pictures in {folder}\n")
        warn(found.remarks)
    return 0


def _described(name: str, folder: Path, options: argparse.Namespace) -> Report:
    """A rotor, or a scene's, whose pictures go into `folder`."""
    from touchdown.master.common.units import to_si
    from touchdown.master.scene.file import is_scene
    from touchdown.master.studies.rotor.report import SPEED, report

    speed = None if options.speed is None else to_si(options.speed, "rad/s", "--speed")
    modes = to_si(options.modes, "1", "--modes")
    if modes < 0.0 or modes != int(modes):
        raise TouchdownError(f"--modes {options.modes} must be a whole number, 2 or more, or 0 for all")
    if is_scene(name):
        return _described_in(name, folder, speed, int(modes), options)
    for option in ("load", "set", "swap", "names"):
        if getattr(options, option):
            raise TouchdownError(f"--{option} is for scenes; {name} is a rotor")
    supports = {station: _stiffness(station, text) for station, text in _given(options.support)}
    return report(name, folder, SPEED if speed is None else speed, int(modes), supports)


def _described_in(
    name: str, folder: Path, speed: float | None, modes: int, options: argparse.Namespace
) -> Report:
    """Of the scene `name`."""
    from touchdown.master.interop.scenes import find_scene
    from touchdown.master.studies.rotor.scene_report import report_scene

    if options.support:
        raise TouchdownError(
            f"--support is for rotors; {name} is a scene, whose bearings hold it: --set COMPONENT.VARIABLE"
        )
    load = above_zero(options.load, "1", "--load")
    scene = swapped(find_scene(name), options).set(settings(options))
    return report_scene(scene, folder, speed, modes, 1.0 if load is None else load)


def _given(texts: list[str]) -> list[tuple[str, str]]:
    return [assignment(text, "--support") for text in texts]


def _stiffness(name: str, text: str) -> float:
    value = above_zero(text, "N/m", f"--support {name}")
    assert value is not None
    return value


VERB = Verb(
    "rotor",
    "describe rotors, also in a scene's bearings: frequencies, modes, critical speeds, how they lie",
    EXAMPLES,
    declare,
    execute,
)
