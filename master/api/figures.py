"""Figures and tables of the source by name."""

from __future__ import annotations

from touchdown.master.common.progress import growing_bar
from touchdown.master.studies.dissertation.exhibits.exhibit import Exhibit
from touchdown.master.studies.dissertation.exhibits.make import dropping, make
from touchdown.master.studies.dissertation.exhibits.registry import entry


def figure(name: str | int, *, dark: bool = False, jobs: int = 2, progress: bool = False) -> Exhibit:
    """A figure or table of the source as it comes out here: its picture, and rows beside its values.

    name: such as 25 or "table7"; `touchdown figure` lists them. Returns `figure` (matplotlib's; None for
    some tables), `rows` (each with what, source, ours, deviation, verdict) and `notes` (what is assumed).
    What it needs is run, `jobs` drops at a time in processes of their own: a script needs
    `if __name__ == "__main__":` around it. dark: on a dark ground. Raises TouchdownError for a figure that
    the models do not give, and where a run stops; Ctrl-C raises KeyboardInterrupt.

    >>> picture, rows, notes = touchdown.figure("table1")
    >>> print(rows[4].what, rows[4].source, rows[4].ours)
    6904: pitch diameter [mm] 26.1 28.5
    >>> rows[4].verdict
    'differs: 17 balls do not fit on 26.1 mm; mean of bore and outside diameter'
    """
    chosen = entry(str(name))
    with growing_bar("drops", not progress) as growing, dropping(jobs, growing) as drops:
        return make(chosen, drops, dark)
