"""How far a ring or a shaft grows by its own spin: elastic, in plane stress, nothing holding its rims.

    u(a) = rho w^2 a/(4 E) ((3 + nu) b^2 + (1 - nu) a^2)
    u(b) = rho w^2 b/(4 E) ((3 + nu) a^2 + (1 - nu) b^2)

of a ring with bore a and rim b (radii); a thin one grows by rho w^2 r^3/E, a solid shaft by
(1 - nu) rho w^2 r^3/(4 E).
"""

from __future__ import annotations

from typing import NamedTuple

from ...modelkit.kernel import kernel


class Growth(NamedTuple):
    """Radial, in m."""

    bore: float
    rim: float


@kernel
def spin_growth(bore, rim, speed, density, elastic):
    """`Growth` of a ring that spins with `speed` (rad/s).

    bore, rim: radii (m), bore 0 for a solid shaft; density: kg/m3; elastic: `Elastic`.
    """
    pull = density * speed * speed / (4.0 * elastic.modulus)
    more, less = 3.0 + elastic.poisson, 1.0 - elastic.poisson
    inside, outside = bore * bore, rim * rim
    return Growth(
        pull * bore * (more * outside + less * inside), pull * rim * (more * inside + less * outside)
    )
