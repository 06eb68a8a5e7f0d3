"""Say which macro steps the schemes bear in a scene."""

from __future__ import annotations

import argparse
from typing import Any

from touchdown.master.verbs.arguments import settings


def add_to(verbs: Any) -> None:
    """Add the verb to the command."""
    verb = verbs.add_parser("advise", help="which macro step each coupling scheme bears in a scene")
    verb.add_argument("scene", help="name of a scene, or path of a .toml")
    verb.add_argument(
        "--set", action="append", default=[], metavar="NAME=VALUE", help="set COMPONENT.VARIABLE"
    )
    verb.set_defaults(run=execute)


def execute(options: argparse.Namespace) -> int:
    """Do it; returns the exit status."""
    from touchdown.master.coupling.advisor import advise
    from touchdown.master.interop.scenes import load
    from touchdown.master.scene.schemes import SCHEMES

    chosen = load(options.scene).set(settings(options))
    found = advise(chosen, SCHEMES)
    reason = found[chosen.run.scheme.name].reason
    print(f"{chosen.name}, which takes {1e6 * chosen.run.macro_step:g} us: {reason}")
    for name, advice in found.items():
        scheme = SCHEMES[name]
        print(f"  {name:<18}{1e6 * advice.macro_step:>10g} us   {scheme.bears:>5g} rad   {scheme.title}")
    return 0
