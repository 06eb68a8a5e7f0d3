"""Bearings whose balls are bodies in space: the same state as in the plane, shaken ones, and falls."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

import touchdown
from tests.support.bearing_states import instance_of, pressed
from touchdown.bearings import seat
from touchdown.bearings.angular.angular_row import SINGLE_REVERSED
from touchdown.bearings.angular.bodies import space_cage
from touchdown.bearings.angular.bodies.memory_layout import (
    CAGE_SIZE,
    FIRST_BALL,
    RTX,
    RTY,
    RVZ,
    RWX,
    RWY,
    RZ,
    SIZE,
    VX,
    VY,
    VZ,
    WX,
    WY,
    WZ,
    X,
    Y,
)
from touchdown.bearings.rolling import ball_bodies, ring
from touchdown.bearings.rolling.ring import BALLS
from touchdown.master.scene.run_spec import RunSpec
from touchdown.master.scene.scene import ComponentSpec, Scene
from touchdown.modelkit.instance import Instance

PLANE = {"angular_cageless": "detailed_cageless", "angular_caged": "detailed_caged"}
FROM_PLANE = {  # component of a ball in space: in the plane
    X: ball_bodies.X,
    Y: ball_bodies.Y,
    VX: ball_bodies.VX,
    VY: ball_bodies.VY,
    WZ: ball_bodies.SPIN,
}
CAGE_FROM_PLANE = {
    space_cage.X: ball_bodies.X,
    space_cage.Y: ball_bodies.Y,
    space_cage.VX: ball_bodies.VX,
    space_cage.VY: ball_bodies.VY,
    space_cage.ANGLE: ball_bodies.ANGLE,
    space_cage.SPIN: ball_bodies.SPIN,
}
ENERGIES = (  # of a bearing, with what went to rotor and housing
    *(f"bearing.energy.{kind}" for kind in ("kinetic", "potential", "dissipated")),
    *(f"bearing.{end}.{account}" for end in ("journal", "housing") for account in ("work", "jump")),
)
PEAKS = ("bearing.shoulder.peak_force", "rotor.A.rx", "rotor.A.ry")
_PAIR: dict[str, float] = {  # 71904 with ceramic balls, back to back
    "balls__rows": 2,
    "balls__contact_angle": math.radians(25.0),
    "balls__outer_conformity": 1.06,
    "balls__modulus": 310e9,
    "balls__poisson": 0.26,
    "balls__density": 3200.0,
    "arrangement": 1,
    "row_distance": 9e-3,
    "preload": 100.0,
    "land": 16e-3,
    "shoulder__gap_minus": 0.15e-3,
    "shoulder__gap_plus": 0.15e-3,
    "shoulder__dissipation": 5.0,
    "ring__mass": 0.019,
    "ring__inertia": 2.16e-6,
    "ring__transverse_inertia": 1.6e-6,
    "balls__damping_ratio": 0.05,
}
PAIRS: dict[str, dict[str, float]] = {
    "angular_cageless": _PAIR,
    "angular_caged": _PAIR
    | {
        "balls__count": 15,
        "balls__diameter": 5.1e-3,
        "balls__pitch_diameter": 28.5e-3,
        "balls__play": 0.0,
        "cage__mass": 2.2e-3,
        "cage__clearance": 0.1e-3,
    },
}


def put(instance: Instance, **parameters: float) -> None:
    """Set parameters; `group__name` for one in a group."""
    for key, value in parameters.items():
        *groups, name = key.split("__")
        at = instance.record["p"]
        for group in groups:
            at = at[group]
        at[name] = value


def derived(name: str, **parameters: float) -> Instance:
    """A bearing at its start, without gravity, journal and housing held; `group__name` for parameters."""
    instance = instance_of(name)
    put(instance, **{"gravity": 0.0, **parameters})
    instance.start(0.0)
    return instance


def instant(instance: Instance, q: np.ndarray) -> np.ndarray:
    """Derivative of what is inside in the state q; the load then stands in the outputs."""
    dq = np.zeros_like(q)
    assert instance.model.instant is not None
    instance.model.instant(0.0, q, dq, instance.words)
    return dq


def components(q: np.ndarray, first: int, count: int) -> slice:
    """Where a component of all `count` balls lies in the state q."""
    return slice(FIRST_BALL + first * count, FIRST_BALL + (first + 1) * count)


def of_balls(q: np.ndarray, first: int, n: int) -> np.ndarray:
    """Three components of all balls, (3, n)."""
    return q[FIRST_BALL + first * n : FIRST_BALL + (first + 3) * n].reshape(3, n)


def balls_of(instance: Instance) -> int:
    """How many balls are in the state."""
    return int(instance.record["d"]["balls"])


def cage_of(instance: Instance, row: int) -> int:
    """Where the state of a row's cage starts."""
    return FIRST_BALL + SIZE * balls_of(instance) + CAGE_SIZE * row


