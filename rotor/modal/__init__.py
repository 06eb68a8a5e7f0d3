"""A rotor by its modes: free-free modes, whirl speeds, stresses, and what its kernels read of them."""
