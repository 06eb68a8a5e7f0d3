"""Contact: impacts, and the journal's strip in its bore."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from scipy.integrate import solve_ivp
from scipy.special import gamma

from ..bearings import catalogue
from ..bearings.contact.laws import ContactLaw, elastic_and_damping, elastic_force
from ..bearings.contact.line import FROM_GEOMETRY, BoreContact, approach
from ..bearings.contact.pair import damped_normal
from ..modelkit.variables import as_record
from .case import Kind, Row, case

MASS = 1.65  # kg, of the source's disk
SPEED = math.sqrt(2.0 * 9.81 * 0.3e-3)  # m/s, after a fall through its clearance
STIFFNESS = 2.4e9  # N/m^1.5


class Impact(NamedTuple):
    """Deepest indentation (m), elastic force there (N), time in contact (s), speed out over speed in."""

    indentation: float
    force: float
    duration: float
    restitution: float


def impact(law: ContactLaw, speed: float = SPEED) -> Impact:
    """`MASS` lands at `speed` (m/s) on a rigid wall of a contact `law`, without its weight."""
    record = as_record(law)

    def motion(_: float, y: Any) -> list[float]:
        elastic, damping = elastic_and_damping(y[0], record)
        return [y[1], -damped_normal(elastic, damping, y[1], 0.0, 0.0) / MASS]

    def turns(_: float, y: Any) -> float:
        return y[1]

    def leaves(_: float, y: Any) -> float:
        return y[0]

    leaves.terminal, leaves.direction = True, -1.0  # type: ignore[attr-defined]
    run = solve_ivp(
        motion, (0.0, 0.1), [0.0, speed], method="DOP853", events=(turns, leaves),
        rtol=1e-12, atol=[1e-16, 1e-12], max_step=2e-5,
    )  # fmt: skip
    deepest = float(run.y_events[0][0][0])
    leaving = -float(run.y_events[1][0][1])
    return Impact(deepest, elastic_force(deepest, record), float(run.t_events[1][0]), leaving / speed)


@case(
    "hertz-impact",
    "an impact on Hertz's contact",
    Kind.CLOSED_FORM,
    source="K. L. Johnson, Contact Mechanics (1985), section 11.4",
    looked_at=False,
    tolerance=1e-8,
    why="the integrator's tolerance is 1e-12; the end of contact, where the force is flat, is known less",
)
def hertz_impact() -> list[Row]:
    """The disk of 1.65 kg lands after a fall of 0.3 mm on k d^1.5 with k = 2.4e9 N/m^1.5: the contact
    law's kernel under an integrator of high order. Energy gives the depth, a beta function the duration."""
    found = impact(ContactLaw(stiffness=STIFFNESS))
    depth = (5.0 * MASS * SPEED**2 / (4.0 * STIFFNESS)) ** 0.4
    factor = 2.0 * math.sqrt(math.pi) * gamma(1.4) / gamma(0.9)
    return [
        Row("largest force", "N", STIFFNESS * depth**1.5, found.force),
        Row("deepest indentation", "um", 1e6 * depth, 1e6 * found.indentation),
        Row("time in contact", "ms", 1e3 * factor * depth / SPEED, 1e3 * found.duration),
    ]


@case(
    "restitution",
    "restitution of a damped impact",
    Kind.CLOSED_FORM,
    source="K. H. Hunt, F. R. E. Crossley, Journal of Applied Mechanics 42 (1975) 440",
    looked_at=False,
    tolerance=2e-3,
    why="the formula is the first term of a series in the loss, here 1e-3; the second adds as much",
)
def restitution() -> list[Row]:
    """The share of its speed that a body loses on k d^n (1 + e d'), d' the speed of the indentation d, is
    2/3 e v to first order in the loss, whatever the exponent n. Chosen is e v = 1e-3."""
    lost, rows = 1e-3, []
    for name, n in (("10/9", 10.0 / 9.0), ("3/2", 1.5)):
        found = impact(ContactLaw(stiffness=STIFFNESS, exponent=n, dissipation=lost / SPEED))
        rows.append(
            Row(f"loss of speed, n = {name}", "%", 200.0 / 3.0 * lost, 100.0 * (1.0 - found.restitution))
        )
    return rows


BORES = {name: catalogue.bearing(name) for name in ("6904", "6004")}
JOURNAL, CLEARANCE = 9.7e-3, 0.3e-3  # m


@case(
    "bore-strip",
    "a journal in a bore of a little more than its radius",
    Kind.CLOSED_FORM,
    source="K. L. Johnson, Contact Mechanics (1985), section 4.2 (Hertz's line contact)",
    looked_at=False,
    tolerance=1e-6,
    why="the same formula, for the law that kernels take",
)
def bore_strip() -> list[Row]:
    """Half the width of the strip in which a journal of 9.7 mm radius, 350 N on 9 mm of length, touches a
    bore with 0.3 mm of play: b^2 = 4 q R/(pi E*)."""
    relative = JOURNAL * (JOURNAL + CLEARANCE) / CLEARANCE
    modulus = 207e9 / (2.0 * (1.0 - 0.3**2))
    exact = math.sqrt(4.0 * 350.0 / 9e-3 * relative / (math.pi * modulus))
    law = BoreContact(length=BORES["6904"].width, depth=BORES["6904"].depth, load=350.0, law=FROM_GEOMETRY)
    found = approach(350.0, as_record(law), JOURNAL, CLEARANCE)
    return [Row("half width of the strip", "mm", 1e3 * exact, 1e3 * found.half_width)]
