"""Models made from another: that start from other values, or have connectors for fewer modes."""
