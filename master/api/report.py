"""Reports on runs, and moving pictures of them."""

from __future__ import annotations

import os
from pathlib import Path

from touchdown.master.api.run import open_result
from touchdown.master.api.scenes import PathLike
from touchdown.master.common.errors import TouchdownError
from touchdown.master.common.progress import bar_over
from touchdown.master.results.result import Result
from touchdown.master.studies.sweep.definition import FILE as SWEEP
from touchdown.master.studies.sweep.results import Sweep
from touchdown.master.studies.sweep.results import read as read_sweep


def report(
    run: Result | Sweep | PathLike, path: PathLike | None = None, *, pdf: bool = False
) -> list[Path]:
    """Write the report of a run or a sweep, given itself or its folder, as one page; returns the files.

    `path`: of the page; None: report.html in the run's folder. pdf: print it, too, beside the page, by a
    Chromium on the PATH. The page needs nothing beside it. Raises TouchdownError where there is no such
    run, or it cannot be written or printed.

    >>> scene = touchdown.load("disk-caged-simplified").set({"run.duration": "10 ms"})
    >>> result = touchdown.run(scene, in_process=True)
    >>> [path.name for path in touchdown.report(result, "drop.html")]
    ['drop.html']
    """
    # matplotlib, which these import, is slow to come
    from touchdown.master.report.page.pdf import browser, print_page
    from touchdown.master.report.page.writing import PAGE, make_room, report_on, write_page
    from touchdown.master.report.sweeps import report_on_sweep

    if pdf:
        browser()  # first of all: a page takes seconds
    found = run if isinstance(run, (Result, Sweep)) else _read(Path(run))
    page = Path(path) if path else found.folder / PAGE
    make_room(page)
    write_page(report_on_sweep(found) if isinstance(found, Sweep) else report_on(found), page)
    return [page, print_page(page, page.with_suffix(".pdf"))] if pdf else [page]


def _read(folder: Path) -> Result | Sweep:
    """What a run or a sweep left in a folder. Raises TouchdownError where there is neither."""
    return read_sweep(folder) if os.path.isfile(folder / SWEEP) else open_result(folder)


def animate(run: Result | PathLike, path: PathLike | None = None, *, progress: bool = False) -> Path:
    """Draw the drop of a run, given its result or its folder, as a film, .gif or .mp4; returns its path.

    Rotor, ring, balls and cage turn, an arrow is the force on the journal, and the first impact goes
    slowly. `path`: None: drop.gif in the run's folder; progress: show a bar. An .mp4 takes ffmpeg, from the
    PATH or the extra `animate`. Raises TouchdownError where nothing touched, or the film cannot be made.

    >>> scene = touchdown.load("disk-caged-simplified").set({"run.duration": "8 ms"})
    >>> touchdown.animate(touchdown.run(scene, in_process=True), "drop.gif").name
    'drop.gif'
    """
    from touchdown.master.report.animation.film import checked_suffix, film_frames, write_film
    from touchdown.master.report.animation.motion import motions
    from touchdown.master.report.facts.subject import Subject
    from touchdown.master.report.page.blocks import Absent

    result = run if isinstance(run, Result) else open_result(run)
    film = Path(path) if path else result.folder / "drop.gif"
    checked_suffix(film)
    try:
        shown, lacking = motions(Subject(result))
    except Absent as absent:
        shown, lacking = [], [str(absent)]
    if not shown:
        raise TouchdownError(f"there is no drop to show: {' '.join(lacking) or 'no touchdown bearing'}")
    frames = len(film_frames(shown, film.suffix.lower()))
    with bar_over(frames, "frames", not progress) as bar:
        return write_film(shown, result.scene.title, film, bar.update)
