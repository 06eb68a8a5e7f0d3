"""Reads the text of a rotor file (docs/rotor-file.md) and names every mistake in it."""

from __future__ import annotations

import keyword
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ...modelkit.errors import TouchdownError, one_of, require
from ...modelkit.reader import TEXT, Kind, Table, key, mistake, number, toml_of, whole
from ..beams.beam_body import NODE, PointMass, disc_mass, in_unit
from ..beams.element import Element, split_element
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
from ..beams.superelement import MAX_COORDINATES, Superelement, symmetric_body

POSITION_TOLERANCE = 1e-7  # m; positions and sums of lengths this close agree
LENGTH, LENGTH_OR_0 = in_unit("m", above=0.0), in_unit("m", minimum=0.0)


@dataclass(frozen=True)
class Material:
    """Modulus in Pa, density in kg/m3; without Poisson's ratio it can be a sleeve only."""

    modulus: float = key(
        in_unit("Pa", minimum=0.0),
        says='of elasticity; "0 GPa" for what carries nothing, which only a sleeve or a layer may be',
    )
    density: float = key(in_unit("kg/m3", above=0.0))
    poisson: float | None = key(
        number(minimum=-0.9, below=0.5), None, "a material without it can only be a sleeve"
    )


@dataclass(frozen=True)
class Sleeve:
    """What is shrunk onto a core, or begins to describe other parts: diameter in m."""

    outer_diameter: float = key(LENGTH)
    material: str | None = key(TEXT, None, "left out: the only one that can be a core")


@dataclass(frozen=True)
class Layer(Sleeve):
    """A part of an element; lengths in m."""

    inner_diameter: float | None = key(LENGTH_OR_0, None, "of an element 0, of a layer that below it")
    outer_diameter_end: float | None = key(LENGTH, None, "makes it a cone, over all of its `count`")
    inner_diameter_end: float | None = key(LENGTH_OR_0, None, "the same")
    shear_factor: float | None = key(number(minimum=0.1, below=1.2), None, "Cowper's where it is not given")


@dataclass(frozen=True, kw_only=True)
class Core(Layer):
    """[[element]], without what is around it."""

    length: float = key(LENGTH, says="of each of them")
    count: int = key(whole(1), 1, "how many follow each other")
    position: float | None = key(LENGTH_OR_0, None, "where it starts, to check the sum of the lengths")


@dataclass(frozen=True, kw_only=True)
class Disc(Sleeve):
    """[[disc]]."""

    node: int = key(NODE)
    inner_diameter: float = key(LENGTH_OR_0)
    width: float = key(LENGTH)


@dataclass(frozen=True)
class GapAt:
    """[[gap]], whose place is given in one of three ways."""

    name: str = key(TEXT)
    radial: float = key(LENGTH)
    journal_radius: float | None = key(LENGTH, None, "of the rotor there, where touching acts")
    station: str | None = key(TEXT, None, "or sensor: its place")
    node: int | None = key(NODE, None, "or this one")
    position: float | None = key(
        LENGTH_OR_0, None, "or this, from node 1; an element is cut where no node is there"
    )


def _material(t: Table, name: str | None, materials: dict[str, Material]) -> Material:
    """The material called so; without a name the only one that can be a core."""
    cores = [one for one in materials.values() if one.poisson is not None]
    if name is None and len(cores) == 1:
        return cores[0]
    if name not in materials:
        says = "is missing" if name is None else "is not a material of this file"
        raise t.error("material", f"{says}; {one_of(name or '', materials)}")
    return materials[name]


def _check_inside(t: Table, inner: float, outer: float, end: str = "") -> None:
    """Of the diameters (m) at one end, which two keys say, or what is beneath a layer."""
    if inner < outer:
        return
    outside = f"outer_diameter{end}" if f"outer_diameter{end}" in t.values else "outer_diameter"
    for bore in (f"inner_diameter{end}", "inner_diameter"):
        if bore in t.values:
            raise t.error(bore, f"must be below {outside} = {t.values[outside]!r}")
    raise t.error(outside, "must be above what it sits on")


