"""A measured rotor on magnetic bearings: the test rig MLPS of TU Darmstadt and TU Munich."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any

import numpy as np

from ..bearings.magnetic.magnet import Circuit, Magnet, lay_out_circuit
from ..modelkit.variables import as_record
from ..rotor.beams.beam_body import PointMass
from ..rotor.beams.element import Element
from ..rotor.beams.shaft import Shaft
from ..rotor.modal.modes import basis
from ..rotor.modal.supported import HeldRotor, LinearBearing
from .case import Row

MAGNETS = (0.113, 0.623)  # m
DISCS = {  # at m: kg, kg m2 polar and diametral
    0.113: (0.85074, 4.036839e-4, 4.840066e-4),
    0.363: (1.276499, 2.832751e-3, 1.487212e-3),
    0.623: (0.85074, 4.036839e-4, 4.840066e-4),
}
SLEEVES = ((0.094, 0.132), (0.350, 0.376), (0.604, 0.642))  # m, where hubs are clamped to the shaft
RADIUS, LENGTH, ELEMENT = 4e-3, 0.702, 0.01  # m
FREE = (22.647, 106.131, 176.616, 215.302)  # Hz, by hammer
ESTIMATE = 1.1e5  # N/m, of a magnetic bearing at P = 5000, by the rig's authors


def _rotor(sleeve: float) -> tuple[Shaft, dict[float, int]]:
    """The rotor, and its nodes by place (m); sleeve: radius under the hubs over that of the shaft."""
    marks = sorted({0.0, LENGTH, *DISCS, *(edge for pair in SLEEVES for edge in pair)})
    elements: list[Element] = []
    nodes = {0.0: 1}
    for start, end in pairwise(marks):
        clamped = any(a < 0.5 * (start + end) < b for a, b in SLEEVES)
        count = max(1, round((end - start) / ELEMENT))
        size = 2.0 * RADIUS * (sleeve if clamped else 1.0)
        piece = Element(
            length=(end - start) / count, outer_diameter=size, modulus=211e9, density=7860.0, poisson=0.3
        )
        elements += [piece] * count
        nodes[end] = len(elements) + 1
    points = tuple(PointMass(nodes[place], *body) for place, body in DISCS.items())
    return Shaft("MLPS", tuple(elements), points), nodes


def _held(stiffness: float, count: int) -> np.ndarray:
    """Frequencies (Hz) of the first planes' modes on magnetic bearings of a stiffness (N/m), at rest."""
    shaft, nodes = _rotor(1.2)
    bearings = [LinearBearing(nodes[place], stiffness * np.eye(2), np.zeros((2, 2))) for place in MAGNETS]
    return HeldRotor(basis(shaft, 0), bearings).damped_modes(0.0).frequencies[: 2 * count : 2]


def _bending(sleeve: float) -> list[Row]:
    """Frequencies of the free rotor."""
    found = basis(_rotor(sleeve)[0], 6).omega[2:] / (2.0 * math.pi)
    pairs = enumerate(zip(FREE, found, strict=True), start=1)
    return [Row(f"bending mode {k}", "Hz", theirs, float(ours)) for k, (theirs, ours) in pairs]


def rig_free() -> list[Row]:
    """A shaft of 8 mm by 0.702 m with three hubs of 0.85, 1.28 and 0.85 kg, hung up: four frequencies. The
    shaft's radius is 1.2 times as large where hubs are clamped on it."""
    return _bending(1.2)


def rig_free_plain() -> list[Row]:
    """The rotor by its drawing's dimensions alone, hubs as rigid bodies that touch the shaft at a point."""
    return _bending(1.0)


def rig_held() -> list[Row]:
    """Frequencies at rest, levitated; assumed: magnetic bearings without damping, lag or tilt stiffness,
    their force at the middle of their hubs. 52.013 Hz was taken for the whole rotor on two springs: 1.748e5
    N/m each."""
    estimate, rigid = _held(ESTIMATE, 4), _held(1.748e5, 2)
    return [
        Row("first bending", "Hz", 16.7, float(estimate[0])),
        Row("next bending", "Hz", 103.0, float(estimate[3])),
        Row("on its springs, 1.1e5 N/m", "Hz", 52.013, float(estimate[1])),
        Row(
            "on its springs, 1.748e5 N/m",
            "Hz",
            52.013,
            float(rigid[1]),
            why="1.748e5 N/m takes the rotor for rigid, so that all of its 3.274 kg swings; "
            "it bends at 17 Hz already, the middle disc stays behind, and less mass swings. The authors' "
            "own later estimate of 1.1e5 N/m, above, is without that",
        ),
    ]


def rig_magnets() -> list[Row]:
    """K of F = K i^2/g^2 from poles of 2.9 cm2, 2 x 104 turns and 22.5 degrees between force and pole."""
    circuit: Any = as_record(Circuit())
    magnet = Magnet(gap=780e-6, area=2.9e-4, turns=208.0, pole_angle=math.pi / 8.0)
    lay_out_circuit(circuit, as_record(magnet), 2.5, math.cos(magnet.pole_angle))
    ours = float(circuit["factor"]) * math.cos(magnet.pole_angle)
    return [Row("force factor", "1e-6 N m2/A2", 3.63, 1e6 * ours)]
