"""Masters that are compared."""
