"""Rotor files: a shaft written by hand in TOML.

    title = "Stub shaft"

    [material.steel]
    modulus = "207 GPa"
    density = "7830 kg/m3"
    poisson = 0.3            # a material without it can be a sleeve only

    [material.laminations]
    modulus = "0 GPa"        # carries nothing
    density = "7650 kg/m3"

    [[element]]              # in order from node 1
    length = "20 mm"         # of each of them
    count = 4
    outer_diameter = "28 mm"
    sleeve = { outer_diameter = "55 mm", material = "laminations" }

    [[disc]]
    node = 5
    outer_diameter = "80 mm"
    inner_diameter = "28 mm"
    width = "10 mm"

    [[unbalance]]
    node = 5
    moment = "3 g.mm"

    [stations]               # where bearings hold it: NAME = node
    A = 1
    B = 5
    amb = 3

    [sensors]                # where only its motion is asked for
    near_amb = 4

Also known: about, damping_ratio, levitated_at = ["amb"] (the stations that hold the rotor at rest at the
start); in an element inner_diameter, material and position (its start, to check the sum of lengths);
[[point_mass]] with node, mass, polar_inertia, diametral_inertia; in an unbalance angle. Every physical
quantity is text with a unit.
"""

from __future__ import annotations

import keyword
import tomllib
from dataclasses import dataclass
from difflib import get_close_matches
from pathlib import Path
from textwrap import shorten
from typing import Any

from touchdown.modelkit.model import ModelError
from touchdown.modelkit.units import UnitError, to_si, units_of
from touchdown.rotor.beams.shaft import (
    MOST_NODES,
    MOST_STATIONS,
    Element,
    PointMass,
    Shaft,
    Station,
    Unbalance,
    disc,
)

DATA = Path(__file__).parent / "data"
CLOSE = 1e-7  # m; positions and sums of lengths this close agree
RESERVED = ("station", "sensor", "node", "stress", "energy", "mass", "modes")  # names of other variables
EXAMPLES = {
    "m": "12.5 mm", "Pa": "207 GPa", "kg/m3": "7830 kg/m3", "kg": "0.5 kg", "kg.m2": "0.002 kg.m2",
    "kg.m": "3 g.mm", "rad": "90 deg",
}  # fmt: skip
LIMITS = {  # beyond them it is a slip, or too far apart to calculate with
    "m": (1e-4, 1e2), "Pa": (1e6, 1e13), "kg/m3": (1.0, 1e5), "kg": (1e-9, 1e6), "kg.m2": (1e-15, 1e7),
    "kg.m": (1e-12, 1e3), "rad": (0.0, 1e3),
}  # fmt: skip


class RotorFileError(ModelError):
    """A mistake in a rotor file: file, place, value and remedy in one line."""


def shipped() -> dict[str, Path]:
    """Rotor files that come with the package, by name."""
    return {path.stem: path for path in sorted(DATA.glob("*.toml"))}


def load(path: str | Path) -> Shaft:
    """The rotor written in the file at `path`. Raises RotorFileError."""
    return parse(read(Path(path)), str(path))


def find(name: str) -> Shaft:
    """A rotor of the package's by name, or the one in a file (.toml).

    Raises RotorFileError where the file has a mistake, LookupError for an unknown name.
    """
    if name.endswith(".toml"):
        return load(Path(name))
    if name not in shipped():
        raise LookupError(f"there is no rotor called {name}")
    return load(shipped()[name])


def read(path: Path) -> str:
    """The text of a rotor file. Raises RotorFileError."""
    try:
        return path.read_text(encoding="utf-8")
    except OSError as error:
        raise RotorFileError(f"{path}: cannot be read: {error.strerror}") from None
    except UnicodeDecodeError as error:
        raise RotorFileError(
            f"{path}: is not text in UTF-8 (byte {error.start}); save it as UTF-8"
        ) from None


