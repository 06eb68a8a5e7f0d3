"""Rotors, rigid and flexible: models, beams, modes and rotor files. Physics only."""
