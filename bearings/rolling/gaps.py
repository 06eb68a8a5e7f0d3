"""Play and clearance that follow the temperatures of the parts and the spin of ring and journal.

With `thermal = 1` the heat that the parts took in a macro step goes into the network of `bearings.heat`
when the next one begins; with `ring.growth = 1` inner ring and journal grow by the square of their spin
then. With the temperatures T above the start and the growth u,

    play = balls.play + play_change(T) - u(race)
    clearance = p.clearance + clearance_change(T) + u(bore) - u(journal)

Both stay over a macro step and then change by nanometres. What is pressed there is pressed harder: that
work comes out of the heat, whether heat or spin makes the parts grow.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ...modelkit.kernel import kernel
from ...modelkit.status import OK, TOO_HOT
from ...modelkit.variables import array, real
from ..contact.laws import elastic_energy
from ..contact.materials import (
    SILICON_NITRIDE,
    SILICON_NITRIDE_DENSITY,
    STEEL_DENSITY,
    STEEL_NUMBERS,
    elastic_of,
)
from ..heat import network, shares, warm_parts
from ..heat.flash import TEMPERED
from ..heat.growth import spin_growth
from ..heat.shares import Sources
from ..heat.warm_parts import NODES, Bodies
from ..seat import JW
from . import ring
from .ball_set import ball_mass, inner_radius

EFFECTS = "thermal", "ring.growth"  # parameters by which gaps change
HEATED = warm_parts.HOUSING  # parts before the housing, which take heat themselves


@dataclass(frozen=True)
class GapMemory:
    """Gaps over the macro step at hand, and the temperatures that they are of."""

    play: float = real(0.0, "m", "radial play of the balls")
    clearance: float = real(0.0, "m", "radial clearance of the journal")
    ball_growth: float = real(0.0, "m", "of a ball's diameter, which the play has")
    strain_along: float = real(0.0, "1", "of the inner ring along the shaft, less that of the outer one")
    span: float = real(0.0, "s", "length of the macro step before; 0: none yet")
    matrix_step: float = real(0.0, "s", "length of a step that the matrices are of; 0: none yet")
    warmth: tuple = array(NODES)  # K above the start
    inflow: tuple = array(NODES)  # W, from shaft and surroundings as they are at the start
    heat: tuple = array(HEATED)  # J, that the parts had taken when the step before began
    kept: tuple = array(NODES, NODES)
    gained: tuple = array(NODES, NODES)


@dataclass(frozen=True)
class GapReport:
    """Radial gaps in the macro step that ends."""

    play: float = real(0.0, "m", "radial play of the balls now; negative: preload", local=True)
    clearance: float = real(0.0, "m", "radial clearance of the journal now", local=True)


@dataclass(frozen=True)
class Temperatures:
    """Temperatures above the start, with thermal = 1; 0 without."""

    journal: float = real(0.0, "K", "of the journal above the start", local=True)
    inner: float = real(0.0, "K", "of the inner ring above the start", local=True)
    balls: float = real(0.0, "K", "of the balls above the start", local=True)
    outer: float = real(0.0, "K", "of the outer ring above the start", local=True)
    housing: float = real(0.0, "K", "of the housing above the start", local=True)
    contact: float = real(
        0.0, "K", "largest between journal and bore since the start, above the start", local=True
    )
    contact_time: float = real(-1.0, "s", "time of that; -1: not yet", local=True)


class Closed(NamedTuple):
    """By how much gaps have closed from one macro step to the next (m)."""

    play: float
    clearance: float


@kernel
def start_gaps(m):
    """Set the gaps to those of the parameters, at the temperature of the start."""
    g = m.s.gaps
    g.play, g.clearance, g.span, g.matrix_step = m.p.balls.play, m.p.clearance, 0.0, 0.0
    g.ball_growth = g.strain_along = 0.0
    warm_parts.set_surroundings(_bodies(m.p, m.u.housing.inv_m), g.warmth, g.inflow)
    for i in range(HEATED):
        g.heat[i] = 0.0


@kernel
def due(m, since):
    """Whether gaps change now, `since` (s) after a macro step has begun: at its beginning, if at all."""
    return since == 0.0 and (m.p.thermal == 1 or m.p.ring.growth == 1)


@kernel
def change_gaps(m):
    """Have the gaps be those of the temperatures and spins now, as a macro step begins; `Closed` (m)."""
    p, g = m.p, m.s.gaps
    play, clearance = p.balls.play, p.clearance
    if p.thermal == 1:
        b = _bodies(p, m.u.housing.inv_m)
        _warm(b, m)
        play += warm_parts.play_change(b, g.warmth)
        clearance += warm_parts.clearance_change(b, g.warmth)
        g.ball_growth = warm_parts.ball_growth(b, g.warmth)
        g.strain_along = warm_parts.strain_along(b, g.warmth)
    if p.ring.growth == 1:
        bore, race = p.journal_radius + p.clearance, inner_radius(p.balls)
        density = SILICON_NITRIDE_DENSITY if p.ring.material == SILICON_NITRIDE else STEEL_DENSITY
        grown = spin_growth(bore, race, m.q[ring.RW], density, elastic_of(p.ring))
        journal = spin_growth(0.0, p.journal_radius, m.q[JW], STEEL_DENSITY, STEEL_NUMBERS)
        play -= grown.rim
        clearance += grown.bore - journal.rim
    closed = Closed(g.play - play, g.clearance - clearance)
    g.play, g.clearance = play, clearance
    return closed


@kernel
def _bodies(p, inv_housing_mass):
    """`Bodies` of a bearing's parameters p; inv_housing_mass: 1/kg."""
    b, around = p.balls, p.heat
    width = p.ring.width if p.ring.width > 0.0 else p.contact.length
    return Bodies(
        p.journal_radius,
        p.clearance,
        width,
        b.pitch_diameter,
        b.diameter,
        1.0 * b.count * b.rows,
        b.count * ball_mass(b),
        b.material,
        p.ring.mass,
        p.ring.material,
        inv_housing_mass,
        around.shaft_conductance,
        around.housing_conductance,
        around.ambient_conductance,
        around.shaft_temperature,
        around.housing_temperature,
    )


