"""Rotors of ROSS (Rotordynamic Open Source Software): its saved files, and its objects in Python.

A saved file holds tables of the arguments of each element, and so do the objects as attributes; elements
are told by what they have, so that names of classes, which changed from version to version, do not matter.
ROSS counts nodes from 0. Elements on the same nodes lie in parallel; the stiffest is the core here, the
others are its layers.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ...modelkit.errors import TouchdownError, require
from ...modelkit.reader import TABLE, Kind, Table, number, whole
from ..beams.body import PointMass
from ..beams.element import Element
from ..beams.shaft import MAX_STATIONS, Shaft, Station, Support

ELEMENT_LISTS = ("shaft_elements", "disk_elements", "bearing_elements", "point_mass_elements")
READ_ATTRIBUTES = (  # attributes of elements that matter here
    *("n", "L", "idl", "odl", "idr", "odr", "axial_force", "torque", "alpha", "beta", "n_link"),
    *("shear_effects", "rotary_inertia", "gyroscopic", "shear_method_calc"),
    *("m", "mx", "Id", "Ip", "frequency", "kxx", "kyy", "kxy", "kyx", "cxx", "cyy", "cxy", "cyx"),
)
MIN_CROSS_COUPLING = 1e-9  # of the direct coefficient; cross-coupling below is none
STATION_LETTERS = "ABCDEFGH"


ANY, POSITIVE, NODE = number(), number(above=0.0), whole(0, what="node, a whole number")


@dataclass(frozen=True)
class Part(Table):
    """An element as ROSS has it: its class, and its arguments by name; ROSS counts nodes from 0."""

    kind: str
    name_of: str

    def has(self, *names: str) -> bool:
        """Whether all of these are there."""
        return all(name in self.values for name in names)

    @property
    def node(self) -> int:
        """Counted from 0. Raises TouchdownError."""
        return self.get("n", NODE)


def _part(kind: str, name: str, where: str, values: Mapping[str, Any]) -> Part:
    return Part(f"{where}.", {key: value for key, value in values.items() if value is not None}, kind, name)


def of_elements(data: Mapping[str, Any], file: str, name: str, speed: float | None) -> Shaft:
    """The rotor in a file that `ross.Rotor.save` wrote, as `data` (tables by name). See `read`."""
    parts = [
        _part(key.partition("_")[0], key, f"{file}: {key}", values)
        for key, values in data.items()
        if isinstance(values, Mapping) and key != "parameters"
    ]
    require(
        any(part.has("L", "odl") for part in parts),
        f"{file}: is no rotor that ROSS saved: it has no shaft element with L and odl; "
        "save the whole rotor by rotor.save(file)",
    )
    version = data.get("ross_version")
    about = "Imported from ROSS" + (f" {version}" if isinstance(version, str) else "")
    return _imported(parts, name, about, speed)


def from_ross(rotor: Any, speed: float | None = None) -> Shaft:
    """A `ross.Rotor`; ROSS itself is not needed. Raises TouchdownError.

    speed: rad/s, at which bearings whose coefficients depend on it are taken.
    """
    parts = [_part(type(e).__name__, _name(e), _name(e), _attributes(e)) for e in _elements(rotor)]
    require(
        any(part.has("L", "odl") for part in parts),
        f"a {type(rotor).__name__} is no ross.Rotor: it has no shaft elements",
    )
    title = getattr(rotor, "tag", None) or "Rotor of ROSS"
    return _imported(parts, str(title), "Imported from ROSS", speed)


def _elements(rotor: Any) -> Iterator[Any]:
    for name in ELEMENT_LISTS:
        listed = getattr(rotor, name, None)
        yield from listed if isinstance(listed, Iterable) else ()


def _name(element: Any) -> str:
    return str(getattr(element, "tag", None) or type(element).__name__)


def _attributes(element: Any) -> dict[str, Any]:
    values = {name: getattr(element, name, None) for name in READ_ATTRIBUTES}
    material = getattr(element, "material", None)
    if material is not None:
        values["material"] = {
            name: getattr(material, name, None) for name in ("rho", "E", "G_s", "Poisson")
        }
    return values


def _imported(parts: list[Part], title: str, about: str, speed: float | None) -> Shaft:
    """The rotor of all its parts; `about` begins what it says of itself."""
    shaft_parts = [p for p in parts if p.has("L", "odl")]
    others = [p for p in parts if p not in shaft_parts]
    elements = _shaft(shaft_parts)
    discs = [p for p in others if p.has("m", "Id", "Ip")]
    bearings = [p for p in others if p.has("kxx")]
    remarks = [*_shaft_remarks(shaft_parts)]
    nodes = len(elements) + 1
    points = tuple(
        PointMass(_on(p, nodes) + 1, p.get("m", ANY), p.get("Ip", ANY), p.get("Id", ANY)) for p in discs
    )
    grounded, more = _grounded(bearings, nodes)
    held, unheld = _supports(grounded, speed)
    remarks += [*more, *unheld, *_left_out(others, discs, bearings)]
    return Shaft(
        title,
        elements,
        points,
        stations=_stations(grounded),
        supports=held,
        about="\n".join(f"{remark}." for remark in (about, *remarks)),
    )


def _shaft(parts: list[Part]) -> tuple[Element, ...]:
    """Elements in order, those on the same nodes as core and layers."""
    at: dict[int, list[Part]] = {}
    for part in parts:
        at.setdefault(part.node, []).append(part)
    missing = next((n for n, there in enumerate(sorted(at)) if n != there), None)
    if missing is not None:
        raise TouchdownError(
            f"no shaft element begins at node {missing} of ROSS's: this is more than one shaft, and a "
            "rotor here is one; save them one by one"
        )
    return tuple(_together(at[n]) for n in sorted(at))


def _together(parts: list[Part]) -> Element:
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


def _element(part: Part) -> Element:
    material = part.get("material", Kind(TABLE.take, "a table, as newer versions of ROSS save it"))
    own = _part("Material", part.name_of, part.name("material"), material)
    E = own.get("E", POSITIVE)
    poisson = 0.5 * E / own.get("G_s", POSITIVE) - 1.0 if own.has("G_s") else own.get("Poisson", ANY)
    outer, inner = part.get("odl", POSITIVE), part.get("idl", ANY)
    outer_end, inner_end = part.get("odr", POSITIVE, outer), part.get("idr", ANY, inner)
    return Element(
        length=part.get("L", POSITIVE),
        outer_diameter=outer,
        inner_diameter=inner,
        modulus=E,
        density=own.get("rho", POSITIVE),
        poisson=poisson,
        shear_factor=_shear_factor(part, poisson, (inner + inner_end) / (outer + outer_end)),
        outer_diameter_end=None if outer_end == outer else outer_end,
        inner_diameter_end=None if inner_end == inner else inner_end,
    )


def _shear_factor(part: Part, poisson: float, ratio: float) -> float | None:
    """None for Cowper's, which is the default here, too; else as ROSS has it: Hutchinson's over 1 + nu."""
    if part.values.get("shear_method_calc") != "hutchinson":
        return None
    square = ratio**2
    full = (1.0 + square) ** 2
    below = full * (7.0 + 12.0 * poisson + 4.0 * poisson**2)
    return 6.0 * full * (1.0 + poisson) / (below + 4.0 * square * (5.0 + 6.0 * poisson + 2.0 * poisson**2))


def _shaft_remarks(parts: list[Part]) -> Iterator[str]:
    """Remarks on features of ROSS's beam elements that the elements here do not have."""
    for name, here in (
        ("shear_effects", "elements shear"),
        ("rotary_inertia", "sections have rotary inertia"),
        ("gyroscopic", "elements are gyroscopic"),
    ):
        off = sum(part.values.get(name) is False for part in parts)
        if off:
            yield f"{off} shaft elements have {name} = false in ROSS; here {here}, so frequencies differ"
    for name in ("axial_force", "torque"):
        if any(part.get(name, ANY, 0.0) != 0.0 for part in parts):
            yield f"{name} of shaft elements is left out, so frequencies differ"
    if any(part.get(name, ANY, 0.0) != 0.0 for part in parts for name in ("alpha", "beta")):
        yield "proportional damping (alpha, beta) is left out; set damping_ratio"


