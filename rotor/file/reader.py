"""Reads the text of a rotor file and names every mistake in it.

A rotor is described by elements, or by its matrices in the table [superelement]: those of the whole rotor
in one plane, as blocks of numbers in SI.

    [superelement]
    positions = "0 0.05 0.1 0.15"    # m, of the nodes
    mass = \"\"\"                       # row, column, value; those on the diagonal and below it
    1 1 0.58
    2 1 0.0041
    ...\"\"\"
    stiffness, gyroscopic            # likewise
    shapes                           # row, column, value

Rows and columns of mass, stiffness and gyroscopic (the polar matrix, of inertias about the axis) count
from 1; they are the deflection (m) and the slope dx/dz of node after node. With `shapes` they are other
coordinates, modes for example, and the rows of shapes, deflection and slope of node after node, say how
each of them moves the nodes. The rotor is free: with the first two coordinates held it has no rigid motion
left. Without mass the coordinates are mass-normalised.
"""

from __future__ import annotations

import keyword
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass, replace
from difflib import get_close_matches
from textwrap import shorten
from typing import Any

import numpy as np

from ...modelkit.model import ModelError
from ...modelkit.units import UnitError, to_si, units_of
from ..beams.body import PointMass, disc
from ..beams.element import Element, split
from ..beams.shaft import (
    MAX_NODES,
    MAX_STATIONS,
    Gap,
    Shaft,
    Station,
    Support,
    Unbalance,
    node_at,
    with_node,
)
from ..beams.superelement import MAX_COORDINATES, Superelement, checked

EXAMPLES = {
    "m": "12.5 mm", "Pa": "207 GPa", "kg/m3": "7830 kg/m3", "kg": "0.5 kg", "kg.m2": "0.002 kg.m2",
    "kg.m": "3 g.mm", "rad": "90 deg", "N/m": "20 MN/m", "N.s/m": "500 N.s/m",
}  # fmt: skip
LIMITS = {  # beyond them it is a slip, or too far apart to calculate with
    "m": (1e-4, 1e2), "Pa": (1e3, 1e13), "kg/m3": (1.0, 1e5), "kg": (1e-9, 1e6), "kg.m2": (1e-15, 1e7),
    "kg.m": (1e-12, 1e3), "rad": (0.0, 1e3), "N/m": (1e-3, 1e15), "N.s/m": (1e-6, 1e12),
}  # fmt: skip


class RotorFileError(ModelError):
    """A mistake in a rotor file: file, place, value and remedy in one line."""


