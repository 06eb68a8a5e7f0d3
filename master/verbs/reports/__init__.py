"""Verbs that show a run that is over."""
