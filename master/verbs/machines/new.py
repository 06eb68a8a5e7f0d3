"""A machine of one's own: a folder with a scene to start from."""

from __future__ import annotations

import argparse
from pathlib import Path

from touchdown.master.verbs.arguments import above_zero
from touchdown.master.verbs.verb import Verb

EXAMPLES = (
    "touchdown new my-machine --rotor rotor_II --bearings 7014",
    'touchdown new my-machine --rotor rotor.toml --bearings 7014 --at A,B --amb A,B --speed "9000 rpm"',
    'touchdown new my-disk --mass "60 kg" --bearings 6014 --dry-run',
)


def declare(verb: argparse.ArgumentParser) -> None:
    """Its options."""
    verb.add_argument("folder", type=Path, help="where the scene is written, with all files it needs")
    verb.add_argument("--rotor", help="name of a rotor, or path of its .toml")
    verb.add_argument(
        "--bearings",
        required=True,
        metavar="BEARING,...",
        help="touchdown bearings: one for all, or one for each place; `touchdown catalogue` lists them",
    )
    verb.add_argument(
        "--at",
        metavar="STATION,...",
        help="where they hold the rotor (default: its stations that are not in levitated_at)",
    )
    verb.add_argument(
        "--amb", metavar="STATION,...", help="where magnetic bearings do (default: its levitated_at)"
    )
    verb.add_argument(
        "--speed",
        help="at the start (default: the lower of 0.7 of the first bending frequency and 1,000,000 mm rpm "
        "over the bore)",
    )
    verb.add_argument("--clearance", default="0.25 mm", help='radial (default: "0.25 mm")')
    verb.add_argument("--mass", help="of a rigid rotor, instead of --rotor")
    verb.add_argument(
        "--inertia", help="its polar moment of inertia (default: mass times journal radius^2)"
    )
    verb.add_argument("--dry-run", action="store_true", help="show the scene, write nothing")
    verb.add_argument("--force", action="store_true", help="replace files that are there")


def execute(options: argparse.Namespace) -> int:
    """Do it; returns the exit status."""
    from touchdown.master.scene.file import SCENE_FILE
    from touchdown.master.studies.machine.new import Wanted, machine, write

    wanted = Wanted(
        rotor=options.rotor,
        bearings=_names(options.bearings) or (),
        at=_names(options.at),
        amb=_names(options.amb),
        speed=above_zero(options.speed, "rad/s", "--speed"),
        clearance=above_zero(options.clearance, "m", "--clearance") or 0.0,
        mass=above_zero(options.mass, "kg", "--mass"),
        inertia=above_zero(options.inertia, "kg.m2", "--inertia"),
    )
    made = machine(wanted, options.folder.resolve().name)
    notes = "".join(f"note: {note}\n" for note in made.notes)
    if options.dry_run:
        print(f"{made.files[SCENE_FILE]}{notes}", end="")
    else:
        written = write(made, options.folder, options.force)
        print(f"{notes}{written}: now run it with\n  touchdown run {options.folder}")
    return 0


def _names(text: str | None) -> tuple[str, ...] | None:
    """Names with commas between them."""
    return None if text is None else tuple(name.strip() for name in text.split(",") if name.strip())


VERB = Verb(
    "new", "a machine of one's own: a folder with a scene to start from", EXAMPLES, declare, execute
)