@dataclass(frozen=True)
class Table:
    """A table of the file, and what to call it in a message."""

    file: str
    where: str
    values: dict[str, Any]

    def path(self, name: str) -> str:
        """Where the value `name` stands in the file: disc[2].node."""
        shown = name if name.isidentifier() else repr(name)
        return f"{self.where}.{shown}" if self.where else shown

    def error(self, name: str, says: str) -> RotorFileError:
        """The error to raise about the value `name`, whose beginning it quotes if there is one."""
        value = f" = {shorten(repr(self.values[name]), 60)}" if name in self.values else ""
        return RotorFileError(f"{self.file}: {self.path(name)}{value} {says}")

    def only(self, *known: str) -> None:
        """Raises RotorFileError for the first field that is not known."""
        for name in self.values:
            if name not in known:
                near = get_close_matches(name, known, n=1)
                remedy = f"did you mean {near[0]}" if near else f"there are: {', '.join(known)}"
                raise RotorFileError(f"{self.file}: {self.path(name)} is not a known field; {remedy}")

    def get(self, name: str, kind: Any, meant: str, default: Any = None) -> Any:
        """A value of the given kind, described by `meant`; required unless there is a default.

        Raises RotorFileError where it is missing or of another kind.
        """
        if name not in self.values:
            if default is None:
                raise self.error(name, f"is missing; it must be {meant}")
            return default
        value = self.values[name]
        if not isinstance(value, kind) or (isinstance(value, bool) and kind is not bool):
            raise self.error(name, f"must be {meant}")
        return value

    def text(self, name: str, default: str | None = None) -> str:
        """A text. Raises RotorFileError, as all that follow."""
        return self.get(name, str, "text", default)

    def integer(self, name: str, low: int, high: int, default: int | None = None) -> int:
        """An integer from `low` to `high`."""
        meant = f"an integer from {low} to {high}"
        value = self.get(name, int, meant, default)
        if not low <= value <= high:
            raise self.error(name, f"must be {meant}")
        return value

    def number(self, name: str, low: float, below: float, default: float | None = None) -> float:
        """A number without unit, at least `low` and below `below`."""
        meant = f"a number without unit, at least {low:g} and below {below:g}"
        value = self.get(name, (int, float), meant, default)
        if not low <= value < below:
            raise self.error(name, f"must be {meant}")
        return float(value)

    def quantity(
        self,
        name: str,
        unit: str,
        default: float | None = None,
        zero: bool = False,
        negative: bool = False,
    ) -> float:
        """A value with a unit, in SI; positive unless `zero` or `negative` allow more.

        Raises RotorFileError where it has no unit or another one, and where it is beyond `LIMITS`.
        """
        meant = f"text with a unit of {unit} ({', '.join(units_of(unit))}), such as {EXAMPLES[unit]!r}"
        if name not in self.values:
            return self.get(name, str, meant, default)
        value = self.values[name]
        if not isinstance(value, str) or len(value.split()) < 2:
            raise self.error(name, f"has no unit; write {meant}")
        try:
            number = to_si(value, unit, self.path(name))
        except UnitError as error:
            raise RotorFileError(f"{self.file}: {error}; write {meant}") from None
        if (number == 0.0 and not zero) or (number < 0.0 and not negative):
            raise self.error(name, "must not be negative" if zero else "must be above 0")
        low, high = LIMITS[unit]
        if number != 0.0 and not low <= abs(number) <= high:
            raise self.error(name, f"is out of proportion; rotors have {low:g} to {high:g} {unit}")
        return number

    def node(self, name: str, nodes: int) -> int:
        """The number of one of the rotor's nodes, which count from 1 to `nodes`."""
        value = self.get(name, int, f"the number of a node, 1 to {nodes}")
        if not 1 <= value <= nodes:
            raise self.error(name, f"is not a node; the elements make nodes 1 to {nodes}")
        return value

    def table(self, name: str) -> Table:
        """A table within this one."""
        values = self.get(name, dict, f"a table [{self.path(name)}]")
        return Table(self.file, self.path(name), values)

    def tables(self, name: str, *known: str) -> list[Table]:
        """A list of tables, written [[name]]; none where there is none. They hold fields `known`."""
        meant = f"a list of tables, each written [[{name}]]"
        tables = []
        for i, values in enumerate(self.get(name, list, meant, []), 1):
            if not isinstance(values, dict):
                raise self.error(name, f"must be {meant}")
            tables.append(Table(self.file, f"{self.path(name)}[{i}]", values))
            tables[-1].only(*known)
        return tables


DIAMETERS = ("outer_diameter", "inner_diameter", "outer_diameter_end", "inner_diameter_end")
POSITION_TOLERANCE = 1e-7  # m; positions and sums of lengths this close agree


@dataclass(frozen=True)
class Material:
    """Modulus in Pa, density in kg/m3; without Poisson's ratio it can be a sleeve only."""

    modulus: float
    density: float
    poisson: float | None


def materials_of(top: Table) -> dict[str, Material]:
    """The materials of a file by name. Raises RotorFileError, as all that follow."""
    materials: dict[str, Material] = {}
    group = top.table("material")
    for name in group.values:
        t = group.table(name)
        t.only("modulus", "density", "poisson")
        materials[name] = Material(
            modulus=t.quantity("modulus", "Pa", zero=True),
            density=t.quantity("density", "kg/m3"),
            poisson=t.number("poisson", -0.9, 0.5) if "poisson" in t.values else None,
        )
    return materials


def material_of(table: Table, materials: dict[str, Material]) -> Material:
    """The material a table names; by default the only one that can be a core."""
    cores = [name for name, m in materials.items() if m.poisson is not None]
    if "material" not in table.values and len(cores) == 1:
        return materials[cores[0]]
    listed = ", ".join(materials) or "none"
    name = table.get("material", str, f"the name of a material; there are: {listed}")
    if name not in materials:
        raise table.error("material", f"is not a material of this file; there are: {listed}")
    return materials[name]


