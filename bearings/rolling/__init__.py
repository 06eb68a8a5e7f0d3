"""Parts of rolling bearings: balls, rings, cage, their contacts and their resistance."""
