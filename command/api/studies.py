"""Studies, and figures of Halminen (2016), for Python."""

from __future__ import annotations

import math
import os
import tempfile
import warnings
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ...master.common.errors import TouchdownError, as_list
from ...master.common.progress import bar_over, growing_bar
from ..parameters import (
    Angle,
    Count,
    Counts,
    Fraction,
    Jobs,
    Length,
    Names,
    PathLike,
    Speed,
    Spins,
    Texts,
    Time,
    Times,
    assignment,
    bare_speeds,
    parted,
)
from .run import as_scene

if TYPE_CHECKING:
    from ...master.scene.scene import Scene
    from ...studies.comparison.engine import Comparison
    from ...studies.loop.over_speed import Found
    from ...studies.machine.rank import Ranking
    from ...studies.rotor.whirl_figure import WhirlPrediction
    from ...studies.sweep.design import Design
    from ...studies.sweep.results import Sweep
    from ...studies.sweep.survival import Survival
    from ...studies.verdict.study import Study
    from ...validation.case import Found as FoundCase


REFERENCE = 5e-6  # s, macro step beside adaptive steps inside the bearings


@contextmanager
def _kept(folder: PathLike | None) -> Iterator[Path]:
    """The folder, or one for the time it is needed."""
    if folder is not None:
        yield Path(folder)
        return
    with tempfile.TemporaryDirectory(prefix="touchdown_") as temporary:
        yield Path(temporary)


def figure(
    name: str | int,
    *,
    dark: bool = False,
    ensemble: Count | None = None,
    jobs: Count = 2,
    progress: bool = False,
) -> FoundCase:
    """A figure or table of Halminen (2016) computed here: its picture, and rows beside its values.

    name: such as 25 or "table7"; `touchdown figure` lists them
    dark: pictures on a dark ground
    ensemble: drops behind a median of table7, bearings, options and rotors (default: 5, rotors 8)
    jobs: drops at a time, in processes of their own

    Returns `figure` (matplotlib's; None for some tables), `rows` (each with quantity, unit, theirs, ours,
    deviation, conclusion), `notes` (what is assumed) and `lines` (tables of another form, as text). A
    script needs `if __name__ == "__main__":` around it. Raises TouchdownError for a figure that the
    models do not give, and where a run stops; Ctrl-C raises KeyboardInterrupt.

    >>> rows = touchdown.figure("table1").rows
    >>> print(rows[4].quantity, rows[4].theirs, rows[4].ours, rows[4].unit)
    6904: pitch diameter 26.1 28.5 mm
    >>> rows[4].conclusion
    'differs: 17 balls do not fit on 26.1 mm; mean of bore and outside diameter'
    """
    from ...validation.case import find_figure, make
    from ...validation.dissertation.drop_cache import dropping

    chosen = find_figure(str(name))
    with growing_bar("drops", not progress) as growing, dropping(jobs, growing, ensemble) as drops:
        return make(chosen, drops, dark=dark)


