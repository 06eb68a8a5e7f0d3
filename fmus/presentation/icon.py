"""The picture of an FMU in other tools: drawn from circles and bars, the same bytes everywhere."""

from __future__ import annotations

import struct
import zlib
from collections.abc import Callable
from enum import Enum, auto

import numpy as np

from ...modelkit.model import Model, slots

SIZE, SMALL = 64, 16  # pixels
SUBPIXELS = 4  # sub-pixels along each side, for smooth edges
PALETTE = np.array(
    [[255, 255, 255], [52, 73, 94], [231, 146, 60], [189, 199, 209], [38, 122, 176]], dtype=np.uint8
)
WHITE, DARK, BALL, STEEL, BLUE = range(len(PALETTE))


class Motif(Enum):
    """The subject of a picture."""

    ROTOR = auto()
    HOUSING = auto()
    BALL_BEARING = auto()
    MAGNETIC_BEARING = auto()
    BUSHING = auto()


def icon(model: Model) -> bytes:
    """PNG for `model`: a bearing around its journal, a magnetic bearing, a rotor or a housing."""
    return _picture(SIZE, lambda picture, x, y: _draw(_motif(model), picture, x, y))


def dot() -> bytes:
    """PNG of a port: a dot."""

    def draw(picture: np.ndarray, x: np.ndarray, y: np.ndarray) -> None:
        picture[np.hypot(x, y) < 0.8] = BLUE

    return _picture(SMALL, draw)


def _picture(size: int, draw: Callable[[np.ndarray, np.ndarray, np.ndarray], None]) -> bytes:
    """PNG of size x size pixels; draw(picture, x, y) paints it, x and y run from -1 to 1."""
    n = size * SUBPIXELS
    across = (np.arange(n) + 0.5) / n * 2.0 - 1.0
    picture = np.full((n, n), WHITE)
    draw(picture, across[None, :], -across[:, None])
    fine = PALETTE[picture].reshape(size, SUBPIXELS, size, SUBPIXELS, 3).astype(float)
    return _png(fine.mean(axis=(1, 3)).round().astype(np.uint8))


def _motif(model: Model) -> Motif:
    """The subject to draw, by the inputs and outputs of the model."""
    names = {slot.variable.name for slot in slots(model)}
    if "journal.x" not in names:
        return Motif.HOUSING if any(name.startswith(("seat.", "mount_")) for name in names) else Motif.ROTOR
    if "balls.count" in names:
        return Motif.BALL_BEARING
    return Motif.MAGNETIC_BEARING if "shutdown_time" in names else Motif.BUSHING


def _draw(motif: Motif, picture: np.ndarray, x: np.ndarray, y: np.ndarray) -> None:
    """Paint one over the other; x and y run from -1 to 1."""
    r = np.hypot(x, y)
    if motif is Motif.ROTOR:
        picture[(abs(x) < 0.92) & (abs(y) < 0.14)] = STEEL
        picture[(abs(x) < 0.22) & (abs(y) < 0.72)] = DARK
        return
    if motif is Motif.HOUSING:
        picture[(abs(x) < 0.62) & (abs(y - 0.2) < 0.62)] = DARK
        picture[np.hypot(x, y - 0.2) < 0.4] = WHITE
        picture[(abs(y + 0.88) < 0.05) & (abs(x) < 0.92)] = STEEL
        picture[(abs(abs(x) - 0.4) < 0.07) & (y < -0.42) & (y > -0.83)] = BALL
        return
    picture[(r < 0.92) & (r > 0.72)] = DARK
    if motif is Motif.BALL_BEARING:
        angle = np.arange(9) * 2.0 * np.pi / 9
        for a in angle:
            picture[np.hypot(x - 0.6 * np.cos(a), y - 0.6 * np.sin(a)) < 0.125] = BALL
        picture[(r < 0.48) & (r > 0.4)] = DARK
    if motif is Motif.MAGNETIC_BEARING:
        poles = (r < 0.74) & (r > 0.5) & ((abs(x) < 0.16) | (abs(y) < 0.16))
        picture[poles] = BLUE
    size, drop = (0.34, 0.04) if motif is not Motif.BUSHING else (0.62, 0.09)
    picture[np.hypot(x, y + drop) < size] = STEEL


def _png(pixels: np.ndarray) -> bytes:
    """A picture (rows, columns, 3) as PNG, stored and not deflated: no library's version shows in it."""
    rows = b"".join(b"\0" + row.tobytes() for row in pixels)
    length = struct.pack("<2H", len(rows), 0xFFFF - len(rows))
    stored = b"\x78\x01\x01" + length + rows + struct.pack(">I", zlib.adler32(rows))
    header = struct.pack(">2I5B", pixels.shape[1], pixels.shape[0], 8, 2, 0, 0, 0)
    chunks = ((b"IHDR", header), (b"IDAT", stored), (b"IEND", b""))
    return b"\x89PNG\r\n\x1a\n" + b"".join(
        struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
        for kind, data in chunks
    )
