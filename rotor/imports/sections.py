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
Lines that begin with # are comments.
"""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from ...modelkit.units import UnitError, to_si
from ..beams.body import PointMass
from ..beams.element import Element, split
from ..beams.shaft import MAX_NODES, Shaft, Station, Unbalance
from .tables import ImportedRotorError, named, separator

UNITS = {  # column: SI unit; those of text and of pure numbers are not here
    "length": "m", "outer diameter": "m", "inner diameter": "m", "outer diameter end": "m",
    "inner diameter end": "m", "modulus": "Pa", "density": "kg/m3", "sleeve diameter": "m",
    "sleeve density": "kg/m3", "sleeve modulus": "Pa", "mass": "kg", "polar inertia": "kg.m2",
    "diametral inertia": "kg.m2", "unbalance": "kg.m", "unbalance angle": "rad",
}  # fmt: skip
PURE = ("poisson", "elements", "shear factor")
TEXTS = ("material", "station")
COLUMNS = (*UNITS, *PURE, *TEXTS)
MATERIALS = {  # modulus (Pa), density (kg/m3), Poisson's ratio
    "steel": (207e9, 7830.0, 0.3),
    "aluminium": (70e9, 2700.0, 0.33),
    "titanium": (114e9, 4430.0, 0.34),
}


@dataclass(frozen=True)
class Row:
    """A row: its place in the file, and its cells that are not empty, by column."""

    where: str
    cells: dict[str, str]
    units: dict[str, str]

    def error(self, column: str, says: str) -> ImportedRotorError:
        """The error to raise about a cell."""
        value = f" = {self.cells[column]!r}" if column in self.cells else ""
        return ImportedRotorError(f"{self.where}: {column}{value} {says}")

    def quantity(self, column: str, default: float | None = None, zero: bool = True) -> float:
        """A cell in SI; required unless there is a default. Raises ImportedRotorError."""
        if column not in self.cells:
            if default is None:
                raise self.error(column, "is missing")
            return default
        unit = UNITS.get(column, "1")
        try:
            value = to_si(f"{self.cells[column]} {self.units.get(column, '')}", unit, column)
        except UnitError as error:
            raise ImportedRotorError(f"{self.where}: {error}") from None
        if value < 0.0 and column != "unbalance angle":
            raise self.error(column, "must not be negative")
        if value == 0.0 and not zero:
            raise self.error(column, "must be above 0")
        return value


@dataclass
class Built:
    """The parts that the rows read so far have made."""

    elements: list[Element]
    points: list[PointMass]
    unbalances: list[Unbalance]
    stations: list[Station]


def of_sections(text: str, file: str, title: str) -> Shaft:
    """The rotor of a table as this module describes it. Raises ImportedRotorError."""
    built = Built([], [], [], [])
    for row in _rows(text, file):
        _add_things(row, built)
        if "length" in row.cells:
            built.elements += _elements(row, MAX_NODES - 1 - len(built.elements))
        elif "outer diameter" in row.cells:
            raise row.error("length", "is missing, of a section with an outer diameter")
    if not built.elements:
        raise ImportedRotorError(f"{file}: has no section: no row below the header has a length")
    return Shaft(
        title,
        tuple(built.elements),
        tuple(built.points),
        tuple(built.unbalances),
        tuple(built.stations),
        about="Imported from a table of sections.",
    )


def _rows(text: str, file: str) -> Iterator[Row]:
    lines = [(i, line) for i, line in enumerate(text.splitlines(), 1) if line.strip(" ,;\t")]
    lines = [(i, line) for i, line in lines if not line.lstrip(' "').startswith("#")]
    if not lines:
        raise ImportedRotorError(f"{file}: is empty")
    (number, head), *body = lines
    mark = separator(head)
    units = _units(next(csv.reader([head], delimiter=mark)), f"{file}, line {number}")
    for i, line in body:
        where = f"{file}, line {i}"
        values = [value.strip() for value in next(csv.reader([line], delimiter=mark))]
        if len(values) > len(units) and any(values[len(units) :]):
            raise ImportedRotorError(f"{where}: has {len(values)} cells, the header {len(units)}")
        cells = {name: value for name, value in zip(units, values, strict=False) if value}
        if mark == ";":  # as spreadsheets with decimal commas write them
            cells = {n: v if n in TEXTS else v.replace(",", ".") for n, v in cells.items()}
        yield Row(where, cells, units)


def _units(heads: Iterable[str], where: str) -> dict[str, str]:
    """The unit of each column by name, in their order."""
    units: dict[str, str] = {}
    for head in heads:
        own, unit = named(head)
        name = re.sub(r"[\s_]+", " ", own).lower()
        if name not in COLUMNS:
            raise ImportedRotorError(
                f"{where}: the column {head.strip()!r} is not known; there are: {', '.join(COLUMNS)}"
            )
        if name in units:
            raise ImportedRotorError(f"{where}: there are two columns {name}")
        if name in UNITS and not unit:
            raise ImportedRotorError(f"{where}: {name} has no unit; write it as {name} [{_usual(name)}]")
        units[name] = unit
    if "length" not in units or "outer diameter" not in units:
        raise ImportedRotorError(f"{where}: the header must name length [mm] and outer diameter [mm]")
    return units


def _usual(column: str) -> str:
    return {"m": "mm", "Pa": "GPa", "kg.m": "g.mm", "rad": "deg"}.get(UNITS[column], UNITS[column])


def _add_things(row: Row, built: Built) -> None:
    """Add the parts that sit where the row's section begins."""
    node = len(built.elements) + 1
    if any(name in row.cells for name in ("mass", "polar inertia", "diametral inertia")):
        mass, polar, diametral = (
            row.quantity(name, 0.0) for name in ("mass", "polar inertia", "diametral inertia")
        )
        built.points.append(PointMass(node, mass, polar, diametral))
    if "unbalance" in row.cells:
        angle = row.quantity("unbalance angle", 0.0)
        built.unbalances.append(Unbalance(node, row.quantity("unbalance"), angle))
    if "station" in row.cells:
        name = row.cells["station"]
        if any(s.name == name for s in built.stations):
            raise row.error("station", "is there twice; choose another name")
        built.stations.append(Station(name, node))


