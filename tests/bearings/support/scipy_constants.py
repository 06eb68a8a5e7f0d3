"""Constants of the bearings as Python and scipy find them: the reference of what their kernels derive.

Each function takes a model's parameters, as declared, and gives what m.d is to hold by dotted names.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import asdict, replace
from typing import Any

import numpy as np
from scipy.optimize import brentq, minimize_scalar
from scipy.special import ellipe, ellipkm1

from touchdown.bearings import seat
from touchdown.bearings.contact.friction import MAKKAR, FrictionLaw
from touchdown.bearings.contact.laws import ContactLaw
from touchdown.bearings.rolling.ball_set import BallSet
from touchdown.bearings.rolling.micro_step import HIT_RESOLUTION, MICRO_STEP, RESOLUTION

Values = dict[str, Any]


def ellipse(ratio: float) -> tuple[float, float, float]:
    """(kappa, K, E) of Hertz's contact for curvatures of `ratio` above 1."""

    def integrals(kappa: float) -> tuple[float, float]:
        return float(ellipkm1(kappa**-2.0)), float(ellipe(1.0 - kappa**-2.0))

    def mismatch(kappa: float) -> float:
        first, second = integrals(kappa)
        return (kappa**2 * second - first) / (first - second) - ratio

    kappa: Any = brentq(mismatch, 1.0 + 0.5 * (ratio - 1.0) / ratio, ratio, xtol=1e-14)
    return (kappa, *integrals(kappa))


def race_stiffness(b: BallSet, race_radius: float, conformity: float) -> float:
    """Of a ball on a race (N/m^1.5)."""
    across = 2.0 / b.diameter + 1.0 / race_radius
    along = 2.0 / b.diameter * (1.0 - 1.0 / conformity)
    ratio = across / along
    if b.hertz:
        kappa, first, second = (
            1.0339 * ratio**0.636,
            1.5277 + 0.6023 * math.log(ratio),
            1.0003 + 0.5968 / ratio,
        )
    else:
        kappa, first, second = ellipse(ratio)
    root = math.sqrt(2.0 / (across + along) * second / first**3)
    return math.pi / 3.0 * root * kappa * 207e9 / (1.0 - 0.3**2)


def stiffness(b: BallSet) -> tuple[float, float, float]:
    """Inner race, outer race, both in series (N/m^1.5)."""
    inner = race_stiffness(b, 0.5 * (b.pitch_diameter - b.diameter), b.conformity)
    outer = race_stiffness(b, -0.5 * (b.pitch_diameter + b.diameter), b.outer_conformity or b.conformity)
    return inner, outer, (inner ** (-2.0 / 3.0) + outer ** (-2.0 / 3.0)) ** -1.5


def makkar_peak(law: FrictionLaw, g1: float) -> float:
    """Largest coefficient of Makkar's curve up to a speed of 3/g3."""

    def negative(v: Any) -> Any:
        rise = g1 * (np.tanh(law.g2 * v) - np.tanh(law.g3 * v))
        return -(rise + law.dynamic * np.tanh(law.slope * v) + law.g6 * v)

    last = 3.0 / law.g3
    samples = np.geomspace(1e-3 / max(law.g2, law.slope), last, 2000)
    best = int(np.argmin(negative(samples)))
    bounds = samples[max(best - 1, 0)], samples[min(best + 1, len(samples) - 1)]
    found = minimize_scalar(negative, bounds=bounds, method="bounded", options={"xatol": 1e-12 * last})
    return max(-found.fun, -negative(last))


def prepared(law: FrictionLaw) -> FrictionLaw:
    """With g1 where it is left to follow from the static coefficient."""
    if law.kind != MAKKAR or law.g1 > 0.0:
        return law
    if law.static <= makkar_peak(law, 0.0):
        return replace(law, g1=0.0)
    g1: Any = brentq(lambda g: makkar_peak(law, g) - law.static, 0.0, 100.0 * law.static, xtol=1e-15)
    return replace(law, g1=g1)


