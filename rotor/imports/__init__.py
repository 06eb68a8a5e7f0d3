"""Third-party rotors: read from their files or objects, and given the places that a drop needs."""

from .arrays import of_arrays
from .formats import placed, read_rotor
from .ross import from_ross

__all__ = ["from_ross", "of_arrays", "placed", "read_rotor"]
