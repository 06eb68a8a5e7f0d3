"""What the command prints of studies."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from ...master.common.errors import FAILED, STOPPED, Ended, TouchdownError
from ...master.common.progress import growing_bar
from ..api.machines import report
from ..api.studies import figure
from ..console import print_error, report_interrupt, show_findings, warn
from ..parameters import Count, PathLike, Settings, Texts, count
from .scenes import before_run

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

DURATION, STEP = {"run.duration": "--duration"}, {"run.macro_step": "--macro-steps"}
BOTH = dict.fromkeys(("residual", "stress.mode_acceleration"), "none: both ways are run")
INSTEAD = {  # settings that comparisons make themselves, by kind
    "schemes": DURATION | STEP | {"run.scheme": "--schemes"},
    "models": DURATION,
    "modes": DURATION | STEP | {"modes": "--modes"} | BOTH,
}


def before_sweep(scene: Scene, variations: Design, over: Texts, pick: Texts) -> None:
    """Refuse maps and quantities that cannot be, and say how many runs there will be, and of whose code."""
    from ...studies.sweep.places import refuse_axes
    from ...studies.sweep.report import refuse_picks

    refuse_axes(list(over), variations.names)
    refuse_picks(pick)
    print(f"{len(variations)} runs: {variations.about}", flush=True)
    before_run(scene)


def show_sweep(
    sweep: Sweep, folder: Path, *, pick: Texts = (), over: Texts = (), pictures: bool = True
) -> int:
    """Print the table of a sweep and draw its maps; the exit status says whether runs failed.

    pick: show this quantity, such as peak_contact_force or "seats.A.*"; * is anything, alone all of them
    over: draw maps over this setting; repeat it for the second axis (default: the first that vary)
    pictures: draw maps
    """
    from ...studies.sweep.report import report_lines

    if kept := sum(member.kept for member in sweep):
        print(f"{kept} of {len(sweep)} were finished before and not run again")
    if bare := sweep.definition.bare_units():
        print(f"values without a unit are in SI: {', '.join(f'{name} in {unit}' for name, unit in bare)}")
    everything = list(pick) == ["*"]
    lines, complaints = report_lines(sweep.members, () if everything else list(pick), everything)
    print("\n".join(lines))
    if pictures:
        sweep.plot.save(folder, list(over))
    print(f"results in {folder}")
    warn(complaints)
    if any(m.ended is Ended.INTERRUPTED for m in sweep):
        return report_interrupt()
    if failed := sum(bool(m.failed) for m in sweep):
        print_error(f"{failed} of {len(sweep)} runs failed, see the table")
        return STOPPED
    return 0


def show_survival(found: Survival, sweep: Path, *, drops: str = "1,2,5,10,20") -> int:
    """Print what a machine survives, and write it into the sweep's folder.

    drops: numbers of drops, such as "1:20"
    """
    from ...studies.sweep.maps import SURVIVAL_FILE, write_survival
    from ...studies.sweep.survival import lines

    first, colon, last = drops.partition(":")
    numbers = sorted({count(one, "--drops") for one in ((first, last) if colon else drops.split(","))})
    if colon:
        if count(first, "--drops") > count(last, "--drops"):
            raise TouchdownError(f"--drops {drops} must go up, such as 1:20")
        numbers = list(range(numbers[0], numbers[-1] + 1))
    print("\n".join(lines(found, numbers)))
    warn(found.warnings)
    write_survival(found, range(1, max(numbers) + 1), sweep / SURVIVAL_FILE)
    print(f"{SURVIVAL_FILE} in {sweep}")
    return 0


def show_rank(ranking: Ranking, folder: Path) -> int:
    """Print a ranking and write its page; the exit status says whether drops failed."""
    if ranking.interrupted:
        return report_interrupt()
    print("\n".join(ranking.lines()))
    print(f"results in {folder}, its page is {report(folder)[0]}")
    return STOPPED if any(one.failed for one in ranking.candidates) else 0


def show_verdict(study: Study, folder: Path) -> int:
    """Print the windows of phases; the exit status says whether runs failed."""
    from ...studies.verdict.verdict_report import findings

    print("\n".join([*findings(study).lines, f"results in {folder}"]))
    warn(study.remarks)
    if study.interrupted:
        return report_interrupt()
    if failed := sum(len(circle.failed) for circle in study.circles):
        print_error(f"{failed} runs failed, see above")
    return STOPPED if failed else 0


def show_whirl(prediction: WhirlPrediction, variations: Design | None, folder: Path) -> int:
    """Print a prediction."""
    print("\n".join(prediction.lines()))
    if variations is not None:
        if not any(one.settled for one in prediction.over):
            print("no whirl with any of these settings")
        print(f"{' and '.join(prediction.files)} in {folder}")
    return 0


def show_margins(found: Found, folder: Path, *, require: bool = False) -> int:
    """Print the loops of a scene; the exit status says whether they levitate the rotor.

    require: fail where the scene's requirement of the sensitivity is not met
    """
    from ...studies.loop.loop_report import lines

    print("\n".join([*lines(found), f"\npictures and tables in {folder}"]))
    if found.faults:
        return FAILED
    return STOPPED if require and not all(one.met for one in found.required) else 0


def before_compare(
    scene: Scene | None,
    scene_name: str | None,
    folder: Path,
    of: str,
    settings: Settings | None,
    swap: Texts,
    names: Texts,
    progress: bool,
    **options: Any,
) -> None:
    """Refuse options that this kind of comparison does not take, in the command's words."""
    from ...master.common.files import make_writable
    from ...studies.comparison import STABILITY, check_options

    asked = [name for name, value in options.items() if value not in (None, False)]
    changed = {"set": settings, "swap": swap, "names": names} if of == STABILITY else {}
    asked += [name for name, value in changed.items() if value]
    check_options(of, scene, asked, "--")
    for name in settings or ():
        for key in (name, name.partition(".")[2]):
            if key in INSTEAD.get(of, {}):
                raise TouchdownError(f"--set {name}: compare sets it itself; use {INSTEAD[of][key]}")
    make_writable(folder)
    if scene is not None:
        before_run(scene)