def _elements(top: Table, materials: dict[str, Material]) -> tuple[Element, ...]:
    """The elements of a file, in order from node 1."""
    elements: list[Element] = []
    end = 0.0
    for t in top.tables("element"):
        said = t.read(Core, "sleeve", "layers")
        if said.position is not None and abs(said.position - end) > POSITION_TOLERANCE:
            what = "leaves a gap after" if said.position > end else "overlaps"
            raise t.error(
                "position",
                f"{what} the elements before it, which end at {1e3 * end:.6g} mm; mend it or their lengths",
            )
        nodes = len(elements) + said.count + 1
        require(
            nodes <= MAX_NODES,
            f"{t.where[:-1]} brings the rotor to {nodes} nodes; at most {MAX_NODES} are possible, take "
            "fewer and longer elements",
        )
        element = _element(t, said, materials)
        elements += [piece.stretched(element.length) for piece in split_element(element, said.count)]
        end += said.count * element.length
    top.require(elements, "element", "is missing; describe the shaft by one table [[element]] or more")
    return tuple(elements)


def _element(t: Table, said: Core, materials: dict[str, Material]) -> Element:
    core = _part(t, said, materials, said.length, beneath=None)
    t.require(
        core.modulus != 0.0,
        "material",
        "has a modulus of 0, which only a sleeve or layer may have; name another",
    )
    if "sleeve" in t.values:
        t.require(not core.tapered, "sleeve", "cannot sit on a cone; write it as one of layers")
        table = t.table("sleeve")
        sleeve = table.read(Sleeve)
        if sleeve.outer_diameter <= core.outer_diameter:
            below = t.values["outer_diameter"]
            raise table.error("outer_diameter", f"must be above that of the core it sits on, {below!r}")
        material = _material(table, sleeve.material, materials)
        return replace(
            core,
            sleeve_diameter=sleeve.outer_diameter,
            sleeve_density=material.density,
            sleeve_modulus=material.modulus,
        )
    layers: list[Element] = []
    for layer in t.tables("layers"):
        beneath = layers[-1] if layers else core
        layers.append(_part(layer, layer.read(Layer), materials, said.length, beneath))
    return replace(core, layers=tuple(layers))


def _part(
    t: Table, said: Layer, materials: dict[str, Material], length: float, beneath: Element | None
) -> Element:
    """A core, or a layer on what is `beneath` it, whose outside is its bore where nothing is said."""
    bores = (0.0, 0.0) if beneath is None else (beneath.outer_diameter, beneath.diameters(1.0)[0])
    outer, inner = said.outer_diameter, said.inner_diameter
    bore_end = bores[1] if inner is None and beneath is not None else inner
    inner = bores[0] if inner is None else inner
    bore_end = inner if bore_end is None else bore_end
    outer_end = outer if said.outer_diameter_end is None else said.outer_diameter_end
    inner_end = bore_end if said.inner_diameter_end is None else said.inner_diameter_end
    _check_inside(t, inner, outer)
    _check_inside(t, inner_end, outer_end, "_end")
    material = _material(t, said.material, materials)
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
        shear_factor=said.shear_factor,
        outer_diameter_end=None if outer_end == outer else outer_end,
        inner_diameter_end=None if inner_end == inner else inner_end,
    )


# -- a superelement ----------------------------------------------------------------------------------

ENTRY = ("row", "column", "value")


def _block(value: Any, name: str) -> np.ndarray:
    """All numbers of a text, one after the other."""
    numbers = np.array(value.split() if isinstance(value, str) else None, dtype=float)
    if not np.all(np.isfinite(numbers)):
        raise ValueError
    return numbers


def _entries(value: Any, name: str) -> np.ndarray:
    """Rows, columns and values of a matrix (entries, 3), rows and columns from 1."""
    numbers = _block(value, name)
    if len(numbers) % len(ENTRY):
        raise mistake(name, value, f"must have three numbers for each entry: {', '.join(ENTRY)}")
    entries = numbers.reshape(-1, len(ENTRY))
    places = entries[:, :2]
    if np.any(places != np.round(places)) or np.any(places < 1.0):
        raise mistake(name, value, "has an entry whose row or column is not a whole number from 1 on")
    if len(np.unique(places, axis=0)) < len(places):
        raise mistake(name, value, "has two entries at one place")
    if np.any(places[:, 1] > MAX_COORDINATES):
        raise mistake(name, value, f"has more than {MAX_COORDINATES} columns, the most that is possible")
    return entries


