"""The FMI versions of a native FMU: its functions in C, its description, its files."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from xml.etree.ElementTree import Element

from pythonfmu import Fmi2Slave

from ...modelkit.model import Model, Slot, slots
from ..description import fmi2, fmi3
from ..description.described_variables import Making, arrays, scalars, time_reference
from .c_tables import access, by_word, hidden
from .compiler import NativeError, Target, library_folders, places_3


@dataclass(frozen=True)
class FmiVersion:
    """A version of FMI."""

    version: int
    source: str  # its side, of the files in C
    categories: Mapping[str, str]  # of what goes to the host's log
    variables: Callable[[Model], Mapping[str, Slot]]  # by name; the first element stands for an array
    documented: Callable[[Model], Sequence[Slot]]  # as its pages list them
    described: Callable[[Model, str, Mapping[str, str], Making], Element]  # modelDescription.xml
    places: Callable[[tuple[Target, ...]], dict[str, Target]]  # in binaries/, and whose library lies there
    tables: Callable[[Model], dict[str, str]]  # in C, by members of MODEL: what references stand for


def _scalars(model: Model) -> dict[str, str]:
    allowed = {slot.index: access(slot) for slot in scalars(model).values()}
    return {"access": by_word("uint8_t", "ACCESS", hidden(model), allowed)}


def _with_sizes(model: Model) -> list[Slot]:
    """One for each array, whose name ends with its size."""
    named: list[Slot] = []
    for array in arrays(model):
        size = "" if array.dimension is None else f"[{array.dimension}]"
        variable = replace(array.first.variable, name=f"{array.name}{size}")
        named.append(replace(array.first, variable=variable))
    return named


def _arrays(model: Model) -> dict[str, str]:
    time = time_reference(model)
    if "time" in scalars(model):
        raise NativeError(f"{model.name} has a variable called time, as FMI 3.0 has; choose another name")
    allowed, extents = {time: "REAL | INDEPENDENT"}, {time: "{1, 0}"}
    for array in arrays(model):
        place = array.first.index
        allowed[place] = access(array.first)
        extents[place] = f"{{{len(array.elements)}, {array.stride}}}"
    end = hidden(model)
    return {
        "access": by_word("uint8_t", "ACCESS", end, allowed),
        "extents": by_word("Extent", "EXTENTS", end, extents),
    }


FMI_2 = FmiVersion(
    2, "fmi2.c", Fmi2Slave.log_categories, scalars, slots, fmi2.describe_fmi2, library_folders, _scalars
)
FMI_3 = FmiVersion(
    3,
    "fmi3.c",
    {"logStatusDiscard": "A smaller step may be possible.", "logStatusError": "What went wrong."},
    lambda model: {array.name: array.first for array in arrays(model)},
    _with_sizes,
    fmi3.describe_fmi3,
    places_3,
    _arrays,
)
INTERFACES = {face.version: face for face in (FMI_2, FMI_3)}
