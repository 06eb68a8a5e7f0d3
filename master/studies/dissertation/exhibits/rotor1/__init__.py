"""Section 4.1: rotor I on cageless bearings out of line."""
