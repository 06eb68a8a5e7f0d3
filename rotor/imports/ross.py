"""Rotors of ROSS (Rotordynamic Open Source Software): its saved files, and its objects in Python.

A saved file holds tables of the arguments of each element, and so do the objects as attributes; elements
are told by the names of their classes. What is of no known class, such as a coupling, is left out, and
`about` names it. ROSS counts nodes from 0. Elements on the same nodes lie in parallel; the stiffest is the
core here, the others are its layers.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ...modelkit.errors import TouchdownError, require
from ...modelkit.reader import TABLE, Kind, Table, number, whole
from ..beams.beam_body import PointMass
from ..beams.element import Element
from ..beams.shaft import MAX_STATIONS, Shaft, Station, Support

SHAFT, DISC, POINT, SEAL, BEARING = "shaft", "disc", "point mass", "seal", "bearing"
ROLES = {  # part of the name of a class, in versions 0.4 to 3.1: what the element is
    "Coupling": "",
    "Shaft": SHAFT,
    "Disk": DISC,
    "Gear": DISC,
    "PointMass": POINT,
    "Seal": SEAL,
    **dict.fromkeys(("Bearing", "Journal", "TiltingPad", "SqueezeFilm"), BEARING),
}
READ_ATTRIBUTES = (  # attributes of elements that matter here
    *("n", "L", "idl", "odl", "idr", "odr", "axial_force", "torque", "alpha", "beta", "n_link"),
    *("shear_effects", "rotary_inertia", "gyroscopic", "shear_method_calc"),
    *("m", "mx", "my", "Id", "Ip", "speed", "frequency", "kxx", "kyy", "cxx", "cyy"),
    *("kxy", "kyx", "cxy", "cyx", "mxx", "myy", "mxy", "myx", "kzz", "czz", "mzz"),
)
DIRECT = "kxx", "kyy", "cxx", "cyy"
LEFT_OUT = {  # other coefficients of bearings
    "cross-coupled": ("kxy", "kyx", "cxy", "cyx"),
    "mass": ("mxx", "myy", "mxy", "myx"),
    "axial": ("kzz", "czz", "mzz"),
}
MIN_COEFFICIENT = 1e-9  # of the direct stiffness; a coefficient below counts as 0
STATION_LETTERS = "ABCDEFGH"


ANY, POSITIVE, NODE = number(), number(above=0.0), whole(0, what="node, a whole number")


@dataclass(frozen=True)
class RossPart(Table):
    """An element as ROSS has it: its class, and its arguments by name; ROSS counts nodes from 0."""

    kinds: Sequence[str]  # its class, and those that this is derived from
    name_of: str

    @property
    def role(self) -> str:
        """What it is; "" where that is not known."""
        return next((role for kind in self.kinds for word, role in ROLES.items() if word in kind), "")

    @property
    def node(self) -> int:
        """Counted from 0. Raises TouchdownError."""
        return self.get("n", NODE)


def _part(kinds: Sequence[str], name: str, where: str, values: Mapping[str, Any]) -> RossPart:
    return RossPart(
        f"{where}.", {key: value for key, value in values.items() if value is not None}, kinds, name
    )


def of_elements(data: Mapping[str, Any], file: str, name: str, speed: float | None) -> Shaft:
    """The rotor in a file that `ross.Rotor.save` wrote, as `data` (tables by name). See `read`."""
    parts = [
        _part([key.partition("_")[0]], key, f"{file}: {key}", values)
        for key, values in data.items()
        if isinstance(values, Mapping) and key != "parameters"
    ]
    require(
        any(part.role == SHAFT for part in parts),
        f"{file}: is not a rotor that ROSS saved: it has no ShaftElement; save the whole rotor by "
        "rotor.save(file)",
    )
    version = data.get("ross_version")
    about = "Imported from ROSS" + (f" {version}" if isinstance(version, str) else "")
    return _imported(parts, name, about, speed)


def from_ross(rotor: Any, speed: float | None = None) -> Shaft:
    """A `ross.Rotor`; ROSS itself is not needed. Raises TouchdownError.

    speed: rad/s, at which bearings whose coefficients depend on it are taken.
    """
    parts = [_part_of(element) for element in getattr(rotor, "elements", None) or ()]
    require(
        any(part.role == SHAFT for part in parts),
        f"a {type(rotor).__name__} is not a ross.Rotor: it has no shaft elements",
    )
    title = getattr(rotor, "tag", None) or "Rotor of ROSS"
    return _imported(parts, str(title), "Imported from ROSS", speed)


def _part_of(element: Any) -> RossPart:
    values = {name: getattr(element, name, None) for name in READ_ATTRIBUTES}
    material = getattr(element, "material", None)
    if material is not None:
        values["material"] = {
            name: getattr(material, name, None) for name in ("rho", "E", "G_s", "Poisson")
        }
    kinds = [kind.__name__ for kind in type(element).__mro__]
    name = f"{kinds[0]}_{getattr(element, 'tag', None) or ''}".rstrip("_")
    return _part(kinds, name, name, values)


def _imported(parts: list[RossPart], title: str, about: str, speed: float | None) -> Shaft:
    """The rotor of all its parts; `about` begins what it says of itself."""
    roles = {role: [p for p in parts if p.role == role] for role in (SHAFT, DISC, POINT, SEAL, BEARING, "")}
    elements = _shaft(roles[SHAFT], roles[""])
    nodes = len(elements) + 1
    points, uneven = _points(roles[DISC], [p for p in roles[POINT] if p.node < nodes], nodes)
    on_shaft = sorted((p for p in roles[BEARING] if p.node < nodes), key=lambda p: p.node)
    grounded = [p for p in on_shaft if _holds(p)]
    held, unheld = _supports(grounded, speed)
    remarks = [*_shaft_remarks(roles[SHAFT]), *uneven]
    if roles[SEAL]:
        remarks.append(f"{len(roles[SEAL])} seals are left out")
    if any(p.node >= nodes or "n_link" in p.values for p in roles[BEARING]):
        remarks.append(
            "what stands between bearings and ground (n_link) is left out: bearings are grounded"
        )
    remarks += unheld
    left = [
        *roles[""],
        *(p for p in roles[POINT] if p.node >= nodes),
        *(p for p in on_shaft if not _holds(p)),
    ]
    if left:
        remarks.append(f"left out, {len(left)}: {', '.join(p.name_of for p in left)}")
    return Shaft(
        title,
        elements,
        points,
        stations=_stations(grounded),
        supports=held,
        about="\n".join(f"{remark}." for remark in (about, *remarks)),
    )


def _points(
    discs: list[RossPart], masses: list[RossPart], n: int
) -> tuple[tuple[PointMass, ...], list[str]]:
    """Of discs, and of masses on the shaft; remarks on those whose masses in x and y differ."""
    found = [PointMass(_on(p, n) + 1, *(p.get(name, ANY) for name in ("m", "Ip", "Id"))) for p in discs]
    remarks: list[str] = []
    for part in masses:
        mx, my = (part.get(name if name in part.values else "m", ANY) for name in ("mx", "my"))
        found.append(PointMass(part.node + 1, 0.5 * (mx + my)))
        if mx != my:
            remarks.append(f"{part.name_of}: has the mean of its masses in x and y, {mx:g} and {my:g} kg")
    return tuple(found), remarks


def _shaft(parts: list[RossPart], others: list[RossPart]) -> tuple[Element, ...]:
    """Elements in order, those on the same nodes as core and layers; `others`: what may be in a gap."""
    on_node: dict[int, list[RossPart]] = {}
    for part in parts:
        on_node.setdefault(part.node, []).append(part)
    missing = next((n for n, there in enumerate(sorted(on_node)) if n != there), None)
    if missing is not None:
        between = [p.name_of for p in others if p.values.get("n") == missing]
        raise TouchdownError(
            f"no shaft element begins at node {missing} of ROSS's{''.join(f', but {b}' for b in between)}: "
            "this is more than one shaft, and a rotor here is one; save them one by one"
        )
    return tuple(_together(on_node[n]) for n in sorted(on_node))


def _together(parts: list[RossPart]) -> Element:
    elements = sorted((_element(part) for part in parts), key=lambda e: -e.EI)
    core, *layers = elements
    for part in parts:
        require(
            abs(part.get("L", ANY) - core.length) <= 1e-9 * core.length,
            f"{part.where}L = {part.get('L', ANY):g} m, but another element on the same nodes has "
            f"{core.length:g} m",
        )
    layers = [layer.stretched(core.length) for layer in layers]
    return replace(core, layers=tuple(sorted(layers, key=lambda e: e.inner_diameter)))


def _element(part: RossPart) -> Element:
    material = part.get("material", Kind(TABLE.take, "a table, as newer versions of ROSS save it"))
    material_part = _part((), part.name_of, part.name("material"), material)
    E = material_part.get("E", POSITIVE)
    shear = material_part.get("G_s", POSITIVE, None)
    poisson = material_part.get("Poisson", ANY) if shear is None else 0.5 * E / shear - 1.0
    outer, inner = part.get("odl", POSITIVE), part.get("idl", ANY)
    outer_end, inner_end = part.get("odr", POSITIVE, outer), part.get("idr", ANY, inner)
    return Element(
        length=part.get("L", POSITIVE),
        outer_diameter=outer,
        inner_diameter=inner,
        modulus=E,
        density=material_part.get("rho", POSITIVE),
        poisson=poisson,
        shear_factor=_shear_factor(part, poisson, (inner + inner_end) / (outer + outer_end)),
        outer_diameter_end=None if outer_end == outer else outer_end,
        inner_diameter_end=None if inner_end == inner else inner_end,
    )


def _shear_factor(part: RossPart, poisson: float, ratio: float) -> float | None:
    """None for Cowper's, which is the default here, too; else as ROSS has it: Hutchinson's over 1 + nu."""
    if part.values.get("shear_method_calc") != "hutchinson":
        return None
    square = ratio**2
    full = (1.0 + square) ** 2
    below = full * (7.0 + 12.0 * poisson + 4.0 * poisson**2)
    return 6.0 * full * (1.0 + poisson) / (below + 4.0 * square * (5.0 + 6.0 * poisson + 2.0 * poisson**2))


def _shaft_remarks(parts: list[RossPart]) -> Iterator[str]:
    """Remarks on features of ROSS's beam elements that the elements here do not have."""
    for name, ours in (
        ("shear_effects", "elements shear"),
        ("rotary_inertia", "sections have rotary inertia"),
        ("gyroscopic", "elements are gyroscopic"),
    ):
        off = sum(part.values.get(name) is False for part in parts)
        if off:
            yield f"{off} shaft elements have {name} = false in ROSS; here {ours}, so frequencies differ"
    for name in ("axial_force", "torque"):
        if any(part.get(name, ANY, 0.0) != 0.0 for part in parts):
            yield f"{name} of shaft elements is left out, so frequencies differ"
    if any(part.get(name, ANY, 0.0) != 0.0 for part in parts for name in ("alpha", "beta")):
        yield "proportional damping (alpha, beta) is left out; set damping_ratio"


