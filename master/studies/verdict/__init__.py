"""How the verdict on a drop hangs on the phase of the unbalance."""
