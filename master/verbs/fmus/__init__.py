"""Verbs that make FMUs and packages of them, and look whether they work."""
