"""Reports on runs, and moving pictures of them."""

from __future__ import annotations

from pathlib import Path

from touchdown.master.api.run import open_result
from touchdown.master.api.scenes import PathLike
from touchdown.master.results.result import Result


def report(run: Result | PathLike, path: PathLike | None = None, *, pdf: bool = False) -> list[Path]:
    """Write the report of a run, given its result or its folder, as one page; returns the files.

    `path`: of the page; None: report.html in the run's folder. pdf: print it, too, beside the page, by a
    Chromium on the PATH. The page needs nothing beside it. Raises TouchdownError where there is no such run,
    or it cannot be written or printed.

    >>> scene = touchdown.load("disk-caged-simplified").set({"run.duration": "10 ms"})
    >>> result = touchdown.run(scene, in_process=True)
    >>> [path.name for path in touchdown.report(result, "drop.html")]
    ['drop.html']
    """
    from touchdown.master.report.page import PAGE, report_on, write_page  # matplotlib is slow to import
    from touchdown.master.report.pdf import browser, print_page

    if pdf:
        browser()  # first of all: a page takes seconds
    result = run if isinstance(run, Result) else open_result(run)
    page = write_page(report_on(result), Path(path) if path else result.folder / PAGE)
    return [page, print_page(page, page.with_suffix(".pdf"))] if pdf else [page]
