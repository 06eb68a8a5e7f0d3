"""Lengths that cannot be meant: mostly millimetres that were read as metres.

The clearance of a touchdown bearing is 0.1 to 5 % of its journal's radius, play and indentation are less;
read in the wrong unit they are a thousand times that. Half of it lies between, and lets a bearing be opened
so wide that it is not touched.
"""

from __future__ import annotations

from touchdown.modelkit.kernel import kernel

MOST = 0.5


def problem(name: str, beside: str) -> str:
    """What is wrong where the length `name` is `out_of_proportion` to `beside`."""
    return (
        f"{name} = {{0:g}} m is out of all proportion to {beside} = {{1:g}} m; it may be half of that "
        "at most. A plain number is in m; write '{0:g} mm' where mm are meant"
    )


@kernel
def out_of_proportion(length, size, told):
    """Whether a `length` cannot be meant beside one of `size` (m); told: `Model`'s m.told."""
    if abs(length) <= MOST * size:
        return False
    told[0], told[1] = length, size
    return True
