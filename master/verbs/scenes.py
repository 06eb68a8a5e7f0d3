"""List the scenes, or show one."""

from __future__ import annotations

import argparse
from typing import Any


def add_to(verbs: Any) -> None:
    """Add the verb to the command."""
    verb = verbs.add_parser("scenes", help="list the scenes, or show one")
    verb.add_argument("scene", nargs="?", help="show this scene's components and settings")
    verb.set_defaults(run=execute)


def execute(options: argparse.Namespace) -> int:
    """Do it; returns the exit status."""
    from master import scene as scenes

    if options.scene is None:
        names = scenes.names()
        width = max(len(name) for name in names)
        for name in names:
            print(f"  {name:<{width}}  {scenes.load(name).title}")
        return 0
    chosen = scenes.load(options.scene)
    print(chosen.title)
    print(chosen.about.strip())
    print(
        f"\nrun: {chosen.run.duration:g} s from {chosen.zero or 'the start'}, "
        f"macro step {chosen.run.macro_step:g} s, scheme {chosen.run.scheme}"
    )
    for name, spec in chosen.components.items():
        settings = "".join(f"\n      {key} = {value}" for key, value in spec.set.items())
        kind = f" ({spec.preset})" if spec.preset else ""
        print(f"  {name}: {spec.fmu}{kind}{settings}")
    for bearing, body in chosen.attach:
        print(f"  {bearing} on {body}")
    return 0
