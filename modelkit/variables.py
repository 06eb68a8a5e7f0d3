"""Variables, declared once.

A model states its parameters, inputs and outputs as frozen dataclasses whose fields are made by
`real`, `integer`, `choice`, `group` or `groups`. Everything else is derived from them: the memory layout
a kernel reads (``p.contact.stiffness``), the FMU's XML, bounds checks, tables and column headers.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable
from dataclasses import dataclass, field, fields
from enum import StrEnum
from typing import Any

import numpy as np

from . import messages


class Scalar(StrEnum):
    """Types of the scalars that a model declares."""

    REAL = "real"
    INTEGER = "integer"


class Causality(StrEnum):
    """The causality of a variable in FMI 2.0; a model has parameters, inputs and outputs."""

    PARAMETER = "parameter"
    CALCULATED_PARAMETER = "calculatedParameter"
    INPUT = "input"
    OUTPUT = "output"
    LOCAL = "local"
    INDEPENDENT = "independent"


class Variability(StrEnum):
    """When FMI 2.0's variables may change."""

    CONSTANT = "constant"
    FIXED = "fixed"
    TUNABLE = "tunable"
    DISCRETE = "discrete"
    CONTINUOUS = "continuous"


@dataclass(frozen=True)
class Choices:
    """Meanings of whole numbers in words, the first for 0. `name` is that of FMI's type."""

    name: str
    words: tuple[str, ...]
    meanings: tuple[str, ...] = ()  # where words do not say it all


SWITCH = Choices("Switch", ("off", "on"))


@dataclass(frozen=True)
class Spec:
    """The declaration of one scalar beside its name and default."""

    kind: Scalar
    unit: str
    meaning: str
    minimum: float | None = None
    maximum: float | None = None
    above: float | None = None  # exclusive lower bound
    nominal: float | None = None
    local: bool = False  # a diagnostic, not part of the coupling
    constant: bool = False  # fixed once initialised
    tunable: bool = False  # a parameter that may be set between macro steps
    shown: str | None = None  # unit to show it in, where its size does not tell
    choices: Choices | None = None
    needs: str = ""  # what a parameter needs to act (`modelkit.needs`)


@dataclass(frozen=True)
class Variable:
    """One scalar of a model: full dotted name, declaration, default.

    needs: of its groups and its own, each after the name of what declares it.
    """

    name: str
    spec: Spec
    default: float
    needs: tuple[tuple[str, str], ...] = ()

    def problem(self, value: float) -> str | None:
        """Why `value` is not allowed, or None."""
        s, value = self.spec, float(value)
        unit = "" if s.unit == "1" else f" {s.unit}"
        if not math.isfinite(value):
            return messages.NOT_FINITE.format(name=self.name, value=value)
        if s.above is not None and not value > s.above:
            return messages.NOT_ABOVE.format(name=self.name, value=value, bound=s.above, unit=unit)
        if s.minimum is not None and value < s.minimum:
            return messages.TOO_SMALL.format(name=self.name, value=value, bound=s.minimum, unit=unit)
        if s.maximum is not None and value > s.maximum:
            return messages.TOO_LARGE.format(name=self.name, value=value, bound=s.maximum, unit=unit)
        return None


def real(default: float, unit: str, meaning: str, **bounds: Any) -> Any:
    """Declare a float64 scalar; `bounds` are the optional fields of `Spec`."""
    return field(default=default, metadata={"spec": Spec(Scalar.REAL, unit, meaning, **bounds)})


def integer(default: int, meaning: str, **bounds: Any) -> Any:
    """Declare an int64 scalar (a count)."""
    return field(default=default, metadata={"spec": Spec(Scalar.INTEGER, "1", meaning, **bounds)})


def choice(default: int, choices: Choices, meaning: str, needs: str = "", tunable: bool = False) -> Any:
    """Declare an int64 scalar that is one of `choices`."""
    words = ", ".join(f"{number} {word}" for number, word in enumerate(choices.words))
    most = len(choices.words) - 1
    bounds: dict[str, Any] = {"minimum": 0, "maximum": most, "choices": choices, "needs": needs}
    return integer(default, f"{meaning}: {words}", tunable=tunable, **bounds)


def array(*shape: int) -> Any:
    """Declare a float64 array; only for values derived from parameters, never exposed."""
    return field(default_factory=lambda: np.zeros(shape), metadata={"array": shape})


def group(kind: type, needs: str = "", **changes: Any) -> Any:
    """Declare a nested group of variables, its defaults changed by `changes`; `needs`: of all of them."""
    value = kind(**changes)
    return field(default_factory=lambda: value, metadata={"group": kind, "needs": needs})


def groups(kind: type, count: int, needs: str = "") -> Any:
    """Declare `count` groups of the same kind, NAME[1] to NAME[count]; kernels count them from 0."""
    value = (kind(),) * count
    return field(default_factory=lambda: value, metadata={"groups": kind, "count": count, "needs": needs})