def _on(part: RossPart, nodes: int) -> int:
    """Its node, from 0. Raises TouchdownError where it is beyond the shaft."""
    node = part.node
    require(node < nodes, f"{part.where}n = {node} is not on the shaft, whose nodes are 0 to {nodes - 1}")
    return node


def _holds(bearing: RossPart) -> bool:
    """Whether it does across the shaft; thrust pads do not."""
    return any(np.any(_numbers(bearing, name)) for name in DIRECT)


def _stations(bearings: list[RossPart]) -> tuple[Station, ...]:
    nodes = list(dict.fromkeys(p.node for p in bearings))[:MAX_STATIONS]
    return tuple(Station(letter, node + 1) for letter, node in zip(STATION_LETTERS, nodes, strict=False))


def _supports(bearings: list[RossPart], speed: float | None) -> tuple[tuple[Support, ...], list[str]]:
    """Stiffness and damping of bearings, those that depend on the speed at `speed` (rad/s)."""
    remarks: list[str] = []
    supports: list[Support] = []
    for part in bearings:
        largest = max((_numbers(part, name) for name in DIRECT), key=np.size)
        if largest.size > 1 and speed is None:
            remarks.append(
                f"{part.name_of}: its coefficients depend on the speed, and are left out: none was given"
            )
            continue
        spin = abs(speed or 0.0)
        k, ky, c, cy = (_coefficient(part, name, spin) for name in DIRECT)
        supports.append(Support(part.node + 1, k, None if ky == k else ky, c, None if cy == c else cy))
        for speeds in _axes(part, "kxx", largest):
            if not speeds[0] <= spin <= speeds[-1]:
                nearest = np.clip(spin, speeds[0], speeds[-1])
                remarks.append(
                    f"{part.name_of}: taken at {nearest:.6g} rad/s, the nearest speed it is given at"
                )
        for what, names in LEFT_OUT.items():
            if any(abs(_coefficient(part, name, spin)) > MIN_COEFFICIENT * abs(k or 1.0) for name in names):
                remarks.append(f"{part.name_of}: its {what} coefficients are left out")
    return tuple(supports), remarks


