"""Contacts that march one way round the bore, by a turn or nearly so."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from touchdown.master.results.whirl.contacts import TURN, March, Orbit
from touchdown.master.results.whirl.stretches import Stretch, period, stretches, without_rests
from touchdown.master.results.whirl.swings import is_swing

GRAVITY = 9.81  # m/s2, for the scale of a pendulum's period
BACK = TURN / 4.0  # friction and rattle turn a whirl back by less, a swing by more
NEARLY = 0.75 * TURN  # a free swing's one side, half a turn at most, and half as much again
CREEP = 0.25  # of the pendulum's frequency


class Direction(StrEnum):
    """Of a whirl: as the rotor spins, or against it."""

    FORWARD = "forward"
    BACKWARD = "backward"


@dataclass(frozen=True)
class Turning:
    """Contacts that march one way by NEARLY or more and are no swing; without rest, or they creep."""

    march: March
    stretch: Stretch  # indices into the march
    time: np.ndarray  # s, of the march's rows
    creeps: bool  # so slowly that gravity would have swung it back, were it not carried

    @property
    def whirls(self) -> bool:
        """Whether it is a whirl."""
        return self.turns >= 1.0 and not self.creeps

    @property
    def turns(self) -> float:
        """How many, without a sign."""
        return abs(self.stretch.turn) / TURN

    def direction(self, spin: float) -> Direction:
        """As the rotor spins (rad/s; 0 as above 0), or against it."""
        along = self.stretch.turn * (-1.0 if spin < 0.0 else 1.0) > 0.0
        return Direction.FORWARD if along else Direction.BACKWARD


def most_turns(march: March) -> float:
    """The most that a row of contacts goes one way (turns), swings and rests included; no sign."""
    ways = stretches(march.angle, BACK)
    return max((abs(way.turn) for way in ways), default=float(np.ptp(march.angle))) / TURN


def turnings(orbit: Orbit, march: March) -> Iterator[Turning]:
    """All of a row of contacts, in their order."""
    time = orbit.time[march.rows]
    pendulum = TURN * math.sqrt(orbit.clearance / GRAVITY)
    ways = stretches(march.angle, BACK)
    for i, whole in enumerate(ways):
        if abs(whole.turn) < NEARLY or is_swing(time, march.angle, ways, i):
            continue
        parts = [p for p in without_rests(time, march.angle, whole, pendulum) if abs(p.turn) >= NEARLY]
        for part in parts:
            yield Turning(march, part, time, CREEP * period(time, part) > pendulum)
        if not parts:
            yield Turning(march, whole, time, creeps=True)