def diameters_of(table: Table, inner_default: float | None = None) -> tuple[float, float]:
    """Outer and inner diameter (m) of an element or a disc; the inner one is less."""
    outer = table.quantity("outer_diameter", "m")
    inner = table.quantity("inner_diameter", "m", default=inner_default, zero=True)
    _check_inside(table, inner, outer, "")
    return outer, inner


def _check_inside(table: Table, inner: float, outer: float, end: str) -> None:
    """Of the diameters at one end, which two fields say, or what is beneath a layer."""
    if inner < outer:
        return
    outside = f"outer_diameter{end}" if f"outer_diameter{end}" in table.values else "outer_diameter"
    for bore in (f"inner_diameter{end}", "inner_diameter"):
        if bore in table.values:
            raise table.error(bore, f"must be below {outside} = {table.values[outside]!r}")
    raise table.error(outside, "must be above what it sits on")


def elements_of(top: Table, materials: dict[str, Material]) -> tuple[Element, ...]:
    """The elements of a file, in order from node 1."""
    elements: list[Element] = []
    end = 0.0
    for t in top.tables("element", "length", "material", "count", "sleeve", "layers", "position",
                        "shear_factor", *DIAMETERS):  # fmt: skip
        _check_position(t, end)
        count = t.integer("count", 1, 10**9, default=1)
        nodes = len(elements) + count + 1
        if nodes > MAX_NODES:
            raise RotorFileError(
                f"{top.file}: {t.where} brings the rotor to {nodes} nodes; "
                f"at most {MAX_NODES} are possible, take fewer and longer elements"
            )
        element = _element(t, materials)
        elements += [piece.stretched(element.length) for piece in split(element, count)]
        end += count * element.length
    if not elements:
        raise RotorFileError(
            f"{top.file}: element is missing; describe the shaft by one table [[element]] or more"
        )
    return tuple(elements)


def _check_position(table: Table, end: float) -> None:
    """Where an element says it starts, it must start at the end of the one before (m)."""
    if "position" not in table.values:
        return
    start = table.quantity("position", "m", zero=True)
    if abs(start - end) > POSITION_TOLERANCE:
        what = "leaves a gap after" if start > end else "overlaps"
        raise table.error(
            "position",
            f"{what} the elements before it, which end at {1e3 * end:.6g} mm; mend it or their lengths",
        )


def _element(t: Table, materials: dict[str, Material]) -> Element:
    length = t.quantity("length", "m")
    core = _part(t, materials, length, beneath=None)
    if core.modulus == 0.0:
        raise t.error("material", "has a modulus of 0, which only a sleeve or layer may have; name another")
    if "sleeve" in t.values:
        if core.tapered:
            raise t.error("sleeve", "cannot sit on a cone; write it as one of layers")
        return replace(core, **_sleeve(t, materials, core.outer_diameter))
    layers: list[Element] = []
    for layer in t.tables("layers", "material", "shear_factor", *DIAMETERS):
        layers.append(_part(layer, materials, length, beneath=layers[-1] if layers else core))
    return replace(core, layers=tuple(layers))


def _part(t: Table, materials: dict[str, Material], length: float, beneath: Element | None) -> Element:
    """A core, or a layer on what is `beneath` it, whose outside is its bore where nothing is said."""
    bore = 0.0 if beneath is None else beneath.outer_diameter
    outer, inner = diameters_of(t, inner_default=bore)
    outer_end = t.quantity("outer_diameter_end", "m", default=outer)
    bore_end = inner if beneath is None or "inner_diameter" in t.values else beneath.diameters(1.0)[0]
    inner_end = t.quantity("inner_diameter_end", "m", default=bore_end, zero=True)
    _check_inside(t, inner_end, outer_end, "_end")
    material = material_of(t, materials)
    if material.poisson is None:
        what = "core of an element" if beneath is None else "layer"
        raise t.error("material", f"has no poisson, which the {what} needs; add it there")
    return Element(
        length=length,
        outer_diameter=outer,
        inner_diameter=inner,
        modulus=material.modulus,
        density=material.density,
        poisson=material.poisson,
        shear_factor=t.number("shear_factor", 0.1, 1.2) if "shear_factor" in t.values else None,
        outer_diameter_end=None if outer_end == outer else outer_end,
        inner_diameter_end=None if inner_end == inner else inner_end,
    )