def _coefficient(part: RossPart, name: str, spin: float) -> float:
    """A coefficient of a bearing, by straight lines between the speeds (rad/s) at which it is given."""
    values = _numbers(part, name)
    for axis in reversed(_axes(part, name, values)):
        values = np.array([np.interp(spin, axis, row) for row in values.reshape(-1, len(axis))])
    value = float(values.ravel()[0])
    require(math.isfinite(value), f"{part.where}{name} = {value!r} is not a finite number")
    return value


def _numbers(part: RossPart, name: str) -> np.ndarray:
    """What a bearing has by this name: of any shape, at least one. Raises TouchdownError."""
    entry = part.values.get(name, part.values.get(f"{name[0]}xx", 0.0) if name[1:] == "yy" else 0.0)
    try:
        values = np.asarray(entry, dtype=float)
    except (TypeError, ValueError):
        values = np.array([])
    require(values.size, f"{part.where}{name} cannot be read as numbers")
    return values


def _axes(part: RossPart, name: str, values: np.ndarray) -> list[np.ndarray]:
    """The speeds, excitation frequencies or both, rising (rad/s), that `values` are given over."""
    if values.size == 1:
        return []
    axes = [_numbers(part, axis) for axis in ("speed", "frequency") if axis in part.values][: values.ndim]
    require(
        values.shape == tuple(axis.size for axis in axes),
        f"{part.where}{name} cannot be read as numbers over speed or frequency",
    )
    for axis in axes:
        require(np.all(np.diff(axis) > 0.0), f"{part.where}the speeds it is given at do not rise")
    return axes