def damped(law: ContactLaw, lighter: float) -> ContactLaw:
    """With the damping its ratio asks for (2.47)."""
    if law.damping_ratio == 0.0:
        return law
    depth = law.expected_indentation
    slope = law.exponent * law.stiffness * depth ** (law.exponent - 1.0)
    added = 2.0 * math.sqrt(slope * (law.mass or lighter)) * law.damping_ratio / depth
    return replace(law, damping=law.damping + added, damping_ratio=0.0)


def abreast(law: ContactLaw, rows: int) -> ContactLaw:
    """Of contacts side by side."""
    shared = ("stiffness", "damping", "viscous", "mass")
    return replace(law, **{name: rows * getattr(law, name) for name in shared})


def ball_mass(b: BallSet) -> float:
    """Of the balls side by side (kg)."""
    return b.rows * (b.density or 7830.0) * math.pi / 6.0 * b.diameter**3


def race_law(b: BallSet, of_ball: float) -> ContactLaw:
    """Of the balls side by side on races, each of stiffness `of_ball` (N/m^1.5)."""
    expected = {"damping_ratio": b.damping_ratio, "expected_indentation": b.expected_indentation}
    law = ContactLaw(stiffness=of_ball, damping=b.damping, **expected)
    return damped(abreast(law, b.rows), ball_mass(b))


def touch_angle(b: BallSet) -> float:
    """Between neighbours that just touch (rad)."""
    return 2.0 * math.asin(min(1.0, b.diameter / b.pitch_diameter))