def sweep(
    scene: PathLike | Scene,
    variations: Design | Mapping[str, object] | Iterable[Mapping[str, object]],
    folder: PathLike | None = None,
    *,
    jobs: Jobs = 2,
    in_process: bool = False,
    keep: bool = False,
    anew: bool = False,
    continue_from: PathLike | None = None,
    progress: bool = False,
) -> Sweep:
    """Run a scene many times with settings that vary.

    folder: for sweep.nc and sweep.csv; a sweep that it has begun goes on there; without one nothing is
        left on disk
    jobs: runs at a time, in processes of their own, or the address of the Dask scheduler whose workers run
        them
    in_process: step the models without FMUs, faster
    keep: keep each run's recording, result.h5
    anew: delete a sweep that the folder holds
    continue_from: folder of a run of the scene, at whose end each run starts, such as one to the shutdown
        (run.until=shutdown); tunable parameters vary then, such as times of shutdown and faults

    `variations` is a Design, or values by setting, of which every combination runs, or a list of points,
    each of them values by setting. Returns the members in their order, each with its `settings`, its
    `summary`, and in `failed` why it stopped, or nothing; `data` of the whole is an xarray.Dataset, `plot`
    draws maps. A script needs `if __name__ == "__main__":` around it. After Ctrl-C the members that had not
    run to their ends are there with `ended` INTERRUPTED. Raises TouchdownError where a setting cannot be,
    and where `folder` holds another sweep.

    >>> scene = touchdown.load("disk-caged-simplified").set({"run.duration": "8 ms"})
    >>> members = touchdown.sweep(scene, {"bearing.clearance": ["0.2 mm", "0.25 mm"]}, in_process=True)
    >>> [round(1e3 * m.summary["seats"]["A"]["first_contact_time"], 1) for m in members]  # ms
    [6.5, 7.2]
    >>> members.data["bearing.clearance"].values  # m
    array([0.0002 , 0.00025])
    """
    from ...studies.sweep import sweep as study
    from ...studies.sweep.design import designed
    from ...studies.sweep.tasks import Running

    design = designed(variations)
    earlier = None if continue_from is None else Path(continue_from)
    running = Running(in_process=in_process, keep=keep, anew=anew, earlier=earlier)
    running = replace(running, cluster=jobs) if isinstance(jobs, str) else replace(running, jobs=jobs)
    with _kept(folder) as where, growing_bar("runs", not progress) as growing:
        return study.sweep(as_scene(scene), design, where, running, growing)


def open_sweep(folder: PathLike) -> Sweep:
    """Read the present state of a sweep from its folder, also while it runs or where it was interrupted.

    Raises TouchdownError where the folder is not that of a sweep.

    >>> scene = touchdown.load("disk-caged-simplified").set({"run.duration": "2 ms"})
    >>> found = touchdown.sweep(scene, {"rotor.mass": ["1 kg", "2 kg"]}, "runs/masses", in_process=True)
    >>> touchdown.open_sweep("runs/masses")
    <Sweep of disk-caged-simplified, 2 points of a grid: 2 completed>
    """
    from ...studies.sweep.results import read

    return read(Path(folder))


def survival(sweep: PathLike | Sweep, *, limit: str | None = None) -> Survival:
    """Tell from a sweep how many drops a machine survives.

    sweep: folder of a sweep, finished or under way; in Python also the sweep itself
    limit: that each drop must meet: a requirement as in scenes, a quantity as "peak_ball_force=1695 N", of
        one seat as "seats.B.peak_contact_force=700 N" (default: lowest_static_safety=1, a dent)

    `chance` of what it returns is the probability that a drop exceeds the limit, `after(drops)` that of
    surviving so many, each with its interval, `drivers` what the limit depends on. Raises TouchdownError
    where no drop tells of the limit.

    >>> scene = touchdown.load("disk-caged-simplified").set({"run.duration": "10 ms"})
    >>> members = touchdown.sweep(scene, {"rotor.mass": ["1 kg", "2 kg"]}, in_process=True)
    >>> touchdown.survival(members, limit="peak_contact_force=1 N").chance.value
    1.0
    """
    from ...studies.sweep.survival import survival_of

    found = open_sweep(sweep) if isinstance(sweep, (str, os.PathLike)) else sweep
    return survival_of(found.definition, found.members, limit)


