"""Rotor files (docs/rotor-file.md): a shaft written by hand in TOML, read, and written again."""

from .reader import parse
from .storage import find, load, save, shipped
from .writer import written

__all__ = ["find", "load", "parse", "save", "shipped", "written"]
