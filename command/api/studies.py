"""Studies and figures of the source for Python."""

from __future__ import annotations

import math
import tempfile
from collections.abc import Iterable, Mapping
from contextlib import nullcontext
from dataclasses import replace
from pathlib import Path
from typing import TypeVar

from ...master.common.errors import TouchdownError, as_list
from ...master.common.progress import bar_over, growing_bar
from ...master.scene.scene import Scene
from ...master.scene.schemes import SCHEMES, scheme
from ...master.scene.tables import above_zero
from ...studies import comparison
from ...studies.comparison import check_options
from ...studies.comparison.engine import MODES, TARGET_ERROR_M, Comparison, Options
from ...studies.comparison.modes import mode_counts
from ...studies.sweep import sweep as sweep_study
from ...studies.sweep.design import Design, designed
from ...studies.sweep.results import Sweep, read
from ...studies.sweep.tasks import Running
from ...studies.verdict.report import findings
from ...studies.verdict.study import Plan, Study, study_verdict
from ...validation.case import Found, find_figure, make
from ...validation.dissertation.drop_cache import dropping
from .run import PathLike, as_scene


def figure(name: str | int, *, dark: bool = False, jobs: int = 2, progress: bool = False) -> Found:
    """A figure or table of the source as it comes out here: its picture, and rows beside its values.

    name: such as 25 or "table7"; `touchdown figure` lists them. Returns `figure` (matplotlib's; None for
    some tables), `rows` (each with quantity, unit, theirs, ours, deviation, conclusion), `notes` (what is
    assumed) and `lines` (tables of another form, as text).
    What it needs is run, `jobs` drops at a time in processes of their own: a script needs
    `if __name__ == "__main__":` around it. dark: on a dark ground. Raises TouchdownError for a figure that
    the models do not give, and where a run stops; Ctrl-C raises KeyboardInterrupt.

    >>> rows = touchdown.figure("table1").rows
    >>> print(rows[4].quantity, rows[4].theirs, rows[4].ours, rows[4].unit)
    6904: pitch diameter 26.1 28.5 mm
    >>> rows[4].conclusion
    'differs: 17 balls do not fit on 26.1 mm; mean of bore and outside diameter'
    """
    chosen = find_figure(str(name))
    with growing_bar("drops", not progress) as growing, dropping(jobs, growing) as drops:
        return make(chosen, drops, dark=dark)


Item = TypeVar("Item")


def sweep(
    scene: PathLike | Scene,
    variations: Design | Mapping[str, object] | Iterable[Mapping[str, object]],
    folder: PathLike | None = None,
    *,
    jobs: int | str = 2,
    in_process: bool = False,
    progress: bool = False,
) -> Sweep:
    """Run a scene at every point of `variations`, and return its members in their order.

    `variations` is a Design, or values by setting, of which every combination runs, or a list of points,
    each of them values by setting. A member has its `settings`, its `summary`, and in `failed` why it
    stopped, or nothing; `data` of the whole is an xarray.Dataset, `plot` draws maps. `folder` gets sweep.nc
    and sweep.csv, and a sweep that it has begun goes on there; without one nothing is left on disk. `jobs`
    run at a time, in processes of their own, or on the workers of the Dask scheduler whose address it is: a
    script needs `if __name__ == "__main__":` around it. After Ctrl-C the members that had not run to their
    ends are there with `ended` INTERRUPTED. Raises TouchdownError where a setting cannot be, and where
    `folder` holds another sweep.

    >>> scene = touchdown.load("disk-caged-simplified").set({"run.duration": "8 ms"})
    >>> members = touchdown.sweep(scene, {"bearing.clearance": ["0.2 mm", "0.25 mm"]}, in_process=True)
    >>> [round(1e3 * member.summary["first_contact_time_s"], 1) for member in members]  # ms
    [6.5, 7.2]
    >>> members.data["bearing.clearance"].values  # m
    array([0.0002 , 0.00025])
    """
    design = designed(variations)
    running = Running(in_process=in_process)
    running = replace(running, cluster=jobs) if isinstance(jobs, str) else replace(running, jobs=jobs)
    kept = tempfile.TemporaryDirectory(prefix="touchdown_") if folder is None else nullcontext(folder)
    with kept as where, bar_over(len(design), "runs", not progress) as bar:
        return sweep_study.sweep(as_scene(scene), design, Path(where), running, bar.update)


def open_sweep(folder: PathLike) -> Sweep:
    """Read a sweep from its folder as it is now, also while it runs or where it was interrupted.

    Raises TouchdownError where the folder is not that of a sweep.

    >>> scene = touchdown.load("disk-caged-simplified").set({"run.duration": "2 ms"})
    >>> found = touchdown.sweep(scene, {"rotor.mass": ["1 kg", "2 kg"]}, "runs/masses", in_process=True)
    >>> touchdown.open_sweep("runs/masses")
    <Sweep of disk-caged-simplified, 2 points of a grid: 2 completed>
    """
    return read(Path(folder))