def _sleeve(element: Table, materials: dict[str, Material], outer: float) -> dict[str, float]:
    """The addition of a sleeve to an `Element` whose core has the diameter `outer` (m)."""
    t = element.table("sleeve")
    t.only("outer_diameter", "material")
    diameter = t.quantity("outer_diameter", "m")
    if diameter <= outer:
        core = element.values["outer_diameter"]
        raise t.error("outer_diameter", f"must be above that of the core it sits on, {core!r}")
    material = material_of(t, materials)
    return {
        "sleeve_diameter": diameter,
        "sleeve_density": material.density,
        "sleeve_modulus": material.modulus,
    }


FIELDS = ("positions", "mass", "stiffness", "gyroscopic", "shapes")
ENTRY = ("row", "column", "value")


def superelement_of(t: Table) -> Superelement:
    """The superelement of a table. Raises RotorFileError for values that are no free rotor's."""
    t.only(*FIELDS)
    positions = _numbers(t, "positions")
    own = 2 * len(positions)
    if own > 2 * MAX_COORDINATES:
        raise t.error("positions", f"are {len(positions)}; at most {MAX_COORDINATES} nodes are possible")
    shapes = _entries(t, "shapes") if "shapes" in t.values else None
    n = own if shapes is None else int(np.max(shapes[:, 1], initial=0.0))
    given = {name: _symmetric(t, name, n) for name in FIELDS[1:4] if name in t.values or name != "mass"}
    body = Superelement(
        positions,
        given.get("mass", np.eye(n)),
        given["stiffness"],
        given["gyroscopic"],
        None if shapes is None else _filled(t, "shapes", shapes, (own, n)),
    )
    try:
        return checked(body)
    except ModelError as error:
        raise RotorFileError(f"{t.file}: superelement: {error}") from None


def _numbers(t: Table, name: str) -> np.ndarray:
    """All numbers of a block, one after the other."""
    text = t.text(name)
    try:
        numbers = np.array(text.split(), dtype=float)
    except ValueError as error:
        raise RotorFileError(f"{t.file}: {t.path(name)}: {error}; write a block of numbers in SI") from None
    if not np.all(np.isfinite(numbers)):
        raise RotorFileError(f"{t.file}: {t.path(name)} holds what is no finite number")
    return numbers


def _entries(t: Table, name: str) -> np.ndarray:
    """Rows, columns and values of a matrix (entries, 3), rows and columns from 1."""
    numbers = _numbers(t, name)
    if len(numbers) % len(ENTRY):
        raise t.error(name, f"holds {len(numbers)} numbers; write three for each entry: {', '.join(ENTRY)}")
    entries = numbers.reshape(-1, len(ENTRY))
    places = entries[:, :2]
    if np.any(places != np.round(places)) or np.any(places < 1.0):
        raise t.error(name, "has an entry whose row or column is no whole number from 1 on")
    if len(np.unique(places, axis=0)) < len(places):
        raise t.error(name, "has two entries at one place")
    if np.any(places[:, 1] > MAX_COORDINATES):
        raise t.error(name, f"has more than {MAX_COORDINATES} columns, which is the most that is possible")
    return entries


def _filled(t: Table, name: str, entries: np.ndarray, size: tuple[int, int]) -> np.ndarray:
    """The matrix of all entries, zero elsewhere."""
    matrix = np.zeros(size)
    rows, columns = (entries[:, i].astype(int) - 1 for i in (0, 1))
    if np.any(rows >= size[0]) or np.any(columns >= size[1]):
        raise t.error(name, f"has an entry beyond its {size[0]} rows and {size[1]} columns")
    matrix[rows, columns] = entries[:, 2]
    return matrix


def _symmetric(t: Table, name: str, n: int) -> np.ndarray:
    """A symmetric matrix (n, n) of the entries on and below its diagonal."""
    entries = _entries(t, name)
    if np.any(entries[:, 1] > entries[:, 0]):
        raise t.error(name, "has an entry above the diagonal; write those on it and below")
    lower = _filled(t, name, entries, (n, n))
    return lower + np.tril(lower, -1).T


