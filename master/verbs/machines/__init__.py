"""Verbs about machines of one's own: their bearings, and a scene to start from."""
