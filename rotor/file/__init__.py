"""Rotor files (docs/rotor-file.md): a shaft written by hand in TOML, read, and written again.

They lie with the package, by name, or anywhere, by their path.
"""

from __future__ import annotations

from pathlib import Path

from ...modelkit.errors import TouchdownError
from ...modelkit.kernel.writing import write
from ...modelkit.reader import text_of
from ..beams.shaft import Shaft
from .parser import parse_rotor
from .writer import rotor_text

__all__ = ["find", "load", "parse", "save", "shipped", "written"]

DATA = Path(__file__).parents[1] / "data"


def shipped_rotors() -> dict[str, Path]:
    """Rotor files that come with the package, by name."""
    return {path.stem: path for path in sorted(DATA.glob("*.toml"))}


def rotor_named(name: str) -> Shaft:
    """A rotor of the package's by name, or the one in a file (.toml).

    Raises TouchdownError where the file has a mistake, LookupError for an unknown name.
    """
    if name.endswith(".toml"):
        return load_rotor(Path(name))
    if name not in shipped_rotors():
        raise LookupError(f"there is no rotor called {name}")
    return load_rotor(shipped_rotors()[name])


def load_rotor(path: str | Path) -> Shaft:
    """The rotor written in the file at `path`. Raises TouchdownError."""
    return parse_rotor(text_of(Path(path)), str(path))


def save_rotor(shaft: Shaft, path: str | Path) -> None:
    """Write `shaft` to a rotor file at `path`, from which `load_rotor` reads an equal one.

    An existing file is replaced. Raises TouchdownError where the shaft cannot be written (`rotor_text`) or
    the file cannot.
    """
    text = rotor_text(shaft, str(path))
    try:
        write(Path(path), text)
    except OSError as error:
        raise TouchdownError(f"{path}: cannot be written: {error.strerror}") from None
