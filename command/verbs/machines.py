"""Verbs for a machine: scenes, catalogue, new, rotor."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from ...master.common.errors import TouchdownError, one_of
from ...master.common.units import spoken
from ...modelkit.units import display_unit, is_bare, per_display
from . import completion
from .arguments import (
    above_zero,
    add_output,
    add_scene_name,
    add_settings,
    add_swaps,
    assignment,
    settings,
    swapped,
)
from .completion import complete
from .verb import Verb, warn

if TYPE_CHECKING:
    from ...master.components.component import Variable
    from ...master.scene.scene import Scene
    from ...studies.rotor.report import Report


SCENES_EXAMPLES = (
    "touchdown scenes",
    "touchdown scenes rotor1-9000",
    "touchdown scenes disk-caged-simplified --variables bearing",
)


def _declare_scenes(verb: argparse.ArgumentParser) -> None:
    add_scene_name(verb, "show this scene's components and settings", nargs="?")
    named = verb.add_argument(
        "--variables", metavar="COMPONENT", help="show what can be set in this component of the scene"
    )
    complete(named, completion.components)


def _execute_scenes(options: argparse.Namespace) -> int:
    from ...master.interop.scenes import find_scene
    from ...master.scene.file import shipped

    if options.scene is None:
        names = shipped()
        width = max(len(name) for name in names)
        for name in names:
            print(f"  {name:<{width}}  {find_scene(name).title}")
        return 0
    chosen = find_scene(options.scene)
    print("\n".join(filter(None, (chosen.title, chosen.about.strip()))))
    begins = f"begins at t = {chosen.run.start_time:g} s, " if chosen.run.start_time else ""
    print(
        f"\nrun: {begins}{chosen.run.duration:g} s from {chosen.zero or 'the start'}, "
        f"macro step {_time(chosen.run.macro_step)}, scheme {chosen.run.scheme.name}"
    )
    if options.variables is not None:
        _show_variables(chosen, options.variables)
        return 0
    for name, spec in chosen.components.items():
        settings = "".join(f"\n      {key} = {_plainly(value)}" for key, value in spec.set.items())
        kind = f" ({spec.preset})" if spec.preset else ""
        print(f"  {name}: {spec.fmu}{kind}{settings}")
    for bearing, body in chosen.attach:
        print(f"  {bearing} on {body}")
    return 0


def _time(seconds: float) -> str:
    unit = display_unit("s", seconds)
    return f"{per_display('s', unit) * seconds:g} {unit}"


def _plainly(value: object) -> str:
    """A setting as a file has it."""
    return f"{value:.12g}" if isinstance(value, float) else str(value)


def _show_variables(scene: Scene, name: str) -> None:
    """All that `--set NAME.VARIABLE=VALUE` takes: value in this scene, unit, bounds in it, meaning."""
    from ...master.coupling.simulation import opened

    with opened(scene, in_process=True) as system:
        component = system.components.get(name)
        if component is None:
            known = one_of(name, system.components)
            raise TouchdownError(f"scene {scene.name} has no component {name}; {known}")
        settable = [v for v in component.variables.values() if v.settable and v.causality == "parameter"]
        values = component.read([v.name for v in settable])
        print(f"\n{name} ({component.origin})")
        for v, value in zip(settable, values, strict=True):
            shown, unit, bounds = _as_shown(v, value)
            print(f"  {v.name:<34}{shown:>12} {unit:<10}{bounds:<18} {v.description}")


def _as_shown(variable: Variable, value: float) -> tuple[str, str, str]:
    """Value, unit and bounds as people read them; a choice is a word, and has neither of these."""
    if variable.choices:
        return variable.in_words(value), "", ""
    unit = variable.unit or "1"
    shown = unit if spoken(variable.name, 0.0)[1] == "Hz" else display_unit(unit, value)
    factor = per_display(unit, shown)
    ends = (("from", variable.minimum), ("to", variable.maximum))
    bounds = " ".join(f"{word} {factor * bound:g}" for word, bound in ends if bound is not None)
    return f"{factor * value:.6g}", "" if shown == "1" else shown, bounds


SCENES = Verb("scenes", "list the scenes, or show one", SCENES_EXAMPLES, _declare_scenes, _execute_scenes)


CATALOGUE_EXAMPLES = (
    'touchdown catalogue --bore "70 mm"',
    "touchdown catalogue 7014",
    "touchdown catalogue 7014 --toml",
    'touchdown catalogue 7014 --thrust "2 kN" --arrangement "back to back" --preload "300 N"',
)


def _declare_catalogue(verb: argparse.ArgumentParser) -> None:
    verb.add_argument(
        "bearing",
        metavar="BEARING",
        nargs="?",
        help="show this one: its designation, a name in bearings.toml, or FILE.toml:NAME",
    )
    verb.add_argument("--bore", metavar="LENGTH", help='list those of this bore, such as "70 mm"')
    verb.add_argument("--toml", action="store_true", help="show it as it stands in a file of one's own")
    verb.add_argument(
        "--load", metavar="FORCE", help='show its most loaded ball by rings and seat, such as "350 N"'
    )
    verb.add_argument("--speed", help='show which cages run it for long, such as "45000 rpm"')
    verb.add_argument(
        "--thrust",
        metavar="FORCE",
        help='show its shift, balls and stiffness under a thrust, such as "2 kN"',
    )
    verb.add_argument(
        "--arrangement",
        default="",
        help='of rows under --thrust: "back to back", "face to face", tandem, "tandem reversed", single, '
        '"single reversed"',
    )
    verb.add_argument("--preload", metavar="FORCE", help="of that pair")


def _execute_catalogue(options: argparse.Namespace) -> int:
    from ...studies.machine.bearings import (
        as_file,
        available_bearings,
        described,
        fast_enough,
        find_bearing,
        listed,
        pushed,
        shared,
    )

    here = Path()
    load = above_zero(options.load, "N", "--load")
    speed = above_zero(options.speed, "rad/s", "--speed")
    thrust = above_zero(options.thrust, "N", "--thrust")
    preload = above_zero(options.preload, "N", "--preload")
    if (options.arrangement or preload) and not thrust:
        raise TouchdownError("--arrangement and --preload are of a bearing under --thrust; give that, too")
    if options.bearing is None:
        if load or speed or thrust:
            raise TouchdownError("--load, --speed and --thrust are of one bearing; name it, such as 6904")
        print(listed(available_bearings(here), above_zero(options.bore, "m", "--bore")))
        return 0
    bearing = find_bearing(options.bearing, here)
    if load or speed or thrust:
        if thrust:
            print(pushed(bearing, thrust, options.arrangement, preload or 0.0))
        for describe, value in ((shared, load), (fast_enough, speed)):
            if value:
                print(describe(bearing, value))
        return 0
    print(as_file(bearing) if options.toml else described(bearing), end="" if options.toml else "\n")
    return 0


CATALOGUE = Verb(
    "catalogue",
    "list the bearings of the catalogue, or show one",
    CATALOGUE_EXAMPLES,
    _declare_catalogue,
    _execute_catalogue,
)


NEW_EXAMPLES = (
    "touchdown new my-machine --rotor rotor_II --bearings 7014",
    'touchdown new my-machine --rotor rotor.toml --bearings 7014 --at A,B --amb A,B --speed "9000 rpm"',
    'touchdown new my-disk --mass "60 kg" --bearings 6014 --dry-run',
    'touchdown new my-soft-disk --mass "60 kg" --bearings 6014 --mount soft',
)


def _declare_new(verb: argparse.ArgumentParser) -> None:
    verb.add_argument(
        "folder", metavar="FOLDER", type=Path, help="where the scene is written, with all files it needs"
    )
    verb.add_argument("--rotor", help="name of a rotor, or path of its .toml")
    verb.add_argument(
        "--bearings",
        required=True,
        metavar="BEARING,...",
        help="touchdown bearings: one for all, or one for each place; `touchdown catalogue` lists them",
    )
    verb.add_argument(
        "--at",
        metavar="STATION,...",
        help="stations at which the touchdown bearings hold the rotor (default: its stations that are "
        "not in levitated_at)",
    )
    verb.add_argument(
        "--amb", metavar="STATION,...", help="stations of the magnetic bearings (default: its levitated_at)"
    )
    verb.add_argument(
        "--speed",
        help="speed at the start (default: the lower of 0.7 of the first bending frequency and 1,000,000 "
        "mm rpm over the bore)",
    )
    verb.add_argument("--clearance", default="0.25 mm", help='radial clearance (default: "0.25 mm")')
    verb.add_argument(
        "--balls",
        metavar="MATERIAL",
        help="material of the balls: steel, or Si3N4 in hybrid bearings (default: what the "
        "designation says, where HC is ceramic)",
    )
    verb.add_argument(
        "--mount",
        metavar="soft|stiff|FILE",
        help="mounts of the touchdown bearings: soft or stiff by rules, or from a TOML file such as "
        "`import-mount` writes (default: a linear housing)",
    )
    verb.add_argument("--mass", help="mass of a rigid rotor, instead of --rotor")
    verb.add_argument(
        "--inertia", help="its polar moment of inertia (default: mass times journal radius^2)"
    )
    verb.add_argument("--dry-run", action="store_true", help="show the scene, write nothing")
    verb.add_argument("--force", action="store_true", help="replace files that are there")


def _execute_new(options: argparse.Namespace) -> int:
    from ...master.scene.file import SCENE_FILE
    from ...studies.machine.new import Wanted, machine, write

    wanted = Wanted(
        rotor=options.rotor,
        bearings=_names(options.bearings) or (),
        at=_names(options.at),
        amb=_names(options.amb),
        speed=above_zero(options.speed, "rad/s", "--speed"),
        clearance=above_zero(options.clearance, "m", "--clearance") or 0.0,
        balls=options.balls,
        mount=options.mount,
        mass=above_zero(options.mass, "kg", "--mass"),
        inertia=above_zero(options.inertia, "kg.m2", "--inertia"),
    )
    made = machine(wanted, options.folder.resolve().name)
    notes = [f"note: {note}" for note in [*_bare_speed(options.speed), *made.notes]]
    if options.dry_run:  # notes are comments, so that what is printed is a scene
        print("\n".join([made.files[SCENE_FILE].rstrip("\n"), *(f"# {note}" for note in notes)]))
    else:
        written = write(made, options.folder, options.force)
        print("\n".join([*notes, f"{written}: now run it with\n  touchdown run {options.folder}"]))
    return 0


def _bare_speed(speed: str | None) -> list[str]:
    """A note on the unit of a speed without one, or none."""
    if speed is None or not is_bare(speed):
        return []
    turns, unit = spoken("speed", float(speed))
    meant = f'it is taken for rad/s, {turns:.0f} {unit}; write "{speed} rpm" where that is meant'
    return [f"--speed {speed} has no unit: {meant}"]


def _names(text: str | None) -> tuple[str, ...] | None:
    """Names with commas between them."""
    return None if text is None else tuple(name.strip() for name in text.split(",") if name.strip())


NEW = Verb(
    "new",
    "create a folder with a first scene for your machine",
    NEW_EXAMPLES,
    _declare_new,
    _execute_new,
)


ROTOR_EXAMPLES = (
    "touchdown rotor rotor_I",
    'touchdown rotor rotor_II --support "amb_A=20 MN/m" --support "amb_B=20 MN/m" --speed "10000 rpm"',
    'touchdown rotor my-rotor.toml --speed "12000 rpm" --modes 8 -o runs/my-rotor',
    "touchdown rotor rotor1-9000 --set amb_*.stiffness=4e5 -o runs/stiffer",
    "touchdown rotor rotor1-9000 --load 10",
)


def _declare_rotor(verb: argparse.ArgumentParser) -> None:
    names = verb.add_argument(
        "rotors",
        nargs="*",
        metavar="ROTOR",
        help="name of a rotor, or path of its .toml; or a scene, whose rotor is described in its bearings, "
        "too (default: all rotors)",
    )
    complete(names, completion.scenes)
    add_output(verb, "runs/rotor-ROTOR")
    verb.add_argument(
        "--speed",
        help='for forward and backward whirl; Campbell diagrams reach twice as far (default: "9000 rpm", '
        "of a scene its own); of a scene's rotor, below 0: clockwise",
    )
    verb.add_argument(
        "--modes",
        default="5",
        metavar="N",
        help="per plane, the two rigid ones included; 0: all (default: 5)",
    )
    verb.add_argument(
        "--support",
        action="append",
        default=[],
        metavar="STATION=STIFFNESS",
        help='a spring there, such as "amb_A=20 MN/m", which holds the rotor; not for scenes',
    )
    verb.add_argument(
        "--load",
        metavar="TIMES",
        help="scenes only: the load that presses the rotor onto its touchdown bearings, over its weight "
        "(default: 1)",
    )
    add_settings(verb, "scenes only: set COMPONENT.VARIABLE")
    add_swaps(verb)


def _execute_rotor(options: argparse.Namespace) -> int:
    from ...rotor.file import shipped

    names = options.rotors or list(shipped())
    owns = [Path(name).stem for name in names]
    for own in owns:
        if owns.count(own) > 1:
            raise TouchdownError(f"{owns.count(own)} rotors are called {own}; ask for them one by one")
    for name, own in zip(names, owns, strict=True):
        folder = options.output or Path("runs") / f"rotor-{own}"
        if options.output and len(names) > 1:
            folder = options.output / own
        found = _described(name, folder, options)
        print(found.text)
        print(f"pictures in {folder}\n")
        warn(found.remarks)
    return 0


def _described(name: str, folder: Path, options: argparse.Namespace) -> Report:
    """A rotor, or a scene's, whose pictures go into `folder`."""
    from ...master.common.units import to_si
    from ...master.scene.file import is_scene
    from ...studies.rotor.report import SPEED, report

    speed = None if options.speed is None else to_si(options.speed, "rad/s", "--speed")
    modes = to_si(options.modes, "1", "--modes")
    if modes < 0.0 or modes != int(modes):
        raise TouchdownError(f"--modes {options.modes} must be a whole number, 2 or more, or 0 for all")
    if is_scene(name):
        return _described_in(name, folder, speed, int(modes), options)
    for option in ("load", "set", "swap", "names"):
        if getattr(options, option):
            raise TouchdownError(f"--{option} is for scenes; {name} is a rotor")
    pairs = [assignment(text, "--support") for text in options.support]
    supports = {station: _stiffness(station, text) for station, text in pairs}
    return report(name, folder, SPEED if speed is None else speed, int(modes), supports)


def _described_in(
    name: str, folder: Path, speed: float | None, modes: int, options: argparse.Namespace
) -> Report:
    """Of the scene `name`."""
    from ...master.interop.scenes import find_scene
    from ...studies.rotor.scene_report import report_scene

    if options.support:
        raise TouchdownError(
            f"--support is for rotors; {name} is a scene, whose bearings hold it: --set COMPONENT.VARIABLE"
        )
    load = above_zero(options.load, "1", "--load")
    scene = swapped(find_scene(name), options).set(settings(options))
    return report_scene(scene, folder, speed, modes, 1.0 if load is None else load)


def _stiffness(name: str, text: str) -> float:
    value = above_zero(text, "N/m", f"--support {name}")
    assert value is not None
    return value


ROTOR = Verb(
    "rotor",
    "describe rotors, also in a scene's bearings: frequencies, modes, critical speeds, static position",
    ROTOR_EXAMPLES,
    _declare_rotor,
    _execute_rotor,
)
