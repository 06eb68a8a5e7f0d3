"""Scenes and points of sweeps, made of options; whose code runs in them."""

from __future__ import annotations

import os
from functools import reduce
from operator import mul
from pathlib import Path
from typing import TYPE_CHECKING

from ...master.common.errors import TouchdownError
from ..console import say_whose_code_runs
from ..parameters import Count, PathLike, Points, Settings, Texts, assignment

if TYPE_CHECKING:
    from ...master.scene.scene import Scene
    from ...studies.sweep.design import Design


def set_scene(
    scene_name: str | Scene,
    *,
    variant: str | None = None,
    settings: Settings | None = None,
    swap: Texts = (),
    names: Texts = (),
) -> Scene | None:
    """The scene that is named, if one is, changed as asked for. Raises TouchdownError."""
    from ...master.interop.find_scene import find_scene
    from ...master.scene.file import read_names

    if scene_name is None:
        return None
    scene = find_scene(scene_name, variant or "") if isinstance(scene_name, str) else scene_name
    for text in swap:
        pattern, fmu = assignment(text, "--swap")
        scene = scene.swap(**dict.fromkeys(scene.matching(pattern), fmu))
    for text in names:
        pattern, file = assignment(text, "--names")
        for name in scene.matching(pattern):
            scene = scene.with_names(name, read_names(Path(file)))
    changed = dict(settings or {})
    if changed.get("run.macro_step") != "auto":
        return scene.set(changed)
    from ...studies.comparison.steps import advise

    del changed["run.macro_step"]
    scene = scene.set(changed)
    advice = advise(scene)[scene.run.scheme.name]
    print(f"macro step {1e6 * advice.macro_step:g} us: {advice.reason}")
    return scene.set({"run.macro_step": advice.macro_step})


def chosen_scene(
    scene_name: str | Scene,
    *,
    variant: str | None = None,
    settings: Settings | None = None,
    swap: Texts = (),
    names: Texts = (),
    duration: str | None = None,
) -> Scene | None:
    """`set_scene` with what --duration gives. Raises TouchdownError."""
    timed = {"run.duration": duration} if duration else {}
    changed = {**(settings or {}), **timed}
    return set_scene(scene_name, variant=variant, settings=changed, swap=swap, names=names)


def scene_or_earlier(
    scene_name: str | None = None,
    *,
    variant: str | None = None,
    settings: Settings | None = None,
    swap: Texts = (),
    names: Texts = (),
    duration: str | None = None,
    continue_from: PathLike | None = None,
    member: Count | None = None,
    worst: str | None = None,
) -> Scene | None:
    """`chosen_scene`, that of the run that --from names, or a sweep's member. Raises TouchdownError.

    member: SCENE is the folder of a sweep: run its drop of this number again, in full and with pictures
    worst: the same of the drop with the worst value of this quantity, such as least_gap
    """
    from ...studies.sweep.definition import DEFINITION_FILE

    if (scene_name is None) == (continue_from is None):
        raise TouchdownError("give a SCENE, or by --from the folder of a run; see touchdown run --help")
    chosen: str | Scene | None = scene_name
    if member or worst or os.path.isfile(os.path.join(chosen or "", DEFINITION_FILE)):  # names may be long
        chosen = _member(chosen or str(continue_from), member, worst)
    return scene_or_state(
        chosen,
        variant=variant,
        settings=settings,
        swap=swap,
        names=names,
        duration=duration,
        continue_from=continue_from,
    )


def scene_or_state(
    scene_name: str | Scene | None = None,
    *,
    variant: str | None = None,
    settings: Settings | None = None,
    swap: Texts = (),
    names: Texts = (),
    duration: str | None = None,
    continue_from: PathLike | None = None,
) -> Scene | None:
    """`chosen_scene`, by default that of the run that --from names. Raises TouchdownError.

    continue_from: folder of a run at whose end every drop starts, such as one with --set
        run.until=shutdown; tunable parameters may vary, such as times of shutdown and faults
    """
    from ...master.scene.file import RECORDED_SCENE

    if scene_name is None and continue_from is None:
        raise TouchdownError("give a SCENE, or by --from the folder of a run")
    chosen = scene_name or str(Path(continue_from or "") / RECORDED_SCENE)
    return chosen_scene(
        chosen, variant=variant, settings=settings, swap=swap, names=names, duration=duration
    )