def verdict(
    scene: PathLike | Scene,
    folder: PathLike | None = None,
    *,
    grid: float | str = "12 deg",
    jobs: int = 2,
    in_process: bool = False,
    progress: bool = False,
) -> Study:
    """Which phases of its rotor's unbalance a scene whirls at, and where the edges are.

    Runs the scene round the circle of phases, `grid` (rad) apart, and three times as close where the
    verdicts of neighbours differ; windows narrower than the grid may be missed. `circles[0]` of what it
    returns has the runs and their `verdicts` by phase (deg), `data` all runs as an xarray.Dataset, as a
    sweep has them. `folder` gets phases.csv, verdict.json,
    verdict.png and the summary of each run; without one nothing is left on disk. `jobs` run at a time, in
    processes of their own: a script needs `if __name__ == "__main__":` around it. After Ctrl-C the study
    has what is there, and is `interrupted`. Raises TouchdownError where the scene has no unbalance.

    >>> scene = touchdown.load("disk-caged-simplified").set({"run.duration": "8 ms"})
    >>> eccentric = scene.set({"rotor.eccentricity": "5 um"})
    >>> study = touchdown.verdict(eccentric, grid="180 deg", in_process=True)
    >>> dict(study.circles[0].verdicts)  # how each phase (deg) whirls, if it does
    {0.0: '', 180.0: ''}
    """
    spacing = math.degrees(above_zero(grid, "rad", "grid"))
    plan, running = Plan(spacing, spacing / 3.0), Running(jobs, in_process=in_process)
    kept = tempfile.TemporaryDirectory(prefix="touchdown_") if folder is None else nullcontext(folder)
    with kept as where, growing_bar("runs", not progress) as growing:
        study = study_verdict(as_scene(scene), plan, Path(where), running, growing)
        if folder is not None:
            findings(study).write(Path(where))
    return study


def compare(
    scene: PathLike | Scene | None = None,
    of: str = "schemes",
    *,
    schemes: str | Iterable[str] | None = None,
    macro_steps: float | str | Iterable[float | str] | None = None,
    wanted: float | str | None = None,
    duration: float | str | None = None,
    timed: float | str | None = None,
    repeat: int | None = None,
    modes: int | Iterable[int] | None = None,
    cases: str | Iterable[str] | None = None,
    jobs: int | None = None,
    in_process: bool = False,
    progress: bool = False,
) -> Comparison:
    """Variants of a scene against one reference, by the error and the time of each.

    of: "schemes", coupling schemes (None: all) at macro steps (s) on one drop, against two monolithic
    solutions, and which is the cheapest that errs by no more than `wanted` (m); "models", what the scene
    could do without; "modes", numbers of modes of a flexible rotor, against all of its finite elements;
    "steps", the largest macro step advised for each scheme, without a run; "stability", which has `cases`
    of its own, the longest macro step that each scheme bears in them. Each kind takes some of the options.

    Errors are those of the first impacts, or of `duration` (s) from the first contact; `rows` has them in
    SI, with the wall time of runs, `timed` (s) long, `lines` all of it as text, and `write` makes files.
    `recommended()` is the cheapest row that is good enough. Raises TouchdownError where nothing touches,
    and for what cannot be; Ctrl-C raises KeyboardInterrupt, and nothing is left of it, but for stability.

    >>> chosen = {"schemes": ["hold"], "macro_steps": "100 us", "in_process": True}
    >>> comparison = touchdown.compare("disk-caged-simplified", **chosen)
    >>> 1e-6 < comparison.rows[0].errors["position"] < 1e-5  # m
    True
    """
    given: dict[str, object] = {"schemes": schemes, "macro_steps": macro_steps, "wanted": wanted}
    given |= {"duration": duration, "timed": timed, "repeat": repeat, "modes": modes, "cases": cases}
    given |= {"jobs": jobs, "in_process": in_process or None}
    check_options(of, scene, [name for name, value in given.items() if value is not None])
    options = Options(
        schemes=_distinct(SCHEMES if schemes is None else (scheme(name).name for name in as_list(schemes))),
        steps=()
        if macro_steps is None
        else _distinct(above_zero(step, "s", "macro_steps") for step in as_list(macro_steps)),
        target=TARGET_ERROR_M if wanted is None else above_zero(wanted, "m", "wanted"),
        duration=None if duration is None else above_zero(duration, "s", "duration"),
        timed=None if timed is None else above_zero(timed, "s", "timed"),
        repeat=3 if repeat is None else repeat,
        modes=MODES if modes is None else mode_counts(as_list(modes), "modes"),
        cases=() if cases is None else as_list(cases),
        jobs=2 if jobs is None else jobs,
        in_process=in_process,
    )
    chosen = None if scene is None else as_scene(scene)
    with growing_bar(of, not progress) as growing:
        return comparison.compare(of, chosen, options, growing)


def _distinct(items: Iterable[Item]) -> tuple[Item, ...]:
    """In their order. Raises TouchdownError where there are none."""
    distinct = tuple(dict.fromkeys(items))
    if not distinct:
        raise TouchdownError("a comparison needs a scheme and a macro step at least")
    return distinct
