"""Verbs that make and check FMUs and packages of them."""
