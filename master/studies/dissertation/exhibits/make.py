"""Exhibits made: one, or all with their drops shared."""

from __future__ import annotations

import tempfile
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path

from touchdown.master.common.errors import TouchdownError
from touchdown.master.common.progress import UNSEEN, Progress
from touchdown.master.results.figures.style import darkened, styled
from touchdown.master.studies.dissertation.exhibits.drops import Drops
from touchdown.master.studies.dissertation.exhibits.exhibit import Exhibit
from touchdown.master.studies.dissertation.exhibits.registry import Entry


@contextmanager
def dropping(jobs: int, progress: Progress = UNSEEN) -> Iterator[Drops]:
    """Drops whose recordings are gone at the end."""
    with tempfile.TemporaryDirectory(prefix="touchdown_") as folder:
        yield Drops(Path(folder), jobs, progress)


def make(entry: Entry, drops: Drops, dark: bool = False) -> Exhibit:
    """One exhibit. Raises TouchdownError where a run stops."""
    with styled():
        exhibit = entry.make(drops)
    if dark and exhibit.figure is not None:
        darkened(exhibit.figure)
    return exhibit


def make_all(
    entries: Iterable[Entry], drops: Drops, dark: bool = False
) -> dict[Entry, Exhibit | TouchdownError]:
    """All of them, each with what it is or why it failed; drops are run once."""
    made: dict[Entry, Exhibit | TouchdownError] = {}
    for entry in entries:
        try:
            made[entry] = make(entry, drops, dark)
        except TouchdownError as error:
            made[entry] = error
    return made
