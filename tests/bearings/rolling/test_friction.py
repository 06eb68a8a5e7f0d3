"""Friction of all balls, ring and journal over one kick; what a kick does to a whole bearing."""

from __future__ import annotations

from importlib import import_module
from types import ModuleType
from typing import NamedTuple

import numpy as np
import pytest
from bearing_states import pressed, state_in_contact
from friction_records import prepared, unwritten_lines

from touchdown.bearings import seat
from touchdown.bearings.contact.friction import COULOMB, MAKKAR, STRIBECK, FrictionCurve, FrictionLaw, curve
from touchdown.bearings.contact.pair import friction_line
from touchdown.bearings.rolling import ball_bodies as bodies
from touchdown.bearings.rolling import ring, row
from touchdown.bearings.rolling.ball_set import MAX_BALLS
from touchdown.bearings.rolling.friction import (
    Answers,
    Around,
    Bore,
    Inner,
    Push,
    RingChange,
    Rubbed,
    rub,
)
from touchdown.bearings.rolling.ring import BALLS, rounded_lanes
from touchdown.modelkit.instance import Instance
from touchdown.modelkit.ports import Load

LENGTHS = {"still": 0.0, "0.1us": 1e-7, "2.5us": 2.5e-6, "100us": 1e-4}  # s
every_kick = pytest.mark.parametrize("h", LENGTHS.values(), ids=LENGTHS)
LAWS = {
    "Coulomb": FrictionLaw(kind=COULOMB),
    "Makkar": FrictionLaw(kind=MAKKAR),
    "Makkar, three slopes": FrictionLaw(kind=MAKKAR, g2=300.0),
    "Stribeck": FrictionLaw(kind=STRIBECK),
    "steep": FrictionLaw(kind=COULOMB, slope=1e5),
}


class Set(NamedTuple):
    """Balls between a ring and a race that stands, the ring around a journal; each ball has two contacts.

    Directions are angles (rad) of the contacts' normals; the last row of a pair is the inner race's.
    """

    angles: np.ndarray  # (2, n)
    lever: np.ndarray  # (n,) m, of the inner contacts from the ring's centre
    normal: np.ndarray  # (2, n) N
    sliding: np.ndarray  # (2, n) m/s
    last: np.ndarray  # (2, n) N, friction in the kick before
    others: np.ndarray  # (n, 3) m/s2, rad/s2: what else accelerates the balls
    moved: RingChange
    push: Push
    bore: Bore


MASS, INERTIA, RADIUS = 0.45e-3, 1.8e-9, 3.2e-3  # of a ball


def random_set(rng: np.random.Generator, count: int, h: float) -> Set:
    """Some balls are pressed by both races, some by one, some by none."""
    angle = rng.uniform(-np.pi, np.pi, count)
    normal = rng.uniform(0.0, 500.0, (2, count)) * (rng.uniform(size=(2, count)) < 0.7)
    heading = rng.uniform(-np.pi, np.pi)
    return Set(
        angles=np.array([angle, angle + rng.normal(0.0, 0.02, count)]),
        lever=12.3e-3 + rng.normal(0.0, 1e-4, count),
        normal=normal,
        sliding=rng.normal(0.0, 1.0, (2, count)) * 10.0 ** rng.uniform(-4.0, 0.5, (2, count)),
        last=rng.normal(0.0, 0.1, (2, count)) * normal,
        others=rng.normal(0.0, 1.0, (count, 3)) * [1e4, 1e4, 1e6],
        moved=RingChange(*(h * rng.normal(0.0, 1.0, 3) * [1e3, 1e3, 1e5])),
        push=Push(*rng.normal(0.0, 100.0, 2), rng.normal(0.0, 0.5), 1.5e-2, 1.9e-6),
        bore=Bore(np.cos(heading), np.sin(heading), 10e-3, rng.normal(0.0, 50.0), rng.uniform(0.0, 2e3)),
    )


def along(angle: np.ndarray) -> np.ndarray:
    """(n, 2) directions t for the angles of n."""
    return np.stack([-np.sin(angle), np.cos(angle)], axis=-1)


def jacobians(given: Set) -> tuple[np.ndarray, np.ndarray]:
    """(2, n, 3) of both sliding speeds of a ball to its velocity and spin; (n, 3) of the ring's surface."""
    t = along(given.angles)
    spins = np.array([RADIUS, -RADIUS])[:, None, None] + np.zeros((*given.angles.shape, 1))
    return np.concatenate([t, spins], axis=2), np.column_stack([t[1], given.lever])


