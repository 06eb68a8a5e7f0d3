"""Reports on runs."""

from __future__ import annotations

from pathlib import Path

from touchdown.master.api.scenes import PathLike
from touchdown.master.results.folder.reopened import reopened
from touchdown.master.results.result import Result


def report(run: Result | PathLike, path: PathLike | None = None) -> list[Path]:
    """Write a run's report; returns the files."""
    from touchdown.master.report.page import PAGE, report_on, write_page

    result = run if isinstance(run, Result) else reopened(Path(run))
    return [write_page(report_on(result), Path(path) if path else result.folder / PAGE)]
