"""Journal in a bore: momentum, energy and frame of the contact, and the search for its first touch."""

from __future__ import annotations

import math

import numpy as np
import pytest
from contact_law import stated_force
from friction_records import prepared

from touchdown.bearings.contact import journal as bore
from touchdown.bearings.contact.friction import COULOMB, MAKKAR, STRIBECK, FrictionLaw, coefficient
from touchdown.bearings.contact.laws import ContactLaw, elastic_energy
from touchdown.modelkit.ports import Motion
from touchdown.modelkit.variables import as_record, as_tuple, layout

RADIUS = 9.7e-3  # m, of the journal
CLEARANCE = 0.3e-3  # m
GRAVITY = 9.81
FRICTIONS = {"Coulomb": COULOMB, "Stribeck": STRIBECK, "Makkar": MAKKAR}
LAWS = {
    "Hertz": ContactLaw(),
    "damped": ContactLaw(damping=1e7),
    "rotor-ring": ContactLaw(exponent=10 / 9, dissipation=0.12),
    "linear": ContactLaw(exponent=1.0, stiffness=1e8, viscous=150.0),
}
every_law = pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)
every_friction = pytest.mark.parametrize("kind", FRICTIONS.values(), ids=FRICTIONS)
every_seed = pytest.mark.parametrize("seed", range(2))


def random_pair(seed: int, indentation: float = 20e-6) -> tuple[Motion, Motion]:
    """Journal and ring in contact somewhere on the bore, away from the origin, moving and spinning."""
    rng = np.random.default_rng(seed)
    angle = rng.uniform(-math.pi, math.pi)
    distance = CLEARANCE + indentation
    rx, ry = rng.uniform(-1e-3, 1e-3, 2)
    ring = Motion(rx, ry, *rng.normal(0.0, 0.05, 2), rng.normal(0.0, 300.0))
    x, y = rx + distance * math.cos(angle), ry + distance * math.sin(angle)
    return Motion(x, y, *rng.normal(0.0, 0.05, 2), rng.normal(0.0, 900.0)), ring


def touched(
    pair: tuple[Motion, Motion], law: ContactLaw = LAWS["damped"], kind: int = MAKKAR
) -> bore.Touch:
    """The contact of a pair of bodies."""
    friction = prepared(FrictionLaw(kind=kind))
    return bore.Touch(*bore.touch(*pair, RADIUS, CLEARANCE, as_record(law), friction))


def direction(pair: tuple[Motion, Motion]) -> tuple[np.ndarray, np.ndarray]:
    """Unit vectors from ring to journal, and a quarter turn counter-clockwise of that."""
    journal, ring = pair
    n = np.array([journal.x - ring.x, journal.y - ring.y])
    n /= np.linalg.norm(n)
    return n, np.array([-n[1], n[0]])


def sliding_speed(pair: tuple[Motion, Motion]) -> float:
    """Velocity of the journal's surface over the ring's at the point of contact, along the tangent (m/s).

    Both bodies are taken as rigid: velocity of the centre plus spin times the arm to the point.
    """
    n, t = direction(pair)
    journal, ring = pair
    point = np.array([journal.x, journal.y]) + RADIUS * n

    def surface_velocity(body: Motion) -> np.ndarray:
        arm = point - np.array([body.x, body.y])
        return np.array([body.vx, body.vy]) + body.spin * np.array([-arm[1], arm[0]])

    return float((surface_velocity(journal) - surface_velocity(ring)) @ t)


