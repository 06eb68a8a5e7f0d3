"""What a journal presses its bearing with when it lands: the load at which contacts are made stiff."""

from __future__ import annotations

from scipy.optimize import brentq

from ...modelkit.variables import as_record
from ..contact.line import BoreContact, approach
from ..rolling.ball_set import RaceStiffness, set_stiffness
from .entry import Bearing

STRIBECK = 4.37  # largest ball load over the mean one, of balls without play
BRACKET = (1.0, 1e6)  # N


def landing_load(bearing: Bearing, clearance: float, energy: float) -> float:
    """Load (N) at which bore and balls of `bearing` hold the `energy` (J) that a journal brings.

    clearance: radial, of journal and bore (m). Steel on steel; the ring stays round and has no mass, the
    outer one is held. Within 1 N and 1 MN.
    """
    law = as_record(BoreContact(length=bearing.width, depth=bearing.depth))
    stiffness = as_record(RaceStiffness())
    set_stiffness(stiffness, as_record(bearing.balls))
    share = STRIBECK / (bearing.balls.count * bearing.balls.rows)
    radius = 0.5 * bearing.bore - clearance

    def missing(load: float) -> float:
        bore = approach(load, law, radius, clearance)
        exponent = bore.indentation / (load * bore.slope)
        balls = (share * load / float(stiffness["series"])) ** (2.0 / 3.0)
        return load * (bore.indentation / (exponent + 1.0) + 0.4 * balls) - energy

    low, high = BRACKET
    if missing(low) >= 0.0:
        return low
    return float(brentq(missing, low, high)) if missing(high) > 0.0 else high  # type: ignore[arg-type]
