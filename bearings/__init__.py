"""Touchdown bearings and what stands beside them: magnetic bearing, housing. Physics only."""
