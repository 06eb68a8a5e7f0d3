"""Where rotor files lie: with the package, by name, or anywhere, by their path."""

from __future__ import annotations

from pathlib import Path

from ...modelkit.kernel.writing import write
from ..beams.shaft import Shaft
from .reader import RotorFileError, parse
from .writer import written

DATA = Path(__file__).parents[1] / "data"


def shipped() -> dict[str, Path]:
    """Rotor files that come with the package, by name."""
    return {path.stem: path for path in sorted(DATA.glob("*.toml"))}


def find(name: str) -> Shaft:
    """A rotor of the package's by name, or the one in a file (.toml).

    Raises RotorFileError where the file has a mistake, LookupError for an unknown name.
    """
    if name.endswith(".toml"):
        return load(Path(name))
    if name not in shipped():
        raise LookupError(f"there is no rotor called {name}")
    return load(shipped()[name])


def load(path: str | Path) -> Shaft:
    """The rotor written in the file at `path`. Raises RotorFileError."""
    return parse(text_of(Path(path)), str(path))


def save(shaft: Shaft, path: str | Path) -> None:
    """Write `shaft` to a rotor file at `path`, from which `load` reads an equal one.

    An existing file is replaced. Raises RotorFileError where the shaft cannot be written (`written`) or
    the file cannot.
    """
    text = written(shaft, str(path))
    try:
        write(Path(path), text)
    except OSError as error:
        raise RotorFileError(f"{path}: cannot be written: {error.strerror}") from None


def text_of(path: Path) -> str:
    """The text of a rotor file. Raises RotorFileError."""
    try:
        return path.read_text(encoding="utf-8-sig")  # some editors begin files with a mark
    except OSError as error:
        raise RotorFileError(f"{path}: cannot be read: {error.strerror}") from None
    except UnicodeDecodeError as error:
        raise RotorFileError(
            f"{path}: is not text in UTF-8 (byte {error.start}); save it as UTF-8"
        ) from None
