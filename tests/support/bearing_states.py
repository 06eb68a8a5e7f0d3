"""Bearings in a state of contact, for tests of what happens at one instant."""

from __future__ import annotations

import math
from importlib import import_module

import numpy as np

from touchdown.bearings import seat
from touchdown.bearings.rolling import ring
from touchdown.bearings.rolling.ball_bodies import SPIN, VX, VY
from touchdown.bearings.rolling.ring import BALLS
from touchdown.modelkit.instance import Instance


def instance_of(bearing: str) -> Instance:
    """An instance of the bearing's model, by its name."""
    return Instance(import_module(f"touchdown.bearings.{bearing}").MODEL)


def pressed(name: str, seed: int, **parameters: float) -> Instance:
    """A bearing 0.4 ms after first touch, journal and housing free, its speeds then shaken at random."""
    instance = instance_of(name)
    m = instance.memory
    m["p"]["gravity"] = 0.0
    m["p"]["micro_step"] = 0.0
    for key, value in parameters.items():
        head, _, tail = key.partition("__")
        if tail:
            m["p"][head][tail] = value
        else:
            m["p"][head] = value
    journal, housing = m["u"]["journal"], m["u"]["housing"]
    journal["x"], journal["y"], journal["vx"], journal["vy"] = 0.5e-4, -2.958e-4, 0.01, -0.07
    journal["inv_m"], journal["omega"], journal["inv_I"] = 1.0 / 1.65, 942.0, 2000.0
    housing["inv_m"], housing["k_over_m"], housing["c_over_m"] = 1.0 / 5.02, 4.98e7, 498.0
    instance.start(0.0)
    instance.step(0.0, 4e-4)
    q = m["q"][0]
    for part, first in (("journal", seat.JX), ("housing", seat.HX)):
        for i, key in enumerate(("x", "y", "vx", "vy")):
            m["u"][part][key] = q[first + i]
    rng = np.random.default_rng(seed)
    count = int(m["p"]["balls"]["count"][0])
    for component, scale in ((VX, 0.05), (VY, 0.05), (SPIN, 50.0)):
        q[part_of(component, count)] += scale * rng.normal(size=count)
    if name == "detailed_caged":  # past the middle of its clearance, so that some pockets press
        first = BALLS + 6 * count
        q[first : first + 2] += 4e-6 * rng.normal(size=2)
        q[first + SPIN] += 20.0
    return instance


def part_of(component: int, count: int) -> slice:
    """Where a component of all balls lies in the state."""
    return slice(BALLS + component * count, BALLS + (component + 1) * count)


def state_in_contact(bearing: str, seed: int) -> Instance:
    """A bearing with journal, ring and balls in a random state of contact."""
    generator = np.random.default_rng(seed)
    instance = instance_of(bearing)
    if bearing not in ("bushing", "landing_sleeve"):
        instance.record["p"]["gravity"] = 0.0
    j = instance.record["u"]["journal"]
    angle = generator.uniform(0.0, 2.0 * math.pi)
    j["x"], j["y"] = 0.32e-3 * math.cos(angle), 0.32e-3 * math.sin(angle)
    j["vx"], j["vy"], j["omega"] = generator.uniform(-0.1, 0.1), generator.uniform(-0.1, 0.1), 900.0
    instance.start(0.0)
    q = instance.record["q"]
    if bearing not in ("bushing", "landing_sleeve"):
        q[[ring.RX, ring.RY]] += 8e-6 * np.array([math.cos(angle + 0.4), math.sin(angle + 0.4)])
        q[[ring.RVX, ring.RVY]] = generator.uniform(-0.05, 0.05, 2)
        q[ring.RW] = generator.uniform(0.0, 900.0)
    if bearing == "simplified_cageless":
        for b in range(17):
            q[ring.NEXT + 17 + b] = generator.uniform(0.0, 300.0)
            q[ring.NEXT + 34 + b] = generator.uniform(-2000.0, 0.0)
    return instance
