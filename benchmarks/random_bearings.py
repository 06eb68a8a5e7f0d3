"""Bearings at the moment a rotor lands on them: random ones within what is built, and the shipped ones.

A case is the bearing's parameters and how rotor and housing are, everything by name in SI units, so that
it can be printed and written. The rotor is a disk that the bearing carries itself, its centre a hair short
of first touch, over a ring at rest on its balls. The housing has springs and no damping, so that the
energy of rotor, bearing and housing closes.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from touchdown.bearings import (
    angular_caged,
    angular_cageless,
    detailed_caged,
    detailed_cageless,
    seat,
    simplified_cageless,
)
from touchdown.bearings.catalogue import bearing
from touchdown.modelkit.instance import Instance
from touchdown.modelkit.variables import flatten

MODULES = {
    "detailed_caged": detailed_caged,
    "detailed_cageless": detailed_cageless,
    "simplified_cageless": simplified_cageless,
    "angular_caged": angular_caged,
    "angular_cageless": angular_cageless,
}
SHIPPED = {  # where nothing else is said
    "detailed_caged": "6004",
    "detailed_cageless": "6904",
    "simplified_cageless": "6904",
    "angular_caged": "6004",
    "angular_cageless": "6904",
}
ANGLES = 12  # of the first ball, in the shipped bearings
SEED = 13
RPM = math.pi / 30.0  # rad/s
GRAVITY = 9.81  # m/s2
FAST = 60  # beside the seed, tells the draws of `fast_case` from the others
FASTEST = 60_000.0 * RPM
CERAMIC = 310e9  # Pa, silicon nitride
SHORT_OF_TOUCH = 1e-8  # m


@dataclass(frozen=True)
class Rotor:
    """Rotor and housing at the landing. SI; `direction` (rad) is where on the bore the journal lands."""

    mass: float = 1.65
    inertia: float = 0.5e-3
    speed: float = 9000.0 * RPM
    direction: float = -0.5 * math.pi
    approach: float = 0.0767  # m/s, towards the bore
    across: float = 0.0  # m/s, along it
    housing_mass: float = 5.02
    housing_stiffness: float = 2.5e8


@dataclass(frozen=True)
class Case:
    """A bearing of `model` with these parameters by name, under this rotor; `seed` tells it from others."""

    model: str
    seed: int
    parameters: dict[str, float]
    rotor: Rotor

    @property
    def clearance(self) -> float:
        """Radial, of the journal in the bore (m)."""
        return self.parameters["clearance"]


def random_case(model: str, seed: int) -> Case:
    """The random bearing of a seed, the same in every process and for every number of cases."""
    rng = np.random.default_rng([SEED, seed])
    caged = model.endswith("_caged")
    parameters = _geometry(rng, caged)
    diameter, pitch = parameters["balls.diameter"], parameters["balls.pitch_diameter"]
    parameters |= _ring(rng, diameter, pitch) | _contacts(rng, "cage" if caged else "ball")
    if caged:
        ball = 7830.0 * math.pi / 6.0 * diameter**3
        parameters["cage.mass"] = ball * rng.uniform(1.0, 3.0)
        parameters["cage.clearance"] = _between(rng, 3e-6, 1e-4)
    rotor = _rotor(rng, pitch, parameters["clearance"])
    if model in ("angular_caged", "angular_cageless"):
        parameters |= _paired(rng, diameter)
    return Case(model, seed, parameters, rotor)


def fast_case(model: str, seed: int) -> Case:
    """The random bearing of a seed under a rotor of 60 000 rpm, its ceramic balls of any size and weight.

    Balls of 1 to 20 mm and 100 to 8000 kg/m3, play up to 0.1 mm, friction up to 0.9; nothing is damped. Odd
    seeds have the friction of the journal and of the races apart, even ones alike.
    """
    rng = np.random.default_rng([SEED, FAST, seed])
    caged = model.endswith("_caged")
    parameters = _geometry(rng, caged)
    grown = _between(rng, 1e-3, 20e-3) / parameters["balls.diameter"]
    for name in ("balls.diameter", "balls.pitch_diameter"):
        parameters[name] *= grown
    diameter, pitch = parameters["balls.diameter"], parameters["balls.pitch_diameter"]
    parameters |= _ring(rng, diameter, pitch) | _contacts(rng, "cage" if caged else "ball")
    parameters["clearance"] = min(parameters["clearance"], 0.05 * parameters["journal_radius"])
    parameters |= {
        "balls.modulus": CERAMIC,
        "ring.modulus": CERAMIC,  # the harder case
        "balls.density": _between(rng, 100.0, 8000.0),
        "balls.play": rng.uniform(0.0, 1e-4),
        "balls.damping_ratio": 0.0,
        "contact.damping": 0.0,
    }
    side = "cage" if caged else "ball"
    parameters[f"{side}_contact.damping_ratio"] = 0.0
    drawn = rng.uniform(0.0, 0.9, 3)
    for law, value in zip(("friction", "race_friction", f"{side}_friction"), drawn, strict=True):
        level = drawn[0] if seed % 2 == 0 else value
        parameters[f"{law}.static"] = parameters[f"{law}.dynamic"] = float(level)
    if caged:
        ball = parameters["balls.density"] * math.pi / 6.0 * diameter**3
        parameters["cage.mass"] = ball * rng.uniform(1.0, 3.0)
        parameters["cage.clearance"] = _between(rng, 3e-6, 1e-4)
    rotor = _rotor(rng, pitch, parameters["clearance"])
    return Case(model, seed, parameters, replace(rotor, speed=math.copysign(FASTEST, rotor.speed)))


def shipped_cases(model: str) -> list[Case]:
    """The bearing of the model's disk scene, its first ball at twelve angles within one pitch of the balls.

    Their seeds count them.
    """
    settings = bearing(SHIPPED[model]).settings()
    known = {v.name for v in flatten(MODULES[model].MODEL.parameters())}
    taken = {n: value for n, value in settings.items() if n in known and n.startswith(("balls.", "ring."))}
    taken["clearance"] = 0.3e-3
    if model.endswith("_caged"):
        taken["cage.mass"] = settings["cage.mass"]
    pitch = 2.0 * math.pi / settings["balls.count"]
    return [
        Case(model, i, taken | {"balls.first_angle": -0.5 * math.pi + pitch * i / ANGLES}, Rotor())
        for i in range(ANGLES)
    ]


def landed(case: Case, tolerance: float, step: float) -> Instance:
    """The bearing of `case` at the landing, to be stepped inside by at most `step` (s); 0: adaptive."""
    instance = Instance(MODULES[case.model].MODEL)
    m = instance.record
    for name, value in case.parameters.items():
        _put(m["p"], name, value)
    m["p"]["interface"]["tolerance"] = tolerance
    m["p"]["micro_step"] = step
    instance.start(0.0)  # to know where the ring rests
    _land(m, case.rotor)
    instance.start(0.0)
    return instance


def continue_from(instance: Instance) -> None:
    """Set the bearing's inputs to where its copies of journal and housing went, for the next macro step."""
    q, u = instance.record["q"], instance.record["u"]
    journal, housing = u["journal"], u["housing"]
    for axis, at, speed in (("x", seat.HX, seat.HVX), ("y", seat.HY, seat.HVY)):
        moved, faster = q[at] - housing[axis], q[speed] - housing["v" + axis]
        housing[f"a{axis}_free"] -= housing["k_over_m"] * moved + housing["c_over_m"] * faster
        housing[axis], housing["v" + axis] = q[at], q[speed]
    for name, component in (("x", seat.JX), ("y", seat.JY), ("vx", seat.JVX), ("vy", seat.JVY)):
        journal[name] = q[component]
    journal["omega"] = q[seat.JW]


