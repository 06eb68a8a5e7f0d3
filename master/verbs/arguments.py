"""What several verbs read from their options."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from touchdown.master.common.errors import TouchdownError
from touchdown.master.common.units import to_si
from touchdown.master.scene.schemes import DEFAULT, SCHEMES

if TYPE_CHECKING:
    from touchdown.master.scene.scene import Scene


def add_scene(verb: argparse.ArgumentParser) -> None:
    """Add what names a scene and changes it; `chosen_scene` reads it."""
    verb.add_argument("scene", help="name of a scene, or path of a .toml or .ssp")
    verb.add_argument("--scheme", help=f"coupling: {', '.join(SCHEMES)} (default: {DEFAULT})")
    verb.add_argument("--macro-step", help='macro step, in s, as text such as "20 us", or auto')
    verb.add_argument(
        "--set", action="append", default=[], metavar="NAME=VALUE", help="set run.KEY or COMPONENT.VARIABLE"
    )
    verb.add_argument(
        "--swap", action="append", default=[], metavar="COMPONENT=FMU", help="replace a component's FMU"
    )
    verb.add_argument(
        "--names",
        action="append",
        default=[],
        metavar="COMPONENT=FILE",
        help="TOML: what a component's FMU calls the contract's variables",
    )


def chosen_scene(options: argparse.Namespace) -> Scene:
    """The scene that the options of `add_scene` ask for. Raises TouchdownError."""
    from touchdown.master.interop.scenes import load
    from touchdown.master.scene.file import read_names

    chosen = load(options.scene)
    for text in options.swap:
        name, fmu = assignment(text, "--swap")
        chosen = chosen.swap(**{name: fmu})
    for text in options.names:
        name, file = assignment(text, "--names")
        chosen = chosen.with_names(name, read_names(Path(file)))
    chosen = chosen.set(settings(options))
    if options.scheme is not None:
        chosen = chosen.set({"run.scheme": options.scheme})
    if options.macro_step == "auto":
        from touchdown.master.coupling.advisor import advise

        advice = advise(chosen)[chosen.run.scheme.name]
        print(f"macro step {1e6 * advice.macro_step:g} us: {advice.reason}")
        chosen = chosen.set({"run.macro_step": advice.macro_step})
    elif options.macro_step is not None:
        chosen = chosen.set({"run.macro_step": options.macro_step})
    return chosen


def settings(options: argparse.Namespace) -> dict[str, str]:
    """What the option --set gives, in its order. Raises TouchdownError."""
    return dict(assignment(text, "--set") for text in options.set)


def assignment(text: str, option: str) -> tuple[str, str]:
    """NAME and VALUE of NAME=VALUE, given with `option`. Raises TouchdownError."""
    name, equals, value = text.partition("=")
    if not equals or not name or not value:
        raise TouchdownError(f"{option} {text}: write NAME=VALUE")
    return name.strip(), value.strip()


def count(text: str, option: str) -> int:
    """A whole number above 0, given with `option`. Raises TouchdownError."""

    number = to_si(text, "1", option)
    if number < 1.0 or number != int(number):
        raise TouchdownError(f"{option} {text} must be a whole number above 0")
    return int(number)
