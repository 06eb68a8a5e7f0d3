"""The text of a rotor file, read."""

from __future__ import annotations

import keyword
import tomllib
from dataclasses import replace

from touchdown.rotor.beams.shaft import MOST_STATIONS, PointMass, Shaft, Station, Support, Unbalance, disc
from touchdown.rotor.file.elements import Material, diameters_of, elements_of, material_of, materials_of
from touchdown.rotor.file.superelement import superelement_of
from touchdown.rotor.file.table import RotorFileError, Table

BEAMS = ("material", "element", "disc", "point_mass")
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
             "stations", "sensors", "levitated_at")  # fmt: skip
    made = _made(top)
    nodes = made.nodes
    return replace(
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
    )


def _made(top: Table) -> Shaft:
    """What the rotor is made of, and how it is called."""
    told = Shaft(
        title=top.text("title"),
        about=top.text("about", ""),
        damping_ratio=top.number("damping_ratio", 0.0, 1.0, default=0.003),
    )
    if "superelement" not in top.values:
        materials = materials_of(top)
        elements = elements_of(top, materials)
        return replace(told, elements=elements, points=_points(top, materials, len(elements) + 1))
    if beams := [name for name in BEAMS if name in top.values]:
        raise top.error(beams[0], "cannot stand beside superelement, whose matrices are those of the whole")
    return replace(told, superelement=superelement_of(top.table("superelement")))


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


def _stations(top: Table, kind: str, nodes: int) -> tuple[Station, ...]:
    """The stations or the sensors; their names become those of variables."""
    if kind not in top.values:
        return ()
    t = top.table(kind)
    if len(t.values) > MOST_STATIONS:
        raise top.error(kind, f"are {len(t.values)}; at most {MOST_STATIONS} are possible")
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
