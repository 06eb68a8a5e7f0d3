"""Build FMUs."""

from __future__ import annotations

import argparse
from pathlib import Path

from touchdown.master.common.errors import TouchdownError
from touchdown.master.common.files import writing_to
from touchdown.master.verbs import completion
from touchdown.master.verbs.arguments import add_output
from touchdown.master.verbs.completion import complete
from touchdown.master.verbs.verb import Verb

EXAMPLES = (
    "touchdown build -o build",
    "touchdown build simplified_caged housing --link-python -o build/linked",
    "touchdown build my-rotor.toml",
)


def declare(verb: argparse.ArgumentParser) -> None:
    """Its options."""
    names = verb.add_argument(
        "names", nargs="*", help="FMUs to build, or paths of rotor files (.toml) (default: all)"
    )
    complete(names, completion.fmus)
    add_output(verb, Path("build"))
    verb.add_argument(
        "--link-python",
        action="store_true",
        help="for hosts without Python on this machine: the FMUs name this interpreter's libpython",
    )


def execute(options: argparse.Namespace) -> int:
    """Do it; returns the exit status."""
    from touchdown.fmus.build import build
    from touchdown.fmus.python.link import LinkError, interpreter
    from touchdown.fmus.recipes import Recipe, names
    from touchdown.master.components.library import locate

    recipes = [locate(name) for name in options.names or names()]
    for name, one in zip(options.names, recipes, strict=False):
        if not isinstance(one, Recipe):
            raise TouchdownError(f"{name} is an FMU already; give the name of one or a rotor's .toml")
    try:
        linked = interpreter() if options.link_python else None
    except LinkError as error:
        raise TouchdownError(str(error)) from None
    for one in recipes:
        assert isinstance(one, Recipe)
        try:
            with writing_to(options.output):
                print(build(one, options.output, linked))
        except LinkError as error:
            raise TouchdownError(str(error)) from None
    return 0


VERB = Verb("build", "build the FMUs", EXAMPLES, declare, execute)