def angles(b: BallSet) -> np.ndarray:
    """Attitude angles at the start (rad)."""
    touching = min(1.0, b.count * touch_angle(b) / (2.0 * math.pi))
    spread = 1.0 + getattr(b, "bunching", 0.0) * (touching - 1.0)
    i = np.arange(b.count)
    gap = np.where(i > b.count // 2, (1.0 - spread) * 2.0 * math.pi, 0.0)
    return b.first_angle + spread * 2.0 * math.pi / b.count * i + gap


def imbalance(b: BallSet, weight: float) -> Callable[[Any], np.ndarray]:
    """Forces on a ring of `weight` (N), over the weight (2,), as a function of its place (m)."""
    normals = np.column_stack((np.cos(angles(b)), np.sin(angles(b))))
    of_ball = b.rows * stiffness(b)[2]

    def at(place: Any) -> np.ndarray:
        force = of_ball * np.maximum(normals @ np.asarray(place) - b.play, 0.0) ** 1.5
        return (force @ normals + [0.0, weight]) / weight

    return at


def step_limits(longest: float, contacts: list[tuple[ContactLaw, float]]) -> Values:
    """Longest step (s) and resolution (rad); contacts: (law, mass in kg of the lighter body)."""
    finer, speed = min(longest / MICRO_STEP, 1.0), seat.VELOCITY_SCALE
    steps = [longest]
    for law, mass in contacts:
        energy = 0.5 * (law.exponent + 1.0) * mass * speed**2 / law.stiffness
        steps.append(finer * HIT_RESOLUTION * 3.0 * energy ** (1.0 / (law.exponent + 1.0)) / speed)
    return {"micro_step": min(steps), "resolution": finer * RESOLUTION}


def _laws(**laws: ContactLaw | FrictionLaw) -> Values:
    return {f"{name}.{key}": value for name, law in laws.items() for key, value in asdict(law).items()}


def _shared(p: Any) -> Values:
    b, names = p.balls, ("stiffness.inner", "stiffness.outer", "stiffness.series")
    return {
        **_laws(contact=damped(p.contact, p.ring.mass), friction=prepared(p.friction)),
        **_laws(race_friction=prepared(p.race_friction)),
        **dict(zip(names, stiffness(b), strict=True)),
        "mass": ball_mass(b),
        "ball_radius": 0.5 * b.diameter,
        "inner_radius": 0.5 * (b.pitch_diameter - b.diameter),
    }


def bushing(p: Any) -> Values:
    """Of the plain bushing."""
    return _laws(contact=damped(p.contact, p.contact.mass), friction=prepared(p.friction))


def simplified_caged(p: Any) -> Values:
    """Of the simplified caged bearing."""
    b, r = p.balls, 0.5 * p.balls.pitch_diameter
    inner = r - 0.5 * b.diameter
    cage, ball = 0.5 * inner / r, -inner / b.diameter
    orbiting = (p.cage.mass + b.count * ball_mass(b)) * r**2
    spinning = b.count * 0.4 * ball_mass(b) * (0.5 * b.diameter) ** 2
    carried = 0.0 if p.slip else orbiting * cage**2 + spinning * ball**2
    return _shared(p) | _laws(race=race_law(b, stiffness(b)[2])) | {
        "ring_inertia": p.ring.inertia + carried,
        "orbiting": orbiting,
        "spinning": spinning,
        "cage_ratio": cage,
        "ball_ratio": ball,
        "size.coordinates": 5 + 2 * p.slip,
        "cosine": np.cos(angles(b)),
        "sine": np.sin(angles(b)),
    }  # fmt: skip


def simplified_cageless(p: Any) -> Values:
    """Of the simplified cageless bearing."""
    b, mass = p.balls, ball_mass(p.balls)
    race, side = race_law(b, stiffness(b)[2]), damped(abreast(p.ball_contact, b.rows), mass)
    hit = [(p.contact, p.ring.mass), (race, p.ring.mass), (side, 0.5 * mass)]
    inner, outer = (k ** (-2.0 / 3.0) for k in stiffness(b)[:2])
    run = [(0.0, 0.0), (0.5 * b.play, outer / (inner + outer)), (0.0, -0.5)][p.corrected_pitch]
    return _shared(p) | step_limits(p.micro_step, hit) | {
        **_laws(race=race, ball_contact=side, ball_friction=prepared(p.ball_friction)),
        "run_radius": 0.5 * b.pitch_diameter + run[0],
        "run_share": run[1],
        "touch_angle": touch_angle(b),
        "angles": angles(b),
    }  # fmt: skip


def _bodies(p: Any, side: ContactLaw, lighter: float) -> Values:
    b, mass = p.balls, ball_mass(p.balls)
    inner, outer = (race_law(b, k) for k in stiffness(b)[:2])
    hit = [(p.contact, p.ring.mass), (inner, mass), (outer, mass), (side, lighter)]
    return _shared(p) | _laws(inner=inner, outer=outer) | step_limits(p.micro_step, hit) | {
        "inertia": 0.4 * mass * (0.5 * b.diameter) ** 2,
        "inner_radius": 0.5 * (b.pitch_diameter - b.diameter - b.play),
        "outer_radius": 0.5 * (b.pitch_diameter + b.diameter + b.play),
    }  # fmt: skip


def detailed_cageless(p: Any) -> Values:
    """Of the detailed cageless bearing."""
    mass, side = ball_mass(p.balls), abreast(p.ball_contact, p.balls.rows)
    laws = _laws(ball_contact=damped(side, mass), ball_friction=prepared(p.ball_friction))
    return _bodies(p, side, 0.5 * mass) | laws


def detailed_caged(p: Any) -> Values:
    """Of the detailed caged bearing."""
    b, r, side = p.balls, 0.5 * p.balls.pitch_diameter, abreast(p.cage_contact, p.balls.rows)
    lighter = min(ball_mass(b), p.cage.mass)
    inertia = p.cage.inertia or p.cage.mass * r**2
    return _bodies(p, side, lighter) | {
        **_laws(cage_contact=damped(side, lighter), cage_friction=prepared(p.cage_friction)),
        "cage_inertia": inertia,
        "cage_answer": 1.0 / p.cage.mass + r**2 / inertia,
        "pocket_x": r * np.cos(angles(b)),
        "pocket_y": r * np.sin(angles(b)),
    }  # fmt: skip


REFERENCES = {
    f.__name__: f
    for f in (bushing, simplified_caged, simplified_cageless, detailed_caged, detailed_cageless)
}
