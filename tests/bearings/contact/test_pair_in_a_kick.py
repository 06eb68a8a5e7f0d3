"""Friction and damping over a kick: closed forms, steep laws, no chatter."""

from __future__ import annotations

import math

import numpy as np
import pytest
from friction_records import prepared

from touchdown.bearings.contact.friction import (
    COULOMB,
    MAKKAR,
    STRIBECK,
    FrictionCurve,
    FrictionLaw,
    coefficient,
    curve,
)
from touchdown.bearings.contact.pair import damped_normal, force_on, friction_line

NORMAL = 250.0  # N
STEEPNESS = 10.0 ** np.arange(-4.0, 8.1, 2.0)  # z, what a kick makes of the law's slope
LAWS = {
    "Coulomb": FrictionLaw(kind=COULOMB),
    "Stribeck": FrictionLaw(kind=STRIBECK),
    "Makkar": FrictionLaw(kind=MAKKAR),
    "steep Makkar": FrictionLaw(kind=MAKKAR, slope=1e4, g2=1e4, g3=1e3),
}
every_law = pytest.mark.parametrize("law", [prepared(law) for law in LAWS.values()], ids=LAWS)


def viscous(slope: float) -> FrictionCurve:
    """Friction that rises with speed without end."""
    return FrictionCurve(g1=0.0, g2=1.0, g3=1.0, dynamic=0.0, extra=0.0, faded=0.0, slope=1.0, g6=slope)


def rubbed(
    sliding: float, others: float, answer: float, normal: float, law: FrictionCurve
) -> tuple[float, float]:
    """(Friction (N), sliding speed after the kick (m/s)) of a contact driven by `others` (m/s)."""
    line = friction_line(sliding, sliding + others, answer, normal, law)
    force = force_on(line, answer, others)
    return force, sliding + others + answer * force


def decay(z: float | np.ndarray) -> float | np.ndarray:
    """The Pade approximant of exp(-z) with one zero and two poles."""
    return (6.0 - 2.0 * z) / (6.0 + 4.0 * z + z * z)


@pytest.mark.parametrize("z", STEEPNESS)
def test_linear_friction_decays_as_radau_has_it(z):
    """(6 - 2z)/(6 + 4z + z^2) of the speed is left, however steep; never more than there was."""
    answer = 3e-3
    for sliding in (0.7, -1e-6):
        _, after = rubbed(sliding, 0.0, answer, NORMAL, viscous(z / (answer * NORMAL)))
        assert after / sliding == pytest.approx(decay(z), abs=1e-14)
        assert abs(after) < abs(sliding)


@every_law
def test_without_a_kick_it_is_the_law(law):
    """At rest, on the peak and beyond."""
    for speed in (0.0, *10.0 ** np.arange(-9.0, 2.1, 0.25), *(-(10.0 ** np.arange(-9.0, 2.1, 0.25)))):
        force, after = rubbed(speed, 0.0, 0.0, 1e5, curve(law))
        mu = coefficient(speed, law)
        assert force == pytest.approx(-mu * 1e5, rel=1e-14, abs=1e-300)
        assert after == speed


@every_law
def test_friction_alone_never_adds_to_the_speed(law):
    """From any start under any load: it stops, or turns round by less than a third; ever slower then.

    A linear law would turn it round by a tenth, the least of (6 - 2z)/(6 + 4z + z^2). A curve does so by
    most where friction would just stop the motion within the kick.
    """
    friction, stopped = curve(law), 0
    for answer in 10.0 ** np.arange(-8.0, 2.1, 0.25):
        for speed in 10.0 ** np.arange(-9.0, 2.1, 0.25):
            _, after = rubbed(speed, 0.0, answer, NORMAL, friction)
            assert -speed / 3.0 < after <= speed
            assert rubbed(-speed, 0.0, answer, NORMAL, friction)[1] == -after
            assert abs(rubbed(after, 0.0, answer, NORMAL, friction)[1]) <= abs(after)
            stopped += abs(after) < 1e-3 * speed
    assert stopped > 100


def creep(law, share: float) -> float:
    """Speed (m/s) below the peak at which the coefficient is `share` of the plateau."""
    low, high = 0.0, 1.0 / float(law["slope"])
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if coefficient(middle, law) < share * law["dynamic"] else (low, middle)
    return high


@every_law
@pytest.mark.parametrize("share", [0.0, 0.5, -0.6])
@pytest.mark.parametrize("reach", [0.01, 1.0, 100.0])
def test_a_contact_driven_below_its_friction_sticks(law, share, reach):
    """From any start it creeps in the end as the law has it, within 1 %, and stays: nothing chatters.

    share: drive over the plateau's friction; reach: by what that slows the motion in a kick (m/s).
    """
    friction, answer = curve(law), reach / (NORMAL * float(law["dynamic"]))
    resting = math.copysign(creep(law, abs(share)), share) if share else 0.0
    for speed in (50.0 * reach, -15.0 * reach, 0.5 * reach, -1e-4 * reach, 1e-6, 0.0):
        speeds = []
        for _ in range(220):
            _, speed = rubbed(speed, share * reach, answer, NORMAL, friction)
            speeds.append(speed)
        late = np.array(speeds[-100:])
        assert np.max(np.abs(late - resting)) < 0.01 * abs(resting) + 1e-12 * reach
        assert np.ptp(late) < 1e-4 * abs(resting) + 1e-12 * reach


@pytest.mark.parametrize("z", STEEPNESS)
def test_damping_takes_out_an_approach_as_radau_has_it(z):
    """Without other forces (6 - 2z)/(6 + 4z + z^2) of the approach is left."""
    along, rate = 4e-3, 0.2
    force = damped_normal(0.0, z / along, rate, along, 0.0)
    after = rate - along * force
    assert after / rate == pytest.approx(decay(z), abs=1e-14)
    assert abs(after) < rate


def test_a_contact_never_pulls():
    """Whatever it meets; and where bodies part faster than damping could hold them, it is nothing."""
    rng = np.random.default_rng(0)
    for _ in range(500):
        elastic, damping, along = 10.0 ** rng.uniform(-3.0, 4.0, 3) * [1.0, 1.0, 1e-4]
        rate, others = rng.normal(0.0, 1.0, 2)
        assert damped_normal(elastic, damping, rate, along, others) >= 0.0
    assert damped_normal(1.0, 250.0, -1.0, 5e-3, -0.1) == 0.0
