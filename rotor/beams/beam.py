"""One Timoshenko beam element in one plane (section 3.1 of the source), a cylinder or a cone.

Coordinates of an element: (y1, slope1, y2, slope2), where a slope is the turn of the cross-section,
not of the centre line (3.14): dy/dz less the shear angle. z runs from node 1 to node 2.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from touchdown.rotor.beams.element import Element

CYLINDER = np.polynomial.legendre.leggauss(4)  # exact for the sixth degree of N^T N
CONE = np.polynomial.legendre.leggauss(5)  # and of the eighth, with the second degree of the area


@dataclass(frozen=True)
class ElementMatrices:
    """Each (4, 4): mass with rotary inertia, stiffness, and the gyroscopic ("polar") matrix."""

    mass: np.ndarray
    stiffness: np.ndarray
    polar: np.ndarray


@dataclass(frozen=True)
class Shapes:
    """Shape functions at places S along an element of n places, each (n, 4).

    deflection N of (3.15), slope N' + D of (3.17), curvature N'', third N'''.
    """

    deflection: np.ndarray
    slope: np.ndarray
    curvature: np.ndarray
    third: np.ndarray


def shapes(element: Element, places: np.ndarray) -> Shapes:
    """Shape functions with bending and shear at `places` (n,), in m from the element's first node.

    Built as (3.15) does, from the polynomial and its values at the ends, in S/L for good conditioning.
    """
    L = element.length
    shear = element.phi / 12.0  # EI / (kGA L^2), see (3.16)
    at_ends = _polynomial(np.array([0.0, 1.0]))
    turn = (at_ends[1] + shear * at_ends[3]) / L
    h = np.array([at_ends[0][0], turn[0], at_ends[0][1], turn[1]])
    coefficients = np.linalg.inv(h)
    value, first, second, third = (p @ coefficients for p in _polynomial(np.asarray(places) / L))
    return Shapes(value, (first + shear * third) / L, second / L**2, third / L**3)


def _polynomial(s: np.ndarray) -> list[np.ndarray]:
    """The row (3.2) and its three derivatives at dimensionless places s (n,), each (n, 4)."""
    one, zero = np.ones_like(s), np.zeros_like(s)
    return [
        np.stack(rows, axis=-1)
        for rows in (
            (one, s, s**2, s**3),
            (zero, one, 2.0 * s, 3.0 * s**2),
            (zero, zero, 2.0 * one, 6.0 * s),
            (zero, zero, zero, 6.0 * one),
        )
    ]


@lru_cache(maxsize=4096)
def matrices(element: Element) -> ElementMatrices:
    """Consistent matrices of an element with its sleeve and layers, by Gauss quadrature, exact for them.

    Of a cone the shape functions are those of its middle section, as in Genta and Gugliotta (1988), while
    area and second moment vary along it. Layers share the displacements and slopes of the nodes.
    """
    mass, stiffness, polar = np.zeros((4, 4)), np.zeros((4, 4)), np.zeros((4, 4))
    for part in element.parts:
        own = _of_one(part)
        mass += own.mass
        stiffness += own.stiffness
        polar += own.polar
    return ElementMatrices(mass, stiffness, polar)


def _of_one(element: Element) -> ElementMatrices:
    """Of an element without layers."""
    points, weights = CONE if element.tapered else CYLINDER
    N = shapes(element, 0.5 * element.length * (points + 1.0))
    area = second = 0.5 * element.length * weights  # times what they are of the middle's
    if element.tapered:
        places = 0.5 * (points + 1.0)
        area, second = area * element.area_ratio(places), second * element.second_moment_ratio(places)
    shear_angle = N.third * _bending_over_shear(element)  # D of (3.16), the same all along
    rotary = element.diametral_inertia_per_length * _integral(second, N.slope)
    return ElementMatrices(
        mass=element.mass_per_length * _integral(area, N.deflection) + rotary,
        stiffness=element.EI * _integral(second, N.curvature) + element.kGA * _integral(area, shear_angle),
        polar=2.0 * rotary,
    )


def _bending_over_shear(element: Element) -> float:
    """EI / kGA in the middle (m2); of laminations, which have neither, nothing hangs on it."""
    return element.EI / element.kGA if element.EI > 0.0 else 0.0


def _integral(weights: np.ndarray, rows: np.ndarray) -> np.ndarray:
    """Integral of rows^T rows along the element (4, 4), exactly symmetric."""
    product = rows.T @ (weights[:, None] * rows)
    return 0.5 * (product + product.T)
