"""Rotors as the master sees them: their files by name, what they are, and what is known of them."""

from __future__ import annotations

from pathlib import Path

from rotor.modal_data import seats
from rotor.portrait import Portrait, portrait
from rotor.rotor_file import load, shipped
from rotor.shaft import Shaft, Station
from rotor.statics import Rest

__all__ = ["Portrait", "Rest", "Shaft", "Station", "portrait", "rotor", "rotors", "seat_nodes"]


def rotors() -> list[str]:
    """Names of the rotors that come with the project."""
    return list(shipped())


def rotor(name: str) -> Shaft:
    """A rotor of the project's by name, or the one in a file (.toml).

    Raises RotorFileError where the file has a mistake, LookupError for an unknown name.
    """
    if name.endswith(".toml"):
        return load(Path(name))
    if name not in shipped():
        raise LookupError(f"there is no rotor called {name}")
    return load(shipped()[name])


def seat_nodes(shaft: Shaft) -> list[int]:
    """Nodes (from 1) where the rotor can touch down, each once."""
    return sorted(set(seats(shaft)))
