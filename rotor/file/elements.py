"""The shaft of a rotor file: materials, and the elements with their sleeves."""

from __future__ import annotations

from dataclasses import dataclass, replace

from touchdown.rotor.beams.element import Element, split
from touchdown.rotor.beams.shaft import MOST_NODES
from touchdown.rotor.file.table import RotorFileError, Table

DIAMETERS = ("outer_diameter", "inner_diameter", "outer_diameter_end", "inner_diameter_end")
CLOSE = 1e-7  # m; positions and sums of lengths this close agree


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
        if nodes > MOST_NODES:
            raise RotorFileError(
                f"{top.file}: {t.where} brings the rotor to {nodes} nodes; "
                f"at most {MOST_NODES} are possible, take fewer and longer elements"
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
    if abs(start - end) > CLOSE:
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
    """What a sleeve adds to an `Element` whose core has the diameter `outer` (m)."""
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