def _member(folder: str, number: int | None, quantity: str | None) -> Scene:
    """The scene of a member of a sweep, by its number or its worst quantity. Raises TouchdownError."""
    from ..api.studies import open_sweep

    sweep = open_sweep(folder)
    if sweep.definition.earlier:
        raise TouchdownError(
            f"drops of {folder} start at the end of {sweep.definition.earlier}; run one by `touchdown run "
            "--from` that folder, with its settings by --set, or have the sweep --keep all"
        )
    if (number is None) == (quantity is None):
        raise TouchdownError(f"{folder} is a sweep; add --member NUMBER, or --worst QUANTITY")
    if quantity is not None:
        number = sweep.worst(quantity).number
        print(f"drop {number} of {folder} has the worst {quantity}")
    return sweep.scene(number or 0)


def before_run(scene: Scene) -> None:
    """Say which code from files is about to run."""
    from ...master.components.loading import foreign

    say_whose_code_runs([name for name, spec in scene.components.items() if foreign(spec.fmu)])


def before_drop(scene: Scene, folder: Path) -> None:
    """`before_run`; and say which pages and films of an earlier run in the folder go with it."""
    from ...master.results.folder import derived_files

    before_run(scene)
    if gone := derived_files(folder):
        print(f"{folder} has an earlier run: {', '.join(gone)} go once this one begins", flush=True)


def grid(*, vary: Texts = ()) -> Design | None:
    """Every combination of what varies; None: nothing does.

    vary: as for sweep, such as "housing_*.stiffness=2:250:20:log MN/m"; two make a map
    """
    from ...studies.sweep.design import Design, parse_all

    return Design.grid(parse_all(list(vary))) if vary else None


def points(
    *,
    vary: Texts = (),
    tie: Texts = (),
    points: PathLike | None = None,
    random: Points | None = None,
    latin: Points | None = None,
    sobol: Points | None = None,
    range: Texts = (),
    seed: str = "0",
) -> Design:
    """The points that are asked for: every combination of all that is given. Raises TouchdownError.

    vary: NAME is a setting, or several with commas between them, or has * for anything; VALUES are a list
        such as "0.2,0.25,0.3 mm", or START:STOP:COUNT such as "0:315:8 deg", with :log for even ratios;
        repeat the option for all combinations
    tie: as --vary, but the settings of several --tie vary together, value by value
    points: CSV: a column NAME [UNIT] per setting, a line per point
    random: so many points of the --range settings: drawn at random
    latin: so many points of the --range settings: Latin hypercube
    sobol: so many points of the --range settings: Sobol, 2^k
    range: range of a setting to draw points from
    seed: of the points that are drawn
    """
    from ...studies.sweep.design import Design, parse_all, read_points

    samples = {"random": random, "latin": latin, "sobol": sobol}
    asked = {name: number for name, number in samples.items() if number is not None}
    if range and not asked:
        raise TouchdownError("--range says where to draw points; add how many, such as --sobol 64")
    if len(asked) > 1:
        raise TouchdownError(f"--{' and --'.join(asked)} are different samples; choose one")
    if not seed.strip().isdecimal():
        raise TouchdownError(f"--seed {seed} must be a whole number, 0 or above")
    ranges: dict[str, str] = {}
    for text in range:
        name, equals, span = (part.strip() for part in text.partition("="))
        if not equals or not name or name in ranges:
            raise TouchdownError(f"--range {text}: write NAME=LOW:HIGH UNIT, each name once")
        ranges[name] = span
    designs = [] if points is None else [read_points(Path(points))]
    designs += [getattr(Design, name)(ranges, number, int(seed)) for name, number in asked.items()]
    if tie:
        designs.append(Design.tied(parse_all(list(tie), "--tie")))
    if vary:
        designs.append(Design.grid(parse_all(list(vary))))
    if not designs:
        raise TouchdownError(
            "nothing varies; add --vary NAME=VALUE,VALUE,... or --vary NAME=START:STOP:COUNT"
        )
    return reduce(mul, designs)