def superelement_lines(body: Superelement) -> Iterator[str]:
    """The table for a superelement, from which an equal one is read."""
    yield "\n[superelement]"
    yield f'positions = "{" ".join(map(repr, body.positions.tolist()))}"'
    for name, matrix in (
        ("mass", np.tril(body.mass_matrix)),
        ("stiffness", np.tril(body.stiffness_matrix)),
        ("gyroscopic", np.tril(body.polar_matrix)),
        ("shapes", body.shapes),
    ):
        if matrix is not None:
            rows, columns = np.nonzero(matrix)
            yield f'{name} = """'
            values = matrix[rows, columns].tolist()
            yield from (f"{i + 1} {j + 1} {v!r}" for i, j, v in zip(rows, columns, values, strict=True))
            yield '"""'


BEAMS = ("material", "element", "disc", "point_mass")
PLACES = ("station", "node", "position")  # of a gap
SUPPORT = ("node", "stiffness", "stiffness_y", "damping", "damping_y")
RESERVED = ("station", "sensor", "node", "stress", "energy", "mass", "modes")  # names of other variables


def parse(text: str, file: str) -> Shaft:
    """The rotor that `text` describes; `file` is what to call it in messages. Raises RotorFileError."""
    try:
        top = Table(file, "", tomllib.loads(text))
    except RecursionError:
        raise RotorFileError(f"{file}: is not valid TOML: its values lie too deep in each other") from None
    except ValueError as error:  # of TOML's syntax, or of an integer with thousands of digits
        raise RotorFileError(f"{file}: is not valid TOML: {error}") from None
    top.only("title", "about", "damping_ratio", *BEAMS, "superelement", "unbalance", "support",
             "stations", "sensors", "levitated_at", "gap")  # fmt: skip
    made = _made(top)
    nodes = made.nodes
    return _with_gaps(
        top,
        replace(
            made,
            unbalances=tuple(
                Unbalance(
                    node=t.node("node", nodes),
                    moment=t.quantity("moment", "kg.m", zero=True),
                    angle=t.quantity("angle", "rad", default=0.0, zero=True, negative=True),
                )
                for t in top.tables("unbalance", "node", "moment", "angle")
            ),
            stations=_stations(top, "stations", nodes),
            sensors=_stations(top, "sensors", nodes),
            levitated_at=_levitated(top),
            supports=tuple(_support(t, nodes) for t in top.tables("support", *SUPPORT)),
        ),
    )


def _made(top: Table) -> Shaft:
    """The shaft that a whole file describes."""
    shaft = Shaft(
        title=top.text("title"),
        about=top.text("about", ""),
        damping_ratio=top.number("damping_ratio", 0.0, 1.0, default=0.003),
    )
    if "superelement" not in top.values:
        materials = materials_of(top)
        elements = elements_of(top, materials)
        return replace(shaft, elements=elements, points=_points(top, materials, len(elements) + 1))
    if beams := [name for name in BEAMS if name in top.values]:
        raise top.error(beams[0], "cannot stand beside superelement, whose matrices are those of the whole")
    return replace(shaft, superelement=superelement_of(top.table("superelement")))


def _points(top: Table, materials: dict[str, Material], nodes: int) -> tuple[PointMass, ...]:
    """Discs and point masses."""
    points: list[PointMass] = []
    for t in top.tables("disc", "node", "outer_diameter", "inner_diameter", "width", "material"):
        node = t.node("node", nodes)
        outer, inner = diameters_of(t)
        points.append(disc(node, outer, inner, t.quantity("width", "m"), material_of(t, materials).density))
    for t in top.tables("point_mass", "node", "mass", "polar_inertia", "diametral_inertia"):
        points.append(
            PointMass(
                node=t.node("node", nodes),
                mass=t.quantity("mass", "kg", zero=True),
                polar_inertia=t.quantity("polar_inertia", "kg.m2", default=0.0, zero=True),
                diametral_inertia=t.quantity("diametral_inertia", "kg.m2", default=0.0, zero=True),
            )
        )
    return tuple(points)