@kernel
def _warm(b, m):
    """Advance the temperatures of the `Bodies` b by the macro step before, with the heat taken in it."""
    g, span = m.s.gaps, m.s.gaps.span
    if span > 0.0:
        if g.matrix_step != span:
            inverse, conductances = np.empty(NODES), np.empty((NODES, NODES))
            warm_parts.set_inverse_capacities(b, inverse)
            warm_parts.set_conductances(b, conductances)
            network.set_step(inverse, conductances, span, g.kept, g.gained)
            g.matrix_step = span
        heats = np.empty(NODES)
        for i in range(NODES):
            heats[i] = span * g.inflow[i]
        for i in range(HEATED):
            heats[i] += m.q[ring.HEAT + i] - g.heat[i]
            g.heat[i] = m.q[ring.HEAT + i]
        network.take_step(g.kept, g.gained, heats, g.warmth)
    g.span = 2.0 * m.half


@kernel
def pressed_in(way, indentation, stored, law):
    """Work (J) by its law, a record, on a contact that is pressed in farther by a `way` (m).

    Force times way would never press what just touches. It gives back no more than it has `stored` (J).
    """
    work = elastic_energy(indentation + way, law) - elastic_energy(indentation, law)
    return max(work, -max(stored, 0.0))


@kernel
def book_closing(closed, inner, outer, m):
    """Book the work that gaps did as they closed (m) in m.q as less heat, and in the journal's account.

    inner, outer: of that at both races (J), which the balls' accounts already have.
    """
    bore = closed.clearance * m.s.ring.elastic
    m.s.ring.stored += bore
    m.q[ring.LOSS] -= bore + inner + outer
    shares.add_heat(Sources(-bore, 0.0, -inner, -outer, 0.0), m.q, ring.HEAT)


@kernel
def status_when_warm(status, m):
    """`status` of a macro step, or `TOO_HOT` where a part of steel is warmer than that bears."""
    warmth = m.s.gaps.warmth
    hottest = warmth[warm_parts.JOURNAL]
    if m.p.ring.material != SILICON_NITRIDE:
        hottest = max(hottest, warmth[warm_parts.INNER], warmth[warm_parts.OUTER])
    if m.p.balls.material != SILICON_NITRIDE:
        hottest = max(hottest, warmth[warm_parts.BALLS])
    return TOO_HOT if status == OK and m.p.thermal == 1 and hottest > TEMPERED else status


@kernel
def report(m):
    """Outputs of gaps and temperatures."""
    g, o, t = m.s.gaps, m.o.gaps, m.o.temperature
    o.play, o.clearance = g.play, g.clearance
    t.journal, t.inner, t.balls = (
        g.warmth[warm_parts.JOURNAL],
        g.warmth[warm_parts.INNER],
        g.warmth[warm_parts.BALLS],
    )
    t.outer, t.housing = g.warmth[warm_parts.OUTER], g.warmth[warm_parts.HOUSING]
