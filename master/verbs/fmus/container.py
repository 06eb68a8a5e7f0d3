"""Write a scene as one FMU."""

from __future__ import annotations

import argparse
from pathlib import Path

from touchdown.master.verbs.arguments import add_making, add_output, add_scene, chosen_scene, making
from touchdown.master.verbs.verb import Verb

EXAMPLES = ("touchdown container disk-caged-simplified --scheme jacobi-lead -o disk.fmu",)


def declare(verb: argparse.ArgumentParser) -> None:
    """Its options."""
    add_scene(verb)
    add_making(verb)
    add_output(verb, "SCENE.fmu", "file")


def execute(options: argparse.Namespace) -> int:
    """Do it; returns the exit status."""
    from touchdown.master.interop.container import write_container

    scene = chosen_scene(options)
    path = write_container(scene, options.output or Path(f"{scene.name}.fmu"), making(options))
    print(f"{path}: macro step {scene.run.macro_step:g} s, scheme {scene.run.scheme.name}")
    return 0


VERB = Verb(
    "container", "write a scene as one FMU, for tools that take only one", EXAMPLES, declare, execute
)
