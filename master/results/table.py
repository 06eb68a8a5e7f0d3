"""Quantities of a run as text: grouped, several seats side by side."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import groupby
from typing import Any

from ..common.text import aligned
from ..quantities import INVALID, Item, Owner, owned, summary_items

WIDEST = 24  # of a value beside others; a longer one has a line of its own
SINGLE = (Owner.SEAT, Owner.COMPONENT)  # of which a single one need not be named


def result_table(summary: Mapping[str, Any], everything: bool = True) -> str:
    """The quantities by groups, in the units in which people read them.

    Without `everything` those of the drop that there are. What several seats, components or gaps have
    stands in a row, their names over the columns.
    """
    found = summary_items(summary)
    if not everything:
        found = [i for i in found if not i.quantity.detail and i.of(summary) is not None]
    width = max(len(i.head) for i in found) + 2
    lines: list[str] = []
    for group, of_group in groupby(found, lambda i: i.quantity.group):
        lines.append(group)
        for owner, members in groupby(of_group, lambda i: i.quantity.owner):
            lines += _rows(owner, list(members), summary, width)
    return "\n".join(lines)


def _rows(owner: Owner, members: Sequence[Item], summary: Mapping[str, Any], width: int) -> Iterator[str]:
    """Lines of quantities of one owner; `width`: of what they are called."""
    there, shown_here = list(owned(summary, owner)), {i.name for i in members}
    names = [name for name in there if name in shown_here]
    if len(names) == 1:
        alone = owner in SINGLE and len(there) == 1
        for i in members:
            yield f"  {i.quantity.head if alone else i.head:<{width}}{shown_value(i, summary)}"
        return
    texts = {head: {i.name: shown_value(i, summary) for i in same}
             for head, same in groupby(members, lambda i: i.quantity.head)}  # fmt: skip
    beside = {head: row for head, row in texts.items() if all(len(text) <= WIDEST for text in row.values())}
    if beside:
        rows = [(head, *(row.get(name, "") for name in names)) for head, row in beside.items()]
        yield from aligned([("".ljust(width - 2), *names), *rows], indent="  ")
    for i in members:
        if i.quantity.head not in beside:
            yield f"  {i.head:<{width}}{shown_value(i, summary)}"


def shown_value(item: Item, summary: Mapping[str, Any]) -> str:
    """A value as text, in the unit in which people read it; of a list how many it has."""
    value = item.of(summary)
    if value is None:
        return "-"
    if item.path in (summary.get(INVALID) or ()):
        return f"{_shown(value, item)} (not valid)"
    return _shown(value, item)


def _shown(value: Any, item: Item) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, list):
        return str(len(value))
    if isinstance(value, float):
        read = item.quantity.factor * value
        return f"{round(read, 9) if item.quantity.shown_in else read:.6g}"  # less is rounding
    return str(value)
