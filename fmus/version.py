"""The version, named here and nowhere else: the package, its FMUs and what they write take it from here."""

VERSION = "0.2.0"
RELEASED = "2026-11-21T00:00:00Z"  # not the time of the build: equal sources give equal FMUs