def carry(instance: Instance, macro_step: float, count: int) -> None:
    """Take `count` macro steps (s) from the landing, journal and housing as the bearing carries them."""
    for k in range(count):
        instance.step(k * macro_step, macro_step)
        continue_from(instance)


def energy(instance: Instance, rotor: Rotor) -> float:
    """Of rotor, bearing and housing, with the heat (J)."""
    q, inside = instance.record["q"], instance.record["o"]["energy"]
    housing = 0.5 * rotor.housing_mass * (q[seat.HVX] ** 2 + q[seat.HVY] ** 2)
    housing += 0.5 * rotor.housing_stiffness * (q[seat.HX] ** 2 + q[seat.HY] ** 2)
    disk = 0.5 * rotor.mass * (q[seat.JVX] ** 2 + q[seat.JVY] ** 2) + rotor.mass * GRAVITY * q[seat.JY]
    disk += 0.5 * rotor.inertia * q[seat.JW] ** 2
    return float(disk + housing + inside["kinetic"] + inside["potential"] + inside["dissipated"])


def _put(record: np.void, name: str, value: float) -> None:
    *groups, last = name.split(".")
    for group in groups:
        record = record[group]
    record[last] = value


def _land(m: np.void, rotor: Rotor) -> None:
    """Set the inputs of a bearing's memory to the landing."""
    journal, housing = m["u"]["journal"], m["u"]["housing"]
    c, s = math.cos(rotor.direction), math.sin(rotor.direction)
    d, reach = m["d"], m["p"]["clearance"] - SHORT_OF_TOUCH
    journal["x"], journal["y"] = d["rest_x"] + reach * c, d["rest_y"] + reach * s
    journal["vx"] = rotor.approach * c - rotor.across * s
    journal["vy"] = rotor.approach * s + rotor.across * c
    journal["omega"], journal["ay_free"] = rotor.speed, -GRAVITY
    journal["inv_m"], journal["inv_I"] = 1.0 / rotor.mass, 1.0 / rotor.inertia
    housing["inv_m"] = 1.0 / rotor.housing_mass
    housing["k_over_m"] = rotor.housing_stiffness / rotor.housing_mass


