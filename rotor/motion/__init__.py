"""Kernels of the rotor in modal coordinates: its equations of motion, a macro step, what it gives."""