def in_both(name: str, seed: int) -> tuple[Instance, Instance, list[tuple[int, int]]]:
    """A bearing pressed in the plane, the same in space in that state, and where both have components.

    These lie at the same place in both up to the balls; those of balls and cage are told as (in space, in
    the plane).
    """
    plane, space = pressed(PLANE[name], seed), derived(name)
    count = balls_of(space)
    for body in ("journal", "housing"):
        given = plane.record["u"][body]
        for key in (key for key in given.dtype.names if key != "mode"):
            space.record["u"][body][key] = given[key]
    pairs = [
        (FIRST_BALL + to * count + b, BALLS + given * count + b)
        for to, given in FROM_PLANE.items()
        for b in range(count)
    ]
    if name == "angular_caged":
        first, other = cage_of(space, 0), BALLS + ball_bodies.SIZE * count
        pairs += [(first + to, other + given) for to, given in CAGE_FROM_PLANE.items()]
    q, s = plane.record["q"], space.record["q"]
    s[seat.JX : ring.NEXT] = q[seat.JX : ring.NEXT]
    for to, given in pairs:
        s[to] = q[given]
    return plane, space, pairs


def shaken(name: str, seed: int, **changes: float) -> tuple[Instance, np.ndarray]:
    """The pair under a rotor that presses on bore and face at once, all tilted and moving; its state.

    changes: of its parameters.
    """
    rng = np.random.default_rng(seed)
    bearing = derived(name, **PAIRS[name] | changes)
    j, n = bearing.record["u"]["journal"], balls_of(bearing)
    angle = rng.uniform(0.0, 2.0 * math.pi)
    j["x"], j["y"], j["z"] = 0.31e-3 * math.cos(angle), 0.31e-3 * math.sin(angle), -0.151e-3
    j["rx"], j["ry"] = rng.uniform(-3e-4, 3e-4, 2)
    j["vx"], j["vy"], j["vz"], j["omega"] = 0.02, -0.03, -0.05, 900.0
    j["wx"], j["wy"] = rng.uniform(-1.0, 1.0, 2)
    q = bearing.record["q"].copy()
    q[[ring.RX, ring.RY, RZ]] += rng.uniform(-3e-6, 3e-6, 3)
    q[[RTX, RTY]] = rng.uniform(-1e-4, 1e-4, 2)
    q[[ring.RVX, ring.RVY, RVZ]] = rng.uniform(-0.02, 0.02, 3)
    q[[RWX, RWY, ring.RW]] = *rng.uniform(-2.0, 2.0, 2), 200.0
    for k in (VX, VY, VZ):
        q[components(q, k, n)] = rng.normal(size=n) * 0.05
    for k in (WX, WY, WZ):
        q[components(q, k, n)] = rng.normal(size=n) * 100.0
    if name == "angular_caged":
        for row in range(2):  # each so far out that some of its balls press their pockets
            i, way = cage_of(bearing, row), rng.normal(size=3)
            q[i : i + 3] += 0.12e-3 * way / np.linalg.norm(way)
            q[i + space_cage.RX : i + space_cage.RX + 2] = rng.uniform(-5e-3, 5e-3, 2)
            q[i + space_cage.VX : i + space_cage.VX + 3] = rng.normal(size=3) * 0.05
            q[i + space_cage.W1 : i + space_cage.W1 + 3] = *rng.uniform(-5.0, 5.0, 2), 90.0
    return bearing, q


@dataclass(frozen=True)
class Fall:
    """A rotor that lands on the pair: where it is held, how it is tilted, what pulls it (m, rad, m/s2)."""

    off: float  # of the bearing from its centre of mass, along the shaft
    tilt: float
    down: float
    along: float
    begins: tuple[float, float]  # z and its rate
    span: float  # s


