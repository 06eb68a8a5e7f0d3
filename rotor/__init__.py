"""Rotors. Physics only."""
