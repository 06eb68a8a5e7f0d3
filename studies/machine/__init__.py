"""New machines: the bearings of the catalogue, and a scene to start from."""
