"""How hard the rows of a pair are clamped against each other, at rest and where the inner ring spins.

The ring stands in the middle, cold. Its race grows by spin and closes under the balls' loads outwards, and
a ball is thrown outwards, each where the pair's model has it (`ring.growth`, `ring.hoop`,
`balls.centrifugal`; balls that are bodies are always thrown).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, fields, is_dataclass, replace
from functools import lru_cache
from typing import Any, NamedTuple

from ...modelkit.kernel import interpret
from ...modelkit.variables import as_record, group, real
from ..contact.materials import SILICON_NITRIDE, SILICON_NITRIDE_DENSITY, STEEL_DENSITY, elastic_of
from ..heat.growth import spin_growth
from ..rolling.ball_set import ball_mass, inner_radius
from .angular_row import CLAMPED, BallRow, ball_rows
from .arrangement import RowsParameters
from .hoop import HoopRing, OuterRing, hoop_of
from .inner_ring import AngularBallSet
from .thrown_ball import OrbitingBalls, ThrownBall, alone_on_outer, rolled_orbit, thrown_ball

HALVINGS = 40  # of the search for how far the race closes
ORBITS = 3  # times that the orbit is found again from the contact angles that it makes


@dataclass(frozen=True)
class _Contact:
    length: float = real(0.0, "m", "of the bore")


@dataclass(frozen=True)
class _Pair(RowsParameters):
    """What of a pair's parameters its clamping depends on."""

    journal_radius: float = real(0.0, "m", "of the journal")
    clearance: float = real(0.0, "m", "of the journal")
    contact: _Contact = group(_Contact)
    balls: AngularBallSet = group(AngularBallSet)
    ring: HoopRing = group(HoopRing)
    outer_ring: OuterRing = group(OuterRing)


class Clamping(NamedTuple):
    """Of a pair whose inner ring stands in the middle."""

    preload: float  # N, of the rows against each other along the shaft
    interference: float  # m, of both rows along the shaft, before they press anything; below 0: play
    ball: float  # N, largest force of a race on a ball


def _filled(declared: Any, value: Callable[[str, Any], Any], prefix: str = "") -> Any:
    """A declaration with values by dotted names; value(name, what to take where there is none)."""
    found = {}
    for one in fields(declared):
        name, now = f"{prefix}{one.name}", getattr(declared, one.name)
        nested = is_dataclass(now)
        found[one.name] = _filled(now, value, f"{name}.") if nested else type(now)(value(name, now))
    return replace(declared, **found)


def clamping(value: Callable[[str, Any], Any], thrown: bool, spins: tuple[float, ...]) -> list[Clamping]:
    """At each of `spins` (rad/s) of the inner ring; none where rows do not clamp each other.

    value(name, default): of a parameter. thrown: whether balls feel their orbit.
    """
    return list(_clamped(_filled(_Pair(), value), thrown, spins))


@lru_cache(maxsize=16)  # a run asks for its figures and for its warnings, drops of a sweep likewise
def _clamped(pair: _Pair, thrown: bool, spins: tuple[float, ...]) -> tuple[Clamping, ...]:
    p = as_record(pair)
    if p.arrangement not in CLAMPED or p.balls.contact_angle == 0.0:
        return ()
    rings, giving = interpret(elastic_of, p.ring), interpret(hoop_of, p)
    how = p.balls.contact_angle, p.arrangement, p.row_distance, (p.preload, p.interference, giving.race)
    row, _ = interpret(ball_rows, p.balls, rings, *how)
    return tuple(_at(p, row, giving.race, spin, thrown) for spin in spins)


def _at(p: Any, row: BallRow, compliance: float, spin: float, thrown: bool) -> Clamping:
    """At one spin; compliance: of the race (m/N)."""
    bore, race = p.journal_radius + p.clearance, interpret(inner_radius, p.balls)
    density = SILICON_NITRIDE_DENSITY if p.ring.material == SILICON_NITRIDE else STEEL_DENSITY
    growing = interpret(spin_growth, bore, race, spin, density, interpret(elastic_of, p.ring)).rim
    out = row.inner - row.outer + (growing if p.ring.growth == 1 else 0.0)
    along = abs(row.inner_at - row.outer_at)
    reach = math.sqrt(max(row.free * row.free - out * out, 0.0))  # along, at which a ball just touches
    ratio, mass = p.balls.diameter / p.balls.pitch_diameter, interpret(ball_mass, p.balls) / p.balls.rows
    orbit = 0.5 * (1.0 - ratio * math.cos(p.balls.contact_angle))
    ball = _ball(row, (out, along), 0.0)
    for _ in range(ORBITS if thrown and spin != 0.0 else 1):
        force = 0.5 * mass * p.balls.pitch_diameter * (orbit * spin) ** 2 if thrown else 0.0
        ball = _ball(row, (out, along), force)
        low, high = 0.0, 2.0 * compliance * p.balls.count * ball.inner * ball.cosine
        for _ in range(HALVINGS if high > 0.0 else 0):
            middle = 0.5 * (low + high)
            ball = _ball(row, (out - middle, along), force)
            pressed = 2.0 * p.balls.count * ball.inner * ball.cosine  # N, across the shaft
            low, high = (middle, high) if compliance * pressed > middle else (low, middle)
        ball = _ball(row, (out - low, along), force)
        orbit = interpret(rolled_orbit, ball, ratio) if ball.inner > 0.0 else orbit
    preload = p.balls.count * ball.inner * ball.sine
    return Clamping(preload, 2.0 * (along - reach), max(ball.inner, ball.outer))


def _ball(row: BallRow, way: tuple[float, float], thrown: float) -> ThrownBall:
    """`ThrownBall` with the inner groove's centre at `way` (m), outwards and along; thrown: N."""
    if thrown == 0.0:  # which Newton's search takes to be above 0
        length = math.hypot(*way)
        force, across, along = (
            row.stiffness * max(length - row.free, 0.0) ** 1.5,
            *(w / length for w in way),
        )
        return ThrownBall(force, force, 0.0, 0.0, 0.0, across, along, across, along)
    balls = as_record(OrbitingBalls())
    balls["u"][0], balls["v"][0], balls["missed"][0] = *way, 1.0
    return interpret(thrown_ball, row, thrown, interpret(alone_on_outer, row, thrown), 0.0, 0, balls)
