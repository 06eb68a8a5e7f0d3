"""Components around a touchdown bearing: the magnetic bearing, and the housing or mount that holds both."""
