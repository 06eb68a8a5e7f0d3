"""The file of a foundation's modes, as settings that a scene's component takes."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

from ...bearings.supports.foundation import MODES, NAMES
from ...master.common.errors import TouchdownError, one_of
from ...rotor.imports.foundation import FoundationModes, read_foundation

MOST_MODES = MODES
AXES = "xy"
HERTZ = 2.0 * math.pi


def read_modes(path: Path, seats: Mapping[str, str], most: int, ratio: float) -> FoundationModes:
    """Of the foundation at `path`; seats: nodes by letter. Raises TouchdownError."""
    if wrong := [seat for seat in seats if seat not in tuple(NAMES)]:
        raise TouchdownError(f"--at {wrong[0]}: {one_of(wrong[0], NAMES)}")
    if sorted(seats) != list(NAMES[: len(seats)]):
        raise TouchdownError(
            f"--at gives {', '.join(seats)}; seats are used from {NAMES[0]} on, none left out"
        )
    if not 0.0 <= ratio < 1.0:
        raise TouchdownError(f"--damping {ratio:g} must be from 0 to below 1")
    return read_foundation(path, seats, most, ratio)


def foundation_text(found: FoundationModes, seats: Sequence[str], name: str) -> str:
    """TOML for `settings` of a scene's component; name: of the file that the modes are from."""
    return "\n".join(_lines(found, seats, name)) + "\n"


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


def mode_lines(found: FoundationModes) -> Iterator[str]:
    """The modes in words, a line each."""
    for i, (omega, ratio) in enumerate(zip(found.omega, found.damping_ratio, strict=True), 1):
        yield f"mode {i}: {omega / HERTZ:.4g} Hz, damping ratio {ratio:.3g}"
    if found.left_out is None:
        yield "note: what other modes give way by at the seats is not in modal data, and left out"
    elif found.left_out > 0.0:
        yield (
            f"note: other modes, left out, make up to {100.0 * found.left_out:.2g} % of what the seats "
            "give way by at rest; add it to the mounts' springs"
        )
