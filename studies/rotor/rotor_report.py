"""A report on a rotor before it is dropped, as a table and pictures."""

from __future__ import annotations

import math
import os
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from ...master.common.errors import TouchdownError, one_of
from ...master.common.files import make_writable
from ...master.common.text import MM, RPM, UM, aligned
from ...master.scene.file import shipped_scenes as scenes
from ...master.scene.tables import is_of_ross, is_scene_file
from ...rotor.beams.shaft import Shaft, Station, Support
from ...rotor.file import rotor_named, shipped_rotors
from ...rotor.imports.formats import ARCHIVE, MODELS, TABLES
from ...rotor.modal.whirl_speeds import CriticalMap
from ...rotor.properties import RotorProperties, rotor_properties
from ...rotor.static_deflection import Rest
from .rotor_in_bearings import held_lines

SPEED = 9000.0 / RPM  # rad/s, the default
MODES = 5
SPEEDS = 81  # in the Campbell diagram
MAX_SPEED_RATIO = 2.0  # times the speed asked for: its end
MATRICES = (".mtx", ".hb")
FOREIGN = {  # what files of others hold
    **dict.fromkeys(TABLES, "a table of sections"),
    **dict.fromkeys(MODELS, "ROSS's files"),
    ARCHIVE: "matrices or modal data",
    **dict.fromkeys(MATRICES, "the matrices in that folder"),
}
FOREIGN_SOURCES = "a table of sections, of ROSS's files, of matrices or modal data"
TO_REST = (
    "needs two stations or more, at different nodes, that are not in levitated_at, for the rotor to lie on"
)


@dataclass(frozen=True)
class Report:
    """The table, the pictures that were drawn, and what is to be said beside."""

    text: str
    pictures: list[Path] = field(default_factory=list)
    remarks: tuple[str, ...] = ()


def report(
    name: str,
    folder: Path,
    speed: float = SPEED,
    modes: int = MODES,
    supports: Mapping[str, float] | None = None,
) -> Report:
    """Describe the rotor `name` (shipped, or the path of a .toml); pictures go into `folder`.

    speed: rad/s, for the split of the frequencies; modes: per plane, the two rigid ones included (0: all);
    supports: stiffness in N/m of stations by name, beside the supports of the rotor's file. Raises
    TouchdownError where there is no such rotor or station, or its file has a mistake.
    """
    properties = described(supported(find_rotor(name), supports or {}), speed, modes)
    make_writable(folder)
    from .figure import draw_pictures  # matplotlib is slow to import

    held = {}
    if properties.held is not None:
        title = f"{properties.shaft.title} {on_supports(properties)}"
        held["campbell_supports"] = properties.held, title
    return Report(report_text(properties), draw_pictures(properties, folder, held))


def supported(shaft: Shaft, supports: Mapping[str, float]) -> Shaft:
    """`shaft` with springs (N/m) at stations by name, in place of what is there.

    Raises TouchdownError for a station it does not have.
    """
    springs = [Support(shaft.node(name), stiffness) for name, stiffness in supports.items()]
    taken = {spring.node for spring in springs}
    kept = tuple(s for s in shaft.supports if s.node not in taken)
    return replace(shaft, supports=(*kept, *springs))


def described(shaft: Shaft, speed: float, modes: int) -> RotorProperties:
    """The properties of `shaft` at `speed` (rad/s), then over speeds for its Campbell diagram."""
    end = MAX_SPEED_RATIO * abs(speed) or MAX_SPEED_RATIO * SPEED
    return rotor_properties(shaft, modes, [speed, *np.linspace(0.0, end, SPEEDS)])


def find_rotor(name: str) -> Shaft:
    """The rotor of that name, or in the .toml at that path. Raises TouchdownError."""
    try:
        return rotor_named(name)
    except TouchdownError as error:
        path = Path(name)
        if is_scene_file(path):
            raise TouchdownError(
                f"{path} is a scene, no rotor's file; `touchdown scenes {path}` says which its rotor is"
            ) from None
        raise TouchdownError(_foreign(path) or str(error)) from None
    except LookupError:
        if name in scenes():
            raise TouchdownError(
                f"{name} is a scene, no rotor; `touchdown scenes {name}` says which its rotor is; rotors: "
                f"{', '.join(shipped_rotors())}"
            ) from None
        if remedy := _foreign(Path(name)):
            raise TouchdownError(remedy) from None
        known = _nearest(name)
        raise TouchdownError(
            f"there is no rotor called {name}; {one_of(name, known)}, or give the path of a rotor's .toml"
        ) from None


def _nearest(name: str) -> list[str]:
    """Rotors that begin so; or all, and the scenes where a name is like one of theirs."""
    if begun := [rotor for rotor in shipped_rotors() if rotor.startswith(name)]:
        return begun
    like = one_of(name, scenes()).startswith("did you mean")
    return [*shipped_rotors(), *(scenes() if like else ())]


def _foreign(path: Path) -> str:
    """A remedy for a file or folder that `import rotor` may read; else ""."""
    kind, source = path.suffix.lower(), path
    if not os.path.exists(path) or (kind == ".toml" and not is_of_ross(path)):
        return ""
    if path.is_dir() and not any(any(path.glob(f"*{kind}")) for kind in MATRICES):
        return ""
    content = "its matrices" if path.is_dir() else FOREIGN.get(kind, FOREIGN_SOURCES)
    if kind in MATRICES:
        source = path.parent
    return f"{path} is not a rotor's file; `touchdown import rotor {source}` makes one of {content}"


