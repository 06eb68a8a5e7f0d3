"""Write a scene as an SSP package."""

from __future__ import annotations

import argparse
from pathlib import Path

from touchdown.master.verbs.arguments import add_making, add_output, add_scene, chosen_scene, making
from touchdown.master.verbs.verb import Verb

EXAMPLES = (
    "touchdown ssp disk-caged-simplified -o disk.ssp",
    'touchdown ssp rotor1-9000 --scheme jacobi-lead --macro-step "5 us" --outputs-only',
    "touchdown ssp disk-caged-simplified --scheme jacobi-lead --outputs-only --native -o disk.ssp",
)


def declare(verb: argparse.ArgumentParser) -> None:
    """Its options."""
    add_scene(verb)
    verb.add_argument(
        "--outputs-only",
        action="store_true",
        help="connect outputs only; constants such as inv_m are start values (for libcosim and others)",
    )
    add_making(verb)
    add_output(verb, "SCENE.ssp", "file")


def execute(options: argparse.Namespace) -> int:
    """Do it; returns the exit status."""
    from touchdown.master.interop.ssp.write import write_package

    scene = chosen_scene(options)
    path = options.output or Path(f"{scene.name}.ssp")
    package = write_package(scene, path, options.outputs_only, making(options))
    print(
        f"{package.path}: {package.components} components, {package.connections} connections, "
        f"macro step {scene.run.macro_step:g} s"
    )
    if package.fixed:
        names = ", ".join(package.fixed)
        print(f"in tools that set no values, FMUs given as files start from their own: {names}")
    return 0


VERB = Verb("ssp", "write a scene as an SSP package, for other tools", EXAMPLES, declare, execute)
