"""Neighbours in a row of balls that push each other in one kick."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from touchdown.bearings.contact.laws import ContactLaw, elastic_and_damping
from touchdown.bearings.contact.pair import NO_KICK, ContactPlace, damped_normal
from touchdown.bearings.rolling.ball_contacts import (
    Chain,
    SideContacts,
    lay,
    link,
    part_ways,
    set_normal_forces,
)
from touchdown.modelkit.ports import Motion
from touchdown.modelkit.variables import as_record, layout

KICK, MASS, RADIUS = 2.5e-6, 4e-4, 2e-3  # s, kg, m
COUNT = 9
MEMORY = np.dtype(
    [("s", [("side", layout(SideContacts)), ("chain", layout(Chain)), ("kick", "f8"), ("drift", "f8")])]
)
LAWS = {
    "springs": ContactLaw(stiffness=1e8),
    "dashpots": ContactLaw(stiffness=1e8, viscous=250.0),
    "stiff dashpots": ContactLaw(stiffness=1e8, viscous=1e6),
}
ROWS = {
    "one pair": [4],
    "three": [2, 3, 4],
    "two rows": [1, 2, 6],
    "over the first ball": [7, 8, 0, 1],
    "all but one": [0, 1, 2, 3, 4, 5, 6, 7],
}


def unit(b: int) -> np.ndarray:
    """Direction from ball `b` to the next, around a circle."""
    angle = 2.0 * math.pi * (b + 0.5) / COUNT
    return np.array([-math.sin(angle), math.cos(angle)])


def closing(velocities: np.ndarray, b: int) -> float:
    """Rate (m/s) at which ball `b` and the next approach."""
    return float((velocities[b] - velocities[(b + 1) % COUNT]) @ unit(b))


def moving(velocity: np.ndarray) -> Motion:
    """A body's motion, of which only the velocity counts."""
    return Motion(0.0, 0.0, float(velocity[0]), float(velocity[1]), 0.0)


class Row:
    """Balls at random speeds, of which some touch; what the kick before did is known."""

    def __init__(self, touching: list[int], law: ContactLaw) -> None:
        rng = np.random.default_rng(3)
        self.memory = np.zeros(1, MEMORY)
        self.m: Any = self.memory[0]
        self.m["s"]["kick"] = KICK
        self.touching, self.law = touching, as_record(law)
        self.depth = rng.uniform(1e-6, 5e-6, COUNT)
        self.velocities = 0.1 * rng.normal(size=(COUNT, 2))
        self.others = 1e3 * rng.normal(size=(COUNT, 2))  # m/s2, by all but the neighbours
        side = self.m["s"]["side"]
        side["indentation"] = -1.0
        side["stored"] = math.inf
        for b in range(COUNT):
            side["nx"][b], side["ny"][b] = unit(b)
            side["normal"][b] = rng.uniform(0.0, 20.0)  # also of those that are now apart

    def close_up(self) -> None:
        """Have all that touch approach at about 0.1 m/s."""
        middle = np.array([[math.cos(a), math.sin(a)] for a in 2.0 * math.pi * np.arange(COUNT) / COUNT])
        self.velocities = -0.15 * middle + 0.02 * self.velocities

    def pushed(self, forces: np.ndarray) -> np.ndarray:
        """Accelerations (m/s2) by normal forces (COUNT,) (N)."""
        ahead = forces[:, None] * np.array([unit(b) for b in range(COUNT)]) / MASS
        return np.roll(ahead, 1, axis=0) - ahead

    def solve(self) -> np.ndarray:
        """Normal forces (COUNT,) (N) of this kick."""
        side = self.m["s"]["side"]
        before = self.others + self.pushed(np.array(side["normal"][:COUNT]))
        for b in range(COUNT):
            if b not in self.touching:
                part_ways(side, b)
                continue
            k = (b + 1) % COUNT
            place = ContactPlace(*unit(b), self.depth[b], -RADIUS, RADIUS, 0.0)
            bodies = moving(self.velocities[k]), moving(self.velocities[b])
            rates = moving(before[k]), moving(before[b])
            link(b, COUNT, *bodies, rates, place, self.law, (2.0 / MASS, 1.0 / MASS), self.m)
        set_normal_forces(side, self.m["s"]["chain"], COUNT)
        return np.array(side["normal"][:COUNT])

    def line(self, b: int, change: float) -> float:
        """Mean force (N) of a contact whose rate changes by so much (m/s) in the kick; none below zero."""
        elastic, damping = elastic_and_damping(self.depth[b], self.law)
        z = 2.0 * KICK / MASS * damping
        force = elastic + damping * (closing(self.velocities, b) + (3.0 + z) / (6.0 + z) * change)
        return max(force, 0.0)


@pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)
@pytest.mark.parametrize("touching", ROWS.values(), ids=ROWS)
def test_all_forces_of_a_row_meet_their_laws_at_once(touching: list[int], law: ContactLaw) -> None:
    """What each changes of the rates is in the line of all; none is left from the kick before."""
    row = Row(touching, law)
    row.close_up()
    forces = row.solve()
    changes = KICK * (row.others + row.pushed(forces))
    assert sorted(touching) == list(np.flatnonzero(forces))
    for b in touching:
        assert forces[b] == pytest.approx(row.line(b, closing(changes, b)), rel=1e-9)


def test_a_pair_alone_is_the_contact_of_two() -> None:
    row = Row([4], LAWS["dashpots"])
    elastic, damping = elastic_and_damping(row.depth[4], row.law)
    found, others = row.solve()[4], KICK * closing(row.others, 4)
    # Contacts 3 and 5 pushed in the kick before and are gone: what they did is no more.
    rate = closing(row.velocities, 4)
    assert found == pytest.approx(
        damped_normal(elastic, damping, rate, 2.0 * KICK / MASS, others), rel=1e-12
    )


def test_nothing_pulls() -> None:
    """Balls that part fast: dashpots would pull, and do not."""
    row = Row(ROWS["all but one"], LAWS["stiff dashpots"])
    row.velocities[:] = [0.1 * b * unit(b) for b in range(COUNT)]
    assert np.all(row.solve() >= 0.0)


def test_a_full_circle_is_solved_kick_by_kick() -> None:
    """It is cut where the forces of the kick before count, and settles on what all laws ask for."""
    row = Row(list(range(COUNT)), LAWS["dashpots"])
    row.velocities *= 0.01
    for _ in range(40):
        forces = row.solve()
    changes = KICK * (row.others + row.pushed(forces))
    assert np.all(forces > 0.0)
    assert forces == pytest.approx([row.line(b, closing(changes, b)) for b in range(COUNT)], rel=1e-9)


def test_damping_is_no_stiffness() -> None:
    """A dashpot pushes at once where bodies meet, over no indentation: no step could resolve that."""
    law = as_record(ContactLaw(exponent=1.5, stiffness=1e8, viscous=250.0))
    contacts = as_record(SideContacts())
    lay(contacts, 3, ContactPlace(1.0, 0.0, 1e-9, 1e-3, 1e-3, 0.0), 0.0, 0.1, NO_KICK, law)
    assert contacts["stiffness"][3] == pytest.approx(1.5 * 1e8 * 1e-9**1.5 / 1e-9, rel=1e-6)
