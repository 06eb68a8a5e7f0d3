"""Write a scene as one FMU."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from touchdown.master.verbs.arguments import add_scene, chosen_scene


def add_to(verbs: Any) -> None:
    """Add the verb to the command."""
    verb = verbs.add_parser("container", help="write a scene as one FMU, for tools that take only one")
    add_scene(verb)
    verb.add_argument("-o", "--output", type=Path, help="file (default: SCENE.fmu)")
    verb.set_defaults(run=execute)


def execute(options: argparse.Namespace) -> int:
    """Do it; returns the exit status."""
    from touchdown.master.interop.container import write

    scene = chosen_scene(options)
    path = write(scene, options.output or Path(f"{scene.name}.fmu"))
    print(f"{path}: macro step {scene.run.macro_step:g} s, scheme {scene.run.scheme.name}")
    return 0
