"""What stands beside a touchdown bearing: the magnetic bearing, and the housing that holds both."""
