"""The file of a foundation's modes, as settings that a scene's component takes."""

from __future__ import annotations

import json
import math
import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from ...bearings.supports.foundation import MODES, NAMES
from ...master.common.errors import TouchdownError, one_of
from ...master.common.files import keep_other, writing_to
from ...master.common.text import percent
from ...modelkit.kernel.writing import write
from ...rotor.imports.foundation_modes import FoundationModes, read_foundation

MOST_MODES = MODES
AXES = "xy"
HERTZ = 2.0 * math.pi


@dataclass(frozen=True)
class ImportedFoundation:
    """The modes of a foundation, and the seats that they move."""

    modes: FoundationModes
    seats: Sequence[str]  # by letter
    name: str  # of the file that they are from

    @classmethod
    def read(
        cls, path: Path, seats: Mapping[str, int | str], most: int, ratio: float
    ) -> ImportedFoundation:
        """Of the foundation at `path`; seats: nodes by letter. Raises TouchdownError."""
        if most > MOST_MODES:
            raise TouchdownError(f"--modes {most} must be at most {MOST_MODES}")
        if wrong := [seat for seat in seats if seat not in tuple(NAMES)]:
            raise TouchdownError(f"--at {wrong[0]}: {one_of(wrong[0], NAMES)}")
        if sorted(seats) != list(NAMES[: len(seats)]):
            raise TouchdownError(
                f"--at gives {', '.join(seats)}; seats are used from {NAMES[0]} on, none left out"
            )
        if not 0.0 <= ratio < 1.0:
            raise TouchdownError(f"--damping {ratio:g} must be from 0 to below 1")
        nodes = {seat: str(node) for seat, node in seats.items()}
        return cls(read_foundation(path, nodes, most, ratio), list(seats), path.name)

    def lines(self) -> Iterator[str]:
        """The modes in words."""
        found = self.modes
        for i, (omega, ratio) in enumerate(zip(found.omega, found.damping_ratio, strict=True), 1):
            yield f"mode {i}: {omega / HERTZ:.4g} Hz, damping ratio {ratio:.3g}"
        if found.left_out is None:
            yield "note: what other modes give way by at the seats is not in modal data, and left out"
        elif found.left_out > 0.0:
            yield (
                f"note: other modes, left out, make up to {percent(found.left_out, 2)} of what the seats "
                "give way by at rest; add it to the mounts' springs"
            )

    def save(self, path: str | os.PathLike[str], force: bool = True) -> Path:
        """Write the file of settings (.toml) that a scene's component takes; returns the path.

        force=False: not over a file that holds something else. Raises TouchdownError.
        """
        return write_new(Path(path), "\n".join(_lines(self.modes, self.seats, self.name)) + "\n", force)


def write_new(path: Path, text: str, force: bool, beside: Callable[[], object] = lambda: None) -> Path:
    """Write a file, and what comes beside it; without `force` not over one that holds something else."""
    if not force:
        keep_other(path, text, "file with -o")
    with writing_to(path.parent):
        write(path, text)
        beside()
    return path


def _lines(found: FoundationModes, seats: Sequence[str], name: str) -> Iterator[str]:
    yield f"title = {json.dumps(f'Foundation of {name}', ensure_ascii=False)}"
    yield ""
    yield "[set.foundation]"
    yield f"seats = {len(seats)}"
    yield f"modes = {len(found.omega)}  # shapes are mass-normalised, 1/kg^0.5"
    for i, (omega, ratio, shape) in enumerate(
        zip(found.omega, found.damping_ratio, found.shape, strict=True), 1
    ):
        yield f'"mode[{i}].omega" = {omega:.9g}  # rad/s: {omega / HERTZ:.5g} Hz'
        yield f'"mode[{i}].damping_ratio" = {ratio:.6g}'
        for seat, row in zip(seats, shape, strict=True):
            for axis, value in zip(AXES, row, strict=True):
                yield f'"mode[{i}].{seat}.{axis}" = {value + 0.0:.9g}'
