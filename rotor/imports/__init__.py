"""Rotors of others': read from their files or objects, and given the places that a drop needs."""

from touchdown.rotor.imports.arrays import of_arrays
from touchdown.rotor.imports.mistakes import ImportedRotorError
from touchdown.rotor.imports.places import placed
from touchdown.rotor.imports.reading import read
from touchdown.rotor.imports.ross import from_ross

__all__ = ["ImportedRotorError", "from_ross", "of_arrays", "placed", "read"]
