"""The force of a journal's landing on its bearing, at which contacts are linearised."""

from __future__ import annotations

from typing import NamedTuple

from ...modelkit.variables import as_record
from ..contact.line import WIDEST, BoreContact, bore_approach, is_line
from ..contact.materials import elastic_of
from ..rolling.ball_set import RaceStiffness, set_stiffness
from .entry import Bearing

STRIBECK = 4.37  # largest ball load over the mean one, of balls without play
LIGHTEST = 1.0  # N
BACK = 0.95  # by which a load is lowered until it makes a line contact


class LandingLoads(NamedTuple):
    """Loads of a landing on the bearing."""

    load: float  # N
    indentation: float  # m, of the most loaded ball between both races
    is_most: bool  # more would be no line contact


def landing(bearing: Bearing, clearance: float, energy: float) -> LandingLoads:
    """Load at which bore and balls of `bearing` hold the `energy` (J) that a journal brings.

    clearance: radial, of journal and bore (m). Journal and bore of steel; the ring stays round and has no
    mass, the outer one is held. From 1 N up to what makes a line contact.
    """
    from scipy.optimize import brentq  # not in the time of every start

    law = as_record(BoreContact(length=bearing.width, depth=bearing.depth))
    stiffness = as_record(RaceStiffness())
    set_stiffness(stiffness, as_record(bearing.balls), elastic_of(as_record(bearing.ring)))
    share = STRIBECK / (bearing.balls.count * bearing.balls.rows)
    radius = 0.5 * bearing.bore - clearance

    def deepest(load: float) -> float:
        return (share * load / float(stiffness["series"])) ** (2.0 / 3.0)

    def missing(load: float) -> float:
        bore = bore_approach(load, law, radius, clearance)
        stored = 0.25 * load * (bore.indentation + load * bore.slope)  # of P (A - B ln P)
        return stored + 0.4 * load * deepest(load) - energy

    high = (WIDEST * radius / bore_approach(LIGHTEST, law, radius, clearance).half_width) ** 2 * LIGHTEST
    law["load"] = high
    while high > LIGHTEST and not is_line(law, radius, clearance):
        high *= BACK
        law["load"] = high
    if missing(LIGHTEST) >= 0.0 or high <= LIGHTEST:
        return LandingLoads(LIGHTEST, deepest(LIGHTEST), False)
    if missing(high) <= 0.0:
        return LandingLoads(high, deepest(high), True)
    load = float(brentq(missing, LIGHTEST, high))  # type: ignore[arg-type]
    return LandingLoads(load, deepest(load), False)