def parse(text: str, file: str) -> Shaft:
    """The rotor that `text` describes; `file` is what to call it in messages. Raises RotorFileError."""
    try:
        top = _Table(file, "", tomllib.loads(text))
    except tomllib.TOMLDecodeError as error:
        raise RotorFileError(f"{file}: is not valid TOML: {error}") from None
    top.only("title", "about", "damping_ratio", "material", "element", "disc", "point_mass", "unbalance",
             "stations", "sensors", "levitated_at")  # fmt: skip
    materials = _materials(top)
    elements = _elements(top, materials)
    nodes = len(elements) + 1
    return Shaft(
        title=top.text("title"),
        about=top.text("about", ""),
        elements=elements,
        points=_points(top, materials, nodes),
        unbalances=tuple(
            Unbalance(
                node=_node(t, "node", nodes),
                moment=t.quantity("moment", "kg.m", zero=True),
                angle=t.quantity("angle", "rad", default=0.0, zero=True, negative=True),
            )
            for t in top.tables("unbalance", "node", "moment", "angle")
        ),
        stations=_stations(top, "stations", nodes),
        sensors=_stations(top, "sensors", nodes),
        levitated_at=_levitated(top),
        damping_ratio=top.number("damping_ratio", 0.0, 1.0, default=0.003),
    )


@dataclass(frozen=True)
class _Table:
    """A table of the file, and what to call it in a message."""

    file: str
    where: str
    values: dict[str, Any]

    def path(self, name: str) -> str:
        shown = name if name.isidentifier() else repr(name)
        return f"{self.where}.{shown}" if self.where else shown

    def error(self, name: str, says: str) -> RotorFileError:
        """About the value `name`, of which the beginning is shown if there is one."""
        value = f" = {shorten(repr(self.values[name]), 60)}" if name in self.values else ""
        return RotorFileError(f"{self.file}: {self.path(name)}{value} {says}")

    def only(self, *known: str) -> None:
        """Complain of the first field that is not known."""
        for name in self.values:
            if name not in known:
                near = get_close_matches(name, known, n=1)
                remedy = f"did you mean {near[0]}" if near else f"there are: {', '.join(known)}"
                raise RotorFileError(f"{self.file}: {self.path(name)} is not a known field; {remedy}")

    def get(self, name: str, kind: Any, meant: str, default: Any = None) -> Any:
        """A value of the given kind, described by `meant`; required unless there is a default."""
        if name not in self.values:
            if default is None:
                raise self.error(name, f"is missing; it must be {meant}")
            return default
        value = self.values[name]
        if not isinstance(value, kind) or (isinstance(value, bool) and kind is not bool):
            raise self.error(name, f"must be {meant}")
        return value

    def text(self, name: str, default: str | None = None) -> str:
        return self.get(name, str, "text", default)

    def integer(self, name: str, low: int, high: int, default: int | None = None) -> int:
        meant = f"an integer from {low} to {high}"
        value = self.get(name, int, meant, default)
        if not low <= value <= high:
            raise self.error(name, f"must be {meant}")
        return value

    def number(self, name: str, low: float, below: float, default: float | None = None) -> float:
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
        """A value with a unit, in SI; positive unless `zero` or `negative` allow more."""
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

    def table(self, name: str) -> _Table:
        values = self.get(name, dict, f"a table [{self.path(name)}]")
        return _Table(self.file, self.path(name), values)

    def tables(self, name: str, *known: str) -> list[_Table]:
        """A list of tables, written [[name]]; none where there is none. They hold fields `known`."""
        meant = f"a list of tables, each written [[{name}]]"
        found = []
        for i, values in enumerate(self.get(name, list, meant, []), 1):
            if not isinstance(values, dict):
                raise self.error(name, f"must be {meant}")
            found.append(_Table(self.file, f"{self.path(name)}[{i}]", values))
            found[-1].only(*known)
        return found


@dataclass(frozen=True)
class _Material:
    modulus: float
    density: float
    poisson: float | None


def _materials(top: _Table) -> dict[str, _Material]:
    found: dict[str, _Material] = {}
    group = top.table("material")
    for name in group.values:
        t = group.table(name)
        t.only("modulus", "density", "poisson")
        found[name] = _Material(
            modulus=t.quantity("modulus", "Pa", zero=True),
            density=t.quantity("density", "kg/m3"),
            poisson=t.number("poisson", 0.0, 0.5) if "poisson" in t.values else None,
        )
    return found


def _material(table: _Table, materials: dict[str, _Material]) -> _Material:
    """The material a table names; by default the only one that can be a core."""
    cores = [name for name, m in materials.items() if m.poisson is not None]
    if "material" not in table.values and len(cores) == 1:
        return materials[cores[0]]
    listed = ", ".join(materials) or "none"
    name = table.get("material", str, f"the name of a material; there are: {listed}")
    if name not in materials:
        raise table.error("material", f"is not a material of this file; there are: {listed}")
    return materials[name]


