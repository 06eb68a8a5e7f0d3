"""One script per FMU; a file here with a `ModelSlave` in it is an FMU of the project."""

from __future__ import annotations

from pathlib import Path


def scripts() -> dict[str, Path]:
    """The scripts by the names of their FMUs; none is imported."""
    files = sorted(Path(__file__).parent.glob("*.py"))
    return {path.stem: path for path in files if path.stem != "__init__"}
