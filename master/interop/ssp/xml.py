"""XML of a package: names of the formats, and a careful reader."""

from __future__ import annotations

import math
from pathlib import Path
from urllib.parse import unquote
from xml.etree.ElementTree import Element, ParseError
from xml.parsers.expat import ExpatError

from ...common.errors import TouchdownError
from ...common.units import BASE, Scale, Unit, unbracketed
from ...components.description import HostileError
from ...components.description import read_xml as read_file

_STANDARD = "http://ssp-standard.org/SSP1/SystemStructure"
NAMESPACES = {
    "ssd": f"{_STANDARD}Description",
    "ssc": f"{_STANDARD}Common",
    "ssv": f"{_STANDARD}ParameterValues",
    "ssm": f"{_STANDARD}ParameterMapping",
    "oms": "https://raw.githubusercontent.com/OpenModelica/OMSimulator/master/schema/oms.xsd",
    "osp": "http://opensimulationplatform.com/SSP/OSPAnnotations",
    "touchdown": "urn:touchdown-cosim:scene",
}
REALS = ("Real", "Float64", "Float32")  # elements of a connector's or a parameter's type, 1.0's and 2.0's
INTEGERS = ("Integer", *(f"{sign}Int{bits}" for bits in (8, 16, 32, 64) for sign in ("", "U")))
SSD_FILE = "SystemStructure.ssd"
RESOURCES = "resources"
STEP_ANNOTATION = "com.opensimulationplatform"  # holds the macro step for libcosim
MASTER_ANNOTATION = "org.openmodelica"  # holds it for OMSimulator
SCENE_ANNOTATION = "touchdown-cosim.scene"  # what a scene says beyond its structure


CHOICES = ("BooleanMapping", "IntegerMapping", "EnumerationMapping")  # transformations that are not read


def tag(name: str) -> str:
    """ElementTree's name of PREFIX:NAME."""
    prefix, _, local = name.partition(":")
    return f"{{{NAMESPACES[prefix]}}}{local}"


def children(element: Element, path: str) -> list[Element]:
    """Elements at `path`, such as ssd:Elements/ssd:Component."""
    return element.findall(path, NAMESPACES)


def first_child(element: Element, path: str) -> Element | None:
    """The first element at `path`."""
    return element.find(path, NAMESPACES)


def read_xml(path: Path, where: str, root: str) -> Element:
    """The root element of a file, which must be `root` (PREFIX:NAME). Raises TouchdownError."""
    element = _read(path, where)
    if element.tag != tag(root):
        raise TouchdownError(f"{where}: its root is {element.tag}, not {root} of SSP")
    return element


def _read(path: Path, where: str) -> Element:
    try:
        return read_file(path)
    except OSError as error:
        raise TouchdownError(f"{where}: cannot read it ({error.strerror})") from None
    except HostileError as error:
        raise TouchdownError(f"{where}: {error}; refused") from None
    except (ParseError, ExpatError, ValueError, LookupError) as error:
        raise TouchdownError(f"{where}: it is not valid XML ({error})") from None


def required(element: Element, name: str, where: str) -> str:
    """A text attribute that must be there."""
    value = element.get(name)
    if not value:
        kind = element.tag.rpartition("}")[2]
        raise TouchdownError(f"{where}: a {kind} has no {name}")
    return value


def number_attribute(element: Element, name: str, where: str, default: float | None = None) -> float:
    """A numeric attribute; without a default it must be there."""
    if default is not None and element.get(name) is None:
        return default
    text = required(element, name, where)
    value = number_of(text, f"{where}: {name}")
    if not math.isfinite(value):
        raise TouchdownError(f"{where}: {name} = {text!r} is not a finite number")
    return value


def number_of(text: str, where: str) -> float:
    """A number, which may be INF or NaN. Raises TouchdownError."""
    try:
        return float(text)
    except ValueError:
        raise TouchdownError(f"{where} = {text!r} is not a number") from None


def switch(element: Element, name: str, where: str) -> bool:
    """A boolean attribute, false by default."""
    text = element.get(name, "false")
    if text not in ("true", "false", "1", "0"):
        raise TouchdownError(f"{where}: {name} = {text!r} is neither true nor false")
    return text in ("true", "1")


def transformation(element: Element, where: str) -> Scale | None:
    """The linear transformation in an element; others are refused."""
    for kind in CHOICES:
        if first_child(element, f"ssc:{kind}Transformation") is not None:
            raise TouchdownError(f"{where}: {kind}Transformation is not supported, only linear ones are")
    linear = first_child(element, "ssc:LinearTransformation")
    if linear is None:
        return None
    return number_attribute(linear, "factor", where, 1.0), number_attribute(linear, "offset", where, 0.0)


def unit_of(element: Element) -> str | None:
    """The name of the unit that an element states."""
    return unbracketed(element.get("unit", "")) or None


def unit_definitions(element: Element, path: str, where: str) -> dict[str, Unit]:
    """The units defined at `path`, by name."""
    units: dict[str, Unit] = {}
    for unit in children(element, f"{path}/ssc:Unit"):
        base = first_child(unit, "ssc:BaseUnit")
        if base is not None:
            name = unbracketed(required(unit, "name", where))
            exponents = {s: int(number_attribute(base, s, f"{where}: unit {name}", 0.0)) for s in BASE}
            factor = number_attribute(base, "factor", f"{where}: unit {name}", 1.0)
            if factor == 0.0:
                raise TouchdownError(f"{where}: unit {name} has the factor 0")
            offset = number_attribute(base, "offset", f"{where}: unit {name}", 0.0)
            units[name] = Unit({s: n for s, n in exponents.items() if n}, factor, offset)
    return units


def inside(folder: Path, source: str, where: str) -> Path:
    """The file of the package that the URI `source` names. Raises TouchdownError for any other."""
    path = unquote(source)
    if ":" in path or path.startswith("/") or "\\" in path or ".." in path.split("/"):
        raise TouchdownError(f"{where}: {source!r} is not a file inside the package; pack it with it")
    if not (folder / path).is_file():
        raise TouchdownError(f"{where}: the package has no file {path!r}")
    return folder / path