MASS, INERTIA, TRANSVERSE = 1.65, 0.5e-3, 0.4e-3  # of the disk (kg, kg m2)
FALLS = {
    "upright": Fall(0.0, 0.0, 0.0, -9.81, (-0.148e-3, -0.0535), 6e-3),
    "upright, off centre": Fall(-0.04, 2e-4, 0.0, -9.81, (-0.148e-3, -0.0535), 6e-3),
    "horizontal, under thrust": Fall(0.0, 0.0, 9.81, 200.0 / MASS, (0.0, 0.0), 12e-3),
    "horizontal": Fall(0.0, 0.0, 9.81, 0.0, (0.0, 0.0), 12e-3),
}


def landed(name: str) -> Instance:
    """A bearing of its defaults that carries rotor and housing itself, at first touch in the plane."""
    bearing = instance_of(name)
    j, h = bearing.record["u"]["journal"], bearing.record["u"]["housing"]
    j["y"], j["vy"], j["ay_free"], j["omega"] = -0.29999e-3, -0.0767, -9.81, 942.478
    j["inv_m"], j["inv_I"] = 1.0 / MASS, 1.0 / INERTIA
    h["inv_m"], h["k_over_m"], h["c_over_m"] = 1 / 5.02, 2.5e8 / 5.02, 2500 / 5.02
    bearing.start(0.0)
    return bearing


def fallen(name: str, fall: Fall, micro_step: float, **changes: float) -> tuple[Instance, float]:
    """The pair after the fall, in which it carries rotor and housing itself, in one macro step.

    changes: of its parameters. Returns it and the potential energy (J) that was in it at the start.
    """
    bearing = instance_of(name)
    put(bearing, **PAIRS[name] | changes, gravity=fall.down, micro_step=micro_step)
    j, h = bearing.record["u"]["journal"], bearing.record["u"]["housing"]
    j["omega"], j["inv_I"], j["inv_m_z"] = 942.478, 1.0 / INERTIA, 1.0 / MASS
    j["inv_m"], j["inv_I_t"] = 1.0 / MASS + fall.off**2 / TRANSVERSE, 1.0 / TRANSVERSE
    j["inv_mI"], j["rx"] = fall.off / TRANSVERSE, fall.tilt
    j["ay_free"], j["az_free"], (j["z"], j["vz"]) = -fall.down, fall.along, fall.begins
    for end in ("", "_z"):
        h[f"inv_m{end}"], h[f"k_over_m{end}"], h[f"c_over_m{end}"] = 1 / 5.02, 2.5e8 / 5.02, 2500 / 5.02
    bearing.start(0.0)
    before = float(bearing.record["o"]["energy"]["potential"])
    bearing.step(0.0, fall.span)
    return bearing, before


def peaks(bearing: Instance) -> np.ndarray:
    """Of face, bore, balls at the inner and at the outer race (N)."""
    o = bearing.record["o"]
    return np.array([float(o[part]["peak_force"]) for part in ("shoulder", "contact", "inner", "outer")])


def _undamped_bearing(rng: np.random.Generator, name: str) -> tuple[dict[str, object], float, float]:
    """Settings of a random bearing of the model, its pitch diameter (m), and a rotor's mass for it (kg)."""
    paired, pitch = rng.uniform() < 2.0 / 3.0, math.exp(rng.uniform(math.log(25e-3), math.log(80e-3)))
    caged, count, clearance = name == "angular_caged", int(rng.integers(9, 20)), rng.uniform(0.1e-3, 0.3e-3)
    fill = rng.uniform(0.45, 0.75) if caged else rng.uniform(0.9, 0.98)
    ball = min(pitch * math.sin(math.pi * fill / count), 0.25 * pitch)
    mass = 1.65 * (pitch / 30e-3) ** 2 * rng.uniform(0.5, 2.0)
    ring_mass, radius = 0.015 * (pitch / 31e-3) ** 3, 0.5 * (pitch - 1.7 * ball)
    bearing: dict[str, object] = {
        "balls.count": count,
        "balls.diameter": ball,
        "balls.pitch_diameter": pitch,
        "balls.play": 0.0,
        "balls.contact_angle": math.radians(rng.uniform(12.0, 40.0)),
        "balls.damping_ratio": 0.0,
        "balls.material": ("steel", "Si3N4")[int(rng.integers(2))],
        "contact.damping": 0.0,
        f"{'cage' if caged else 'ball'}_contact.damping_ratio": 0.0,
        "ring.mass": ring_mass,
        "ring.inertia": ring_mass * (0.5 * pitch - 0.7 * ball) ** 2,
        "clearance": clearance,
        "journal_radius": radius,
        "land": rng.uniform(1.0, 2.0) * ball if rng.uniform() < 0.7 else 0.0,
        "shoulder.gap_minus": rng.uniform(0.05e-3, 0.2e-3),
        "shoulder.gap_plus": rng.uniform(0.05e-3, 0.2e-3) if rng.uniform() < 0.5 else 0.0,
        "shoulder.radius": radius + 0.3 * ball,
        "friction.static": rng.uniform(0.05, 0.3),
        "friction.dynamic": 0.05,
    }
    if paired:
        bearing |= {
            "balls.rows": 2,
            "arrangement": int(rng.integers(1, 3)),
            "row_distance": rng.uniform(1.3, 2.0) * ball,
            "preload": rng.uniform(20.0, 200.0),
        }
    else:
        bearing["arrangement"] = SINGLE_REVERSED  # it carries the thrust, which pushes towards -z
    if caged:
        bearing["cage.clearance"] = rng.uniform(0.02e-3, 0.2e-3)
    return bearing, pitch, mass