@every_seed
@every_law
@every_friction
def test_forces_moments_and_power_of_a_contact(seed, law, kind):
    """Normal law along the line of centres, friction law across it, both computed apart; at one point.

    Nothing is left of their moments about the origin; their power is what the contact stores and heats.
    """
    pair = random_pair(seed)
    (journal, ring), (n, t) = pair, direction(pair)
    found, record = touched(pair, law, kind), as_record(law)
    rate = np.array([journal.vx - ring.vx, journal.vy - ring.vy]) @ n
    normal = stated_force(20e-6, rate, record)
    mu = coefficient(sliding_speed(pair), prepared(FrictionLaw(kind=kind)))
    assert normal > 0.0
    assert (found.indentation, found.rate) == pytest.approx((20e-6, rate), rel=1e-10)
    assert found.normal == pytest.approx(normal, rel=1e-10)
    force = np.array([found.fx, found.fy])
    assert force @ n == pytest.approx(-normal, rel=1e-10)
    assert force @ t == pytest.approx(-mu * normal, rel=1e-9)
    assert found.journal_moment == pytest.approx(-mu * normal * RADIUS, rel=1e-9)
    moment = found.journal_moment + journal.x * found.fy - journal.y * found.fx
    moment += found.ring_moment - ring.x * found.fy + ring.y * found.fx
    assert moment == pytest.approx(0.0, abs=1e-14 * normal * RADIUS)
    on_journal = found.fx * journal.vx + found.fy * journal.vy + found.journal_moment * journal.spin
    on_ring = -found.fx * ring.vx - found.fy * ring.vy + found.ring_moment * ring.spin
    step = 1e-4 * found.indentation
    lower, upper = (elastic_energy(found.indentation + d, record) for d in (-step, step))
    storing = (upper - lower) / (2.0 * step) * found.rate
    scale = abs(storing) + abs(found.loss) + abs(on_journal) + abs(on_ring)
    assert on_journal + on_ring == pytest.approx(-(found.loss + storing), abs=1e-8 * scale)


@every_law
def test_no_force_inside_the_gap(law):
    """Apart, bodies leave each other alone, and the gap and its rate are still told."""
    pair = random_pair(0, indentation=-1e-6)
    found, (n, _) = touched(pair, law), direction(pair)
    rate = (pair[0].vx - pair[1].vx) * n[0] + (pair[0].vy - pair[1].vy) * n[1]
    assert (*found[:5], found.loss) == (0.0,) * 6
    assert (found.indentation, found.rate) == pytest.approx((-1e-6, rate), rel=1e-8)


def test_concentric_bodies_do_not_touch():
    """Without a line of centres there is a gap all round, and no division by zero."""
    found = touched((Motion(0.0, 0.0, 0.1, 0.2, 900.0), Motion(0.0, 0.0, 0.0, 0.0, 0.0)))
    assert found == bore.Touch(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -CLEARANCE, 0.0, 0.0, 0.0)


@every_law
@every_friction
def test_loss_is_never_negative(law, kind):
    """Damping and friction only make heat, in approach and in parting, also where the force is cut off."""
    losses, cut_off = [], 0
    for seed in range(200):
        found = touched(random_pair(seed, indentation=10.0 ** (-8.0 + 4.0 * seed / 200)), law, kind)
        assert found.indentation > 0.0
        losses.append(found.loss)
        cut_off += found.normal == 0.0
        assert found.loss >= -1e-12 * abs(found.normal * found.rate)
    assert max(losses) > 0.0
    may_be_cut_off = law.viscous > 0.0 or law.damping > 0.0  # damping outweighs elasticity when shallow
    assert (cut_off > 0) == may_be_cut_off


def records() -> tuple[np.void, np.void]:
    """Writable records of a report and a memory, as a model starts with."""
    kinds = (bore.ContactReport, bore.ContactMemory)
    report, memory = (np.array([as_tuple(kind())], dtype=layout(kind)) for kind in kinds)
    return report[0], memory[0]


def fallen(time: float) -> Motion:
    """A journal let go in the middle of the bore, falling straight down and drifting nowhere."""
    return Motion(0.0, -0.5 * GRAVITY * time**2, 0.0, -GRAVITY * time, 900.0)


def watch_fall(times, report, memory) -> None:
    """Show the fall through the bore to the watcher at `times`; the normal force is Hertz's."""
    law = as_record(ContactLaw())
    for time in times:
        journal = fallen(time)
        indentation = -journal.y - CLEARANCE
        normal = stated_force(indentation, -journal.vy, law)
        touched = as_record(bore.Touched(normal, indentation, -journal.vy))
        bore.watch_contact(time, journal, touched, report, memory)


