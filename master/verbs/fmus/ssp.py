"""Write a scene as an SSP package."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from touchdown.master.verbs.arguments import add_scene, chosen_scene


def add_to(verbs: Any) -> None:
    """Add the verb to the command."""
    verb = verbs.add_parser("ssp", help="write a scene as an SSP package, for other tools")
    add_scene(verb)
    verb.add_argument(
        "--outputs-only",
        action="store_true",
        help="connect outputs only; constants such as inv_m are start values (for libcosim and others)",
    )
    verb.add_argument("-o", "--output", type=Path, help="file (default: SCENE.ssp)")
    verb.set_defaults(run=execute)


def execute(options: argparse.Namespace) -> int:
    """Do it; returns the exit status."""
    from touchdown.master.interop.ssp.write import write

    scene = chosen_scene(options)
    found = write(scene, options.output or Path(f"{scene.name}.ssp"), options.outputs_only)
    print(
        f"{found.path}: {found.components} components, {found.connections} connections, "
        f"macro step {scene.run.macro_step:g} s"
    )
    return 0
