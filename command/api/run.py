"""Scenes and runs for Python."""

from __future__ import annotations

import os
import warnings
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from ...master.common.errors import Ended, TouchdownError, one_of
from ..parameters import Count, PathLike, Time

if TYPE_CHECKING:
    from ...master.coupling.steppers.stepper import Stepper
    from ...master.results.run import Draw
    from ...master.scene.scene import Scene
    from ...master.scene.schemes import Scheme
    from .result import Result

Pictures = bool | Literal["dark"]  # whether to draw, and on which ground


def scenes() -> dict[str, str]:
    """The scenes that come with the project: titles by name.

    >>> touchdown.scenes()["rotor2-case1"]
    'Rotor II dropped at 10000 rpm, bearings in line'
    """
    from ...master.scene.file import shipped_scenes

    return {name: load(name).title for name in shipped_scenes()}


def load(name_or_path: PathLike, *, variant: str = "") -> Scene:
    """A scene by name or path: of the project's, a .toml of yours, an SSP package, a run's scene.json.

    variant: of a package that has several systems, the name of another .ssd file in it

    Raises TouchdownError where there is none, or it has a mistake.

    >>> scene = touchdown.load("disk-caged-simplified")
    >>> scene.run.duration  # s
    5.0
    """
    from ...master.interop.find_scene import find_scene

    return find_scene(os.fspath(name_or_path), variant)


def as_scene(scene: PathLike | Scene) -> Scene:
    """The scene itself, or the one of that name or path."""
    return load(scene) if isinstance(scene, (str, os.PathLike)) else scene


def register_scheme(scheme: Scheme, stepper: type[Stepper] | None = None) -> None:
    """Let scenes, sweeps and comparisons name a coupling scheme of your own.

    With a `stepper`, a subclass of Stepper or of one of the project's, the scheme's `sequence` is the name
    it gets; without, `sequence` names one there is. Raises TouchdownError where the name of the scheme or
    of the new sequence is another's, where there is no such sequence, or a value cannot be; registering
    the same again is allowed. Processes that a sweep starts know it too, where they can import the
    stepper: from a script or a module, not from a notebook.

    >>> mean_and_slope = touchdown.Scheme(
    ...     name="velocity-slope", title="velocity extrapolated, mean and slope",
    ...     order=1, slopes=True, modes=False, error_order=2, angle_limit=0.08,
    ... )
    >>> touchdown.register_scheme(mean_and_slope)
    >>> scene = touchdown.load("disk-caged-simplified")
    >>> scene = scene.set({"run.duration": "8 ms", "run.scheme": "velocity-slope"})
    >>> touchdown.run(scene, in_process=True).summary["scheme"]
    'velocity-slope'
    """
    from ...master.coupling import steppers
    from ...master.scene import schemes

    known = steppers.SEQUENCES
    if stepper is None and scheme.sequence not in known:
        raise TouchdownError(
            f"scheme {scheme.name}: there is no sequence {scheme.sequence}; "
            f"{one_of(scheme.sequence, known)}, or give a stepper"
        )
    if stepper is not None:
        steppers.check_stepper(scheme.sequence, stepper)
    schemes.register_scheme(scheme)
    if stepper is not None:
        steppers.register_stepper(scheme.sequence, stepper)


def run(
    scene: PathLike | Scene,
    folder: PathLike | None = None,
    *,
    in_process: bool = False,
    native: bool | None = False,
    pictures: Pictures = False,
    progress: bool = False,
    spread: Count = 0,
    continue_from: PathLike | None = None,
    spin_down: Time | None = None,
) -> Result:
    """Run a scene.

    folder: for summary.json, scene.json, result.h5 and, where asked for, pictures; without one nothing is
        left on disk once the result is not used any more
    in_process: step the models without FMUs, the same to the bit and faster
    native: step the project's own FMUs that need no Python, built on first use (the command's default:
        where all of a scene's are built already); in Python None: as the command does by default
    pictures: draw pictures; in Python also "dark", on a dark ground
    spread: also run so many siblings (the same drop, its start shifted by nanometres) and show how far the
        peaks spread
    continue_from: folder of a run of the scene, at whose end this one starts; other than there may be
        run.duration and tunable parameters
    spin_down: run until the rotor stands still, at most so long, such as "60 s": with longer macro steps
        and rows, coarser steps in the bearings, and few bending modes, where --set gives no others

    Siblings run in processes of their own: a script needs `if __name__ == "__main__":` around it;
    summary["spread"]["quantities"] has least, median and most of peaks and first impacts then, by paths
    such as "seats.A.peak_contact_force". Raises TouchdownError where the run cannot start. One that stops
    part-way returns what it recorded, and `ended` says so.

    >>> scene = touchdown.load("disk-caged-simplified").set({"run.duration": "10 ms"})
    >>> result = touchdown.run(scene, in_process=True)
    >>> round(1e3 * result.summary["seats"]["A"]["first_contact_time"], 1)  # ms after the shutdown
    7.9
    """
    from ...master.common.progress import growing_bar
    from ...master.results.run import natively, natively_where_built, run_scene
    from ...master.scene.spin_down import spin_down as to_standstill
    from ...studies.drop import spread as spread_study
    from .result import Result

    if pictures not in (True, False, "dark"):
        raise TouchdownError(f'pictures = {pictures!r} must be True, False or "dark"')
    if native and in_process:
        raise TouchdownError("native takes FMUs and in_process takes none; choose one")
    chosen = as_scene(scene)
    if spin_down is not None:
        chosen = to_standstill(chosen, spin_down)
    earlier = None if continue_from is None else Path(continue_from)
    if not in_process and native is not False and earlier is None:
        chosen = natively(chosen) if native else natively_where_built(chosen)
    where = None if folder is None else Path(folder)
    result = run_scene(
        chosen, where, in_process, _drawing(pictures), progress, _start_warnings(chosen), earlier
    )
    if spread and result.ended is Ended.COMPLETED:
        with growing_bar("siblings", not progress) as growing:
            for warning in spread_study.spread(result, spread, progress=growing):
                warnings.warn(warning, stacklevel=2)
    return Result(**vars(result))


def _drawing(pictures: Pictures) -> Draw | None:
    """What draws a run's pictures on the ground that is asked for; None: nothing does."""
    if not pictures:
        return None
    from ...reports.figures.plot import draw_all  # matplotlib is slow to import

    return partial(draw_all, dark=pictures == "dark")


def _start_warnings(scene: Scene) -> list[str]:
    """Warnings about the loops of a scene, which its run alone does not give; the import takes its time."""
    if not scene.control:
        return []
    from ...studies.loop.over_speed import limit_warnings

    return limit_warnings(scene)


def open_result(folder: PathLike) -> Result:
    """Read a run back from its folder, as `run` returned it; the recording is read when it is used.

    Raises TouchdownError where the folder is not that of a run that is over.

    >>> scene = touchdown.load("disk-caged-simplified").set({"run.duration": "10 ms"})
    >>> kept = touchdown.run(scene, "runs/kept", in_process=True).folder
    >>> touchdown.open_result(kept).summary["completed"]
    True
    """
    from ...master.results.folder import reopened
    from .result import Result

    return Result(**vars(reopened(Path(folder))))
