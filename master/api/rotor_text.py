"""A shaft as the text of a rotor file: what `touchdown.rotor.rotor_file` reads back as the same shaft."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping
from itertools import groupby

from touchdown.master.common.errors import TouchdownError
from touchdown.rotor.beams.shaft import Element, PointMass, Shaft, Station, Unbalance

Material = tuple[float, float, float | None]  # modulus (Pa), density (kg/m3), Poisson's ratio of a core


def text(shaft: Shaft) -> str:
    """The rotor file of `shaft`, every number in SI and in full.

    Raises TouchdownError for a shear factor of an element's own, which a file cannot hold.
    """
    materials = _materials(shaft)
    parts = [
        {"title": shaft.title, "about": shaft.about, "damping_ratio": shaft.damping_ratio},
        {"levitated_at": list(shaft.levitated_at)},
    ]
    lines = [line for part in parts for line in _lines(part)]
    for material, name in materials.items():
        lines += ["", f"[material.{name}]", *_lines(_material(material))]
    for element, same in groupby(shaft.elements):
        lines += ["", "[[element]]", *_lines(_element(element, len(list(same)), materials))]
    for kind, rows in _sitting(shaft):
        for row in rows:
            lines += ["", f"[[{kind}]]", *_lines(row)]
    for kind, places in (("stations", shaft.stations), ("sensors", shaft.sensors)):
        lines += ["", f"[{kind}]", *_lines(_nodes(places))]
    return "\n".join(lines) + "\n"


def _materials(shaft: Shaft) -> dict[Material, str]:
    """Names of all materials, cores and sleeves apart."""
    found: dict[Material, str] = {}
    for number, e in enumerate(shaft.elements, start=1):
        if e.shear_factor is not None:
            raise TouchdownError(
                f"rotor {shaft.title}: element {number} has shear_factor = {e.shear_factor:g}, which no "
                "rotor file can hold; leave it out"
            )
        found.setdefault(_core(e), f"core_{len(found) + 1}")
        if e.sleeve_diameter:
            found.setdefault(_sleeve(e), f"sleeve_{len(found) + 1}")
    return found


def _core(e: Element) -> Material:
    return e.modulus, e.density, e.poisson


def _sleeve(e: Element) -> Material:
    return e.sleeve_modulus, e.sleeve_density, None


def _material(material: Material) -> dict[str, object]:
    modulus, density, poisson = material
    given: dict[str, object] = {"modulus": f"{modulus!r} Pa", "density": f"{density!r} kg/m3"}
    return given if poisson is None else {**given, "poisson": poisson}


def _element(e: Element, count: int, materials: Mapping[Material, str]) -> dict[str, object]:
    given: dict[str, object] = {
        "length": f"{e.length!r} m",
        "count": count,
        "outer_diameter": f"{e.outer_diameter!r} m",
        "inner_diameter": f"{e.inner_diameter!r} m",
        "material": materials[_core(e)],
    }
    if e.sleeve_diameter:
        given["sleeve.outer_diameter"] = f"{e.sleeve_diameter!r} m"
        given["sleeve.material"] = materials[_sleeve(e)]
    return given


def _sitting(shaft: Shaft) -> Iterator[tuple[str, Iterable[Mapping[str, object]]]]:
    """What sits on the shaft, by the name of its tables."""
    yield "point_mass", map(_point, shaft.points)
    yield "unbalance", map(_unbalance, shaft.unbalances)


def _point(p: PointMass) -> dict[str, object]:
    return {
        "node": p.node,
        "mass": f"{p.mass!r} kg",
        "polar_inertia": f"{p.polar_inertia!r} kg.m2",
        "diametral_inertia": f"{p.diametral_inertia!r} kg.m2",
    }


def _unbalance(u: Unbalance) -> dict[str, object]:
    return {"node": u.node, "moment": f"{u.moment!r} kg.m", "angle": f"{u.angle!r} rad"}


def _nodes(places: Iterable[Station]) -> dict[str, object]:
    return {place.name: place.node for place in places}


def _lines(values: Mapping[str, object]) -> list[str]:
    """Keys and values as TOML writes them; text, numbers and lists of text look as in JSON."""
    return [f"{key} = {json.dumps(value, ensure_ascii=False)}" for key, value in values.items()]
