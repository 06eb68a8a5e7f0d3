"""Variables as FMI 3.0 has them: a member of all modes, balls or nodes is one array.

`journal.mode[1].x` to `journal.mode[20].x` become `journal.mode.x` of 20. Where an array's elements lie in
memory, one record apart, does not change; its value reference is the place of the first.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Any

from touchdown.modelkit.model import Model, Slot, slots

SEVERAL = ("mode", "ball", "node")  # groups whose members become arrays, and elements of those again
_ELEMENT = re.compile(rf"((?:.*\.)?(?:{'|'.join(SEVERAL)}))\[\d+\]\.(\w+)")


@dataclass(frozen=True)
class Array:
    """A variable: a scalar, or the elements of an array, which differ in their start values alone."""

    name: str
    elements: tuple[Slot, ...]
    dimension: int | None  # None: a scalar

    @property
    def first(self) -> Slot:
        """What stands for all of them."""
        return self.elements[0]

    @property
    def stride(self) -> int:
        """Words from one element to the next."""
        return self.elements[1].index - self.first.index if len(self.elements) > 1 else 0


def arrays(model: Model) -> tuple[Array, ...]:
    """All exposed variables of `model`, in the order of their first elements."""
    found: dict[str, list[Slot]] = {}
    for slot in slots(model):
        found.setdefault(_array_of(slot.variable.name), []).append(slot)
    return tuple(_array(name, elements) for name, elements in found.items())


def element(array: str, index: tuple[int, ...]) -> str:
    """Name of an array's element: x[2], x[1,2], mode[2].x of mode.x, as in FMI 2.0; of a scalar: ()."""
    counted = f"[{','.join(map(str, index))}]" if index else ""
    group, _, member = array.rpartition(".")
    if group.rpartition(".")[2] in SEVERAL:
        return f"{group}{counted}.{member}"
    return f"{array}{counted}"


def time_reference(model: Model) -> int:
    """Value reference of the independent variable: the place of the time in memory."""
    fields: Any = model.memory.fields
    return fields["time"][1] // 8


def _array_of(name: str) -> str:
    match = _ELEMENT.fullmatch(name)
    return f"{match[1]}.{match[2]}" if match else name


def _array(name: str, elements: list[Slot]) -> Array:
    scalar = elements[0].variable.name == name
    return Array(name, tuple(elements), None if scalar else len(elements))
