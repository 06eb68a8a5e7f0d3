"""Bearings ready to be set in a model, with the origin of each of their numbers.

`sizes` holds those of the tables of Halminen (2016) and the common sizes of ISO 15, `estimate` fills in
what they and a user's own files (`bearing_file`) leave open. A bearing is asked for by its designation, or
by FILE.toml:NAME where a file of the user's describes it; contact angle, ceramic balls and pairs stand
behind it (`mounting`).
"""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from ...modelkit.errors import TouchdownError, one_of
from ..contact.materials import MATERIALS
from .bearing_file import OWN_FILE, bearing_file_text, read_bearings
from .entry import NUMBERS, Bearing
from .mounting import mounted_bearing, nearest
from .sizes import FROM_SOURCE, designations, size, usual

__all__ = [
    "BALL_MATERIALS",
    "NUMBERS",
    "OWN_FILE",
    "Bearing",
    "CatalogueError",
    "bearing",
    "bearing_file_text",
    "bearing_reference",
    "built_in",
    "own",
]

BALL_MATERIALS = MATERIALS.words


class CatalogueError(TouchdownError):
    """There is no bearing of that name; a mistake in a file is a TouchdownError of another kind."""

    def __init__(self, name: str, known: Iterable[str], where: str = "") -> None:
        super().__init__(f"{where}there is no bearing {name}; {one_of(name, known)}")


_FROM_SOURCE = {bearing.designation: bearing for bearing in FROM_SOURCE}


def built_in() -> list[str]:
    """Designations of the bearings that come with the project, those of Halminen (2016) first."""
    return [*_FROM_SOURCE, *(name for name in designations() if name not in _FROM_SOURCE)]


def own(folder: Path) -> dict[str, Bearing]:
    """The bearings of the file `bearings.toml` in a folder, by name; empty without such a file.

    Raises TouchdownError where the file has a mistake.
    """
    path = folder / OWN_FILE
    return read_bearings(path) if path.is_file() else {}


def bearing_reference(name: str, folder: Path) -> str:
    """The reference by which a bearing is found from anywhere, for its name in a scene in `folder`.

    That is a designation, which `bearings.toml` in the folder may have as its own, or FILE.toml:NAME with
    a path that starts there. Raises CatalogueError where there is no such bearing.
    """
    file, colon, inside = name.rpartition(":")
    begins, *rest = name.split(" ")  # may be a designation of JIS
    if colon:
        path = (folder / Path(file).expanduser()).absolute()
    elif (mine := own(folder)) and name in mine:
        path, inside = (folder / OWN_FILE).absolute(), name
    elif (called := next(filter(_named, (name, " ".join((usual(begins), *rest)))), None)) is not None:
        return called
    elif mine and mounted_bearing(name, lambda begins, angle: mine.get(begins) if angle is None else None):
        path, inside = (folder / OWN_FILE).absolute(), name
    else:
        meant = nearest(name, _plain)
        raise CatalogueError(name, [meant] if meant else [*mine, *built_in()])
    found = f"{path}:{inside}"
    bearing(found)
    return found


def bearing(found: str) -> Bearing:
    """The bearing of a `bearing_reference`.

    Raises TouchdownError where it does not exist, a CatalogueError, or its file has a mistake.
    """
    file, colon, name = found.rpartition(":")
    if colon:
        known = read_bearings(Path(file))
        entry = known.get(name) or mounted_bearing(
            name, lambda begins, angle: known.get(begins) if angle is None else None
        )
        if entry is None:
            raise CatalogueError(name, known, f"{file}: ")
        return entry
    entry = _named(name)
    if entry is None:
        raise CatalogueError(name, built_in())
    return entry


def _named(name: str) -> Bearing | None:
    """The bearing with a designation, with what stands behind it (`mounting`); None if missing."""
    return mounted_bearing(name, _plain)


def _plain(name: str, contact_angle: float | None) -> Bearing | None:
    """One of the `built_in`, with a contact angle (rad) where one is asked for."""
    if name in _FROM_SOURCE:
        return _FROM_SOURCE[name] if contact_angle is None else None
    return size(name, contact_angle) if name in built_in() else None
