"""A shaft written as a rotor file, from which an equal one is read.

Each quantity takes the shortest text that is read as the same number to the bit. What a shaft does not
remember is written as what it became: a disc as a point mass, a material by a number.
"""

from __future__ import annotations

import json
import math
import re
from collections.abc import Iterable, Iterator
from itertools import groupby

from ...modelkit.errors import TouchdownError
from ...modelkit.reader import kinds
from ...modelkit.units import UNIT_SCALES, to_si
from ..beams.beam_body import PointMass
from ..beams.element import Element
from ..beams.shaft import Gap, Shaft, Station, Support, Unbalance
from .parser import parse_rotor, superelement_lines

PREFERRED_UNITS = ("mm", "GPa", "g", "kg.mm2", "g.mm", "deg", "MN/m")  # units beside those of SI
DIGITS = 15  # decimal digits that a float holds


def rotor_text(shaft: Shaft, file: str = "the rotor") -> str:
    """The text of a rotor file for `shaft`; `parse_rotor` reads an equal shaft from it.

    `file` is what to call it in messages. Raises TouchdownError where a rotor file cannot say what the
    shaft is, such as an element out of all proportion.
    """
    text = "\n".join(_lines(shaft)) + "\n"
    if parse_rotor(text, file) != shaft:
        raise TouchdownError(
            f"{file}: the rotor {shaft.title} cannot be written as a rotor file: it would be read as "
            "another one; look for a sleeve's density or modulus without its diameter, or for elements "
            "beside a superelement"
        )
    return text


def _lines(shaft: Shaft) -> Iterator[str]:
    yield f"title = {_text(shaft.title)}"
    if shaft.about:
        yield f"about = {_prose(shaft.about)}"
    yield f"damping_ratio = {float(shaft.damping_ratio)!r}"
    if shaft.levitated_at:
        yield f"levitated_at = [{', '.join(map(_text, shaft.levitated_at))}]"
    cores = _numbered(
        "core", ((p.modulus, p.density, p.poisson) for e in shaft.elements for p in (e, *e.layers))
    )
    sleeves = _numbered(
        "sleeve", ((e.sleeve_modulus, e.sleeve_density) for e in shaft.elements if e.sleeve_diameter)
    )
    yield from _materials(cores | sleeves)
    yield from _elements(shaft.elements, cores, sleeves)
    for point in shaft.points:
        yield from _table("point_mass", point)
    if shaft.superelement:
        yield from superelement_lines(shaft.superelement)
    for unbalance in shaft.unbalances:
        yield from _table("unbalance", unbalance)
    for support in shaft.supports:
        yield from _table("support", support)
    yield from _stations("stations", shaft.stations)
    yield from _stations("sensors", shaft.sensors)
    for gap in shaft.gaps:
        yield from _gap(gap)


Names = dict[tuple[float, ...], str]


def _numbered(kind: str, materials: Iterable[tuple[float, ...]]) -> Names:
    """Names by material: (modulus in Pa, density in kg/m3, and Poisson's ratio of a core)."""
    return {one: f"{kind}_{i}" for i, one in enumerate(dict.fromkeys(materials), 1)}


def _materials(names: Names) -> Iterator[str]:
    for (modulus, density, *poisson), name in names.items():
        yield f"\n[material.{name}]"
        yield f"modulus = {_quantity(modulus, 'Pa')}"
        yield f"density = {_quantity(density, 'kg/m3')}"
        yield from (f"poisson = {float(value)!r}" for value in poisson)


def _elements(elements: tuple[Element, ...], cores: Names, sleeves: Names) -> Iterator[str]:
    """One table for each run of equal elements."""
    node = 1
    for e, run in groupby(elements):
        count = len(list(run))
        yield f"\n[[element]]  # nodes {node} to {node + count}"
        node += count
        if count > 1:
            yield f"count = {count}"
        yield f"length = {_quantity(e.length, 'm')}"
        yield from _part(e, cores, bore=0.0)
        if e.sleeve_diameter:
            outer, name = _quantity(e.sleeve_diameter, "m"), sleeves[e.sleeve_modulus, e.sleeve_density]
            yield f'sleeve = {{ outer_diameter = {outer}, material = "{name}" }}'
        if e.layers:
            yield "layers = ["
            yield from (f"    {{ {', '.join(_part(layer, cores, bore=None))} }}," for layer in e.layers)
            yield "]"


def _part(part: Element, materials: Names, bore: float | None) -> Iterator[str]:
    """Lines that an element's core and its layers share; an inner diameter of `bore` is left out."""
    yield f"outer_diameter = {_quantity(part.outer_diameter, 'm')}"
    if part.outer_diameter_end is not None:
        yield f"outer_diameter_end = {_quantity(part.outer_diameter_end, 'm')}"
    if part.inner_diameter != bore:
        yield f"inner_diameter = {_quantity(part.inner_diameter, 'm')}"
    if part.inner_diameter_end is not None:
        yield f"inner_diameter_end = {_quantity(part.inner_diameter_end, 'm')}"
    yield f'material = "{materials[part.modulus, part.density, part.poisson]}"'
    if part.shear_factor is not None:
        yield f"shear_factor = {float(part.shear_factor)!r}"


def _table(name: str, thing: PointMass | Unbalance | Support) -> Iterator[str]:
    yield f"\n[[{name}]]"
    for key, kind in kinds(type(thing)).items():
        if (value := getattr(thing, key)) is not None:
            yield f"{key} = {_quantity(value, kind.unit) if kind.unit != '1' else value}"


def _gap(gap: Gap) -> Iterator[str]:
    yield f"\n[[gap]]\nname = {_text(gap.name)}\nstation = {_text(gap.station)}"
    yield f"radial = {_quantity(gap.radial, 'm')}"
    if gap.journal_radius is not None:
        yield f"journal_radius = {_quantity(gap.journal_radius, 'm')}"


def _stations(kind: str, stations: tuple[Station, ...]) -> Iterator[str]:
    if stations:
        yield f"\n[{kind}]"
    for station in stations:
        yield f"{_key(station.name)} = {station.node}"


def _quantity(value: float, unit: str) -> str:
    """`value` (SI) as text with a unit: the shortest of those that are read as the same number."""
    exact = f"{float(value)!r} {unit}"
    scales = [(UNIT_SCALES[name][0], name) for name in PREFERRED_UNITS if UNIT_SCALES[name][1] == unit]
    ways = [f"{value / factor:.{DIGITS}g} {name}" for factor, name in (*scales, (1.0, unit))]
    same = [way for way in ways if math.isfinite(value) and to_si(way, unit, unit) == value]
    return _text(min((*same, exact), key=len))


def _text(text: str) -> str:
    """A TOML string; its escapes are those of JSON but for one character."""
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


def _prose(text: str) -> str:
    """A TOML string of one or more lines."""
    if "\n" not in text:
        return _text(text)
    return '"""\n' + "\n".join(_text(line)[1:-1] for line in text.split("\n")) + '"""'


def _key(name: str) -> str:
    return name if re.fullmatch(r"[A-Za-z0-9_-]+", name) else _text(name)
