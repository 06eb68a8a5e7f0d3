"""Rolling bearings: the inner ring, balls on the pitch circle, and balls and cage as bodies."""
