"""How the verdict on a drop depends on the phase of the unbalance."""
