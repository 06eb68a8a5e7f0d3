"""Scenes and runs for Python."""

from __future__ import annotations

import os
import warnings
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from ...master.common.errors import Ended, TouchdownError, one_of
from ...master.coupling import steppers
from ...master.coupling.steppers.stepper import Stepper
from ...master.interop import scenes as anywhere
from ...master.results import result as results
from ...master.results.final_state import Finished
from ...master.results.folder import reopened
from ...master.results.run import Draw, natively, run_scene
from ...master.scene import schemes
from ...master.scene.file import shipped
from ...master.scene.scene import Scene
from ...master.scene.schemes import Scheme
from ...studies.drop import spread as spread_study

if TYPE_CHECKING:
    from ...reports.figures.plot import Plot

PathLike = str | os.PathLike[str]
Pictures = bool | Literal["dark"]  # whether to draw, and on which ground


class Result(results.Result):
    """Results of a run.

    `summary` holds its figures by name, each with its unit; None where something did not happen.

    >>> scene = touchdown.load("disk-caged-simplified").set({"run.duration": "10 ms"})
    >>> result = touchdown.run(scene, in_process=True)
    >>> result.ended
    <Ended.COMPLETED: 'completed'>
    >>> result.summary["first_contact_speed_m_s"] > 0.05
    True
    >>> result.data["rotor.A.y"].attrs["units"]
    'm'
    >>> float(result.data["rotor.A.y"].min()) < -200e-6
    True
    >>> list(result.to_pandas(["rotor.A.x", "rotor.A.y"]))
    ['rotor.A.x', 'rotor.A.y']
    >>> result.plot.orbit().get_xlabel()
    'x in space [µm]'
    """

    @property
    def plot(self) -> Plot:
        """Pictures: `plot.orbit()`, `plot.forces()` and more, each of which returns its axes."""
        from ...reports.figures.plot import Plot

        return Plot(lambda: Finished(self.scene, self.ending, self.recording))


def scenes() -> dict[str, str]:
    """The scenes that come with the project: titles by name.

    >>> touchdown.scenes()["rotor2-case1"]
    'Rotor II dropped at 10000 rpm, bearings in line'
    """
    return {name: load(name).title for name in shipped()}


def load(name_or_path: PathLike) -> Scene:
    """A scene by name or path: of the project's, a .toml of yours, an SSP package, a run's scene.json.

    Raises TouchdownError where there is none, or it has a mistake.

    >>> scene = touchdown.load("disk-caged-simplified")
    >>> scene.run.duration  # s
    5.0
    """
    return anywhere.find_scene(os.fspath(name_or_path))


def as_scene(scene: PathLike | Scene) -> Scene:
    """The scene itself, or the one of that name or path."""
    return scene if isinstance(scene, Scene) else load(scene)


def register_scheme(scheme: Scheme, stepper: type[Stepper] | None = None) -> None:
    """Let scenes, sweeps and comparisons name a coupling scheme of your own.

    With a `stepper`, a subclass of Stepper or of one of the project's, the scheme's `sequence` is the name
    it gets; without, `sequence` names one there is. Raises TouchdownError where the name of the scheme or
    of the new sequence is another's, where there is no such sequence, or a value cannot be; registering
    the same again is no mistake. Processes that a sweep starts know it too, where they can import the
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
    known = steppers.SEQUENCES
    if stepper is None and scheme.sequence not in known:
        raise TouchdownError(
            f"scheme {scheme.name}: there is no sequence {scheme.sequence}; "
            f"{one_of(scheme.sequence, known)}, or give a stepper"
        )
    if stepper is not None:
        steppers.check(scheme.sequence, stepper)
    schemes.register(scheme)
    if stepper is not None:
        steppers.register(scheme.sequence, stepper)


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
    draw, remarks = drawing(pictures), start_warnings(chosen)
    result = run_scene(chosen, where, in_process, csv, draw, progress, remarks)
    if spread and result.ended is Ended.COMPLETED:
        for warning in spread_study.spread(result, spread):
            warnings.warn(warning, stacklevel=2)
    return Result(**vars(result))


def drawing(pictures: Pictures) -> Draw | None:
    """What draws a run's pictures on the ground that is asked for; None: nothing does."""
    if not pictures:
        return None
    from ...reports.figures.plot import draw_all  # matplotlib is slow to import

    return partial(draw_all, dark=pictures == "dark")


def start_warnings(scene: Scene) -> list[str]:
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
    return Result(**vars(reopened(Path(folder))))
