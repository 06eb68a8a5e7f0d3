"""Bearing models beside each other on one scene."""
