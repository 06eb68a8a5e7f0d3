"""Build FMUs."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from touchdown.master.common.errors import TouchdownError
from touchdown.master.common.files import writing_to


def add_to(verbs: Any) -> None:
    """Add the verb to the command."""
    verb = verbs.add_parser("build", help="build the FMUs")
    verb.add_argument(
        "names", nargs="*", help="FMUs to build, or paths of rotor files (.toml) (default: all)"
    )
    verb.add_argument("-o", "--output", type=Path, default=Path("build"), help="folder (default: build)")
    verb.add_argument(
        "--link-python",
        action="store_true",
        help="for hosts without Python on this machine: the FMUs name this interpreter's libpython",
    )
    verb.set_defaults(run=execute)


def execute(options: argparse.Namespace) -> int:
    """Do it; returns the exit status."""
    from touchdown.fmus.build import build
    from touchdown.fmus.link import LinkError, interpreter
    from touchdown.fmus.recipes import Recipe, names
    from touchdown.master.components.library import locate

    found = [locate(name) for name in options.names or names()]
    for name, one in zip(options.names, found, strict=False):
        if not isinstance(one, Recipe):
            raise TouchdownError(f"{name} is an FMU already; give the name of one or a rotor's .toml")
    try:
        linked = interpreter() if options.link_python else None
    except LinkError as error:
        raise TouchdownError(str(error)) from None
    for one in found:
        assert isinstance(one, Recipe)
        try:
            with writing_to(options.output):
                print(build(one, options.output, linked))
        except LinkError as error:
            raise TouchdownError(str(error)) from None
    return 0
