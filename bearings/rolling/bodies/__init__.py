"""Balls and cage as bodies of their own, for the detailed bearings (section 2.2 of the source)."""