@dataclass(frozen=True)
class Nothing:
    """The empty set of variables."""


def _own(name: str) -> Any:
    return property(lambda self: self[name], lambda self, value: self.__setitem__(name, value))


class MemoryRecord(np.record):
    """Fields that Python reads and sets as kernels do, those named as numpy's attributes are, too."""

    size, shape, base, flat, sum = map(_own, ("size", "shape", "base", "flat", "sum"))


def dtype_of(parts: Any) -> np.dtype:
    """The dtype of records with these fields, as numpy takes them, for kernels and for Python."""
    return np.dtype((MemoryRecord, parts))


ALIGNMENT = 64  # bytes; of vectors of numbers, as compiled code takes them


def layout(kind: type, aligned: bool = False) -> np.dtype:
    """Structured dtype of a declaration, nested like it; every leaf is 8 bytes wide.

    aligned: arrays lie a multiple of `ALIGNMENT` apart. A loop that writes to one and reads from another
    becomes vector code only so.
    """
    forms: dict[str, Any] = {}
    offsets: list[int] = []
    end, widest = 0, 8
    for f in fields(kind):
        inner = f.metadata.get("group", f.metadata.get("groups"))
        if inner is not None:
            form: Any = layout(inner, aligned)
            form = np.dtype((form, (f.metadata["count"],))) if "groups" in f.metadata else form
        elif "array" in f.metadata:
            form = np.dtype(("f8", f.metadata["array"]))
        else:
            form = np.dtype("f8" if f.metadata["spec"].kind is Scalar.REAL else "i8")
        apart = ALIGNMENT if aligned and (inner is not None or "array" in f.metadata) else 8
        forms[f.name] = form
        offsets.append(-(-end // apart) * apart)
        end, widest = offsets[-1] + form.itemsize, max(widest, apart)
    size = -(-end // widest) * widest
    return dtype_of({"names": [*forms], "formats": [*forms.values()], "offsets": offsets, "itemsize": size})


def flatten(instance: Any, prefix: str = "", needs: tuple[tuple[str, str], ...] = ()) -> list[Variable]:
    """The scalars of a declaration in memory order, with dotted names; arrays are left out.

    needs: of the groups around it.
    """
    scalars: list[Variable] = []
    for f in fields(instance):
        value = getattr(instance, f.name)
        name, spec = f"{prefix}{f.name}", f.metadata.get("spec")
        members = enumerate(value, 1) if "groups" in f.metadata else [(0, value)]
        for i, member in members:
            full_name = f"{name}[{i}]" if i else name
            said = spec.needs if spec else f.metadata.get("needs")
            all_needs = (*needs, (full_name, said)) if said else needs
            if spec:
                scalars.append(Variable(full_name, spec, member, all_needs))
            elif "array" not in f.metadata:
                scalars += flatten(member, f"{full_name}.", all_needs)
    return scalars


def as_tuple(instance: Any) -> tuple:
    """Values of a declaration, nested as `layout` nests them."""

    def nested(f: Any) -> Any:
        value = getattr(instance, f.name)
        if "groups" in f.metadata:
            return [as_tuple(member) for member in value]
        return as_tuple(value) if dataclasses.is_dataclass(value) else value

    return tuple(nested(f) for f in fields(instance))


def as_record(instance: Any) -> Any:
    """A declaration's values as a record that kernels read (numpy record scalar)."""
    return np.array([as_tuple(instance)], dtype=layout(type(instance)))[0]


def from_record(kind: type, record: Any) -> Any:
    """The declaration of type `kind` with the values of `record`."""
    values: dict[str, Any] = {}
    for f in fields(kind):
        value = record[f.name]
        if "group" in f.metadata:
            values[f.name] = from_record(f.metadata["group"], value)
        elif "groups" in f.metadata:
            values[f.name] = tuple(from_record(f.metadata["groups"], member) for member in value)
        elif "array" in f.metadata:
            values[f.name] = np.array(value)
        else:
            values[f.name] = float(value) if f.metadata["spec"].kind is Scalar.REAL else int(value)
    return kind(**values)


def from_values(kind: type, value: Callable[[str], float], prefix: str = "") -> Any:
    """The declaration of type `kind` with what `value` gives by dotted names that begin with `prefix`."""
    values: dict[str, Any] = {}
    for f in fields(kind):
        name, members = f"{prefix}{f.name}", range(1, f.metadata.get("count", 0) + 1)
        if "group" in f.metadata:
            values[f.name] = from_values(f.metadata["group"], value, f"{name}.")
        elif members:
            members_read = (from_values(f.metadata["groups"], value, f"{name}[{i}].") for i in members)
            values[f.name] = tuple(members_read)
        else:
            real = f.metadata["spec"].kind is Scalar.REAL
            values[f.name] = value(name) if real else int(value(name))
    return kind(**values)
