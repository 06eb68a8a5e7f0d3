"""Verbs that import what a machine is made of: import-rotor, import-mount, import-foundation."""

from __future__ import annotations

import argparse
from pathlib import Path

from ...master.common.errors import TouchdownError
from .arguments import add_output, assignment, count
from .verb import Verb

IMPORT_ROTOR_EXAMPLES = (
    "touchdown import-rotor examples/pump_sections.csv -o runs/pump.toml",
    'touchdown import-rotor examples/pump_sections.csv --at "A=50 mm,B=17" --amb amb_A=7,amb_B=15',
    "touchdown import-rotor examples/spindle_matrices -o runs/fe.toml --at A=2,B=16 --amb amb_A=4,amb_B=14",
    'touchdown import-rotor saved-by-ross.toml -o my-rotor.toml --speed "6000 rpm"',
)


def _declare_import_rotor(verb: argparse.ArgumentParser) -> None:
    verb.add_argument(
        "file",
        metavar="FILE",
        type=Path,
        help="saved by ROSS (.toml, .json), a table of sections (.csv), matrices or modal data (.npz), "
        "or a folder of matrices (.mtx, .hb)",
    )
    add_output(verb, "FILE-rotor.toml in this folder", "rotor file")
    for option, meaning in (
        ("--at", "stations that touchdown bearings hold"),
        ("--amb", "stations that levitate the rotor before it drops"),
        ("--sensors", "places whose motion is recorded"),
    ):
        verb.add_argument(
            option,
            action="append",
            default=[],
            metavar="NAME=PLACE,...",
            help=f"{meaning}; a PLACE is a node, from 1, or its name in the file, or a distance from node "
            "1 such as 120 mm",
        )
    verb.add_argument("--force", action="store_true", help="replace a file that is there")
    verb.add_argument("--speed", help="speed at which ROSS's bearings are taken, where they depend on it")


def _execute_import_rotor(options: argparse.Namespace) -> int:
    from ...master.common.files import make_writable
    from ...master.common.units import to_si
    from ..api.rotor import Rotor

    speed = None if options.speed is None else to_si(options.speed, "rad/s", "--speed")
    rotor = Rotor.imported(
        options.file,
        _places(options.at, "--at"),
        _places(options.amb, "--amb"),
        _places(options.sensors, "--sensors"),
        speed,
    )
    path = options.output or Path(f"{options.file.stem}-rotor.toml")
    make_writable(path.parent)
    rotor.save(path, options.force)
    print(rotor)
    print(rotor.about)
    print(f"written to {path}; `touchdown rotor {path}` describes it")
    return 0


def _places(given: list[str], option: str) -> dict[str, str]:
    """Places by name, as an option gives them. Raises TouchdownError."""
    places: dict[str, str] = {}
    for text in (one for several in given for one in several.split(",")):
        name, place = assignment(text, option)
        if name in places:
            raise TouchdownError(f"{option} {text}: {name} is there twice")
        places[name] = place
    return places


IMPORT_ROTOR = Verb(
    "import-rotor",
    "import a rotor from ROSS, a table of its sections, matrices or modal data",
    IMPORT_ROTOR_EXAMPLES,
    _declare_import_rotor,
    _execute_import_rotor,
)


IMPORT_MOUNT_EXAMPLES = (
    "touchdown import-mount examples/mount_loop.csv",
    "touchdown import-mount examples/mount_loop.csv --slides 1 -o runs/mount.toml",
)


def _declare_import_mount(verb: argparse.ArgumentParser) -> None:
    verb.add_argument(
        "file",
        metavar="FILE",
        type=Path,
        help='table (.csv) with columns such as "displacement [mm]" and "force [N]"',
    )
    add_output(verb, "FILE-mount.toml in this folder", "mount file")
    verb.add_argument(
        "--slides", default="4", help="number of slides that may be used, 1 to 4 (default: 4)"
    )
    verb.add_argument("--force", action="store_true", help="replace a file that is there")


def _execute_import_mount(options: argparse.Namespace) -> int:
    from ...master.common.files import keep_other, make_writable, writing_to
    from ...modelkit.kernel.writing import write
    from ...studies.machine.hysteresis import MOST_SLIDES, fit, read_loop
    from ...studies.machine.mount_file import draw, fit_lines, mount_text, notes

    loop = read_loop(options.file)
    found = fit(loop, count(options.slides, "--slides", MOST_SLIDES))
    path = options.output or Path(f"{options.file.stem}-mount.toml")
    make_writable(path.parent)
    text = mount_text(found, options.file.name)
    if not options.force:
        keep_other(path, text, "file with -o")
    picture = path.with_suffix(".png")
    with writing_to(path.parent):
        write(path, text)
        draw(found, loop, options.file.name, picture)
    print("\n".join([*fit_lines(found), *(f"note: {note}" for note in notes(found))]))
    print(f"written to {path}, loop and fit are in {picture}; now: touchdown new --mount {path}")
    return 0


IMPORT_MOUNT = Verb(
    "import-mount",
    "fit a mount to its measured loop of force over displacement",
    IMPORT_MOUNT_EXAMPLES,
    _declare_import_mount,
    _execute_import_mount,
)


IMPORT_FOUNDATION_EXAMPLES = (
    "touchdown import-foundation examples/frame_matrices --at A=2,B=4 -o runs/frame.toml",
    "touchdown import-foundation frame.npz --at A=12,B=40 --modes 3 --damping 0.02",
)


def _declare_import_foundation(verb: argparse.ArgumentParser) -> None:
    verb.add_argument(
        "file",
        metavar="FILE",
        type=Path,
        help="folder of matrices (.mtx, .hb), or matrices or modal data (.npz)",
    )
    verb.add_argument(
        "--at",
        action="append",
        required=True,
        metavar="SEAT=NODE,...",
        help="seats, A to D, on which bearings stand, and the node of the foundation for each",
    )
    verb.add_argument(
        "--modes", default="8", help="largest number of modes, the slowest that move a seat (default: 8)"
    )
    verb.add_argument(
        "--damping", default="0.01", help="damping ratio, where the file gives none (default: 0.01)"
    )
    add_output(verb, "FILE-foundation.toml in this folder", "file of settings")
    verb.add_argument("--force", action="store_true", help="replace a file that is there")


def _execute_import_foundation(options: argparse.Namespace) -> int:
    from ...master.common.files import keep_other, make_writable, writing_to
    from ...master.common.units import to_si
    from ...modelkit.kernel.writing import write
    from ...studies.machine.foundation_file import MOST_MODES, foundation_text, mode_lines, read_modes

    seats = _places(options.at, "--at")
    most = count(options.modes, "--modes", MOST_MODES)
    found = read_modes(options.file, seats, most, to_si(options.damping, "1", "--damping"))
    path = options.output or Path(f"{options.file.stem}-foundation.toml")
    make_writable(path.parent)
    text = foundation_text(found, list(seats), options.file.name)
    if not options.force:
        keep_other(path, text, "file with -o")
    with writing_to(path.parent):
        write(path, text)
    print("\n".join(mode_lines(found)))
    print(f'written to {path}; a scene\'s [components.foundation] takes it by settings = "{path.name}"')
    return 0


IMPORT_FOUNDATION = Verb(
    "import-foundation",
    "import the modes of a foundation from matrices or modal data",
    IMPORT_FOUNDATION_EXAMPLES,
    _declare_import_foundation,
    _execute_import_foundation,
)
