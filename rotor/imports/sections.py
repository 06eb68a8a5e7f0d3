"""A rotor as a table of its sections: a row for each, as a drawing gives them, units in the header.

    length [mm], outer diameter [mm], inner diameter [mm], material, mass [kg], station
    30,          20,                  0,                   steel,    ,          A
    200,         40,                  0,                   steel,    ,
    30,          20,                  0,                   steel,    1.2,       B
    ,            ,                    ,                    ,         0.4,

Rows follow each other from node 1. What a row has beside its section (mass, polar and diametral inertia,
unbalance, station) sits where the section begins; a row without length has it where the last one ended.
Columns `outer diameter end` and `inner diameter end` make cones, `sleeve diameter`, `sleeve density` and
`sleeve modulus` shrink something on; instead of `material` there may be `modulus`, `density` and `poisson`.
A section becomes `elements` equal elements, by default such that none is longer than its diameter.
Columns may have German names (`ALSO`); what else a table may look like: `modelkit.sheets`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

from ...modelkit.errors import one_of, require
from ...modelkit.reader import TEXT, Table, key, kinds, number, whole
from ...modelkit.sheets import rows
from ..beams.beam_body import PointMass
from ..beams.element import Element, split_element
from ..beams.shaft import MAX_NODES, Shaft, Station, Unbalance

MATERIALS = {  # modulus (Pa), density (kg/m3), Poisson's ratio
    "steel": (207e9, 7830.0, 0.3),
    "aluminium": (70e9, 2700.0, 0.33),
    "titanium": (114e9, 4430.0, 0.34),
}
CALLED = {"aluminum": "aluminium", "stahl": "steel", "titan": "titanium"}
SIZE, SIZE_OR_0 = number("m", above=0.0), number("m", minimum=0.0)
INERTIA = number("kg.m2", minimum=0.0)


@dataclass(frozen=True)
class _ShaftSection:
    """A row: a section, and what sits where it begins. SI."""

    length: float | None = key(SIZE, None)
    outer_diameter: float | None = key(SIZE, None)
    inner_diameter: float = key(SIZE_OR_0, 0.0)
    outer_diameter_end: float | None = key(SIZE, None)
    inner_diameter_end: float | None = key(SIZE_OR_0, None)
    modulus: float | None = key(number("Pa", above=0.0), None)
    density: float | None = key(number("kg/m3", above=0.0), None)
    poisson: float | None = key(number(minimum=0.0), None)
    sleeve_diameter: float = key(SIZE_OR_0, 0.0)
    sleeve_density: float | None = key(number("kg/m3", minimum=0.0), None)
    sleeve_modulus: float = key(number("Pa", minimum=0.0), 0.0)
    mass: float | None = key(number("kg", minimum=0.0), None)
    polar_inertia: float | None = key(INERTIA, None)
    diametral_inertia: float | None = key(INERTIA, None)
    unbalance: float | None = key(number("kg.m", minimum=0.0), None)
    unbalance_angle: float = key(number("rad"), 0.0)
    elements: int | None = key(whole(1), None)
    shear_factor: float | None = key(number(minimum=0.0), None)
    material: str = key(TEXT, "")
    station: str | None = key(TEXT, None)


COLUMNS = {name: kind.unit for name, kind in kinds(_ShaftSection).items()}
ALSO = {  # other names of columns
    "laenge": "length", "werkstoff": "material", "elemente": "elements", "lagerstelle": "station",
    "outside_diameter": "outer_diameter", "aussendurchmesser": "outer_diameter",
    "bore": "inner_diameter", "bohrung": "inner_diameter", "innendurchmesser": "inner_diameter",
    "aussendurchmesser_ende": "outer_diameter_end", "innendurchmesser_ende": "inner_diameter_end",
    "e_modul": "modulus", "young's_modulus": "modulus", "dichte": "density", "schubfaktor": "shear_factor",
    "querkontraktionszahl": "poisson", "poisson's_ratio": "poisson", "huelsenmodul": "sleeve_modulus",
    "huelsendurchmesser": "sleeve_diameter", "huelsendichte": "sleeve_density", "masse": "mass",
    "polares_traegheitsmoment": "polar_inertia", "diametrales_traegheitsmoment": "diametral_inertia",
    "unwucht": "unbalance", "unwuchtwinkel": "unbalance_angle",
}  # fmt: skip


def of_sections(path: Path) -> Shaft:
    """The rotor of a table as this module describes it. Raises TouchdownError."""
    elements: list[Element] = []
    points: list[PointMass] = []
    unbalances: list[Unbalance] = []
    stations: list[Station] = []
    for row in rows(path, COLUMNS, ("length", "outer_diameter"), ALSO):
        said, node = row.read(_ShaftSection), len(elements) + 1
        inertias = (said.mass, said.polar_inertia, said.diametral_inertia)
        if inertias != (None, None, None):
            points.append(PointMass(node, *(value or 0.0 for value in inertias)))
        if said.unbalance is not None:
            unbalances.append(Unbalance(node, said.unbalance, said.unbalance_angle))
        if said.station is not None:
            row.require(
                not any(station.name == said.station for station in stations),
                "station",
                "is there twice; choose another name",
            )
            stations.append(Station(said.station, node))
        if said.length is not None:
            elements += _elements(row, said, MAX_NODES - node)
        elif said.outer_diameter is not None:
            raise row.error("length", "is missing, of a section with an outer diameter")
    require(elements, f"{path}: has no section: no row below the header has a length")
    about = "Imported from a table of sections."
    return Shaft(path.stem, tuple(elements), tuple(points), tuple(unbalances), tuple(stations), about=about)


def _elements(row: Table, said: _ShaftSection, most: int) -> list[Element]:
    """The elements of a section, at most `most`."""
    length, outer, inner = said.length, said.outer_diameter, said.inner_diameter
    if length is None or outer is None:
        raise row.error("outer_diameter", "is missing")
    outer_end = outer if said.outer_diameter_end is None else said.outer_diameter_end
    inner_end = inner if said.inner_diameter_end is None else said.inner_diameter_end
    for bore, outside, end in ((inner, outer, ""), (inner_end, outer_end, "_end")):
        row.require(bore < outside, f"inner_diameter{end}", "is not less than the outer diameter")
    modulus, density, poisson = _material(row, said)
    sleeve = said.sleeve_diameter
    row.require(
        not sleeve or sleeve > max(outer, outer_end), "sleeve_diameter", "must be above the outer diameter"
    )
    row.require(
        not sleeve or (outer_end, inner_end) == (outer, inner),
        "sleeve_diameter",
        "cannot be on a cone; take a layer in the rotor's file",
    )
    if sleeve and said.sleeve_density is None:
        raise row.error("sleeve_density", "is missing")
    section = Element(
        length=length,
        outer_diameter=outer,
        inner_diameter=inner,
        modulus=modulus,
        density=density,
        poisson=poisson,
        shear_factor=said.shear_factor,
        sleeve_diameter=sleeve,
        sleeve_density=(sleeve and said.sleeve_density) or 0.0,
        sleeve_modulus=said.sleeve_modulus if sleeve else 0.0,
        outer_diameter_end=None if outer_end == outer else outer_end,
        inner_diameter_end=None if inner_end == inner else inner_end,
    )
    count = said.elements or math.ceil(length / section.widest)
    row.require(
        count <= most,
        "length",
        f"makes {count:g} elements; with those before a rotor has at most {MAX_NODES} nodes",
    )
    return split_element(section, count)


def _material(row: Table, said: _ShaftSection) -> tuple[float, float, float]:
    """Modulus (Pa), density (kg/m3) and Poisson's ratio: of the named material, but for what is given."""
    stated = (said.modulus, said.density, said.poisson)
    name = CALLED.get(said.material.lower(), said.material.lower())
    if name and name not in MATERIALS:
        remedy = f"{one_of(name, MATERIALS)}, or columns modulus, density, poisson"
        raise row.error("material", f"is not known; {remedy}")
    row.require(
        name or None not in stated, "material", "is missing; name one, or give modulus, density and poisson"
    )
    modulus, density, poisson = (
        value if usual is None else usual
        for usual, value in zip(stated, MATERIALS.get(name, (0.0, 0.0, 0.0)), strict=True)
    )
    return modulus, density, poisson