def rank(
    scene: PathLike | Scene,
    bearings: Names | None = None,
    folder: PathLike | None = None,
    *,
    at: Texts = (),
    mount: Texts = (),
    drops: Count = 12,
    friction: Fraction = 0.3,
    clearance: Fraction = 0.1,
    jobs: Count = 2,
    progress: bool = False,
) -> Ranking:
    r"""Rank touchdown bearings and mounts by what a scene requires.

    bearings: names in the catalogue, or in files of your own
    at: SEAT=NAME,NAME: these for a seat of its own, such as "A=71909 AC/HC DB,71909 C/HC DB"; every
        combination is tried, all other seats with --bearings, or as they are
    folder: for the sweep of all drops and rank.csv; a ranking continues in it; without one nothing is left
        on disk
    mount: TOML files whose [set] describes the housings; all bearings are tried in each (default: the
        scene's)
    drops: number of drops of each bearing in each mount
    friction: fraction by which friction varies to either side
    clearance: fraction by which the clearance varies to either side
    jobs: drops at a time, in processes of their own

    The ranking has the best candidate first; `to_pandas()` has its shares and margins. A script needs
    `if __name__ == "__main__":` around it. Raises TouchdownError where the scene requires nothing.

    >>> with open("required.toml", "w") as file:
    ...     print('extends = "disk-caged-simplified"\n[requirements]\nball_force = "1 kN"', file=file)
    >>> scene = touchdown.load("required.toml").set({"run.duration": "8 ms"})
    >>> list(touchdown.rank(scene, "6014", drops=1).to_pandas()["bearing"])
    ['6014']
    """
    from ...master.common.units import to_si
    from ...studies.machine.rank import Spread, mounts_in, rank
    from ...studies.sweep.sweep import sweep
    from ...studies.sweep.tasks import Running

    seats = {seat: parted(chosen) for seat, chosen in (assignment(one, "--at") for one in as_list(at))}
    spread = Spread(drops, to_si(friction, "1", "friction"), to_si(clearance, "1", "clearance"))
    with _kept(folder) as where:

        def run(scene: Scene, design: Design) -> Sweep:
            with growing_bar("drops", not progress) as growing:
                return sweep(scene, design, where, Running(jobs, in_process=True), growing)

        names, mounts = parted(bearings or ()), mounts_in(as_list(mount))
        ranking = rank(as_scene(scene), names, mounts, spread, run, seats)
        if folder is not None and not ranking.interrupted:
            ranking.write(where)
    return ranking


def verdict(
    scene: PathLike | Scene,
    folder: PathLike | None = None,
    *,
    grid: Angle = "12 deg",
    macro_steps: Times = (),
    reference: bool = False,
    jobs: Count = 2,
    in_process: bool = False,
    progress: bool = False,
) -> Study:
    """Find the phases of the unbalance at which the rotor whirls, and their edges.

    folder: for phases.csv, verdict.json, verdict.png and the summary of each run; without one nothing is
        left on disk
    grid: distance between the phases that are run first; it is three times as close where the verdicts of
        neighbours differ, and narrower windows may be missed
    macro_steps: such as "5,10,20,40 us" (default: the scene's own)
    reference: also with adaptive steps inside the bearings, at a macro step of 5 us
    jobs: runs at a time, in processes of their own
    in_process: step the models without FMUs

    Without a duration each run ends once it has settled, at the latest after 4 times the scene's.
    `circles[0]` of what it returns has the runs and their `verdicts` by phase (deg), `data` all runs as an
    xarray.Dataset, as a sweep has them. A script needs `if __name__ == "__main__":` around it. After Ctrl-C
    the study has what is there, and is `interrupted`. Raises TouchdownError where the scene has no
    unbalance.

    >>> scene = touchdown.load("disk-caged-simplified").set({"run.duration": "8 ms"})
    >>> eccentric = scene.set({"rotor.eccentricity": "5 um"})
    >>> study = touchdown.verdict(eccentric, grid="180 deg", in_process=True)
    >>> dict(study.circles[0].verdicts)  # how each phase (deg) whirls, if it does
    {0.0: '', 180.0: ''}
    """
    from ...master.common.units import to_si
    from ...master.scene.tables import positive_value
    from ...studies.sweep.tasks import Running
    from ...studies.verdict.study import Plan, study_verdict
    from ...studies.verdict.verdict_report import findings

    spacing = math.degrees(to_si(grid, "rad", "grid"))
    steps = tuple(sorted({positive_value(step, "s", "macro_steps") for step in as_list(macro_steps)}))
    plan = Plan(spacing, spacing / 3.0, macro_steps=steps, reference=REFERENCE if reference else None)
    with _kept(folder) as where, growing_bar("runs", not progress) as growing:
        study = study_verdict(as_scene(scene), plan, where, Running(jobs, in_process=in_process), growing)
        if folder is not None:
            findings(study).write(where)
    return study


