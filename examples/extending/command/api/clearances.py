"""How hard a rotor lands, by clearance."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from ..parameters import Names, PathLike
from .run import as_scene

if TYPE_CHECKING:
    from ...master.scene.scene import Scene


def clearances(
    scene: PathLike | Scene,
    folder: PathLike,
    *,
    bearing: str = "bearing",
    clearances: Names = ("0.2 mm", "0.3 mm"),
) -> dict[str, float]:
    """Show how hard a rotor lands, by clearance.

    folder: for the runs
    bearing: which component
    clearances: that it has (default: 0.2 and 0.3 mm)

    Returns the peak forces (N).
    """
    from ...studies.clearances import peak_forces

    return peak_forces(as_scene(scene), bearing, clearances, Path(folder))


def show_clearances(peaks: dict[str, float], folder: PathLike) -> int:
    """Print the forces."""
    for clearance, force in peaks.items():
        print(f"{clearance:>8} {force:8.0f} N")
    return 0
