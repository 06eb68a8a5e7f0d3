"""What stands beside a touchdown bearing: the magnetic bearing, and what holds both: housing or mount."""
