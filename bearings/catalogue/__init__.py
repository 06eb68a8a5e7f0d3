"""Bearings ready to be set in a model, with the origin of each of their numbers.

`source` holds those of the source's tables, `sizes` the common sizes of ISO 15, `estimate` fills in what
they and a user's own files (`file`) leave open. A bearing is asked for by its designation, or by
FILE.toml:NAME where a file of the user's describes it.
"""

from __future__ import annotations

from pathlib import Path

from ..contact.materials import MATERIALS
from .entry import NUMBERS, Bearing
from .file import OWN_FILE, CatalogueError, as_file, read
from .sizes import FROM_SOURCE, designations, size, usual

__all__ = [
    "BALL_MATERIALS",
    "NUMBERS",
    "OWN_FILE",
    "Bearing",
    "CatalogueError",
    "as_file",
    "bearing",
    "built_in",
    "own",
    "reference",
]

BALL_MATERIALS = MATERIALS.words

_FROM_SOURCE = {bearing.designation: bearing for bearing in FROM_SOURCE}


def built_in() -> list[str]:
    """Designations of the bearings that come with the project, those of the source first."""
    return [*_FROM_SOURCE, *(name for name in designations() if name not in _FROM_SOURCE)]


def own(folder: Path) -> dict[str, Bearing]:
    """The bearings of the file `bearings.toml` in a folder, by name; none where there is no such file.

    Raises CatalogueError where the file has a mistake.
    """
    path = folder / OWN_FILE
    return read(path) if path.is_file() else {}


def reference(name: str, folder: Path) -> str:
    """What finds a bearing from anywhere, by what a scene in `folder` calls it.

    That is a designation, which `bearings.toml` in the folder may have as its own, or FILE.toml:NAME with
    a path that starts there. Raises CatalogueError where there is no such bearing.
    """
    file, colon, inside = name.rpartition(":")
    if colon:
        path = (folder / Path(file).expanduser()).absolute()
    elif (mine := own(folder)) and name in mine:
        path, inside = (folder / OWN_FILE).absolute(), name
    elif (called := name if name in built_in() else usual(name)) in built_in():
        return called
    else:
        raise CatalogueError(f"there is no preset {name}", [*mine, *built_in()])
    found = f"{path}:{inside}"
    bearing(found)
    return found


def bearing(found: str) -> Bearing:
    """The bearing of a `reference`.

    Raises CatalogueError where there is none, or its file has a mistake.
    """
    file, colon, name = found.rpartition(":")
    if colon:
        known = read(Path(file))
        if name not in known:
            raise CatalogueError(f"{file} has no bearing {name}", known)
        return known[name]
    if name not in built_in():
        raise CatalogueError(f"there is no preset {name}", built_in())
    return _FROM_SOURCE.get(name) or size(name)
