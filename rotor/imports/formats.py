"""Which format a rotor is imported from, and where its bearings and sensors are placed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from ...modelkit.archives import ARCHIVE, read_archive
from ...modelkit.errors import TouchdownError, require
from ...modelkit.reader import json_of, text_of, toml_of
from ...modelkit.sheets import BOOKS
from ...modelkit.units import to_si
from ..beams.shaft import Shaft, Station, node_at, with_node
from .arrays import from_folder, of_arrays
from .ross import of_elements
from .sections import of_sections

Places = Mapping[str, int | str]


def placed(
    shaft: Shaft,
    seats: Places | None = None,
    levitated: Places | None = None,
    sensors: Places | None = None,
) -> Shaft:
    """`shaft` with stations: `seats` for touchdown bearings, and those it is `levitated` at.

    A place is the number of a node, from 1, or what the node is `called`, or a distance from node 1 as
    text with a unit ("120 mm"), where a node is made if missing. What is given replaces all that was
    there of its kind, and what was there by its name; the others stay. Raises TouchdownError, also
    for places that are not on the shaft.
    """
    kinds = [dict(kind or {}) for kind in (seats, levitated, sensors)]
    names = [name for kind in kinds for name in kind]
    if twice := next((name for name in names if names.count(name) > 1), None):
        raise TouchdownError(f"{twice} is there twice; each station and sensor has a name of its own")
    where = [{name: _position(shaft, name, place) for name, place in kind.items()} for kind in kinds]
    for kind in where:
        for position in kind.values():
            shaft = with_node(shaft, position)
    bearings, ambs, looks = (
        tuple(Station(name, node_at(shaft, position) or 0) for name, position in kind.items())
        for kind in where
    )
    if bearings or ambs:
        stay = [s for s in shaft.stations if s.name not in names]
        bearings = bearings or tuple(s for s in stay if s.name not in shaft.levitated_at)
        ambs = ambs or tuple(s for s in stay if s.name in shaft.levitated_at)
        shaft = replace(shaft, stations=bearings + ambs, levitated_at=tuple(s.name for s in ambs))
    return replace(shaft, sensors=looks) if looks else shaft


def _position(shaft: Shaft, name: str, place: int | str) -> float:
    """Of a place (m from node 1)."""
    text = str(place).strip()
    z = shaft.positions()
    if text in shaft.called:
        return float(z[_called(shaft, name, text)])
    if text.isdecimal():
        require(
            1 <= int(text) <= shaft.nodes,
            f"{name} = {text} is not a node of the rotor {shaft.title}, which has nodes 1 to "
            f"{shaft.nodes}; for a distance from node 1 write its unit, such as 120 mm",
        )
        return float(z[int(text) - 1])
    return to_si(text, "m", name)


def _called(shaft: Shaft, name: str, text: str) -> int:
    """Which node (from 0) is called so, where no other has that number."""
    named = shaft.called.index(text)
    counted = int(text) - 1 if text.isdecimal() else named
    if counted != named and 0 <= counted < shaft.nodes:
        z = shaft.positions()
        raise TouchdownError(
            f"{name} = {text} may be the node called {text}, at {1e3 * z[named]:.9g} mm, or node {text} "
            f"along the axis, called {shaft.called[counted]}, at {1e3 * z[counted]:.9g} mm; write the "
            "distance"
        )
    return named


TABLES = (".csv", ".tsv", ".txt")
MODELS = (".toml", ".json")


def read_rotor(path: str | Path, speed: float | None = None) -> Shaft:
    """The rotor in the file at `path`: saved by ROSS (.toml, .json), or a table of sections (.csv).

    Or matrices or modal data in an archive (.npz), or matrices in a folder of Matrix Market files.
    `about` says what of the original it leaves out or has otherwise.

    speed: rad/s, at which bearings whose coefficients depend on it are taken. Raises TouchdownError.
    """
    path = Path(path)
    if path.is_dir():
        return from_folder(path)
    kind = path.suffix.lower()
    if kind == ARCHIVE:
        return of_arrays(read_archive(path), str(path), path.stem)
    if kind in (*TABLES, *BOOKS):  # which are refused with what to do
        return of_sections(path)
    if kind in MODELS:
        return of_elements(_parsed(path), str(path), path.stem, speed)
    require(path.exists(), f"there is no file or folder {path}")
    raise TouchdownError(
        f"{path}: rotors are imported from ROSS's files ({', '.join(MODELS)}), tables of sections "
        f"({', '.join(TABLES)}), matrices and modal data ({ARCHIVE}), and folders of Matrix Market files"
    )


def _parsed(path: Path) -> dict[str, Any]:
    parse = json_of if path.suffix.lower() == ".json" else toml_of
    return parse(text_of(path), str(path))