def by_kernel(given: Set, h: float, law: FrictionCurve) -> tuple[np.ndarray, np.ndarray, float, RingChange]:
    """(Friction (2, n), its heat (2, n), friction on the journal, `RingChange`), as `rub` finds them."""
    count = given.angles.shape[1]
    n = rounded_lanes(count)
    of_balls, _ = jacobians(given)
    races = []
    for k in range(2):
        arrays = np.full((len(Rubbed._fields), MAX_BALLS), np.nan)  # what lies past the balls is no matter
        arrays[0, :count], arrays[1, :count], arrays[3, :count] = (
            given.normal[k], given.last[k], given.sliding[k]
        )  # fmt: skip
        arrays[4, :count] = h * np.sum(of_balls[k] * given.others, axis=1)
        races.append(Rubbed(*(row[:n] for row in arrays)))
    room = np.full((4, MAX_BALLS), np.nan)
    t = along(given.angles)
    room[:, :count] = t[1, :, 1], -t[1, :, 0], given.lever, np.sum(t[0] * t[1], axis=1)
    answers = Answers(h / MASS, h / MASS, h * RADIUS**2 / INERTIA)
    around = Around(given.moved, given.push, given.bore)
    at = Inner(*(row[:n] for row in room))
    on_journal, now = rub(h, count, law, answers, around, at, *races, unwritten_lines())
    tangential, loss = (
        np.array([getattr(r, key)[:count] for r in races]) for key in ("tangential", "loss")
    )
    return tangential, loss, on_journal, RingChange(*now)


def lines_of(given: Set, h: float, law: FrictionCurve) -> np.ndarray:
    """(2, n, 3) start, slope and base of all contacts' lines, drawn where the kick before lets them end."""
    of_balls, of_ring = jacobians(given)
    weights = h * np.array([1.0 / MASS, 1.0 / MASS, 1.0 / INERTIA])
    lines = np.zeros((*given.angles.shape, 3))
    for b in range(given.angles.shape[1]):
        for k in range(2):
            J, other = of_balls[k, b], of_balls[1 - k, b]
            change = h * (J @ given.others[b]) + (J * weights) @ other * given.last[1 - k, b]
            expected = given.sliding[k, b] + change - k * (of_ring[b] @ given.moved)
            answer = (J * weights) @ J
            lines[k, b] = friction_line(given.sliding[k, b], expected, answer, given.normal[k, b], law)
    return lines


def by_matrix(given: Set, h: float, law: FrictionCurve) -> tuple[np.ndarray, float, np.ndarray, np.ndarray]:
    """(Friction (2, n), friction on the journal, changes of the balls (n, 3) and of the ring (3,)).

    One dense system for the changes of all velocities and all friction forces.
    """
    count = given.angles.shape[1]
    of_balls, of_ring = jacobians(given)
    lines, push, bore = lines_of(given, h, law), given.push, given.bore
    of_bore = np.array([-bore.ny, bore.nx, bore.lever])
    size = 5 * count + 4
    matrix, right = np.zeros((size, size)), np.zeros(size)
    friction = 3 * count + np.arange(2 * count).reshape(count, 2)
    body, journal = slice(5 * count, 5 * count + 3), size - 1
    ring_masses = np.array([push.mass, push.mass, push.inertia])
    matrix[body, body] = np.diag(ring_masses)
    right[body] = h * np.array([push.fx, push.fy, push.moment])
    for b in range(count):
        ball = slice(3 * b, 3 * b + 3)
        matrix[ball, ball] = np.diag([MASS, MASS, INERTIA])
        right[ball] = h * given.others[b] * [MASS, MASS, INERTIA]
        for k in range(2):
            start, slope, base = lines[k, b]
            i = friction[b, k]
            matrix[ball, i] = -h * of_balls[k, b]
            matrix[i, i], matrix[i, ball], right[i] = base, slope * of_balls[k, b], start
        matrix[body, friction[b, 1]] = h * of_ring[b]
        matrix[friction[b, 1], body] = -lines[1, b, 1] * of_ring[b]
    matrix[body, journal] = h * of_bore
    matrix[journal, journal], matrix[journal, body], right[journal] = 1.0, -bore.gain * of_bore, bore.held
    scale = np.sqrt(np.abs(np.diag(matrix)))  # masses and lines differ by many orders
    found = np.linalg.solve(matrix / np.outer(scale, scale), right / scale) / scale
    return found[friction].T, found[journal], found[: 3 * count].reshape(count, 3), found[body]


