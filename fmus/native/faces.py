"""What makes a native FMU one of FMI 2.0 or of FMI 3.0: its side in C, its description, its places."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from xml.etree.ElementTree import Element

from pythonfmu import Fmi2Slave

from touchdown.fmus.description import fmi2, fmi3
from touchdown.fmus.description.arrays import TIME, arrays
from touchdown.fmus.description.making import Making
from touchdown.fmus.description.variables import scalars
from touchdown.fmus.native.tables import access, by_word, hidden
from touchdown.fmus.native.targets import Target, places, places_3
from touchdown.modelkit.model import Model, Slot


@dataclass(frozen=True)
class Face:
    """A version of FMI."""

    version: int
    source: str  # its side, of the files in C
    categories: Mapping[str, str]  # of what goes to the host's log
    variables: Callable[[Model], Mapping[str, Slot]]  # by name; the first element stands for an array
    described: Callable[[Model, str, Mapping[str, str], Making], Element]
    places: Callable[[tuple[Target, ...]], dict[str, Target]]  # in binaries/, and whose library lies there
    tables: Callable[[Model], dict[str, str]]  # in C, by members of MODEL: what references stand for

    def describe(self, model: Model, identifier: str, making: Making) -> Element:
        """modelDescription.xml."""
        return self.described(model, identifier, self.categories, making)


def _scalars(model: Model) -> dict[str, str]:
    allowed = {slot.index: access(slot) for slot in scalars(model).values()}
    return {"access": by_word("uint8_t", "ACCESS", hidden(model), allowed)}


def _arrays(model: Model) -> dict[str, str]:
    allowed, extents = {TIME: "REAL | OUTPUT"}, {TIME: "{1, 0}"}
    for array in arrays(model):
        place = array.first.index
        allowed[place] = access(array.first)
        extents[place] = f"{{{len(array.elements)}, {array.stride}}}"
    end = hidden(model)
    return {
        "access": by_word("uint8_t", "ACCESS", end, allowed),
        "extents": by_word("Extent", "EXTENTS", end, extents),
    }


FMI_2 = Face(2, "fmi2.c", Fmi2Slave.log_categories, scalars, fmi2.describe, places, _scalars)
FMI_3 = Face(
    3,
    "fmi3.c",
    {"logStatusDiscard": "A smaller step may be possible.", "logStatusError": "What went wrong."},
    lambda model: {array.name: array.first for array in arrays(model)},
    fmi3.describe,
    places_3,
    _arrays,
)
FACES = {face.version: face for face in (FMI_2, FMI_3)}