def _elements(row: Row, most: int) -> list[Element]:
    """The elements of a section, at most `most`."""
    length = row.quantity("length", zero=False)
    outer = row.quantity("outer diameter", zero=False)
    inner = row.quantity("inner diameter", 0.0)
    outer_end = row.quantity("outer diameter end", outer, zero=False)
    inner_end = row.quantity("inner diameter end", inner)
    for bore, outside, end in ((inner, outer, ""), (inner_end, outer_end, " end")):
        if bore >= outside:
            raise row.error(f"inner diameter{end}", "is not less than the outer diameter")
    modulus, density, poisson = _material(row)
    sleeve = row.quantity("sleeve diameter", 0.0)
    if sleeve and sleeve <= max(outer, outer_end):
        raise row.error("sleeve diameter", "must be above the outer diameter")
    if sleeve and (outer_end, inner_end) != (outer, inner):
        raise row.error("sleeve diameter", "cannot be on a cone; take a layer in the rotor's file")
    section = Element(
        length=length,
        outer_diameter=outer,
        inner_diameter=inner,
        modulus=modulus,
        density=density,
        poisson=poisson,
        shear_factor=row.quantity("shear factor") if "shear factor" in row.cells else None,
        sleeve_diameter=sleeve,
        sleeve_density=row.quantity("sleeve density", None if sleeve else 0.0) if sleeve else 0.0,
        sleeve_modulus=row.quantity("sleeve modulus", 0.0) if sleeve else 0.0,
        outer_diameter_end=None if outer_end == outer else outer_end,
        inner_diameter_end=None if inner_end == inner else inner_end,
    )
    return split(section, _count(row, section, most))


def _material(row: Row) -> tuple[float, float, float]:
    """Modulus (Pa), density (kg/m3) and Poisson's ratio: of the named material, but for what is given."""
    name = row.cells.get("material", "").lower()
    if name and name not in MATERIALS:
        raise row.error(
            "material",
            f"is not known; there are: {', '.join(MATERIALS)}, or columns modulus, density, poisson",
        )
    if not name and not {"modulus", "density", "poisson"} <= set(row.cells):
        raise row.error("material", "is missing; name one, or give modulus, density and poisson")
    modulus, density, poisson = MATERIALS.get(name, (None, None, None))
    return (
        row.quantity("modulus", modulus, zero=False),
        row.quantity("density", density, zero=False),
        row.quantity("poisson", poisson),
    )


def _count(row: Row, section: Element, most: int) -> int:
    """Into how many elements a section is divided, at most `most`."""
    count = math.ceil(section.length / section.widest)
    if "elements" in row.cells:
        count = row.quantity("elements", zero=False)
    if count != int(count):
        raise row.error("elements", "must be a whole number")
    if count > most:
        raise row.error(
            "length", f"makes {count:g} elements; with those before a rotor has at most {MAX_NODES} nodes"
        )
    return int(count)