def show_compare(found: Comparison, folder: Path) -> int:
    """Print a comparison and write its files; the exit status says whether it is whole."""
    show_findings(found.findings(), folder)
    warn(found.warnings)
    if found.interrupted:
        return report_interrupt()
    if found.incomplete or (found.tabulated and found.rows and all(row.failed for row in found.rows)):
        print_error(found.incomplete or "all variants failed, see the table")
        return STOPPED
    return 0


def show_figure(
    figure_name: str = "list",
    folder: PathLike = "runs/figures",
    *,
    dark: bool = False,
    ensemble: Count | None = None,
    jobs: Count = 2,
    progress: bool = False,
) -> int:
    """Draw figures and tables of Halminen (2016) by name, beside its values.

    figure_name: such as 25 or bearings; all: those of Halminen (2016), as a page; list, or nothing: names
    """
    from ...master.common.files import make_writable
    from ...validation import page
    from ...validation.case import figures, find_figure, make_all
    from ...validation.dissertation.drop_cache import dropping

    if figure_name == "list":
        print(f"{page.listing(figures(studies=True).values())}\n  not here: {page.absent()}")
        return 0
    where = Path(folder)
    if figure_name != "all":
        chosen = find_figure(figure_name)
        make_writable(where)
        found = figure(figure_name, dark=dark, ensemble=ensemble, jobs=jobs, progress=progress)
        results, files = {chosen: found}, page.write(chosen, found, where)
    else:
        make_writable(where)
        with growing_bar("drops", not progress) as growing, dropping(jobs, growing, ensemble) as drops:
            results = make_all(figures().values(), drops, dark=dark)
            files = [page.write_page("reproduction", results, where)]
    print("\n".join(page.text(case, found) for case, found in results.items()))
    print(f"results in {', '.join(map(str, files))}")
    return STOPPED if page.failed(results) else 0


def show_validation(
    case: str | None = None, folder: PathLike | None = None, *, progress: bool = False
) -> int:
    """Recompute closed forms, other programs and measurements, within tolerances.

    case: name of one (default: all of them); list: which there are
    folder: for validation.md, the page of all cases, and its pictures

    The exit status says whether a row left its tolerance without a known reason.
    """
    from ...master.common.files import make_writable
    from ...validation import page
    from ...validation.case import cases
    from ..api.studies import validate

    known = cases()
    if case == "list":
        print(page.listing(known.values()))
        return 0
    if case and folder:
        raise TouchdownError("-o writes the page of all cases; name none of them")
    if folder:
        make_writable(Path(folder))
    results = {known[name]: found for name, found in validate(case, progress=progress).items()}
    print("\n".join(page.text(one, found) for one, found in results.items()))
    print(page.summary(results))
    if folder:
        print(f"results in {page.write_page('validation', results, Path(folder))}")
    return STOPPED if page.failed(results) else 0
