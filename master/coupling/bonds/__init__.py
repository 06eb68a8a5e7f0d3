"""Bonds: force one way and motion the other between FMUs that need not know any contract.

`bond` finds them and says in which ways they can be exchanged (`BondHold`); `exchange` predicts motion and
force, hands them over, and accounts for the energy that this makes; `substeps` steps a component under such
inputs; `explain` explains in words what a system does with them. docs/bonds.md has the equations.
"""
