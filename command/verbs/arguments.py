"""Options that several verbs share: their declarations, and how they are read."""

from __future__ import annotations

import argparse
import math
from pathlib import Path
from typing import TYPE_CHECKING

from ...master.common.errors import TouchdownError
from ...master.common.units import to_si
from ...master.scene.run_spec import UNTIL
from ...master.scene.schemes import DEFAULT, SCHEMES
from . import completion
from .completion import complete

if TYPE_CHECKING:
    from ...master.scene.scene import Scene

MOST = 10_000  # of what is counted: runs, repetitions
MOST_JOBS = 256  # processes, each of a hundred MB and more

# -- declared ----------------------------------------------------------------------------------------


def add_scene(verb: argparse.ArgumentParser) -> None:
    """Add what names a scene and changes it; `chosen_scene` reads it."""
    add_scene_name(verb, "name of a scene, or path of a .toml, an .ssp or a run's scene.json")
    complete(
        verb.add_argument("--scheme", help=f"coupling: {', '.join(SCHEMES)} (default: {DEFAULT})"),
        completion.schemes,
    )
    verb.add_argument("--macro-step", help='macro step, such as "20 us" (a number alone is in s), or auto')
    verb.add_argument(
        "--duration", help='length of the run, counted from the scene\'s zero of time, such as "0.2 s"'
    )
    add_settings(verb, "set run.KEY or COMPONENT.VARIABLE")
    add_swaps(verb)


def add_until(verb: argparse.ArgumentParser) -> None:
    """Add --until; `timed` reads it."""
    verb.add_argument(
        "--until",
        choices=UNTIL,
        help="settled: end the run once the motion at all seats has settled, at the latest after "
        "--duration (default: the scene's run.until)",
    )


def add_swaps(verb: argparse.ArgumentParser) -> None:
    """Add --swap and --names; `swapped` reads them."""
    swap = verb.add_argument(
        "--swap",
        action="append",
        default=[],
        metavar="COMPONENT=FMU",
        help="replace a component's FMU; bearing_*=FMU those of all that match",
    )
    complete(swap, completion.swaps)
    verb.add_argument(
        "--names",
        action="append",
        default=[],
        metavar="COMPONENT=FILE",
        help="TOML: the FMU's own names for the variables of the contract; controller_*=FILE names those "
        "of all that match",
    )


def add_scene_name(
    verb: argparse.ArgumentParser,
    meaning: str = "name of a scene, or path of a .toml",
    nargs: str | None = None,
) -> None:
    """Add the scene that the verb is about."""
    complete(verb.add_argument("scene", metavar="SCENE", nargs=nargs, help=meaning), completion.scenes)


def add_settings(verb: argparse.ArgumentParser, meaning: str = "set in all runs") -> None:
    """Add --set; `settings` reads it."""
    action = verb.add_argument("--set", action="append", default=[], metavar="NAME=VALUE", help=meaning)
    complete(action, completion.settings)


def add_output(verb: argparse.ArgumentParser, default: str | Path, what: str = "folder") -> None:
    """Add -o. A `default` that is text only says which it is, since it depends on other options."""
    known = default if isinstance(default, Path) else None
    verb.add_argument("-o", "--output", type=Path, default=known, help=f"{what} (default: {default})")


def add_jobs(verb: argparse.ArgumentParser) -> None:
    """Add --jobs; `chosen_jobs` reads it."""
    verb.add_argument("--jobs", default="2", metavar="N", help="runs at a time (default: 2)")


def add_native(verb: argparse.ArgumentParser) -> None:
    """Add --native, for FMUs that others run."""
    verb.add_argument("--native", action="store_true", help="its FMUs need no Python")


def add_quiet(verb: argparse.ArgumentParser) -> None:
    """Add --quiet."""
    verb.add_argument("--quiet", action="store_true", help="no progress bar")


# -- read --------------------------------------------------------------------------------------------


