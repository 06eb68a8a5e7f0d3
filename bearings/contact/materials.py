"""Materials of balls and rings.

Steel's numbers are of Halminen (2016); those of silicon nitride are rounded from makers' catalogues of
hybrid bearings (from memory), which agree on them within some per cent.
"""

from __future__ import annotations

from typing import NamedTuple

from ...modelkit.kernel import kernel
from ...modelkit.variables import Choices

STEEL, SILICON_NITRIDE = range(2)
MATERIALS = Choices("Material", ("steel", "Si3N4"), ("bearing steel", "silicon nitride, a ceramic"))


class Elastic(NamedTuple):
    """An elastic material."""

    modulus: float  # Pa
    poisson: float


STEEL_NUMBERS, STEEL_DENSITY = Elastic(207e9, 0.3), 7830.0  # kg/m3
SILICON_NITRIDE_NUMBERS, SILICON_NITRIDE_DENSITY = Elastic(310e9, 0.26), 3200.0  # kg/m3


@kernel
def elastic_of(body):
    """`Elastic` numbers of a body, a record: those that it sets, and its material's where it has 0."""
    numbers = SILICON_NITRIDE_NUMBERS if body.material == SILICON_NITRIDE else STEEL_NUMBERS
    return Elastic(
        body.modulus if body.modulus > 0.0 else numbers.modulus,
        body.poisson if body.poisson > 0.0 else numbers.poisson,
    )


@kernel
def density_of(body):
    """Density (kg/m3) of a body, a record: that it sets, or its material's where that is 0."""
    of_material = SILICON_NITRIDE_DENSITY if body.material == SILICON_NITRIDE else STEEL_DENSITY
    return body.density if body.density > 0.0 else of_material


@kernel
def effective_modulus(one, other):
    """E_tot of (2.46) for two bodies (`Elastic`), Pa: 2 over the sum of their (1 - nu^2)/E."""
    if one.modulus == other.modulus and one.poisson == other.poisson:
        return one.modulus / (1.0 - one.poisson * one.poisson)
    plane = (1.0 - one.poisson * one.poisson) / one.modulus
    return 2.0 / (plane + (1.0 - other.poisson * other.poisson) / other.modulus)
