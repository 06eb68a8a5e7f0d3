"""The description of an FMU: whether it is valid and can be co-simulated here; its variables and units."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from contextlib import suppress
from functools import partial
from io import BytesIO
from itertools import product
from pathlib import Path
from typing import Any
from xml.etree.ElementTree import Element, ParseError, fromstring, iterparse, tostring
from xml.parsers import expat
from zipfile import ZipFile

from fmpy import platform as fmi_platform
from fmpy import platform_tuple, read_model_description, sharedLibraryExtension

from ...fmus.description.described_variables import element
from ...modelkit.variables import Causality, Variability
from ..common.errors import TouchdownError
from ..common.text import joined
from ..common.units import BASE, Unit, unbracketed
from .attributes import mend
from .component import FmiType, ScalarVariable
from .log import one_line
from .unpack import unpack

DESCRIPTION = "modelDescription.xml"
STRUCTURAL = "structuralParameter"  # FMI 3.0's: sizes of arrays
KINDS_2 = (FmiType.REAL, FmiType.INTEGER, FmiType.BOOLEAN, FmiType.STRING, FmiType.ENUMERATION)
KINDS_3 = {  # FMI 3.0's types, and the type here
    **dict.fromkeys(("Float64", "Float32"), FmiType.REAL),
    **dict.fromkeys(("Int8", "Int16", "Int32", "Int64"), FmiType.INTEGER),
    **dict.fromkeys(("UInt8", "UInt16", "UInt32", "UInt64"), FmiType.INTEGER),
    **{kind.value: kind for kind in FmiType if kind not in (FmiType.REAL, FmiType.INTEGER)},
}
MAX_LISTED_FILES = 5  # files named where one is missing
MAX_XML, MAX_TAG = 64e6, 1e6  # bytes of a file, and of a tag with its attributes
MAX_DEPTH = 200  # elements in each other
MAX_SCALARS = 500_000  # variables, elements of arrays counted one by one
PIECE = 2**16  # bytes of a file read at a time


def read_description(path: Path, folder: Path) -> Any:
    """fmpy's model description of an unpacked FMU that can be co-simulated here."""
    try:
        description = _read(folder)
    except Exception as error:
        lines = str(error).split("\n") if str(error).strip() else [type(error).__name__]
        reason = one_line("; ".join(line.strip() for line in lines if line.strip()))
        raise TouchdownError(f"{path}: cannot read its {DESCRIPTION} ({reason})") from None
    third = description.fmiVersion.startswith("3.")
    if not (third or description.fmiVersion == "2.0") or description.coSimulation is None:
        raise TouchdownError(
            f"{path} is FMI {description.fmiVersion}, {_purpose(description)}; FMI 2.0 or 3.0 for "
            "co-simulation is needed"
        )
    identifier = description.coSimulation.modelIdentifier
    _check_description(path, description)
    place = platform_tuple if third else fmi_platform
    library = folder / "binaries" / place / f"{identifier}{sharedLibraryExtension}"
    if not library.is_file():
        raise TouchdownError(
            f"{path} has no binary for this platform ({place}): it lacks {_held(library, folder)}"
        )
    return description


def _read(folder: Path) -> Any:
    """fmpy's model description, also where tools write what FMI does not allow."""
    root = read_xml(folder / DESCRIPTION)
    source: Any = str(folder)
    if mend(root):
        source = BytesIO()
        with ZipFile(source, "w") as archive:
            archive.writestr(DESCRIPTION, tostring(root))
    description = read_model_description(source, validate=False)
    described = {element.get("name"): element for element in root.iterfind("ModelVariables/*")}
    for variable in description.modelVariables:  # fmpy looks for it among the elements inside
        element = described.get(variable.name)
        inside = [] if element is None else [element, *element]
        if any(one.get("relativeQuantity") in ("true", "1") for one in inside):
            variable.relativeQuantity = True
    return description


def read_xml(path: Path) -> Element:
    """The root element of an XML file. Raises as `refuse_hostile` does, and ParseError."""
    refuse_hostile(path)
    return fromstring(path.read_bytes())


class HostileError(ValueError):
    """An XML file that takes more than it says, or reads other files."""


def refuse_hostile(path: Path) -> None:
    """Raise HostileError where an XML file could define entities, or is large, deep, or of endless tags.

    A parser finds them in the encoding that the file states, a tag before it is whole. Raises ExpatError,
    ValueError or LookupError where the file is not XML, OSError where it cannot be read.
    """

    def refuse(*_: Any) -> None:
        raise HostileError("it declares a document type, which FMI and SSP have no use for")

    def move(by: int, *_: object) -> None:
        nonlocal depth
        depth += by
        if depth > MAX_DEPTH:
            raise HostileError(f"its elements lie more than {MAX_DEPTH} deep in each other")

    depth = 0
    parser = expat.ParserCreate()
    parser.StartDoctypeDeclHandler = refuse
    parser.StartElementHandler = partial(move, 1)
    parser.EndElementHandler = partial(move, -1)
    with path.open("rb") as file:
        while piece := file.read(PIECE):
            parser.Parse(piece, False)
            if file.tell() > MAX_XML:
                raise HostileError(f"it has more than {MAX_XML / 1e6:.0f} MB")
            if file.tell() - parser.CurrentByteIndex > MAX_TAG:
                raise HostileError(f"a tag of it has more than {MAX_TAG / 1e6:.0f} MB")
    parser.Parse(b"", True)


