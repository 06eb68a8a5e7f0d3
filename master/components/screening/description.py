"""What a model description must not say: it decides which library is loaded and which memory is written."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any
from xml.parsers import expat

from touchdown.master.common.errors import TouchdownError
from touchdown.master.components.component import Kind
from touchdown.modelkit.variables import Causality, Variability

STRUCTURAL = "structuralParameter"  # FMI 3.0's: sizes of arrays
KINDS_2 = (Kind.REAL, Kind.INTEGER, Kind.BOOLEAN, Kind.STRING, Kind.ENUMERATION)
KINDS_3 = {  # FMI 3.0's types, and what they are here
    **dict.fromkeys(("Float64", "Float32"), Kind.REAL),
    **dict.fromkeys(("Int8", "Int16", "Int32", "Int64"), Kind.INTEGER),
    **dict.fromkeys(("UInt8", "UInt16", "UInt32", "UInt64"), Kind.INTEGER),
    **{kind.value: kind for kind in (Kind.BOOLEAN, Kind.STRING, Kind.ENUMERATION, Kind.BINARY, Kind.CLOCK)},
}


class DocumentTypeError(ValueError):
    """An XML file that declares a document type."""


def refuse_definitions(path: Path) -> None:
    """Raise DocumentTypeError where an XML file could define entities: they read files or never end.

    Found by a parser, in whatever encoding it stands. Raises ExpatError, ValueError or LookupError for what
    is no XML, OSError for what cannot be read.
    """

    def refuse(*_: Any) -> None:
        raise DocumentTypeError("it declares a document type, which FMI and SSP have no use for")

    parser = expat.ParserCreate()
    parser.StartDoctypeDeclHandler = refuse
    parser.Parse(path.read_bytes(), True)


def refuse_lies(path: Path, description: Any) -> None:
    """Raise TouchdownError where names or value references cannot be what they are for.

    `description` is fmpy's, `path` that of the FMU.
    """
    identifier = description.coSimulation.modelIdentifier or ""
    if not re.fullmatch(r"[A-Za-z_]\w*", identifier, re.ASCII):
        raise TouchdownError(f"{path}: the modelIdentifier {identifier!r} is no name of a library")
    third = description.fmiVersion.startswith("3.")
    names: set[str] = set()
    owners: dict[tuple[str, int], str] = {}
    for v in description.modelVariables:
        what = f"{path}: variable {v.name}"
        if v.name in names:
            raise TouchdownError(f"{what} is declared twice")
        names.add(v.name)
        if not 0 <= v.valueReference < 2**32:
            raise TouchdownError(f"{what} has the value reference {v.valueReference}; it must fit 32 bits")
        _refuse_unknown(what, v, third)
        if v.causality in (Causality.PARAMETER, Causality.INPUT):
            other = owners.setdefault((v.type, v.valueReference), v.name)
            if other != v.name:
                raise TouchdownError(
                    f"{what} and {other} can both be set and share the value reference {v.valueReference}"
                )


def _refuse_unknown(what: str, variable: Any, third: bool) -> None:
    """Raise TouchdownError where a variable is of a type, causality or variability that FMI lacks."""
    for title, stated, known in (
        ("type", variable.type, KINDS_3 if third else KINDS_2),
        ("causality", variable.causality, [*Causality, STRUCTURAL] if third else Causality),
        ("variability", variable.variability, Variability),
    ):
        if stated is not None and stated not in list(map(str, known)):
            version = "3.0" if third else "2.0"
            raise TouchdownError(f"{what} has the {title} {stated}; FMI {version} has {', '.join(known)}")
