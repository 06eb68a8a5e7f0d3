"""A rotor by finite elements: the shaft as data, Timoshenko elements, matrices of the whole."""