@every_kick
@pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)
@pytest.mark.parametrize("count", [1, 17])
def test_rubbing_is_the_solution_of_one_large_system(h, law, count):
    """Balls two by two and the ring by three equations give what all velocities and forces at once do."""
    rng = np.random.default_rng(count)
    steep = curve(prepared(law))
    for _ in range(2):
        given = random_set(rng, count, h)
        tangential, loss, on_journal, now = by_kernel(given, h, steep)
        exact, at_bore, balls, moved = by_matrix(given, h, steep)
        size = 1e-9 * max(float(np.max(np.abs(exact))), abs(at_bore))
        np.testing.assert_allclose(tangential, exact, rtol=0.0, atol=size)
        assert on_journal == pytest.approx(at_bore, abs=size)
        np.testing.assert_allclose(np.array(now), moved, rtol=1e-8, atol=1e-15)
        of_balls, of_ring = jacobians(given)
        changes = np.sum(of_balls * balls, axis=2)
        changes[1] -= of_ring @ moved
        heat = -exact * (given.sliding + 0.5 * changes)
        np.testing.assert_allclose(loss, heat, rtol=0.0, atol=1e-8 * np.max(np.abs(heat)))


MODELS = ("detailed_cageless", "detailed_caged", "simplified_cageless")
every_model = pytest.mark.parametrize("name", MODELS)
DAMPING, VISCOUS = 1e7, 5.0  # N s/m2, of journal and races; N s/m, at the balls' sides


def module_of(name: str) -> ModuleType:
    """The module of a bearing's model."""
    return import_module(f"touchdown.bearings.{name}")


def in_contact(name: str, seed: int) -> Instance:
    """A bearing with damped contacts of every kind that moves at random in a moving housing."""
    if name == "simplified_cageless":
        instance = state_in_contact(name, seed)
        q, d, count = instance.record["q"], instance.record["d"], 17
        for law in ("contact", "race"):
            d[law]["damping"] = DAMPING
        d["ball_contact"]["viscous"] = VISCOUS
        q[BALLS : BALLS + count] = q[BALLS] + 0.999 * d["touch_angle"] * np.arange(count)
        q[[seat.HVX, seat.HVY]] = 0.02, -0.01
        return instance
    side = "cage" if name == "detailed_caged" else "ball"
    bunched = {"balls__bunching": 1.0} if side == "ball" else {}
    damping = {"contact__damping": DAMPING, "balls__damping": DAMPING, f"{side}_contact__viscous": VISCOUS}
    return pressed(name, seed, **damping, **bunched)


def fill_accounts(instance: Instance) -> None:
    """Give every contact far more energy than it needs, so that its force is its law's."""
    s = instance.record["s"]
    plenty = 1e3  # J
    for part in ("ring", "side", "balls", "inner", "outer"):
        if part in s.dtype.names and "stored" in s[part].dtype.names:
            s[part]["stored"] = plenty


class Kicked(NamedTuple):
    """One kick of a bearing: its state (n,), derivative (n,), and the load on journal and housing."""

    q: np.ndarray
    dq: np.ndarray
    load: Load


def kicked(instance: Instance, h: float, again: int = 2) -> Kicked:
    """The bearing over a kick of h (s), its kick before as it would then be; 0: the laws as they stand."""
    m, module = instance.record, module_of(instance.model.name)
    q = m["q"].copy()
    dq = np.zeros_like(q)
    m["s"]["kick"] = 0.0
    fill_accounts(instance)
    load = module.react(0.0, q, dq, m)
    for _ in range(again if h > 0.0 else 0):
        m["s"]["kick"] = h
        m["s"]["before"][: len(dq)] = dq[: len(m["s"]["before"])]
        dq = np.zeros_like(q)
        load = module.react(0.0, q, dq, m)
    return Kicked(q, dq, Load(*load))


def masses_of(instance: Instance) -> np.ndarray:
    """(n,) masses and inertias (kg, kg m2) that stand with the velocities of ring, balls and cage."""
    m, n = instance.record, int(instance.record["n"])
    p, d, count = m["p"], m["d"], int(m["p"]["balls"]["count"])
    found = np.zeros(n)
    found[[ring.RVX, ring.RVY]], found[ring.RW] = p["ring"]["mass"], p["ring"]["inertia"]
    if instance.model.name == "simplified_cageless":
        parts = {row.ORBIT: d["mass"] * d["pitch_radius"] ** 2, row.SPIN: d["inertia"]}
    else:
        parts = {bodies.VX: d["mass"], bodies.VY: d["mass"], bodies.SPIN: d["inertia"]}
    for component, mass in parts.items():
        found[BALLS + component * count : BALLS + (component + 1) * count] = mass
    if instance.model.name == "detailed_caged":
        first = BALLS + bodies.SIZE * count
        found[[first + bodies.VX, first + bodies.VY]] = p["cage"]["mass"]
        found[first + bodies.SPIN] = d["cage_inertia"]
    return found