def _check_description(path: Path, description: Any) -> None:
    """Raise TouchdownError where names or value references are not valid.

    `description` is fmpy's, `path` that of the FMU.
    """
    identifier = description.coSimulation.modelIdentifier or ""
    if not re.fullmatch(r"[A-Za-z_]\w*", identifier, re.ASCII):
        raise TouchdownError(f"{path}: the modelIdentifier {identifier!r} is not a name of a library")
    third = description.fmiVersion.startswith("3.")
    scalars = sum(math.prod(v.shape or ()) for v in description.modelVariables)
    if scalars > MAX_SCALARS:
        raise TouchdownError(f"{path} has {scalars} variables, more than {MAX_SCALARS}; refused")
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


def _purpose(description: Any) -> str:
    """The interface that an FMU is made for."""
    if description.coSimulation is not None:
        return "co-simulation"
    scheduled = getattr(description, "scheduledExecution", None) is not None
    return "scheduled execution only" if scheduled else "model exchange only"


def _held(library: Path, folder: Path) -> str:
    """Where the `library` of an FMU that is unpacked in `folder` should be, and which it has instead."""
    held = sorted(p.relative_to(folder).as_posix() for p in (folder / "binaries").rglob("*") if p.is_file())
    return f"{library.relative_to(folder)}, and has {joined(held, most=MAX_LISTED_FILES) or 'none'}"


def fmi_version(path: Path, cache: Path) -> str:
    """The version of FMI that an FMU states; "" where its description cannot be read.

    Raises TouchdownError where it cannot be unpacked.
    """
    described = unpack(path, cache) / DESCRIPTION
    with suppress(OSError, ParseError, expat.ExpatError, ValueError, LookupError):
        refuse_hostile(described)
        _, root = next(iterparse(described, ("start",)))
        return root.get("fmiVersion", "")
    return ""


def made_by_pythonfmu(description: Any) -> bool:
    """Whether an FMU was made by pythonfmu."""
    return "PythonFMU" in (description.generationTool or "")


def variables_of(description: Any) -> dict[str, ScalarVariable]:
    """Variables by name. An array of FMI 3.0 is one scalar for each element (`element`)."""
    third = description.fmiVersion.startswith("3.")
    return {
        scalar.name: scalar
        for v in description.modelVariables
        for scalar in _scalars(v, KINDS_3[v.type] if third else FmiType(v.type))
    }


def _scalars(v: Any, kind: FmiType) -> Iterator[ScalarVariable]:
    """The scalars of one variable of the description, as fmpy read it."""
    known = (
        v.causality if v.causality != STRUCTURAL else None
    )  # it could be set in a mode that this master does not enter
    starts = str(v.start).split() if v.shape and v.start is not None else [v.start]
    for number, index in enumerate(product(*(range(1, size + 1) for size in v.shape or ()))):
        yield ScalarVariable(
            name=element(v.name, index),
            reference=v.valueReference,
            kind=kind,
            causality=Causality(known or Causality.LOCAL),
            variability=Variability(v.variability or Variability.CONTINUOUS),
            unit=_unit(v) if kind is FmiType.REAL else "1",
            minimum=_number(v.min or (v.declaredType and v.declaredType.min)),
            maximum=_number(v.max or (v.declaredType and v.declaredType.max)),
            start=_start(starts[number] if number < len(starts) else (starts or [None])[-1], kind),
            description=v.description or "",
            element=number,
            choices=_choices(v) if kind is FmiType.ENUMERATION else {},
            relative=bool(v.relativeQuantity or (v.declaredType and v.declaredType.relativeQuantity)),
            structural=v.causality == STRUCTURAL,
            starts=v.initial in ("exact", "approx") and v.variability != Variability.CONSTANT,
        )


def _unit(v: Any) -> str | None:
    unit = v.unit or (v.declaredType.unit if v.declaredType else None)
    return unit and unbracketed(unit)


def _choices(v: Any) -> dict[str, int]:
    """Words of an enumeration, and the numbers they stand for."""
    items = v.declaredType.items if v.declaredType else ()
    numbers = {item.name: _number(item.value) for item in items if item.name}
    return {word: int(n) for word, n in numbers.items() if n is not None and math.isfinite(n)}


def _start(text: object, kind: FmiType) -> float | None:
    """A start value as a number; None for other text, such as the start of a String."""
    words = {"true": 1.0, "false": 0.0} if kind is FmiType.BOOLEAN else {}
    return None if kind is FmiType.STRING else words.get(str(text), _number(text))


def _number(text: object) -> float | None:
    try:
        return None if text is None else float(str(text))
    except ValueError:
        return None


def defined_units(description: Any) -> dict[str, Unit]:
    """Units that the description defines by SI base units, by name."""
    units: dict[str, Unit] = {}
    for unit in description.unitDefinitions:
        base = unit.baseUnit
        if base is not None:
            exponents = {symbol: getattr(base, symbol) for symbol in BASE if getattr(base, symbol)}
            units[unbracketed(unit.name)] = Unit(exponents, float(base.factor), float(base.offset))
    return units


def seconds(declared: object) -> float | None:
    """A declared length of time (s); None where it is not one above 0."""
    length = _number(declared)
    return length if length is not None and 0.0 < length < math.inf else None


def steps_of(description: Any) -> tuple[float | None, float | None]:
    """The steps (s) that an FMU declares: those that it takes inside, and the macro step it is made for."""
    experiment = description.defaultExperiment
    inner = seconds(getattr(description.coSimulation, "fixedInternalStepSize", None))
    return inner, seconds(experiment.stepSize if experiment else None)


def interface(path: Path, cache: Path) -> tuple[dict[str, ScalarVariable], dict[str, Unit], float | None]:
    """Variables, units and proposed macro step (s) of an FMU, which is not loaded."""
    description = read_description(path, unpack(path, cache))
    inner, proposed = steps_of(description)
    return variables_of(description), defined_units(description), inner or proposed
