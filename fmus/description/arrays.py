"""Variables as FMI 3.0 has them: a member of all modes, or of all balls, is one array.

`journal.mode[1].x` to `journal.mode[20].x` become `journal.mode.x` of 20. Where an array's elements lie in
memory, one record apart, does not change; its value reference is the place of the first.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from touchdown.modelkit.model import Model, Slot, slots

TIME = 0  # value reference of the independent variable: the time is the first word of the memory
_INDEX = re.compile(r"\[\d+\]")


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
        found.setdefault(_INDEX.sub("", slot.variable.name), []).append(slot)
    return tuple(_array(name, elements) for name, elements in found.items())


def _array(name: str, elements: list[Slot]) -> Array:
    scalar = elements[0].variable.name == name
    made = Array(name, tuple(elements), None if scalar else len(elements))
    places = [slot.index for slot in elements]
    assert places == [made.first.index + k * made.stride for k in range(len(elements))]
    return made
