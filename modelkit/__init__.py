"""The parts that all models share; the physics lies in `rotor` and `bearings`.

A model is declared (`variables`, `ports`), written as kernels (`kernel`), put together (`model`) and run
(`instance`). Kernels lean on `integrators`, on the exact `oscillator`, on `body` for what takes a load
and gives its motion, and tell by `status` how a macro step ended.
"""
