"""Bearings of the catalogue, and machines of one's own."""

from __future__ import annotations

import os
from pathlib import Path

from touchdown.bearings.catalogue import Bearing
from touchdown.master.api.scenes import PathLike
from touchdown.master.studies.machine.bearings import known


def catalogue(folder: PathLike = ".") -> dict[str, Bearing]:
    """The bearings that a scene in `folder` may take as a preset, by name: its bearings.toml's come first.

    Each has its numbers in SI (`numbers()`) and where they are from (`origins`). Raises TouchdownError
    where the file has a mistake.

    >>> bearing = touchdown.catalogue()["7014"]
    >>> bearing.balls.count, bearing.origins["balls"]
    (20, 'spaced by 1.15 diameters')
    >>> round(bearing.capacity().static)  # N, by ISO 76
    43627
    """
    return known(Path(os.fspath(folder)))
