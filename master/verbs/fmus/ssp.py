"""Write a scene as an SSP package."""

from __future__ import annotations

import argparse
from pathlib import Path

from touchdown.master.verbs.arguments import add_output, add_scene, chosen_scene
from touchdown.master.verbs.verb import Verb

EXAMPLES = (
    "touchdown ssp disk-caged-simplified -o disk.ssp",
    'touchdown ssp rotor1-9000 --scheme jacobi-lead --macro-step "5 us" --outputs-only',
)


def declare(verb: argparse.ArgumentParser) -> None:
    """Its options."""
    add_scene(verb)
    verb.add_argument(
        "--outputs-only",
        action="store_true",
        help="connect outputs only; constants such as inv_m are start values (for libcosim and others)",
    )
    add_output(verb, "SCENE.ssp", "file")


def execute(options: argparse.Namespace) -> int:
    """Do it; returns the exit status."""
    from touchdown.master.interop.ssp.write import write_package

    scene = chosen_scene(options)
    package = write_package(scene, options.output or Path(f"{scene.name}.ssp"), options.outputs_only)
    print(
        f"{package.path}: {package.components} components, {package.connections} connections, "
        f"macro step {scene.run.macro_step:g} s"
    )
    return 0


VERB = Verb("ssp", "write a scene as an SSP package, for other tools", EXAMPLES, declare, execute)
