"""Properties of a rotor before a drop: modes, whirl, critical speeds, static position."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from ..modelkit.model import ModelError
from .beams.shaft import Shaft
from .modal.data import most_modes
from .modal.modes import RIGID_MODES, Basis, basis, fullest
from .modal.supported import HeldRotor, LinearBearing
from .modal.whirl_speeds import CriticalMap, HeldModes, critical_map, held_modes, whirl_frequencies
from .static_deflection import Rest, at_rest

HZ_PER_RAD_S = 0.5 / math.pi
# Modes per plane on supports, with the residual flexibility there: 1e-6 of the lowest ones
SUPPORTED_MODES = 12
CAMPBELL_LINES = 12  # of a Campbell diagram on supports
CAMPBELL_STRIDE = 2  # of the speeds every which is taken for it


@dataclass(frozen=True)
class RotorProperties:
    """A free rotor's modes in one plane, by frequency, and its lines over the spin speed.

    A line belongs to a mode; lines of the translation, and the backward one of the tilt, stay at zero.
    """

    shaft: Shaft
    kinds: tuple[str, ...]  # of the n modes
    frequencies: np.ndarray  # (n,), Hz, at rest
    shapes: np.ndarray  # (N, n), deflection of the nodes, largest 1
    speeds: np.ndarray  # (S,), rad/s, not negative
    forward: np.ndarray  # (S, n), Hz, whirl with the spin
    backward: np.ndarray  # (S, n), Hz, whirl against it
    rest: Rest | None  # rigidly held at the seats; None where there are less than two
    critical: tuple[CriticalMap, ...]  # held where it is levitated, and at its seats; where two nodes are
    held: HeldModes | None  # on the shaft's supports, over the speeds as well; None without supports


def rotor_properties(shaft: Shaft, modes: int, speeds: Sequence[float] | np.ndarray) -> RotorProperties:
    """The lowest `modes` modes of `shaft` (0: all) and their whirl frequencies at `speeds` (rad/s).

    The sign of a speed does not matter: it turns the senses of whirl with it. Raises ModelError where
    there are not so many modes, or the elements are too unlike each other.
    """
    full = basis(shaft, 0)
    count = modes or len(full.omega)
    if not RIGID_MODES <= count <= len(full.omega):
        raise ModelError(
            f"modes = {modes}: {shaft.title} has {len(full.omega)} modes per plane; ask for "
            f"{RIGID_MODES} (rigid) to {len(full.omega)}, or 0 for all"
        )
    full_there = fullest(shaft, list(dict.fromkeys(s.node for s in (*shaft.stations, *shaft.supports))))
    shapes = full.shapes[0::2, :count]
    turning = np.abs(np.asarray(speeds, dtype=float))
    whirl = HZ_PER_RAD_S * whirl_frequencies(full, turning)
    forward, backward = _lines(whirl, count)
    nodes = sorted({s.node for s in shaft.seats})
    return RotorProperties(
        shaft=shaft,
        kinds=tuple(_kind(k) for k in range(count)),
        frequencies=HZ_PER_RAD_S * full.omega[:count],
        shapes=shapes / np.max(np.abs(shapes), axis=0),
        speeds=turning,
        forward=forward,
        backward=backward,
        rest=at_rest(shaft, [(node, math.inf) for node in nodes]) if len(nodes) > 1 else None,
        critical=tuple(_critical(shaft, full_there)),
        held=_held(shaft, turning) if shaft.supports else None,
    )


def _held(shaft: Shaft, speeds: np.ndarray) -> HeldModes:
    """On its own supports, at the first speed and over the others, with the damping of its own modes."""
    nodes = list(dict.fromkeys(s.node for s in shaft.supports))
    few = basis(shaft, min(SUPPORTED_MODES, most_modes(shaft)), nodes)
    rotor = HeldRotor(few, [LinearBearing.of(s) for s in shaft.supports], shaft.damping_ratio)
    return held_modes(rotor, [speeds[0], *speeds[1:][::CAMPBELL_STRIDE]], CAMPBELL_LINES)


def _critical(shaft: Shaft, full: Basis) -> Iterator[CriticalMap]:
    """Held by what levitates it, and by its seats."""
    levitating = [s for s in shaft.stations if s.name in shaft.levitated_at]
    for places in (levitating, shaft.seats):
        if len({s.node for s in places}) > 1:
            yield critical_map(shaft, full, places)


def _kind(mode: int) -> str:
    return ("translation", "tilt")[mode] if mode < RIGID_MODES else f"bending {mode - RIGID_MODES + 1}"


def _lines(whirl: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Forward and backward lines (S, count) out of ascending whirl frequencies (S, 2n).

    Of the 2n, n - 2 are negative, three are zero, and n - 1 positive: tilting, a free rotor goes round
    only forwards.
    """
    bending = whirl.shape[1] // 2 - RIGID_MODES
    zero = np.zeros((len(whirl), 1))
    forward = np.hstack((zero, np.abs(whirl[:, -bending - 1 :])))
    backward = np.hstack((zero, zero, -whirl[:, :bending][:, ::-1]))
    return forward[:, :count], backward[:, :count]
