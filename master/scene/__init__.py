"""Scenes: which components are connected how, with which settings, run by which scheme."""