def _between(rng: np.random.Generator, low: float, high: float) -> float:
    """A number between two, its logarithm evenly spread."""
    return float(math.exp(rng.uniform(math.log(low), math.log(high))))


def _geometry(rng: np.random.Generator, caged: bool) -> dict[str, float]:
    """Balls that fill 45 to 75 % of the pitch circle with a cage, 90 to 99 % without, but are no larger
    than 0.3 of its diameter. Two in three of the rows without a cage start bunched, so that balls meet.
    """
    count = int(rng.integers(7, 26))
    fill = rng.uniform(0.45, 0.75) if caged else rng.uniform(0.90, 0.99)
    pitch = _between(rng, 20e-3, 100e-3)
    found = {
        "balls.count": count,
        "balls.diameter": pitch * min(math.sin(math.pi * fill / count), 0.3),
        "balls.pitch_diameter": pitch,
        "balls.play": rng.uniform(-2e-6, 10e-6),
        "balls.conformity": rng.uniform(1.02, 1.08),
        "balls.first_angle": rng.uniform(-math.pi, math.pi),
        "balls.damping_ratio": _or_none(rng, 0.005, 0.05),
    }
    if not caged:
        bunched = rng.uniform() < 2.0 / 3.0
        found["balls.bunching"] = rng.uniform(0.95, 1.0) if bunched else 0.0
    return found


def _paired(rng: np.random.Generator, diameter: float) -> dict[str, float]:
    """A pair, back to back or face to face, in two of three cases; a row at contact angle 0 else."""
    if rng.uniform() < 1.0 / 3.0:
        return {}
    return {
        "balls.rows": 2,
        "balls.contact_angle": math.radians(rng.uniform(10.0, 40.0)),
        "balls.play": 0.0,
        "arrangement": int(rng.integers(1, 3)),
        "row_distance": diameter * rng.uniform(1.5, 2.5),
        "preload": _between(rng, 20.0, 500.0),
    }


def _ring(rng: np.random.Generator, diameter: float, pitch: float) -> dict[str, float]:
    """An inner ring as thick under the race as a third of a ball, and the journal in it."""
    race = 0.5 * (pitch - diameter)
    bore = race - diameter * rng.uniform(0.3, 0.4)
    mass = 0.015 * (pitch / 31e-3) ** 3 * rng.uniform(0.6, 1.5)
    clearance = rng.uniform(0.1e-3, 0.4e-3)
    return {
        "ring.mass": mass,
        "ring.inertia": mass * (0.5 * (bore + race)) ** 2,
        "clearance": clearance,
        "journal_radius": bore - clearance,
    }


def _contacts(rng: np.random.Generator, side: str) -> dict[str, float]:
    """Stiffness, damping and friction of the journal's contact and of the balls' with their `side`."""
    found = {
        "contact.stiffness": _between(rng, 1e9, 6e9),
        "contact.damping": _or_none(rng, 1e6, 2e7),
        f"{side}_contact.stiffness": _between(rng, 3e7, 1e9),
        f"{side}_contact.damping_ratio": _or_none(rng, 0.01, 0.2),
    }
    for law in ("friction", "race_friction", f"{side}_friction"):
        found[f"{law}.static"] = rng.uniform(0.02, 0.3)
        found[f"{law}.dynamic"] = max(0.02, found[f"{law}.static"] * rng.uniform(0.6, 1.0))
    return found


def _or_none(rng: np.random.Generator, low: float, high: float) -> float:
    """As `_between`, but zero in a third of the cases."""
    drawn = _between(rng, low, high)
    return drawn if rng.uniform() > 1.0 / 3.0 else 0.0


def _rotor(rng: np.random.Generator, pitch: float, clearance: float) -> Rotor:
    """A disk as heavy for its bearing as the source's, give or take a factor of two, that fell through
    the clearance and swings a little; the housing is three times as heavy.
    """
    mass = 1.65 * (pitch / 30e-3) ** 2 * _between(rng, 0.5, 2.0)
    housing = 3.0 * mass * _between(rng, 0.5, 2.0)
    return Rotor(
        mass=mass,
        inertia=mass * (0.6 * pitch) ** 2 * _between(rng, 0.5, 2.0),
        speed=rng.uniform(-30000.0, 30000.0) * RPM,
        direction=-0.5 * math.pi + rng.uniform(-0.5, 0.5),
        approach=math.sqrt(2.0 * GRAVITY * clearance) * rng.uniform(0.8, 1.5),
        across=rng.uniform(-0.05, 0.05),
        housing_mass=housing,
        housing_stiffness=housing * (2.0 * math.pi * rng.uniform(600.0, 1500.0)) ** 2,
    )
