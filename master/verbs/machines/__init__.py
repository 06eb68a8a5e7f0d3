"""Verbs about machines: the scenes and bearings that there are, and one of one's own."""
