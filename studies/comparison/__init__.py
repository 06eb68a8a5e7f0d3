"""Comparisons of many runs: coupling schemes, models, numbers of modes, and stability in hard cases."""
