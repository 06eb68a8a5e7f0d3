"""The members of a sweep as an xarray.Dataset."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import cast

import numpy as np
import xarray

from .definition import Column, Definition
from .members import Member
from .report import counted, keys

MEMBER = "member"
ENDED, FAILED = "ended", "failed"
LEFT_OUT_FIGURES = (
    "scene",
    "completed",
    "ended",
    "stopped_because",
)  # of a summary: said once for all, or above
UNIT = re.compile(r"_(m_s|rad_s|um|N|Hz|rpm|deg|J|MPa|s)(?=_|$)")  # in the name of a figure


def dataset(definition: Definition, members: Sequence[Member]) -> xarray.Dataset:
    """Settings (coordinates), figures, how each member ended and why it failed, over `member`.

    Settings are in SI, figures in the unit of their name; both have it as an attribute. A number that
    there is not is NaN, a word "". What changes from machine to machine, wall times, is not in it.
    """
    numbers = [member.number for member in members]
    rows = [definition.values[number - 1] for number in numbers]
    coordinates = {MEMBER: _column(numbers, long_name="number in the sweep")}
    for place, column in enumerate(definition.columns):
        coordinates[column.name] = _setting(column, [row[place] for row in rows])
    variables = {
        ENDED: _column([member.ended.value for member in members], long_name="how it ended"),
        FAILED: _column([member.failed for member in members], long_name="why it failed"),
    }
    for key in keys(members):
        if key not in LEFT_OUT_FIGURES:
            values = [counted(member.summary.get(key)) for member in members]
            name = key  # without that of the component it is of, which may look like a unit
            for component in definition.scene["components"]:
                name = name.removesuffix(f"_{component}")
            variables[key] = _figure(name, values)
    attributes = {
        "title": str(definition.scene["title"]),
        "scene": str(definition.scene["name"]),
        "design": definition.about,
        "version": definition.version,
    }
    return xarray.Dataset(variables, coordinates, attributes)


def _setting(column: Column, values: Sequence[object]) -> xarray.Variable:
    attributes = {"units": column.unit} if column.unit else {}
    return _column(values, **attributes, long_name=" and ".join(column.settings))


def _figure(key: str, values: Sequence[object]) -> xarray.Variable:
    """Words where any is, else numbers."""
    if any(isinstance(value, str) for value in values):
        return _column(["" if value is None else str(value) for value in values])
    numbers = [np.nan if value is None else float(cast(float, value)) for value in values]
    units = UNIT.findall(key)
    attributes = {"units": units[-1].replace("_", "/")} if units else {}
    return _column(numbers, **attributes)


def _column(values: Sequence[object], **attributes: str) -> xarray.Variable:
    kind = object if any(isinstance(value, str) for value in values) else None
    return xarray.Variable(MEMBER, np.array(values, dtype=kind), attributes)
