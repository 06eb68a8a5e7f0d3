"""A row, or a pair of rows, whose balls are bodies in space, and the inner ring that tilts on them."""