BLOCK = Kind(_block, "a block of finite numbers in SI")
ENTRIES = Kind(_entries, BLOCK.meant)


@dataclass(frozen=True, kw_only=True)
class Blocks:
    """[superelement]."""

    positions: np.ndarray = key(BLOCK, says="of the nodes, m")
    mass: np.ndarray | None = key(ENTRIES, None, "without it the coordinates are mass-normalised")
    stiffness: np.ndarray = key(
        ENTRIES,
        says="a line `row column value` for each entry on and below the diagonal; rows and columns count "
        "from 1 and are deflection (m) and slope of node after node",
    )
    gyroscopic: np.ndarray = key(ENTRIES, says="the matrix of polar inertias")
    shapes: np.ndarray | None = key(
        ENTRIES, None, "how coordinates, such as modes, move deflection and slope of the nodes"
    )


def _superelement(t: Table) -> Superelement:
    """The superelement of a table. Raises TouchdownError for values that are not of a free rotor."""
    said = t.read(Blocks)
    count = 2 * len(said.positions)
    t.require(count <= 2 * MAX_COORDINATES, "positions", f"must be of at most {MAX_COORDINATES} nodes")
    n = count if said.shapes is None else int(np.max(said.shapes[:, 1], initial=0.0))

    def filled(name: str, size: tuple[int, int]) -> np.ndarray:
        """The matrix of all entries, zero elsewhere."""
        entries, matrix = getattr(said, name), np.zeros(size)
        rows, columns = (entries[:, i].astype(int) - 1 for i in (0, 1))
        t.require(
            not np.any(rows >= size[0]) and not np.any(columns >= size[1]),
            name,
            f"has an entry beyond its {size[0]} rows and {size[1]} columns",
        )
        matrix[rows, columns] = entries[:, 2]
        return matrix

    def symmetric(name: str) -> np.ndarray:
        """Of the entries on and below its diagonal."""
        lower = filled(name, (n, n))
        t.require(
            not np.any(np.triu(lower, 1)),
            name,
            "has an entry above the diagonal; write those on it and below",
        )
        return lower + np.tril(lower, -1).T

    body = Superelement(
        said.positions,
        np.eye(n) if said.mass is None else symmetric("mass"),
        symmetric("stiffness"),
        symmetric("gyroscopic"),
        None if said.shapes is None else filled("shapes", (count, n)),
    )
    try:
        return symmetric_body(body)
    except TouchdownError as error:
        raise TouchdownError(f"{t.where[:-1]}: {error}") from None


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


# -- the whole ---------------------------------------------------------------------------------------

BEAMS = ("material", "element", "disc", "point_mass")
OTHERS = (*BEAMS, "superelement", "unbalance", "support", "stations", "sensors", "gap")
PLACES = ("station", "node", "position")  # of a gap
RESERVED = ("station", "sensor", "node", "stress", "energy", "mass", "modes")  # names of other variables


def parse_rotor(text: str, file: str) -> Shaft:
    """The rotor that `text` describes; `file` is what to call it in messages. Raises TouchdownError."""
    top = Table(f"{file}: ", toml_of(text, file))
    shaft = top.read(Shaft, *OTHERS)
    if "superelement" not in top.values:
        group = top.table("material")
        materials = {name: group.table(name).read(Material) for name in group.values}
        shaft = replace(shaft, elements=_elements(top, materials))
        points: list[PointMass] = []
        for t, one in _on_nodes(top, "disc", Disc, shaft.nodes):
            _check_inside(t, one.inner_diameter, one.outer_diameter)
            density = _material(t, one.material, materials).density
            points.append(disc_mass(one.node, one.outer_diameter, one.inner_diameter, one.width, density))
        points += [one for _, one in _on_nodes(top, "point_mass", PointMass, shaft.nodes)]
        shaft = replace(shaft, points=tuple(points))
    elif beams := [name for name in BEAMS if name in top.values]:
        raise top.error(beams[0], "cannot stand beside superelement, whose matrices are those of the whole")
    else:
        shaft = replace(shaft, superelement=_superelement(top.table("superelement")))
    stations = _stations(top, "stations", shaft.nodes)
    for name in shaft.levitated_at:
        if name not in [station.name for station in stations]:
            there = one_of(name, [station.name for station in stations])
            raise top.error("levitated_at", f"names {name!r}, which is not a station; {there}")
    shaft = replace(
        shaft,
        unbalances=tuple(one for _, one in _on_nodes(top, "unbalance", Unbalance, shaft.nodes)),
        stations=stations,
        sensors=_stations(top, "sensors", shaft.nodes),
        supports=tuple(one for _, one in _on_nodes(top, "support", Support, shaft.nodes)),
    )
    # a position may cut an element, and nodes beyond count on from there
    for t in sorted(top.tables("gap"), key=lambda t: "position" in t.values):
        shaft = _with_gap(t, shaft)
    return shaft


