"""Verbs that run scenes more than once, or look at a rotor without running any."""
