"""Figures of a recording, one module each."""
