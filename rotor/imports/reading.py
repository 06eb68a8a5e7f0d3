"""Which kind of file a rotor is imported from, and who reads it."""

from __future__ import annotations

import json
import tomllib
from pathlib import Path
from typing import Any

from touchdown.rotor.beams.shaft import Shaft
from touchdown.rotor.imports.arrays import from_archive, from_folder
from touchdown.rotor.imports.cells import text_of
from touchdown.rotor.imports.mistakes import ImportedRotorError
from touchdown.rotor.imports.ross import of_elements
from touchdown.rotor.imports.sections import of_sections

TABLES = (".csv", ".tsv", ".txt")
MODELS = (".toml", ".json")
ARCHIVE = ".npz"


def read(path: str | Path, speed: float | None = None) -> Shaft:
    """The rotor in the file at `path`: saved by ROSS (.toml, .json), or a table of sections (.csv).

    Or matrices or modal data in an archive (.npz), or matrices in a folder of Matrix Market files.
    `about` says what of the original it leaves out or has otherwise.

    speed: rad/s, at which bearings whose coefficients hang on it are taken. Raises ImportedRotorError.
    """
    path = Path(path)
    if path.is_dir():
        return from_folder(path)
    kind = path.suffix.lower()
    if kind == ARCHIVE:
        return from_archive(path)
    if kind in TABLES:
        return of_sections(text_of(path), str(path), path.stem)
    if kind in MODELS:
        return of_elements(_parsed(path), str(path), path.stem, speed)
    if not path.exists():
        raise ImportedRotorError(f"there is no file or folder {path}")
    raise ImportedRotorError(
        f"{path}: rotors are imported from ROSS's files ({', '.join(MODELS)}), tables of sections "
        f"({', '.join(TABLES)}), matrices and modal data ({ARCHIVE}), and folders of Matrix Market files"
    )


def _parsed(path: Path) -> dict[str, Any]:
    text = text_of(path)
    try:
        data = json.loads(text) if path.suffix.lower() == ".json" else tomllib.loads(text)
    except (ValueError, RecursionError) as error:
        raise ImportedRotorError(f"{path}: cannot be read: {error}") from None
    if not isinstance(data, dict):
        raise ImportedRotorError(f"{path}: is no model of ROSS's: it holds a {type(data).__name__}")
    return data
