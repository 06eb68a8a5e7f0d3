"""How hard a rotor lands, by clearance."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from ..master.quantities import values_of
from ..master.results.run import run_scene
from ..master.scene.scene import Scene


def peak_forces(scene: Scene, bearing: str, clearances: Iterable[str], folder: Path) -> dict[str, float]:
    """Peak contact force (N) of `bearing` for each of its clearances (texts with units)."""
    peaks: dict[str, float] = {}
    for clearance in clearances:
        changed = scene.set({f"{bearing}.clearance": clearance})
        summary = run_scene(changed, folder / clearance).summary
        peaks[clearance] = max(values_of(summary, "peak_contact_force").values())
    return peaks
