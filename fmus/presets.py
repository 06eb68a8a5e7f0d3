"""Named sets of parameters that scenes may ask for."""

from __future__ import annotations

from bearings.catalogue import CATALOGUE


def presets() -> list[str]:
    """Names of the sets there are."""
    return sorted(CATALOGUE)


def preset(name: str) -> dict[str, float]:
    """Values in SI by parameter name; a component takes those it has. KeyError for an unknown name."""
    return CATALOGUE[name].settings()
