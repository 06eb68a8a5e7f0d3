"""Verbs for a machine that print figures of their own: scenes, catalogue, rotor, import."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from ...master.common.errors import FAILED, TouchdownError, one_of
from ...master.common.text import aligned, variable_unit
from ...modelkit.units import display_unit, per_display
from ..api import machines
from ..console import warn
from ..parameters import (
    Count,
    Force,
    Fraction,
    Length,
    PathLike,
    Places,
    Ratio,
    Settings,
    Speed,
    Spin,
    Texts,
    above_zero,
    assignment,
)
from .scenes import set_scene

if TYPE_CHECKING:
    from ...master.components.component import ScalarVariable
    from ...master.scene.scene import Scene


def show_new(scene: Scene, folder: Path, notes: list[str]) -> int:
    """Print what is to be known of a new machine, and how to go on; FAILED where its loops are no good."""
    from ...master.scene.file import SCENE_FILE
    from ...studies.machine.controlled_text import UNFIT

    end = f"{folder / SCENE_FILE}: now run it with\n  touchdown run {folder}"
    print("\n".join([*filter(None, [scene.about.strip()]), *(f"note: {note}" for note in notes), end]))
    return FAILED if UNFIT in notes else 0


def show_scenes(
    scene_name: str | None = None, *, component: str | None = None, quantities: bool = False
) -> int:
    """List the scenes, or show one.

    scene_name: show this scene's components and settings
    component: show what can be set in this component of the scene
    quantities: list the quantities of runs: key, of what, SI unit, unit in which people read it, words
    """
    from ...master.interop.find_scene import find_scene
    from ...master.scene.file import shipped_scenes
    from ...studies.sweep.report import quantity_lines

    if quantities:
        if scene_name is not None:
            raise TouchdownError("--quantities are those of any run; give it without a scene")
        print("\n".join(quantity_lines()))
        return 0
    if scene_name is None:
        print("\n".join(aligned([(f"  {name}", find_scene(name).title) for name in shipped_scenes()])))
        return 0
    chosen = find_scene(scene_name)
    print("\n".join(filter(None, (chosen.title, chosen.about.strip()))))
    begins = f"begins at t = {chosen.run.start_time:g} s, " if chosen.run.start_time else ""
    print(
        f"\nrun: {begins}{chosen.run.duration:g} s from {chosen.zero or 'the start'}, "
        f"macro step {_time(chosen.run.macro_step)}, scheme {chosen.run.scheme.name}"
    )
    if component is not None:
        _show_variables(chosen, component)
        return 0
    for name, spec in chosen.components.items():
        plain = {k: f"{v:.12g}" if isinstance(v, float) else v for k, v in spec.set.items()}
        settings = "".join(f"\n      {key} = {value}" for key, value in plain.items())
        kind = f" ({spec.preset})" if spec.preset else ""
        print(f"  {name}: {spec.fmu}{kind}{settings}")
    for bearing, body in chosen.attach:
        print(f"  {bearing} on {body}")
    return 0


def _time(seconds: float) -> str:
    unit = display_unit("s", seconds)
    return f"{per_display('s', unit) * seconds:g} {unit}"


def _show_variables(scene: Scene, name: str) -> None:
    """All that `--set NAME.VARIABLE=VALUE` takes: value in this scene, unit, bounds in it, meaning."""
    from ...master.components.component import SETTABLE
    from ...master.coupling.simulation import opened

    with opened(scene, in_process=True) as system:
        component = system.components.get(name)
        if component is None:
            known = one_of(name, system.components)
            raise TouchdownError(f"scene {scene.name} has no component {name}; {known}")
        settable = [v for v in component.variables.values() if v.settable and v.causality != "input"]
        numbers = [v.name for v in settable if v.kind in SETTABLE]
        values = dict(zip(numbers, component.read(numbers), strict=True))
        print(f"\n{name} ({component.origin})")
        rows = [
            (
                v.name,
                *(_as_shown(v, values[v.name]) if v.name in values else ("text", "", "")),
                v.description,
            )
            for v in settable
        ]
        print("\n".join(aligned(rows, "<><", "  ")))


def _as_shown(variable: ScalarVariable, value: float) -> tuple[str, str, str]:
    """Value, unit and bounds as people read them; a choice is a word, and has neither of these."""
    if variable.choices:
        return variable.in_words(value), "", ""
    unit = variable.unit or "1"
    shown = variable_unit(variable.name, unit, value)
    factor = per_display(unit, shown)
    ends = (("from", variable.minimum), ("to", variable.maximum))
    bounds = " ".join(f"{word} {factor * bound:g}" for word, bound in ends if bound is not None)
    return f"{factor * value:.6g}", "" if shown == "1" else shown, bounds


def show_catalogue(
    bearing: str | None = None,
    *,
    bore: Length | None = None,
    toml: bool = False,
    load: Force | None = None,
    speed: Speed | None = None,
    thrust: Force | None = None,
    arrangement: str = "",
    preload: Force | None = None,
) -> int:
    """List the bearings of the catalogue, or show one.

    bearing: show this one: its designation, a name in bearings.toml, or FILE.toml:NAME
    bore: list those of this bore, such as "70 mm"
    toml: show it as it stands in a file of yours
    load: show its most loaded ball by rings and seat, such as "350 N"
    speed: show which cages run it for long, such as "45000 rpm"
    thrust: show what a static thrust along the shaft, such as "2 kN", does to it: how far the inner ring
        shifts, what the balls bear, the stiffness
    arrangement: of rows under --thrust: "back to back", "face to face", tandem, "tandem reversed", single,
        "single reversed"
    preload: force that clamps the rows of that pair against each other (default: the pair's own)
    """
    from ...master.common.units import to_si
    from ...studies.machine import bearings

    if (arrangement or preload) and not thrust:
        raise TouchdownError("--arrangement and --preload are of a bearing under --thrust; give that, too")
    if bearing is None:
        if load or speed or thrust:
            raise TouchdownError("--load, --speed and --thrust are of one bearing; name it, such as 6904")
        wide = None if bore is None else to_si(bore, "m", "--bore")
        print(bearings.listed(bearings.available_bearings(Path()), wide))
        return 0
    found = bearings.find_bearing(bearing, Path())
    if thrust:
        force, before = to_si(thrust, "N", "--thrust"), to_si(preload or 0.0, "N", "--preload")
        print(bearings.pushed(found, force, arrangement, before))
    if load:
        print(bearings.shared(found, to_si(load, "N", "--load")))
    if speed:
        print(bearings.fast_enough(found, to_si(speed, "rad/s", "--speed")))
    if not (load or speed or thrust):
        print(bearings.as_file(found).rstrip("\n") if toml else bearings.described(found))
    return 0


def show_rotors(
    rotors: Texts = (),
    folder: PathLike | None = None,
    *,
    speed: Spin | None = None,
    modes: str = "5",
    support: Texts = (),
    load: Ratio | None = None,
    settings: Settings | None = None,
    swap: Texts = (),
    names: Texts = (),
) -> int:
    """Describe rotors, also in a scene's bearings: frequencies, modes, critical speeds, static position.

    rotors: name of a rotor, or path of its .toml; or a scene, whose rotor is described in its bearings, too
        (default: all rotors)
    speed: for forward and backward whirl; Campbell diagrams reach twice as far (default: "9000 rpm", of a
        scene its own); of a scene's rotor, below 0: clockwise
    modes: per plane, the two rigid ones included; 0: all
    support: a spring there, such as "amb_A=20 MN/m", which holds the rotor; not for scenes
    load: scenes only: the load that presses the rotor onto its touchdown bearings, over its weight
        (default: 1)
    """
    from ...master.common.units import to_si
    from ...master.scene.file import is_scene
    from ...rotor.file import shipped_rotors
    from ...studies.rotor.rotor_report import SPEED, report
    from ...studies.rotor.scene_report import report_scene

    spin = None if speed is None else to_si(speed, "rad/s", "--speed")
    number = to_si(modes, "1", "--modes")
    if number < 0.0 or number != int(number):
        raise TouchdownError(f"--modes {modes} must be a whole number, 2 or more, or 0 for all")
    sources = list(rotors) or list(shipped_rotors())
    stems = [Path(name).stem for name in sources]
    for name in stems:
        if stems.count(name) > 1:
            raise TouchdownError(f"{stems.count(name)} rotors are called {name}; ask for them one by one")
    pairs = [assignment(text, "--support") for text in support]
    stiffness = {name: above_zero(text, "N/m", f"--support {name}") for name, text in pairs}
    of_scenes = {"load": load, "set": settings, "swap": swap, "names": names}
    for name, plain in zip(sources, stems, strict=True):
        where = Path("runs", f"rotor-{plain}") if folder is None else Path(folder)
        if folder is not None and len(sources) > 1:
            where /= plain
        if is_scene(name):
            if support:
                raise TouchdownError(
                    f"--support is for rotors; {name} is a scene, whose bearings hold it: "
                    "--set COMPONENT.VARIABLE"
                )
            scene = set_scene(name, settings=settings, swap=swap, names=names)
            assert scene is not None
            pressed = 1.0 if load is None else to_si(load, "1", "--load")
            found = report_scene(scene, where, spin, int(number), pressed)
        else:
            for option, value in of_scenes.items():
                if value:
                    raise TouchdownError(f"--{option} is for scenes; {name} is a rotor")
            found = report(name, where, SPEED if spin is None else spin, int(number), stiffness)
        print(found.text)
        print(f"pictures in {where}\n")
        warn(found.remarks)
    return 0


IMPORTED = {  # kind: the options that it takes, and what to do with its file
    "rotor": (("at", "amb", "sensors", "speed"), "`touchdown rotor {0}` describes it"),
    "mount": (("slides",), "loop and fit are in {1}; now: touchdown new --mount {0}"),
    "foundation": (
        ("at", "modes", "damping"),
        'a scene\'s [components.foundation] takes it by settings = "{2}"',
    ),
}


def show_import(
    kind: Literal["rotor", "mount", "foundation"],
    source: PathLike,
    path: PathLike | None = None,
    *,
    at: Places | None = None,
    amb: Places | None = None,
    sensors: Places | None = None,
    speed: Spin | None = None,
    slides: Count | None = None,
    modes: Count | None = None,
    damping: Fraction | None = None,
    force: bool = False,
) -> int:
    """Import a rotor, a mount or a foundation from files of other programs, tables and measurements.

    kind: what the file holds
    source: of a rotor saved by ROSS (.toml, .json), a table of its sections (.csv), matrices or modal data
        (.npz), or a folder of matrices (.mtx, .hb, .matrix); of a mount a table (.csv) of its loop, with
        columns such as "displacement [mm]" and "force [N]"; of a foundation matrices or modal data
    path: file to write
    at: stations of a rotor that touchdown bearings hold, seats A to D of a foundation on which they stand;
        a PLACE is a node, from 1, or of a rotor its name in the file, or a distance from node 1 such as 120
        mm
    force: replace a file that is there
    """
    from ...master.common.files import make_writable

    asked: dict[str, Any] = {"at": at, "amb": amb, "sensors": sensors, "speed": speed, "slides": slides}
    asked |= {"modes": modes, "damping": damping}
    asked = {name: value for name, value in asked.items() if value is not None}
    taken, further = IMPORTED[kind]
    for name in asked:
        if name not in taken:
            taken = ", ".join(f"--{one}" for one in taken)
            raise TouchdownError(f"--{name} does not go with a {kind}, which takes {taken}")
    if kind == "foundation" and at is None:
        raise TouchdownError("--at is missing: seats of the foundation and the node of each, as A=2,B=4")
    found = getattr(machines, f"import_{kind}")(source, **asked)
    goal = Path(path or f"{Path(source).stem}-{kind}.toml")
    make_writable(goal.parent)
    found.save(goal, force)
    print("\n".join([repr(found), found.about] if kind == "rotor" else found.lines()))
    print(f"written to {goal}; {further.format(goal, goal.with_suffix('.png'), goal.name)}")
    return 0
