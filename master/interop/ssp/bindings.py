"""Parameter bindings: values by name, from parameter sets (ssv) through mappings (ssm)."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from xml.etree.ElementTree import Element

from touchdown.master.common.errors import TouchdownError
from touchdown.master.common.units import Scale, Unit
from touchdown.master.interop.ssp import xml
from touchdown.master.interop.ssp.names import INTEGERS, REALS

SET_TYPE, MAPPING_TYPE = "application/x-ssp-parameter-set", "application/x-ssp-parameter-mapping"
BOOLEANS = {"true": 1.0, "1": 1.0, "false": 0.0, "0": 0.0}


@dataclass(frozen=True)
class Value:
    """A value a binding gives, as it stands there."""

    name: str
    given: float | str  # a number, or one of an enumeration's words
    unit: str | None = None
    units: Mapping[str, Unit] | None = None  # that the parameter set defines
    convert: bool = True  # to the unit of the variable
    scale: Scale | None = None  # on the converted value


def values(element: Element, folder: Path, where: str) -> list[Value]:
    """What the bindings of a component or a system give, later ones over earlier ones."""
    by_name: dict[str, Value] = {}
    for binding in xml.children(element, "ssd:ParameterBindings/ssd:ParameterBinding"):
        given = _set(binding, folder, where)
        prefix = binding.get("prefix", "")
        given = [replace(value, name=f"{prefix}{value.name}") for value in given]
        mapping = xml.child(binding, "ssd:ParameterMapping")
        if mapping is not None:
            given = list(_mapped(given, mapping, folder, where))
        by_name |= {value.name: value for value in given}
    return list(by_name.values())


def _set(binding: Element, folder: Path, where: str) -> list[Value]:
    where = f"{where}, parameter binding"
    content = _content(binding, "ssd:ParameterValues/ssv:ParameterSet", "ssv:ParameterSet", folder, where)
    kind = binding.get("type", SET_TYPE)
    if kind != SET_TYPE:
        raise TouchdownError(f"{where}: the type {kind} is not supported, only {SET_TYPE} is")
    return [] if content is None else _parameters(content, where)


def parameters(path: Path, where: str) -> list[Value]:
    """What a parameter set in a file of its own gives."""
    return _parameters(xml.read_xml(path, where, "ssv:ParameterSet"), where)


def _parameters(content: Element, where: str) -> list[Value]:
    units = xml.unit_definitions(content, "ssv:Units", where)
    return [_value(p, units, where) for p in xml.children(content, "ssv:Parameters/ssv:Parameter")]


def _content(element: Element, inline: str, root: str, folder: Path, where: str) -> Element | None:
    """What an element holds inline, or in the file it names."""
    if element.get("sourceBase", "SSD") != "SSD":
        raise TouchdownError(f"{where}: sourceBase = {element.get('sourceBase')!r} is not supported")
    source = element.get("source")
    if not source:
        return xml.child(element, inline)
    return xml.read_xml(xml.inside(folder, source, where), f"{where}: {source}", root)


def _value(parameter: Element, units: Mapping[str, Unit], where: str) -> Value:
    name = xml.required(parameter, "name", where)
    where = f"{where}, {name}"
    for kind in (*REALS, *INTEGERS):
        content = xml.child(parameter, f"ssv:{kind}")
        if content is not None:
            return Value(name, xml.number(content, "value", where), content.get("unit"), units)
    content = xml.child(parameter, "ssv:Enumeration")
    if content is not None:
        return Value(name, xml.required(content, "value", where))
    content = xml.child(parameter, "ssv:Boolean")
    if content is None:
        raise TouchdownError(
            f"{where}: only Real, Integer, Boolean and Enumeration parameters can be set; remove it"
        )
    text = xml.required(content, "value", where)
    if text not in BOOLEANS:
        raise TouchdownError(f"{where}: {text!r} is neither true nor false")
    return Value(name, BOOLEANS[text])


def _mapped(given: Iterable[Value], mapping: Element, folder: Path, where: str) -> Iterable[Value]:
    """Values under the names that a mapping gives them; those it does not name are not applied.

    A mapping without entries, which some tools write beside every parameter set, leaves all as they are.
    """
    where = f"{where}, parameter mapping"
    kind = mapping.get("type", MAPPING_TYPE)
    if kind != MAPPING_TYPE:
        raise TouchdownError(f"{where}: the type {kind} is not supported, only {MAPPING_TYPE} is")
    content = _content(mapping, "ssm:ParameterMapping", "ssm:ParameterMapping", folder, where)
    entries = xml.children(content, "ssm:MappingEntry") if content is not None else []
    if not entries:
        yield from given
    by_name = {value.name: value for value in given}
    for entry in entries:
        if entry.get("source") == "":  # a template that nobody filled in
            continue
        source, target = xml.required(entry, "source", where), xml.required(entry, "target", where)
        if source in by_name:
            yield replace(
                by_name[source],
                name=target,
                convert=not xml.switch(entry, "suppressUnitConversion", where),
                scale=xml.transformation(entry, f"{where}, {source} to {target}"),
            )
