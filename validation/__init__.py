"""Figures of the world beside ours: closed forms, other programs, published computations, measurements."""
