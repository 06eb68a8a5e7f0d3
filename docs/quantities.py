"""Write docs/quantities.md: all quantities of a run, by groups.

python docs/quantities.py
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from touchdown.master.quantities import TABLE, Group, Quantity
from touchdown.reports.numbers import capital

PAGE = Path(__file__).with_suffix(".md")
HEAD = """# Quantities

This page lists all quantities of a run; `docs/quantities.py` writes it from `master/quantities.py`. The
[summary](results.md#the-summary) of a run and the files of a sweep have those that there are, in SI; people
read them in the unit of the fourth column.
"""


def page() -> str:
    """The page's text."""
    return "\n".join([HEAD, *(line for group in Group for line in _of_group(group))])


def _of_group(group: Group) -> Iterator[str]:
    yield from (f"## {capital(group)}", "", "| key | of | SI | read in | words |", "|---|---|---|---|---|")
    yield from (_row(one) for one in TABLE if one.group is group)
    yield ""


def _row(one: Quantity) -> str:
    owner = one.owner.name.lower()
    return f"| `{one.key}` | {owner} | {one.unit} | {one.read_in} | {one.words} |"


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
