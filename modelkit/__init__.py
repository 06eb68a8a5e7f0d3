"""What every model shares: declared variables, compiled kernels, one integrator, one running instance.

The physics lives in ``rotor`` and ``bearings``; this package knows none of it.
"""
