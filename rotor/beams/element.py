"""Beam elements of a shaft: their data (cylinder or cone, sleeves, layers) and Timoshenko matrices.

The matrices are those of one element in one plane (Halminen (2016), section 3.1). Its coordinates are
(y1, slope1, y2, slope2), where a slope is the turn of the cross-section, not of the centre line (3.14):
dy/dz less the shear angle. z runs from node 1 to node 2.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import NamedTuple

import numpy as np

CYLINDER_POINTS = np.polynomial.legendre.leggauss(4)  # exact for the sixth degree of N^T N
CONE_POINTS = np.polynomial.legendre.leggauss(5)  # and of the eighth, with the second degree of the area


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
def element_matrices(element: Element) -> ElementMatrices:
    """Consistent matrices of an element with its sleeve and layers, by Gauss quadrature, exact for them.

    Of a cone the shape functions are those of its middle section, as in Genta and Gugliotta (1988), while
    area and second moment vary along it. Layers share the displacements and slopes of the nodes.
    """
    mass, stiffness, polar = np.zeros((4, 4)), np.zeros((4, 4)), np.zeros((4, 4))
    for part in element.parts:
        matrices = _of_one(part)
        mass += matrices.mass
        stiffness += matrices.stiffness
        polar += matrices.polar
    return ElementMatrices(mass, stiffness, polar)


def _of_one(element: Element) -> ElementMatrices:
    """Of an element without layers."""
    points, weights = CONE_POINTS if element.tapered else CYLINDER_POINTS
    N = shapes(element, 0.5 * element.length * (points + 1.0))
    area = second = 0.5 * element.length * weights  # times what they are of the middle's
    if element.tapered:
        places = 0.5 * (points + 1.0)
        area, second = area * element.area_ratio(places), second * element.second_moment_ratio(places)
    # EI / kGA in the middle; of laminations, which have neither, nothing depends on it
    bending_over_shear = element.EI / element.kGA if element.EI > 0.0 else 0.0
    shear_angle = N.third * bending_over_shear  # D of (3.16), the same all along
    rotary = element.diametral_inertia_per_length * _integral(second, N.slope)
    return ElementMatrices(
        mass=element.mass_per_length * _integral(area, N.deflection) + rotary,
        stiffness=element.EI * _integral(second, N.curvature) + element.kGA * _integral(area, shear_angle),
        polar=2.0 * rotary,
    )


def _integral(weights: np.ndarray, rows: np.ndarray) -> np.ndarray:
    """Integral of rows^T rows along the element (4, 4), exactly symmetric."""
    product = rows.T @ (weights[:, None] * rows)
    return 0.5 * (product + product.T)


_POINTS, _WEIGHTS = np.polynomial.legendre.leggauss(3)  # exact for the fourth degree
PLACES, PARTS = 0.5 * (_POINTS + 1.0), 0.5 * _WEIGHTS  # of an integral from 0 to 1


def ring_area(outer: float, inner: float) -> float:
    """Area between two diameters (m2)."""
    return math.pi / 4.0 * (outer**2 - inner**2)


def ring_second_moment(outer: float, inner: float) -> float:
    """Second moment of area between two diameters, about a diameter (m4)."""
    return math.pi / 64.0 * (outer**4 - inner**4)


class ConeFactors(NamedTuple):
    """How a cone differs from a cylinder of its middle section: factors, and its centre of mass."""

    mass: float = 1.0
    square: float = 1.0  # on mass length^2 / 12, about the centre of mass
    second_moment: float = 1.0  # on the integral of the second moment of area
    offset: float = 0.0  # of the centre of mass from the middle, over the length


CYLINDER = ConeFactors()


@dataclass(frozen=True, kw_only=True)
class Element:
    """A cylinder or cone (the core), solid or hollow, with an optional sleeve and layers around it.

    Diameters are those at the first node; `outer_diameter_end` and `inner_diameter_end` those at the
    second, between which they run linearly. Areas, moments and stiffnesses are those of the middle.

    The sleeve, of cylinders only, reaches from `outer_diameter` to `sleeve_diameter` and always adds mass
    and rotary inertia. It adds stiffness by its modulus: to EI, and to kGA with the shear factor and the
    Poisson's ratio of the core, as one section; a modulus of 0 means laminations, which carry nothing.
    Layers are elements of the same length beside it, held together at the nodes, each of which shears by
    itself. Lengths and diameters in m, moduli in Pa, densities in kg/m3.

    >>> steel = touchdown.Element(
    ...     length=0.1, outer_diameter=0.04, modulus=207e9, density=7830.0, poisson=0.3
    ... )
    >>> round(steel.mass, 3)  # kg
    0.984
    """

    length: float
    outer_diameter: float
    inner_diameter: float = 0.0
    modulus: float
    density: float
    poisson: float
    shear_factor: float | None = None  # None: Cowper's for the core
    sleeve_diameter: float = 0.0  # 0: no sleeve
    sleeve_density: float = 0.0
    sleeve_modulus: float = 0.0
    outer_diameter_end: float | None = None  # None: as at the first node
    inner_diameter_end: float | None = None
    layers: tuple[Element, ...] = ()

    @property
    def tapered(self) -> bool:
        """Whether the core is a cone."""
        return self.diameters(0.0) != self.diameters(1.0)

    def diameters(self, place: float) -> tuple[float, float]:
        """Outer and inner diameter of the core (m) at `place`, from 0 (first node) to 1 (second)."""
        outer, inner = self.outer_diameter, self.inner_diameter
        if self.outer_diameter_end is not None:
            outer += place * (self.outer_diameter_end - outer)
        if self.inner_diameter_end is not None:
            inner += place * (self.inner_diameter_end - inner)
        return outer, inner

    def section(self, place: float) -> Element:
        """A cylinder with the section, layers included, that the element has at `place` (0 to 1)."""
        return self.between(place, place).stretched(self.length)

    def between(self, start: float, end: float) -> Element:
        """The piece from `start` to `end`, both from 0 (first node) to 1 (second)."""
        (outer, inner), (outer_end, inner_end) = self.diameters(start), self.diameters(end)
        return replace(
            self,
            length=self.length * (end - start),
            outer_diameter=outer,
            inner_diameter=inner,
            outer_diameter_end=None if outer_end == outer else outer_end,
            inner_diameter_end=None if inner_end == inner else inner_end,
            layers=tuple(layer.between(start, end) for layer in self.layers),
        )

    def stretched(self, length: float) -> Element:
        """The element and its layers with another length (m)."""
        layers = tuple(replace(layer, length=length) for layer in self.layers)
        return replace(self, length=length, layers=layers)

    @property
    def parts(self) -> tuple[Element, ...]:
        """The core with its sleeve, and the layers: elements without layers."""
        return (replace(self, layers=()), *self.layers) if self.layers else (self,)

    @property
    def widest(self) -> float:
        """Its largest outer diameter, sleeve and layers included (m)."""
        unlayered = max(self.outer_diameter, self.outer_diameter_end or 0.0, self.sleeve_diameter)
        return max(unlayered, *(layer.widest for layer in self.layers)) if self.layers else unlayered

    @property
    def kappa(self) -> float:
        """Shear correction factor of (3.9), of the core; unless set, that of Cowper (1966)."""
        if self.shear_factor is not None:
            return self.shear_factor
        outer, inner = self.diameters(0.5)
        square, nu = (inner / outer) ** 2, self.poisson
        full = (1.0 + square) ** 2
        return 6.0 * (1.0 + nu) * full / ((7.0 + 6.0 * nu) * full + (20.0 + 12.0 * nu) * square)

    @property
    def area(self) -> float:
        """Of the core (m2)."""
        return ring_area(*self.diameters(0.5))

    @property
    def second_moment(self) -> float:
        """Of the core's area, about a diameter (m4)."""
        return ring_second_moment(*self.diameters(0.5))

    @property
    def core_EI(self) -> float:
        """Bending stiffness of the core alone (N m2)."""
        return self.modulus * self.second_moment

    @property
    def EI(self) -> float:
        """Bending stiffness, with sleeve and layers (N m2)."""
        unlayered = self.core_EI + self.sleeve_modulus * self._sleeve_second_moment
        return unlayered + sum(layer.EI for layer in self.layers)

    @property
    def kGA(self) -> float:
        """Shear stiffness, with sleeve and layers (N)."""
        modulus_area = self.modulus * self.area + self.sleeve_modulus * self._sleeve_area
        unlayered = self.kappa * modulus_area / (2.0 * (1.0 + self.poisson))
        return unlayered + sum(layer.kGA for layer in self.layers)

    @property
    def mass_per_length(self) -> float:
        """With sleeve and layers (kg/m)."""
        unlayered = self.density * self.area + self.sleeve_density * self._sleeve_area
        return unlayered + sum(layer.mass_per_length for layer in self.layers)

    @property
    def diametral_inertia_per_length(self) -> float:
        """Rotary inertia about a diameter, with sleeve and layers (kg m); the polar one is twice that."""
        unlayered = self.density * self.second_moment + self.sleeve_density * self._sleeve_second_moment
        return unlayered + sum(layer.diametral_inertia_per_length for layer in self.layers)

    @property
    def phi(self) -> float:
        """Shear deformation parameter (3.12); of laminations, what any modulus would give them."""
        if self.EI == 0.0:
            return replace(self, modulus=1.0).phi
        return 12.0 * self.EI / (self.kGA * self.length**2)

    @property
    def mass(self) -> float:
        """kg."""
        return sum(part.mass_per_length * part.length * part.spread.mass for part in self.parts)

    @property
    def centre_of_mass(self) -> float:
        """Its distance from the middle, towards the second node (m)."""
        if not any(part.tapered for part in self.parts):
            return 0.0
        moment = sum(part.mass * part.spread.offset * part.length for part in self.parts)
        return moment / self.mass

    @property
    def polar_inertia(self) -> float:
        """kg m2."""
        return sum(
            2.0 * part.diametral_inertia_per_length * part.length * part.spread.second_moment
            for part in self.parts
        )

    @property
    def diametral_inertia(self) -> float:
        """About the centre of mass (kg m2)."""
        return sum(self._diametral_inertia(part) for part in self.parts)

    def _diametral_inertia(self, part: Element) -> float:
        """Of a part, about the centre of mass of all (kg m2)."""
        length, spread = part.length, part.spread
        inertia = part.diametral_inertia_per_length * length * spread.second_moment
        inertia += part.mass * length**2 / 12.0 * spread.square
        return inertia + part.mass * (spread.offset * length - self.centre_of_mass) ** 2

    @property
    def spread(self) -> ConeFactors:
        """Of the core and its sleeve; closed integrals of the fourth degree along it."""
        if not self.tapered:
            return CYLINDER
        s = PLACES
        area, second = self.area_ratio(s), self.second_moment_ratio(s)
        mass = float(PARTS @ area)
        offset = float(PARTS @ (area * (s - 0.5))) / mass
        return ConeFactors(
            mass=mass,
            square=12.0 * float(PARTS @ (area * (s - 0.5 - offset) ** 2)) / mass,
            second_moment=float(PARTS @ second),
            offset=offset,
        )

    def area_ratio(self, places: np.ndarray) -> np.ndarray:
        """Area at `places` (n,), from 0 to 1 along the element, over that of the middle (n,)."""
        return np.array([ring_area(*self.diameters(s)) for s in places]) / self.area

    def second_moment_ratio(self, places: np.ndarray) -> np.ndarray:
        """Second moment of area at `places` (n,), from 0 to 1, over that of the middle (n,)."""
        return np.array([ring_second_moment(*self.diameters(s)) for s in places]) / self.second_moment

    @property
    def _sleeve_area(self) -> float:
        return ring_area(self.sleeve_diameter, self.outer_diameter) if self.sleeve_diameter else 0.0

    @property
    def _sleeve_second_moment(self) -> float:
        return (
            ring_second_moment(self.sleeve_diameter, self.outer_diameter) if self.sleeve_diameter else 0.0
        )


def split_element(element: Element, count: int) -> list[Element]:
    """`element` as `count` equally long ones, of cones with the diameters that it has there."""
    length = element.length / count
    return [element.between(k / count, (k + 1) / count).stretched(length) for k in range(count)]