def _check_node(t: Table, name: str, node: int, nodes: int) -> None:
    t.require(node <= nodes, name, f"is not a node; the elements make nodes 1 to {nodes}")


def _on_nodes(top: Table, name: str, declared: type[Any], nodes: int) -> Iterator[tuple[Table, Any]]:
    """The tables [[name]], and what they declare, each at a node."""
    for t in top.tables(name):
        one = t.read(declared)
        _check_node(t, "node", one.node, nodes)
        yield t, one


def _with_gap(t: Table, shaft: Shaft) -> Shaft:
    """With a gap; one at a node or a position has a sensor of its own there, or a station if it acts."""
    said = t.read(GapAt)
    gap = Gap(said.name, said.station or "", said.radial, said.journal_radius)
    keys = [name for name in PLACES if name in t.values]
    t.require(
        len(keys) == 1, "name", f"needs one of {', '.join(PLACES)}; it has {' and '.join(keys) or 'none'}"
    )
    acts = gap.journal_radius is not None
    kind = "stations" if acts else "sensors"
    if said.station is not None:
        there = [s.name for s in (*shaft.stations, *(() if acts else shaft.sensors))]
        if gap.station not in there:
            what = "station" if acts else "station or sensor"
            raise t.error("station", f"is not a {what}; {one_of(gap.station, there)}")
        return replace(shaft, gaps=(*shaft.gaps, gap))
    t.require(
        gap.key.isascii() and gap.key.isidentifier(), "name", "must be of letters, digits, _, - and spaces"
    )
    t.require(
        not any(gap.key == s.name for s in (*shaft.stations, *shaft.sensors)),
        "name",
        f"is there twice, as {gap.key}; choose another",
    )
    t.require(
        len(getattr(shaft, kind)) != MAX_STATIONS, "name", f"is one of more than {MAX_STATIONS} {kind}"
    )
    node = said.node or 1
    _check_node(t, "node", node, shaft.nodes)
    if said.position is not None:
        try:
            shaft = with_node(shaft, said.position)
        except TouchdownError as error:
            raise t.error("position", f"is not a place for a gap: {error}") from None
        node = node_at(shaft, said.position) or 1
    places = (*getattr(shaft, kind), Station(gap.key, node))
    return replace(shaft, **{kind: places}, gaps=(*shaft.gaps, gap._replace(station=gap.key)))


def _stations(top: Table, kind: str, nodes: int) -> tuple[Station, ...]:
    """The stations or the sensors; their names become those of variables."""
    if kind not in top.values:
        return ()
    t = top.table(kind)
    top.require(
        len(t.values) <= MAX_STATIONS, kind, f"are {len(t.values)}; at most {MAX_STATIONS} are possible"
    )
    found: list[Station] = []
    for name in t.values:
        t.require(
            (name.isascii() and name.isidentifier())
            and not keyword.iskeyword(name)
            and name not in RESERVED,
            name,
            "has a name that cannot be used; use letters, digits and _, a letter first, and none "
            f"of {', '.join(RESERVED)}",
        )
        t.require(
            kind != "sensors" or name not in top.values.get("stations", {}),
            name,
            "has the name of a station; choose another",
        )
        found.append(Station(name, t.get(name, NODE)))
        _check_node(t, name, found[-1].node, nodes)
    return tuple(found)