def planar(instance: Instance) -> list[tuple[int, ...]]:
    """Where x, y, vx, vy and spin of all bodies lie that move freely in the plane."""
    found = [(ring.RX, ring.RY, ring.RVX, ring.RVY, ring.RW)]
    count = int(instance.record["p"]["balls"]["count"])
    components = bodies.X, bodies.Y, bodies.VX, bodies.VY, bodies.SPIN
    if instance.model.name != "simplified_cageless":
        found += [tuple(BALLS + c * count + b for c in components) for b in range(count)]
    if instance.model.name == "detailed_caged":
        found.append(tuple(BALLS + bodies.SIZE * count + c for c in components))
    return found


@every_model
@every_kick
@pytest.mark.parametrize("seed", range(1))
def test_momentum_closes_over_a_kick(name, h, seed):
    """What journal and housing get, and what moves all inside, adds up to nothing, whatever the kick.

    Balls that run on the pitch circle take no part in the force; their moments need the races' forces.
    """
    instance = in_contact(name, seed)
    kick, masses, s = kicked(instance, h), masses_of(instance), instance.record["s"]
    q, dq, load = kick
    force = np.array([load.jx + load.hx, load.jy + load.hy])
    moment = load.jm + turning(q[[seat.JX, seat.JY]], np.array([load.jx, load.jy]))
    moment += turning(q[[seat.HX, seat.HY]], np.array([load.hx, load.hy]))
    for x, y, vx, vy, spin in planar(instance):
        pull = masses[vx] * dq[[vx, vy]]
        force += pull
        moment += masses[spin] * dq[spin] + turning(q[[x, y]], pull)
    assert np.hypot(load.jx, load.jy) > 10.0
    assert np.any(s["side"]["indentation"] > 0.0)
    assert force == pytest.approx([0.0, 0.0], abs=1e-9)
    if name != "simplified_cageless":
        assert moment + s["outer_moment"] == pytest.approx(0.0, abs=1e-11)


def turning(arm: np.ndarray, force: np.ndarray) -> float:
    """Moment of a planar force (N m)."""
    return float(arm[0] * force[1] - arm[1] * force[0])


def stored_power(instance: Instance, q: np.ndarray, speeds: np.ndarray) -> float:
    """Rate (W) at which all contacts store energy where the state q moves at these velocities (n,)."""
    m, module, shift = instance.record, module_of(instance.model.name), 1e-9  # s
    m["s"]["kick"] = 0.0
    potential = []
    for way in (-shift, shift):
        moved = q.copy()
        module.drift(moved, q, speeds, way, m)
        module.react(0.0, moved, np.zeros_like(q), m)
        module.report(moved, m)
        potential.append(float(m["o"]["energy"]["potential"]))
    return (potential[1] - potential[0]) / (2.0 * shift)


@every_model
@every_kick
@pytest.mark.parametrize("seed", range(1))
def test_heat_is_what_a_kick_takes(name, h, seed):
    """Kinetic energy, work stored, work handed on to journal and housing, and heat add up over one kick.

    Forces are means over the kick, so their work is that at the mean velocities; journal and housing keep
    theirs.
    """
    instance = in_contact(name, seed)
    kick, masses = kicked(instance, h), masses_of(instance)
    n, load = len(masses), kick.load
    loss = kick.dq[ring.LOSS]
    moving = masses > 0.0
    mean = kick.q.copy()
    mean[:n][moving] += 0.5 * h * kick.dq[:n][moving]
    gained = float(np.sum(masses * kick.dq[:n] * mean[:n]))  # W, of kinetic energy
    handed = load.jx * mean[seat.JVX] + load.jy * mean[seat.JVY] + load.jm * mean[seat.JW]
    handed += load.hx * mean[seat.HVX] + load.hy * mean[seat.HVY]
    storing = stored_power(instance, kick.q, mean)
    scale = abs(gained) + abs(handed) + abs(storing) + abs(loss)
    assert abs(loss) > 1e-3 * scale
    assert gained + storing + handed + loss == pytest.approx(0.0, abs=1e-6 * scale)
