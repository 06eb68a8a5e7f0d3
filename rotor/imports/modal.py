"""A rotor from modal data (docs/rotors.md): the modes of the free rotor in one plane, at nodes of its axis.

The modes say the rotor's mass and inertias: those of its rigid modes. What modes beyond them would give is
not known, so its seats are as stiff as these modes make them.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from ...modelkit.errors import TouchdownError
from ..beams.shaft import Shaft
from ..beams.superelement import RIGID_FREQUENCY_RATIO, Superelement, symmetric_body
from ..modal.modes import RIGID_MODES
from .named_arrays import Given

FIELDS = (
    *("positions", "frequencies", "deflections", "slopes"),
    *("modal_masses", "gyroscopic", "polar_inertias"),
)
UNIT_SCALE_TOLERANCE = 1e-6  # of 1, the largest deflection of modes that are scaled to it


def of_modes(data: Mapping[str, Any], file: str, title: str) -> Shaft:
    """The rotor of these arrays. Raises TouchdownError."""
    arrays = Given(file, data)
    arrays.only(*FIELDS)
    positions = arrays.numbers("positions")
    frequencies = arrays.numbers("frequencies")
    arrays.require(
        positions.ndim == 1 and frequencies.ndim == 1,
        "positions and frequencies must each be one row of numbers",
    )
    order = np.argsort(frequencies)
    _check_rigid(arrays, frequencies[order])
    size = (len(positions), len(frequencies))
    shapes = np.empty((2 * size[0], size[1]))
    shapes[0::2] = arrays.numbers("deflections", size)[:, order]
    shapes[1::2] = arrays.numbers("slopes", size)[:, order]
    scale = 1.0 / np.sqrt(_masses(arrays, shapes[0::2])[order])
    shapes *= scale
    omega = 2.0 * np.pi * frequencies[order]
    omega[:RIGID_MODES] = 0.0
    body = Superelement(
        positions - positions[0],
        np.eye(size[1]),
        np.diag(omega**2),
        _polar(arrays, shapes, order, scale),
        shapes,
    )
    try:
        body = symmetric_body(body)
    except TouchdownError as error:
        raise arrays.error(str(error)) from None
    about = (
        f"Imported from modal data, {size[1]} modes per plane with the two rigid ones; mass "
        f"{body.mass:.4g} kg, as the modes say.\n"
        f"What modes beyond {frequencies[order][-1]:.5g} Hz would give at its seats (residual flexibility) "
        "is not known."
    )
    return Shaft(title, superelement=body, about=about)


def _check_rigid(arrays: Given, frequencies: np.ndarray) -> None:
    """Of ascending frequencies (Hz)."""
    arrays.require(
        len(frequencies) > RIGID_MODES,
        f"{len(frequencies)} modes hold no bending mode; such a rotor is rigid",
    )
    lowest, first = frequencies[:RIGID_MODES], frequencies[RIGID_MODES]
    if first <= 0.0 or np.max(np.abs(lowest)) > RIGID_FREQUENCY_RATIO * first:
        listed = ", ".join(f"{f:.4g}" for f in frequencies[: RIGID_MODES + 1])
        raise arrays.error(
            f"frequencies: the lowest are {listed} Hz; a free rotor has two rigid modes of 0 Hz in a "
            "plane, and no third; export the modes of the rotor without bearings"
        )


def _masses(arrays: Given, deflections: np.ndarray) -> np.ndarray:
    """Modal masses (n,), kg, of modes with these deflections (N, n)."""
    n = deflections.shape[1]
    if not arrays.has("modal_masses"):
        arrays.require(
            not np.allclose(np.abs(deflections).max(axis=0), 1.0, rtol=UNIT_SCALE_TOLERANCE),
            "every mode has the largest deflection 1, so they are not mass-normalised: give modal_masses",
        )
        return np.ones(n)
    masses = arrays.numbers("modal_masses", (n,))
    arrays.require(np.all(masses > 0.0), f"modal_masses must be above 0; one is {masses.min():g}")
    return masses


def _polar(arrays: Given, shapes: np.ndarray, order: np.ndarray, scale: np.ndarray) -> np.ndarray:
    """The modal polar matrix (n, n) of mass-normalised shapes (2N, n) in `order`."""
    n, nodes = shapes.shape[1], len(shapes) // 2
    arrays.require(
        arrays.has("gyroscopic") != arrays.has("polar_inertias"),
        "give one of gyroscopic (n by n) and polar_inertias (one for each node)",
    )
    if arrays.has("gyroscopic"):
        return arrays.numbers("gyroscopic", (n, n))[np.ix_(order, order)] * np.outer(scale, scale)
    inertias = arrays.numbers("polar_inertias", (nodes,))
    arrays.require(
        np.all(inertias >= 0.0), f"polar_inertias must not be negative; one is {inertias.min():g}"
    )
    slopes = shapes[1::2]
    return slopes.T @ (inertias[:, None] * slopes)