@pytest.mark.parametrize("step", [0.37e-3, 10e-3])
def test_first_contact_of_a_free_fall(step):
    """A fall is a parabola, so the cubic finds the touch in it however coarse the steps."""
    report, memory = records()
    times = np.arange(0.0, 10e-3 + 0.5 * step, step)
    watch_fall(times, report, memory)
    assert times[-1] > math.sqrt(2.0 * CLEARANCE / GRAVITY), "the fall goes past the touch"
    assert report["first_time"] == pytest.approx(math.sqrt(2.0 * CLEARANCE / GRAVITY), rel=0, abs=1e-12)
    assert report["first_time"] == pytest.approx(7.821e-3, abs=0.5e-6)  # digits printed, of 7.82062 ms
    assert report["first_speed"] == pytest.approx(math.sqrt(2.0 * GRAVITY * CLEARANCE), rel=1e-9)
    assert report["first_x"] == 0.0
    assert report["first_y"] == pytest.approx(-CLEARANCE, rel=1e-9)


def test_peaks_and_first_contact_stay():
    """Peaks are the largest seen; a second contact does not move the first."""
    report, memory = records()
    watch_fall(np.arange(0.0, 9.05e-3, 0.1e-3), report, memory)
    first = tuple(report[name] for name in ("first_time", "first_speed", "first_x", "first_y"))
    deepest = 0.5 * GRAVITY * 9e-3**2 - CLEARANCE
    assert report["peak_indentation"] == pytest.approx(deepest, rel=1e-9)
    force = report["peak_force"]
    assert force == pytest.approx(2.4e9 * deepest**1.5, rel=1e-9)
    watch_fall([5e-3, 8.5e-3], report, memory)
    assert report["peak_force"] == force
    assert tuple(report[name] for name in ("first_time", "first_speed", "first_x", "first_y")) == first


def test_start_in_contact():
    """A journal that starts pressed against the bore has its first contact there and then."""
    report, memory = records()
    journal = Motion(1e-4, -CLEARANCE, 0.02, -0.05, 0.0)
    bore.watch_contact(0.0, journal, as_record(bore.Touched(12.0, 3e-6, 0.05)), report, memory)
    assert report["first_time"] == 0.0
    assert (report["first_x"], report["first_y"]) == (journal.x, journal.y)
    assert report["first_speed"] == pytest.approx(math.hypot(0.02, 0.05), rel=1e-14)
    assert (report["peak_force"], report["peak_indentation"]) == (12.0, 3e-6)


# -- when it will touch --------------------------------------------------------------------------------


@every_seed
def test_the_time_to_the_touch_is_that_of_straight_ways(seed: int) -> None:
    """Where both are after that time, the gap is closed; before it, it was open."""
    rng = np.random.default_rng(seed)
    place, angle = CLEARANCE * rng.uniform(0.0, 0.99), rng.uniform(-math.pi, math.pi)
    ring = Motion(*rng.normal(scale=(1e-4, 1e-4, 0.2, 0.2)), 0.0)
    x, y = ring.x + place * math.cos(angle), ring.y + place * math.sin(angle)
    journal = Motion(x, y, *rng.normal(scale=0.3, size=2), 500.0)
    time = bore.time_to_touch(journal, ring, CLEARANCE)

    def distance(t: float) -> float:
        away = [x + v * t for x, v in ((journal.x, journal.vx), (journal.y, journal.vy))]
        back = [x + v * t for x, v in ((ring.x, ring.vx), (ring.y, ring.vy))]
        return math.hypot(away[0] - back[0], away[1] - back[1])

    assert 0.0 < time < bore.MAX_REACH
    assert distance(time) == pytest.approx(CLEARANCE, rel=1e-9)
    assert all(distance(s * time) < CLEARANCE for s in (0.1, 0.5, 0.99))