def _elements(top: _Table, materials: dict[str, _Material]) -> tuple[Element, ...]:
    found: list[Element] = []
    end = 0.0
    for t in top.tables("element", "length", "outer_diameter", "inner_diameter", "material", "count",
                        "sleeve", "position"):  # fmt: skip
        _check_position(t, end)
        count = t.integer("count", 1, 10**9, default=1)
        if len(found) + count + 1 > MOST_NODES:
            raise RotorFileError(
                f"{top.file}: {t.where} brings the rotor to {len(found) + count + 1} nodes; "
                f"at most {MOST_NODES} are possible, take fewer and longer elements"
            )
        element = _element(t, materials)
        found += [element] * count
        end += count * element.length
    if not found:
        raise RotorFileError(
            f"{top.file}: element is missing; describe the shaft by one table [[element]] or more"
        )
    return tuple(found)


def _check_position(table: _Table, end: float) -> None:
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


def _element(t: _Table, materials: dict[str, _Material]) -> Element:
    length = t.quantity("length", "m")
    outer = t.quantity("outer_diameter", "m")
    inner = t.quantity("inner_diameter", "m", default=0.0, zero=True)
    if inner >= outer:
        raise t.error("inner_diameter", f"must be below outer_diameter = {t.values['outer_diameter']!r}")
    core = _material(t, materials)
    if core.poisson is None:
        raise t.error("material", "has no poisson, which the core of an element needs; add it there")
    if core.modulus == 0.0:
        raise t.error("material", "has a modulus of 0, which only a sleeve may have; name another")
    sleeve = _sleeve(t, materials, outer) if "sleeve" in t.values else {}
    return Element(
        length=length,
        outer_diameter=outer,
        inner_diameter=inner,
        modulus=core.modulus,
        density=core.density,
        poisson=core.poisson,
        **sleeve,
    )


def _sleeve(element: _Table, materials: dict[str, _Material], outer: float) -> dict[str, float]:
    t = element.table("sleeve")
    t.only("outer_diameter", "material")
    diameter = t.quantity("outer_diameter", "m")
    if diameter <= outer:
        core = element.values["outer_diameter"]
        raise t.error("outer_diameter", f"must be above that of the core it sits on, {core!r}")
    material = _material(t, materials)
    return {
        "sleeve_diameter": diameter,
        "sleeve_density": material.density,
        "sleeve_modulus": material.modulus,
    }


def _points(top: _Table, materials: dict[str, _Material], nodes: int) -> tuple[PointMass, ...]:
    """Discs and point masses."""
    found: list[PointMass] = []
    for t in top.tables("disc", "node", "outer_diameter", "inner_diameter", "width", "material"):
        node = _node(t, "node", nodes)
        outer = t.quantity("outer_diameter", "m")
        inner = t.quantity("inner_diameter", "m", zero=True)
        if inner >= outer:
            raise t.error(
                "inner_diameter", f"must be below outer_diameter = {t.values['outer_diameter']!r}"
            )
        found.append(disc(node, outer, inner, t.quantity("width", "m"), _material(t, materials).density))
    for t in top.tables("point_mass", "node", "mass", "polar_inertia", "diametral_inertia"):
        found.append(
            PointMass(
                node=_node(t, "node", nodes),
                mass=t.quantity("mass", "kg", zero=True),
                polar_inertia=t.quantity("polar_inertia", "kg.m2", default=0.0, zero=True),
                diametral_inertia=t.quantity("diametral_inertia", "kg.m2", default=0.0, zero=True),
            )
        )
    return tuple(found)


def _stations(top: _Table, kind: str, nodes: int) -> tuple[Station, ...]:
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
    return tuple(Station(name, _node(t, name, nodes)) for name in t.values)


def _levitated(top: _Table) -> tuple[str, ...]:
    names = top.get("levitated_at", list, 'a list of stations, such as ["amb_A", "amb_B"]', [])
    there = top.values.get("stations", {})
    for name in names:
        if name not in there:
            listed = ", ".join(there) or "none"
            raise top.error("levitated_at", f"names {name!r}, which is no station; there are: {listed}")
    return tuple(names)


def _node(table: _Table, name: str, nodes: int) -> int:
    value = table.get(name, int, f"the number of a node, 1 to {nodes}")
    if not 1 <= value <= nodes:
        raise table.error(name, f"is not a node; the elements make nodes 1 to {nodes}")
    return value
