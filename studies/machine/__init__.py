"""Machines of one's own: the bearings there are, and a scene to start from."""
