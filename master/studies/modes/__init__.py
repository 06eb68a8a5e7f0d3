"""How many elastic modes of a rotor a drop needs."""
