"""Lengths that cannot be meant: mostly millimetres that were read as metres.

The clearance of a touchdown bearing is 0.1 to 5 % of its journal's radius, play and indentation are less;
read in the wrong unit they are a thousand times that. Half of it lies between, and lets a bearing be opened
so wide that it is not touched.
"""

from __future__ import annotations

MOST = 0.5


def out_of_proportion(name: str, length: float, beside: str, size: float) -> str | None:
    """Why the `length` (m) of parameter `name` cannot be meant `beside` one of `size` (m), or None."""
    if abs(length) <= MOST * size:
        return None
    return (
        f"{name} = {length:g} m is out of all proportion to {beside} = {size:g} m; it may be half of that "
        f"at most. A plain number is in m; write '{length:g} mm' where mm are meant"
    )