def whirl(
    scene: PathLike | Scene,
    variations: Design | Mapping[str, object] | None = None,
    folder: PathLike | None = None,
    *,
    speed: Speed | None = None,
    progress: bool = False,
) -> WhirlPrediction:
    """Predict the whirl without running a drop: how fast, how hard, on which mounts.

    folder: for the table and the map of what varies
    speed: of the rotor (default: the scene's, at the start)

    `variations` are values by setting, as of a sweep, at whose every combination the whirl is predicted,
    too. `backward` and `forward` of what it returns have `frequency` (Hz) and more; `lines` is all of it as
    text, `to_pandas()` has a row for each of the variations. Raises TouchdownError where nothing can whirl.

    >>> prediction = touchdown.whirl("rotor1-18000-225um")
    >>> round(prediction.backward.frequency)  # Hz
    648
    """
    from ...master.common.files import make_writable
    from ...master.scene.tables import positive_value
    from ...studies.rotor.whirl_figure import predict
    from ...studies.sweep.design import designed

    spin = None if speed is None else positive_value(speed, "rad/s", "speed")
    design = None if variations is None else designed(variations)
    if folder is not None and design is not None:  # first of all: many mounts take minutes
        make_writable(Path(folder))
    with growing_bar("mounts", not progress) as growing:
        prediction = predict(as_scene(scene), spin, design, growing)
    if folder is not None:
        prediction.write(Path(folder))
    return prediction


def amb_margins(
    scene: PathLike | Scene,
    folder: PathLike | None = None,
    *,
    speeds: Spins = (),
    measure: bool = False,
    amplitude: Length | None = None,
) -> Found:
    """Compute sensitivity, margins, poles and unbalance response of a scene's magnetic bearings.

    folder: for pictures (sensitivity, Campbell diagram, Bode, Nyquist, unbalance response), `answers.csv`,
        `unbalance.csv`, and `loops.npz` with plant and controller as A, B, C, D
    speeds: of the rotor, such as "0 rpm, 9000 rpm" (default: up to 1.5 times the scene's)
    measure: run the scene levitated, too, and measure its loops by multisines at the scene's speed
    amplitude: of each line at the sensors that are measured (default: 0.1 um)

    `speeds` of what it returns has the loops' `margins` and `poles` at each, `faults` why they do not
    levitate the rotor, `to_pandas()` the worst loop over the speed; `unbalance` orbits, currents and
    voltages over the speed, `answers` L, S, plant, controller and compliance over the frequency, each with
    `to_pandas()`; `measured` has `answers` of the run; `plant`, `sampled_plant` and `controller` are
    scipy's StateSpace. Raises TouchdownError where the scene has no magnetic bearing whose loop is known.

    >>> found = touchdown.amb_margins("disk-caged-relevitated", speeds=[0.0])
    >>> found.faults
    []
    >>> found.own.margins[0].peak < 3.0
    True
    """
    from ...master.common.units import to_si
    from ...studies.loop.measured_response import AMPLITUDE
    from ...studies.loop.over_speed import loops_in
    from ...studies.loop.pictures import write_loops

    asked = as_list(speeds)
    spins = [to_si(speed, "rad/s", "speeds") for speed in asked]
    for note in bare_speeds(asked):
        warnings.warn(note, stacklevel=2)
    size = AMPLITUDE if amplitude is None else to_si(amplitude, "m", "amplitude")
    if size <= 0.0:
        raise TouchdownError(f"amplitude = {amplitude} must be above 0 m")
    if amplitude is not None and not measure:
        raise TouchdownError("amplitude needs measure (--measure, measure=True)")
    found = loops_in(as_scene(scene), spins, size if measure else 0.0)
    if folder is not None:
        write_loops(found, Path(folder))
    return found