def chosen_scene(options: argparse.Namespace) -> Scene:
    """The scene that the options of `add_scene` ask for. Raises TouchdownError."""
    from ...master.interop.scenes import find_scene

    chosen = swapped(find_scene(options.scene), options).set(settings(options))
    if options.scheme is not None:
        chosen = chosen.set({"run.scheme": options.scheme})
    chosen = timed(chosen, options)
    if options.macro_step == "auto":
        from ...studies.comparison.steps import advise

        advice = advise(chosen)[chosen.run.scheme.name]
        print(f"macro step {1e6 * advice.macro_step:g} us: {advice.reason}")
        chosen = chosen.set({"run.macro_step": advice.macro_step})
    elif options.macro_step is not None:
        chosen = chosen.set({"run.macro_step": options.macro_step})
    return chosen


def timed(scene: Scene, options: argparse.Namespace) -> Scene:
    """`scene` with what --duration gives, and --until where the verb has it. Raises TouchdownError."""
    asked = {key: getattr(options, key, None) for key in ("duration", "until")}
    return scene.set({f"run.{key}": given for key, given in asked.items() if given is not None})


def swapped(scene: Scene, options: argparse.Namespace) -> Scene:
    """`scene` with what --swap puts into it, by the names that --names gives. Raises TouchdownError."""
    from ...master.scene.file import read_names

    for text in options.swap:
        pattern, fmu = assignment(text, "--swap")
        scene = scene.swap(**dict.fromkeys(scene.matching(pattern), fmu))
    for text in options.names:
        pattern, file = assignment(text, "--names")
        for name in scene.matching(pattern):
            scene = scene.with_names(name, read_names(Path(file)))
    return scene


def settings(options: argparse.Namespace) -> dict[str, str]:
    """The settings of the option --set, in its order. Raises TouchdownError."""
    return dict(assignment(text, "--set") for text in options.set)


def assignment(text: str, option: str) -> tuple[str, str]:
    """NAME and VALUE of NAME=VALUE, given with `option`. Raises TouchdownError."""
    name, equals, value = text.partition("=")
    if not equals or not name or not value:
        raise TouchdownError(f"{option} {text}: write NAME=VALUE")
    return name.strip(), value.strip()


def count(text: str, option: str, most: int = MOST) -> int:
    """A whole number above 0, at most `most`, given with `option`. Raises TouchdownError."""
    number = to_si(text, "1", option)
    if number < 1.0 or number != int(number):
        raise TouchdownError(f"{option} {text} must be a whole number above 0")
    if number > most:
        raise TouchdownError(f"{option} {text} must be at most {most}")
    return int(number)


def chosen_jobs(options: argparse.Namespace) -> int:
    """The number of processes by --jobs. Raises TouchdownError."""
    return count(options.jobs, "--jobs", MOST_JOBS)


def above_zero(text: str | None, unit: str, option: str) -> float | None:
    """A number above 0 in the SI unit; None where the option is not given. Raises TouchdownError."""
    if text is None:
        return None
    value = to_si(text, unit, option)
    if not 0.0 < value < float("inf"):
        raise TouchdownError(f"{option} {text} must be above 0")
    return value


def names(text: str | None, option: str) -> list[str]:
    """Names between commas; none where the option is not given. Raises TouchdownError."""
    if text is None:
        return []
    names = [name.strip() for name in text.split(",")]
    if not all(names):
        raise TouchdownError(f"{option} {text}: a name is missing between the commas")
    return list(dict.fromkeys(names))


def several_above_zero(text: str | None, unit: str, option: str) -> tuple[float, ...]:
    """Numbers above 0 in the SI unit, ascending, with commas between them; none where not given.

    A unit at the end is everyone's. Raises TouchdownError.
    """
    from ...studies.sweep.design import listed

    if text is None:
        return ()
    given = [above_zero(item, unit, option) for item in listed(text, f"{option} {text}")]
    return tuple(sorted({value for value in given if value is not None}))


def angle(text: str, option: str) -> float:
    """An angle in degrees; text without a unit is in rad. Raises TouchdownError."""
    return math.degrees(to_si(text, "rad", option))


def results_folder(options: argparse.Namespace, default: str | None = None) -> Path:
    """The folder that -o names, or runs/DEFAULT; it is made. Raises TouchdownError where it cannot be."""
    from ...master.common.files import make_writable

    folder: Path = options.output or Path("runs") / str(default)
    make_writable(folder)
    return folder