def _support(t: Table, nodes: int) -> Support:
    """Springs and dampers of a node."""
    return Support(
        node=t.node("node", nodes),
        stiffness=t.quantity("stiffness", "N/m", zero=True),
        stiffness_y=t.quantity("stiffness_y", "N/m", zero=True) if "stiffness_y" in t.values else None,
        damping=t.quantity("damping", "N.s/m", default=0.0, zero=True),
        damping_y=t.quantity("damping_y", "N.s/m", zero=True) if "damping_y" in t.values else None,
    )


def _with_gaps(top: Table, shaft: Shaft) -> Shaft:
    """With its gaps; one at a node or a position has a sensor of its own there, or a station if it acts."""
    tables = top.tables("gap", "name", *PLACES, "radial", "journal_radius")
    # a position may cut an element, and nodes beyond count on from there
    for t in sorted(tables, key=lambda t: "position" in t.values):
        shaft = _with_gap(t, shaft)
    return shaft


def _with_gap(t: Table, shaft: Shaft) -> Shaft:
    own = t.quantity("journal_radius", "m") if "journal_radius" in t.values else None
    gap = Gap(t.text("name"), "", t.quantity("radial", "m"), own)
    given = [key for key in PLACES if key in t.values]
    if len(given) != 1:
        raise t.error("name", f"needs one of {', '.join(PLACES)}; it has {' and '.join(given) or 'none'}")
    kind = "sensors" if own is None else "stations"
    if given == ["station"]:
        gap = gap._replace(station=t.text("station"))
        there = [s.name for s in (*shaft.stations, *(shaft.sensors if own is None else ()))]
        if gap.station not in there:
            what = "station or sensor" if own is None else "station"
            raise t.error("station", f"is no {what}; there are: {', '.join(there) or 'none'}")
        return replace(shaft, gaps=(*shaft.gaps, gap))
    if not (gap.key.isascii() and gap.key.isidentifier()):
        raise t.error("name", "must be of letters, digits, _, - and spaces")
    if any(gap.key == s.name for s in (*shaft.stations, *shaft.sensors)):
        raise t.error("name", f"is there twice, as {gap.key}; choose another")
    if len(getattr(shaft, kind)) == MAX_STATIONS:
        raise t.error("name", f"is one of more than {MAX_STATIONS} {kind}")
    if given == ["position"]:
        at = t.quantity("position", "m", zero=True)
        try:
            shaft = with_node(shaft, at)
        except ModelError as error:
            raise t.error("position", f"is no place for a gap: {error}") from None
        node = node_at(shaft, at) or 1
    else:
        node = t.node("node", shaft.nodes)
    places = (*getattr(shaft, kind), Station(gap.key, node))
    return replace(shaft, **{kind: places}, gaps=(*shaft.gaps, gap._replace(station=gap.key)))


def _stations(top: Table, kind: str, nodes: int) -> tuple[Station, ...]:
    """The stations or the sensors; their names become those of variables."""
    if kind not in top.values:
        return ()
    t = top.table(kind)
    if len(t.values) > MAX_STATIONS:
        raise top.error(kind, f"are {len(t.values)}; at most {MAX_STATIONS} are possible")
    for name in t.values:
        if not (name.isascii() and name.isidentifier()) or keyword.iskeyword(name) or name in RESERVED:
            raise t.error(
                name, "has a name that cannot be used; use letters, digits and _, a letter first, and none "
                f"of {', '.join(RESERVED)}"
            )  # fmt: skip
        if kind == "sensors" and name in top.values.get("stations", {}):
            raise t.error(name, "has the name of a station; choose another")
    return tuple(Station(name, t.node(name, nodes)) for name in t.values)


def _levitated(top: Table) -> tuple[str, ...]:
    """Names of the stations that hold the rotor at rest at the start."""
    names = top.get("levitated_at", list, 'a list of stations, such as ["amb_A", "amb_B"]', [])
    there = top.values.get("stations", {})
    for name in names:
        if not isinstance(name, str) or name not in there:
            listed = ", ".join(there) or "none"
            raise top.error("levitated_at", f"names {name!r}, which is no station; there are: {listed}")
    return tuple(names)
