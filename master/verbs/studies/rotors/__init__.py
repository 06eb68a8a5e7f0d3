"""Verbs about rotors alone: describe them, and import those of others."""