def report_text(properties: RotorProperties) -> str:
    """All figures as text; the frequencies are split at the first of the properties' speeds."""
    shaft = properties.shaft
    lines = [
        shaft.title,
        *aligned(_body(shaft), indent="  "),
        "",
        *_places(shaft),
        "",
        *_frequencies(properties),
        "",
        *(() if properties.held is None else held_lines(properties.held, on_supports(properties))),
        *(line for found in properties.critical for line in _critical(found)),
        *_rest_lines(shaft, properties.rest),
    ]
    return "\n".join(lines)


def _body(shaft: Shaft) -> list[tuple[str, str]]:
    return [
        ("mass", f"{shaft.mass:.5g} kg"),
        ("length", f"{MM * shaft.positions()[-1]:.5g} mm"),
        ("centre of mass", f"{MM * shaft.centre_of_mass:.5g} mm from node 1"),
        ("polar inertia", f"{shaft.polar_inertia:.5g} kg.m2"),
        ("diametral inertia", f"{shaft.diametral_inertia:.5g} kg.m2, about the centre of mass"),
        *_made_of(shaft),
        ("damping ratio", f"{shaft.damping_ratio:g}"),
    ]


def _made_of(shaft: Shaft) -> list[tuple[str, str]]:
    """Elements and what sits on them, or the superelement in their place."""
    nodes = ("nodes", f"{shaft.nodes}")
    if not shaft.elements:
        return [("made of", f"{shaft.body.kind}; no diameters, so no stresses and no outline"), nodes]
    return [
        ("elements", f"{len(shaft.elements)}"),
        nodes,
        ("discs and point masses", f"{len(shaft.points)}"),
    ]


def _places(shaft: Shaft) -> list[str]:
    """Stations and sensors."""
    position = shaft.positions()
    places = [(_kind(shaft, s), s) for s in shaft.stations] + [("sensor", s) for s in shaft.sensors]
    if not places:
        return ["  no stations, no sensors"]
    rows = [(s.name, kind, str(s.node), f"{MM * position[s.node - 1]:.1f}") for kind, s in places]
    return aligned([("place", "kind", "node", "position [mm]"), *rows], "<<>", "  ")


def _frequencies(properties: RotorProperties) -> list[str]:
    speed = f"{RPM * properties.speeds[0]:.6g} rpm"
    each = properties.kinds, properties.frequencies, properties.backward[0], properties.forward[0]
    rows = [(kind, *(f"{one:.2f}" for one in hertz)) for kind, *hertz in zip(*each, strict=True)]
    head = "free rotor", "at rest [Hz]", "backward [Hz]", "forward [Hz]"
    return [f"  backward and forward whirl at {speed}", *aligned([head, *rows], "<>", "  ")]


def on_supports(properties: RotorProperties) -> str:
    """How the rotor is held by its own supports, in words."""
    return f"on its {len(properties.shaft.supports)} supports"


def _critical(found: CriticalMap) -> list[str]:
    """Critical speeds over the stiffness at each of the places, a row per decade."""
    head = f"  critical speeds [rpm], held at {', '.join(s.name for s in found.places)} by"
    rows = [(f"{k:.0e} N/m each", speeds) for k, speeds in zip(found.stiffness, found.speeds, strict=True)]
    rows = rows[:: (len(rows) - 1) // round(math.log10(found.stiffness[-1] / found.stiffness[0]))]
    if len(found.critical):
        rows.append(("its own supports", found.critical))
    cells = ((what, *("" if np.isnan(s) else f"{RPM * s:.0f}" for s in speeds)) for what, speeds in rows)
    return [head, *aligned(cells, "<>", "  "), ""]


def _rest_lines(shaft: Shaft, rest: Rest | None) -> list[str]:
    """How the rotor lies on its seats."""
    if rest is None:
        return [f"  no rest.png: it {TO_REST}"]
    names = [" = ".join(s.name for s in shaft.seats if s.node == node)
             for node in sorted({s.node for s in shaft.seats})]  # fmt: skip
    forces = ", ".join(f"{n} {f:.4g} N" for n, f in zip(names, rest.reactions, strict=True))
    ends = int(np.argmin(rest.deflection)), int(np.argmax(rest.deflection))
    bent = " to ".join(f"{UM * rest.deflection[k]:.3g} µm at node {k + 1}" for k in ends)
    return [
        "  lying on its seats, rigidly held",
        *aligned([("reactions", forces), ("deflection up", bent), *_lying_stresses(rest)], indent="  "),
        *(f"  {line}" for line in pulling(dict(zip(names, rest.reactions.tolist(), strict=True)))),
    ]


def _lying_stresses(rest: Rest) -> list[tuple[str, str]]:
    """The largest, where there are any."""
    if not len(rest.bending):
        return []
    worst = int(np.argmax(np.abs(rest.bending)))
    return [
        ("bending stress", f"{1e-6 * rest.bending[worst]:.3g} MPa at node {rest.node[worst]}"),
        ("shear stress", f"up to {1e-6 * np.max(np.abs(rest.shear)):.3g} MPa"),
    ]


def pulling(reactions: Mapping[str, float]) -> list[str]:
    """A line for each support at rest (N by name, upwards) that would have to pull the rotor down."""
    return [
        f"{name} would have to pull the rotor down with {-force:.4g} N: where bearings only push, the "
        "rotor lifts off there until it lies against the top of the bore"
        for name, force in reactions.items()
        if force < 0.0
    ]


def _kind(shaft: Shaft, station: Station) -> str:
    if station in shaft.seats:
        return "seat"
    return "magnetic bearing" if station.name in shaft.levitated_at else "gap that acts"