def compare(
    scene: PathLike | Scene | None = None,
    of: str = "schemes",
    *,
    schemes: Names | None = None,
    macro_steps: Times | None = None,
    wanted: Length | None = None,
    duration: Time | None = None,
    timed: Time | None = None,
    repeat: Count | None = None,
    modes: Counts | None = None,
    cases: Names | None = None,
    bearings: Names | None = None,
    jobs: Count | None = None,
    in_process: bool = False,
    progress: bool = False,
) -> Comparison:
    """Measure error and time of schemes, models, modes, bearings, macro steps.

    of: schemes, coupling schemes at several macro steps; models, what the scene could do without; modes of
        a flexible rotor; bearings, others in the touchdown seats, over the whole drop; steps, the largest
        macro step advised for each scheme, without a run; stability, the longest one that each bears in
        hard cases
    schemes: names of some (default: all)
    macro_steps: such as "5,20,100 us" (default: "5,10,20,50,100 us"); with modes one (default: "2 us")
    wanted: largest error of the journal that a scheme may have (default: "0.1 um")
    duration: time compared from the first contact on, such as "2 ms" (default: until the first impact is
        over, at most 5 ms, with modes 10 ms; with models 20 ms)
    timed: length of the runs that are timed, such as "1 s" (default: as compared)
    repeat: number of runs that are timed (default: 3)
    modes: numbers of modes per plane, the two rigid ones included (default: 3,5,8,12,20)
    cases: of stability, by name; all: also those that take minutes (default: all that are short)
    bearings: models of the project, or names in the catalogue (default: the four planar models of balls)
    jobs: runs at a time (default: 2)
    in_process: time the models without FMUs

    Each kind takes some of the options. `rows` has the errors against one reference in SI, with the wall
    time of runs, `lines` all of it as text, and `write` makes files. `recommended()` is the cheapest row
    that is good enough. Bearings (unless jobs=1) and stability start processes, so a script needs
    `if __name__ == "__main__":`. Raises TouchdownError where nothing touches, and for what cannot be;
    Ctrl-C raises KeyboardInterrupt, and nothing is left of it, but for stability.

    >>> chosen = {"schemes": ["hold"], "macro_steps": "100 us", "in_process": True}
    >>> comparison = touchdown.compare("disk-caged-simplified", **chosen)
    >>> 1e-6 < comparison.rows[0].errors["position"] < 1e-5  # m
    True
    """
    from ...master.scene.schemes import SCHEMES, scheme
    from ...master.scene.tables import positive_value
    from ...studies import comparison
    from ...studies.comparison.engine import Options
    from ...studies.comparison.modes import mode_counts

    options: dict[str, Any] = {"schemes": schemes, "macro_steps": macro_steps, "wanted": wanted}
    options |= {"duration": duration, "timed": timed, "repeat": repeat, "modes": modes}
    options |= {"jobs": jobs, "in_process": in_process or None}
    for name, texts in (("cases", cases), ("bearings", bearings)):
        options[name] = None if texts is None else list(dict.fromkeys(as_list(texts)))
    options = {name: value for name, value in options.items() if value is not None}
    comparison.check_options(of, scene, list(options))
    for name, unit in (("wanted", "m"), ("duration", "s"), ("timed", "s")):
        if name in options:
            options[name] = positive_value(options[name], unit, name)
    if schemes is not None:
        options["schemes"] = tuple(dict.fromkeys(scheme(name).name for name in as_list(schemes)))
    if macro_steps is not None:
        steps = (positive_value(step, "s", "macro_steps") for step in as_list(macro_steps))
        options["macro_steps"] = tuple(dict.fromkeys(steps))
    if modes is not None:
        options["modes"] = mode_counts(as_list(modes), "modes")
    if not options.get("schemes", SCHEMES) or not options.get("macro_steps", SCHEMES):
        raise TouchdownError("a comparison needs a scheme and a macro step at least")
    with growing_bar(of, not progress) as growing:
        return comparison.compare(
            of, None if scene is None else as_scene(scene), Options(**options), growing
        )


def validate(case: str | None = None, *, progress: bool = False) -> dict[str, FoundCase | TouchdownError]:
    """Recompute closed forms, other programs and measurements, within tolerances.

    case: name of one (default: all of them)

    Returns what each case gives by its name: `rows`, each with `quantity`, `theirs`, `ours` and
    `deviation`, or the error for which there are none. Raises TouchdownError for an unknown case.

    >>> force, *_ = touchdown.validate("hertz-impact")["hertz-impact"].rows
    >>> abs(force.deviation) < 1e-3
    True
    """
    from ...validation.case import cases, find_case, make_all

    chosen = list(cases().values()) if case is None else [find_case(case)]
    with bar_over(len(chosen), "cases", not progress) as bar:
        return {one.name: found for one, found in make_all(chosen, done=bar.update).items()}