def _on(part: Part, nodes: int) -> int:
    """Its node, from 0. Raises TouchdownError where it is beyond the shaft."""
    node = part.node
    require(node < nodes, f"{part.where}n = {node} is not on the shaft, whose nodes are 0 to {nodes - 1}")
    return node


def _grounded(bearings: list[Part], nodes: int) -> tuple[list[Part], list[str]]:
    """Bearings, without seals and what holds others; and remarks about what is left out."""
    seals = [p for p in bearings if "seal" in p.kind.lower()]
    beyond = [p for p in bearings if p not in seals and p.node >= nodes]
    kept = [p for p in bearings if p not in seals and p not in beyond]
    linked = sum(p.has("n_link") for p in kept)
    remarks = [f"{len(seals)} seals are left out"] if seals else []
    if beyond or linked:
        remarks.append(
            "what stands between bearings and ground (n_link) is left out: bearings are grounded"
        )
    return sorted(kept, key=lambda p: p.node), remarks


def _stations(bearings: list[Part]) -> tuple[Station, ...]:
    nodes = list(dict.fromkeys(p.node for p in bearings))[:MAX_STATIONS]
    return tuple(Station(letter, node + 1) for letter, node in zip(STATION_LETTERS, nodes, strict=False))


def _supports(bearings: list[Part], speed: float | None) -> tuple[tuple[Support, ...], list[str]]:
    """Stiffness and damping of bearings, those that depend on the speed at `speed` (rad/s)."""
    remarks: list[str] = []
    supports: list[Support] = []
    for part in bearings:
        if np.size(part.values["kxx"]) > 1 and speed is None:
            remarks.append(
                f"{part.name_of}: its coefficients depend on the speed, and are left out: none was given"
            )
            continue
        k, ky, c, cy = (_coefficient(part, name, speed) for name in ("kxx", "kyy", "cxx", "cyy"))
        supports.append(Support(part.node + 1, k, None if ky == k else ky, c, None if cy == c else cy))
        several = any(np.size(part.values.get(name, 0.0)) > 1 for name in ("kxx", "kyy", "cxx", "cyy"))
        if several and speed is not None:
            given_at = _speeds(part)
            nearest = np.clip(abs(speed), given_at[0], given_at[-1])
            if nearest != abs(speed):
                remarks.append(
                    f"{part.name_of}: taken at {nearest:.6g} rad/s, the nearest speed it is given at"
                )
        if any(
            abs(_coefficient(part, name, speed)) > MIN_CROSS_COUPLING * abs(k or 1.0)
            for name in ("kxy", "kyx", "cxy", "cyx")
        ):
            remarks.append(f"{part.name_of}: its cross-coupled coefficients are left out")
    return tuple(supports), remarks


