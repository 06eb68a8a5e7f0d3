"""Bonds: force one way and motion the other between FMUs that need not know any contract.

`bond` finds them, `ways` names how they cross, `crossing` tells motion and force ahead and hears what came
of it, `turn` steps a component by that, `audit` books what the exchange made, `told` says it in words.
docs/bonds.md has the equations.
"""
