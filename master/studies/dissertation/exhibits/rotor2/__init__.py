"""Section 4.2: stresses in rotor II."""