def _coefficient(part: Part, name: str, speed: float | None) -> float:
    """A coefficient of a bearing, by straight lines between the speeds at which it is given."""
    given = part.values.get(name)
    if given is None and name in ("kyy", "cyy"):
        return _coefficient(part, name[0] + "xx", speed)
    try:
        values = np.atleast_1d(np.asarray(0.0 if given is None else given, dtype=float)).ravel()
        if len(values) == 1 or speed is None:
            value = float(values[0])
        else:
            value = float(np.interp(abs(speed), _speeds(part), values))
    except (TypeError, ValueError):
        raise TouchdownError(f"{part.where}{name} cannot be read as numbers over frequency") from None
    require(math.isfinite(value), f"{part.where}{name} = {value!r} is not a finite number")
    return value


def _speeds(part: Part) -> np.ndarray:
    """Speeds of a bearing's given coefficients, rising (n,), rad/s. Raises TouchdownError."""
    given = np.asarray(part.values.get("frequency"), dtype=float)
    require(np.all(np.diff(given) > 0.0), f"{part.where}the speeds it is given at do not rise")
    return given


def _left_out(others: list[Part], *taken: list[Part]) -> Iterator[str]:
    left = [p for p in others if not any(p in some for some in taken)]
    if left:
        yield f"left out, {len(left)}: {', '.join(dict.fromkeys(p.kind for p in left))}"
