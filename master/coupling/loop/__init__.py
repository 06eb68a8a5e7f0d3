"""Loops that take macro steps: one by one, or many of them in compiled code, and their end."""
