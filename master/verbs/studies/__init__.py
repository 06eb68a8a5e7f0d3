"""Verbs that run a scene many times, or describe what is in it."""
