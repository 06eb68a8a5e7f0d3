"""The members of a sweep as an xarray.Dataset."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray

from ...master.common.text import joined
from ...master.quantities import Item
from .definition import Definition
from .members import Member
from .report import counted, items_of

MEMBER = "member"
ENDED, FAILED = "ended", "failed"
SAID = "scene", "completed", "ended", "stopped_because"  # of a run: once for all, or above


def dataset(definition: Definition, members: Sequence[Member]) -> xarray.Dataset:
    """Settings (coordinates), quantities, how each member ended and why it failed, over `member`.

    A quantity has the name of its path, such as seats.A.peak_contact_force. All is in SI, with its units as
    an attribute. A number that there is not is NaN, a word "". What differs from computer to computer, wall
    times, is not in it.
    """
    numbers = [member.number for member in members]
    rows = [definition.values[number - 1] for number in numbers]
    coordinates = {MEMBER: _column(numbers, long_name="number in the sweep")}
    for place, column in enumerate(definition.columns):
        values, attributes = [row[place] for row in rows], {"units": column.unit} if column.unit else {}
        coordinates[column.name] = _column(values, **attributes, long_name=joined(column.settings))
    variables = {
        ENDED: _column([member.ended.value for member in members], long_name="how it ended"),
        FAILED: _column([member.failed for member in members], long_name="why it failed"),
    }
    for item in items_of(members):
        if item.path not in SAID and not item.quantity.machine:
            variables[item.path] = _quantity(item, [counted(item.of(m.summary)) for m in members])
    attributes = {
        "title": str(definition.scene["title"]),
        "scene": str(definition.scene["name"]),
        "design": definition.about,
        "version": definition.version,
    }
    return xarray.Dataset(variables, coordinates, attributes)


def _quantity(item: Item, values: Sequence[Any]) -> xarray.Variable:
    """Words where any is, else numbers."""
    attributes = {"units": item.quantity.unit} if item.quantity.unit else {}
    if any(isinstance(value, str) for value in values):
        values = ["" if value is None else value for value in values]
    else:
        values = [np.nan if value is None else float(value) for value in values]
    return _column(values, **attributes, long_name=item.words)


def _column(values: Sequence[object], **attributes: str) -> xarray.Variable:
    kind = object if any(isinstance(value, str) for value in values) else None
    return xarray.Variable(MEMBER, np.array(values, dtype=kind), attributes)