def _pushed_rotor(rng: np.random.Generator, mass: float, size: float) -> dict[str, object]:
    """Settings of a random rotor of a `mass` (kg) that a thrust holds on a face; size: m."""
    thrust = rng.uniform(0.5, 5.0) * mass * 9.81
    return {
        "mass": mass,
        "inertia": mass * (0.6 * size) ** 2,
        "transverse_inertia": mass * (0.6 * size) ** 2 * rng.uniform(0.6, 1.5),
        "axial": 1,
        "axial_load": -thrust,
        "bearing_position": rng.uniform(1e-3, 20e-3),
        "speed": rng.uniform(-1500.0, 1500.0),
        "rx": rng.uniform(-3e-4, 3e-4),
        "ry": rng.uniform(-3e-4, 3e-4),
    }


def undamped(name: str, seed: int, duration: float) -> Scene:
    """A random rotor that a thrust holds on the faces of a random bearing of the model, all of it tilting.

    A single row or a pair, with or without a land, of steel or ceramic balls, inclined anyhow, rubbing
    anyhow; the rotor spins at up to 15 000 rpm, 1 to 20 mm from its centre of mass. Nothing is damped.
    """
    rng = np.random.default_rng([seed, len(name)])
    bearing, pitch, mass = _undamped_bearing(rng, name)
    rotor = _pushed_rotor(rng, mass, pitch)
    housing: dict[str, object] = {"mass": 3.0 * mass, "stiffness": 1e8 * mass, "damping": 0.0}
    return Scene(
        f"{name} {seed}",
        "test",
        {
            "rotor": ComponentSpec("rigid_rotor", rotor),
            "bearing": ComponentSpec(name, bearing),
            "housing": ComponentSpec("housing", housing),
        },
        attach=(("bearing.journal", "rotor.A"), ("bearing.housing", "housing.seat")),
        run=RunSpec(duration=duration, macro_step=5e-5, stop_residual=math.inf),
        inclination=rng.uniform(-0.5, 0.5) * math.pi,
    )


class Balance(NamedTuple):
    """How well the energy inside a bearing closes over a run."""

    error: float  # the largest, of turnover and heat
    face: float  # N, largest force of a face
    tilt: float  # rad, largest of the rotor


def balance_of(scene: Scene) -> Balance:
    """`Balance` of the bearing in `scene`."""
    run = touchdown.run(scene, in_process=True)
    data = {name: np.asarray(run.data[name]) for name in (*ENERGIES, *PEAKS)}
    inside = np.sum([data[name] for name in ENERGIES], axis=0)
    assert run.summary["completed"], run.summary["stopped_because"]
    scale = run.summary["energy_turnover"] + float(data["bearing.energy.dissipated"][-1])
    tilt = np.hypot(data["rotor.A.rx"], data["rotor.A.ry"])
    return Balance(
        float(np.max(np.abs(inside - inside[0]))) / scale,
        float(data["bearing.shoulder.peak_force"][-1]),
        float(np.max(tilt)),
    )
