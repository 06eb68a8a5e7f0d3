"""Run a scene."""

from __future__ import annotations

import warnings
from pathlib import Path

from touchdown.master.api.scenes import PathLike, as_scene
from touchdown.master.common.ended import Ended
from touchdown.master.common.errors import TouchdownError
from touchdown.master.results.folder.reopened import reopened
from touchdown.master.results.result import Result
from touchdown.master.results.run import Pictures, natively, run_scene
from touchdown.master.scene.scene import Scene
from touchdown.master.studies.drop import spread as spread_study


def run(
    scene: PathLike | Scene,
    folder: PathLike | None = None,
    *,
    in_process: bool = False,
    native: bool = False,
    csv: bool = False,
    pictures: Pictures = False,
    progress: bool = False,
    spread: int = 0,
) -> Result:
    """Run a scene, given itself, by name or by path.

    `folder` gets summary.json, scene.json, result.h5 and, where asked for, result.csv and pictures; without
    one nothing is left on disk once the result is not used any more. pictures="dark": on a dark ground.
    in_process: step the models without FMUs, the same to the bit and faster; native: take the project's own
    FMUs that need no Python; progress: show a bar. spread: so many drops more that start nanometres away,
    in processes of their own (a script needs `if __name__ == "__main__":` around it); summary["spread"] has
    least, median and most of peaks and first impacts then. Siblings that stop are warned of.

    Raises TouchdownError where the run cannot start. One that stops part-way returns what it recorded, and
    `ended` says so.

    >>> scene = touchdown.load("disk-caged-simplified").set({"run.duration": "10 ms"})
    >>> result = touchdown.run(scene, in_process=True)
    >>> round(1e3 * result.summary["first_contact_time_s"], 1)  # ms after the shutdown
    7.9
    """
    if pictures not in (True, False, "dark"):
        raise TouchdownError(f'pictures = {pictures!r} must be True, False or "dark"')
    if native and in_process:
        raise TouchdownError("native takes FMUs and in_process takes none; choose one")
    chosen = natively(as_scene(scene)) if native else as_scene(scene)
    where = None if folder is None else Path(folder)
    result = run_scene(chosen, where, in_process, csv, pictures, progress)
    if spread and result.ended is Ended.COMPLETED:
        for warning in spread_study.spread(result, spread):
            warnings.warn(warning, stacklevel=2)
    return result


def open_result(folder: PathLike) -> Result:
    """What a run left in a folder, read back as `run` returned it; the recording is read when it is used.

    Raises TouchdownError where the folder is not that of a run that is over.

    >>> scene = touchdown.load("disk-caged-simplified").set({"run.duration": "10 ms"})
    >>> kept = touchdown.run(scene, "runs/kept", in_process=True).folder
    >>> touchdown.open_result(kept).summary["completed"]
    True
    """
    return reopened(Path(folder))
