"""What the command prints of runs."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

from ...master.common.errors import STOPPED, Ended
from ..console import BROKEN_OFF, print_error, warn
from ..parameters import Count, PathLike

if TYPE_CHECKING:
    from ...master.scene.scene import Scene
    from ...studies.drop.differences import Differences
    from ..api.result import Result


def show_run(
    result: Result,
    scene: Scene,
    scene_name: str | None,
    in_process: bool,
    native: bool | None,
    continue_from: PathLike | None,
    member: Count | None,
    worst: str | None,
    *,
    all: bool = False,
    require: bool = False,
) -> int:
    """Print a run's quantities; the exit status says how it ended.

    all: print all results, also energies, steps and what did not happen
    require: fail where the scene's [requirements] are not met
    """
    from ...master.results.required import judged
    from ...master.results.table import result_table
    from ...master.results.whirl.evidence import evidence, goes_on, hint, unbalanced
    from ...master.scene.file import RECORDED_SCENE
    from ...studies.drop.spread import spread_lines
    from ...studies.rotor.supports import balanced

    print("\n".join([result.headline, result_table(result.summary, all), *evidence(result.summary)]))
    required = judged(scene.requirements, result.summary)
    lines = [*goes_on(result.summary), *spread_lines(result.summary), *(one.words() for one in required)]
    if len(required) < len(scene.requirements):
        lines.append("the loops' sensitivity is required, too: `touchdown amb-margins --require` judges it")
    recorded = str(result.folder / RECORDED_SCENE)
    named = recorded if member or worst or scene_name is None else scene_name
    hints = list(hint(named, result.ending, result.summary))
    if hints and balanced(scene, unbalanced(result.ending)):
        hints = ["the rotor has no unbalance, so the verdict does not depend on its phase"]
    way = f"stepped as in {continue_from}" if continue_from else _way(result.scene, in_process, native)
    keys = "`touchdown scenes --quantities` lists the keys of these"
    print("\n".join([*lines, *hints, keys, way, f"results in {result.folder}"]))
    warn(result.warnings)
    if result.ended is not Ended.COMPLETED:
        print_error(f"stopped: {result.stopped_because}; what was recorded is in {result.folder}")
        return BROKEN_OFF if result.ended is Ended.INTERRUPTED else STOPPED
    return STOPPED if require and any(not one.met for one in required) else 0


def left_behind(folder: PathLike | None) -> str:
    """What there is of a run that was broken off before it could sum up, or had not begun."""
    from ...master.results.folder import SUMMARY_FILE
    from ...master.results.result import RECORDING

    if folder is None or not os.path.isfile(Path(folder, RECORDING)):
        return f"nothing was recorded{'' if folder is None else f' in {folder}'}"
    if os.path.isfile(Path(folder, SUMMARY_FILE)):
        return f"{folder} has the results of a whole run, the earlier one where this had not begun"
    return f"{folder} has no {SUMMARY_FILE}: what it recorded is not whole"


def show_diff(found: Differences, folder: PathLike, *, all: bool = False) -> int:
    """Print what runs differ in.

    all: print all quantities, also those that are alike
    """
    print("\n".join([*found.findings(all).lines, f"pictures in {folder}"]))
    return 0


def _way(scene: Scene, in_process: bool, native: bool | None) -> str:
    """How components were stepped, and what would be quicker."""
    from ...master.components.loading import foreign

    files = [name for name, spec in scene.components.items() if foreign(spec.fmu)]
    if in_process:
        others = f"; FMUs: {', '.join(files)}" if files else ""
        return f"stepped in process, without FMUs{others}"
    if not files and all(spec.native for spec in scene.components.values()):
        return f"stepped as native FMUs, which need no Python{'' if native else ' (all were built)'}"
    if files:
        return "stepped as FMUs in Python, and those of others; --in-process steps the own ones faster"
    return (
        "stepped as FMUs in Python; --in-process gives the same rows faster, --native builds FMUs that do, "
        "which later runs take by themselves"
    )
