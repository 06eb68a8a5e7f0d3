"""Normal contact: an impact against its closed form, and what every law must keep to.

The impact is the first touch of a drop through 0.3 mm: a disk of 1.65 kg on a rigid bore. Closed form of
Hertz's impact: Johnson, Contact Mechanics (1985), section 11.4. Damped laws: the source's (2.38), (2.12).
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import pytest
from contact_law import normal_force, stated_force
from scipy.integrate import solve_ivp
from scipy.special import gamma

from touchdown.bearings.contact.laws import ContactLaw, elastic_energy, elastic_force
from touchdown.modelkit.variables import as_record

MASS = 1.65
GRAVITY = 9.81
LANDING_SPEED = math.sqrt(2.0 * GRAVITY * 0.3e-3)
STIFFNESS = 2.4e9
ROUNDING = 1e-15

LAWS = {
    "Hertz (2.1)": ContactLaw(),
    "indentation-proportional (2.38)": ContactLaw(damping=1e7),
    "rotor-ring (2.12)": ContactLaw(exponent=10 / 9, dissipation=0.12),
    "linear damping (2.2)": ContactLaw(viscous=150.0),
    "all terms, n = 2.5": ContactLaw(exponent=2.5, damping=3e6, dissipation=0.4, viscous=20.0),
}
every_law = pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)


class Impact(NamedTuple):
    """Peak indentation (m) and elastic force there (N), time in contact (s), speed out over speed in."""

    indentation: float
    force: float
    duration: float
    restitution: float


def impact(law: ContactLaw, gravity: float = 0.0, speed: float = LANDING_SPEED) -> Impact:
    """The disk lands at `speed` (m/s), pressed on by `gravity`, and leaves again."""
    record = as_record(law)

    def rhs(_t, y):
        return [y[1], gravity - normal_force(y[0], y[1], record) / MASS]

    def turns(_t, y):
        return y[1]

    def leaves(_t, y):
        return y[0]

    leaves.terminal, leaves.direction = True, -1.0
    run = solve_ivp(
        rhs, (0.0, 0.1), [0.0, speed], method="DOP853", events=(turns, leaves),
        rtol=1e-12, atol=[1e-16, 1e-12], max_step=2e-5,
    )  # fmt: skip
    assert len(run.t_events[0]) == len(run.t_events[1]) == 1, "one contact, with one turning point"
    deepest = run.y_events[0][0][0]
    return Impact(
        deepest, elastic_force(deepest, record), run.t_events[1][0], -run.y_events[1][0][1] / speed
    )


@pytest.mark.parametrize(("exponent", "speed"), [(1.0, 0.01), (10 / 9, LANDING_SPEED), (2.0, 1.0)])
def test_impact_in_closed_form(exponent, speed):
    """Energy gives the peak, a beta function the duration, of an impact on k d^n."""
    found = impact(ContactLaw(stiffness=STIFFNESS, exponent=exponent), speed=speed)
    n1 = exponent + 1.0
    deepest = (n1 * MASS * speed**2 / (2.0 * STIFFNESS)) ** (1.0 / n1)
    factor = 2.0 * math.sqrt(math.pi) * gamma(1.0 + 1.0 / n1) / gamma(0.5 + 1.0 / n1)
    assert found.indentation == pytest.approx(deepest, rel=1e-9)
    assert found.duration == pytest.approx(factor * deepest / speed, rel=1e-8)


def test_impact_with_damping_proportional_to_indentation():
    """(2.38) with the source's c = 1e7, which is N s/m2."""
    found = impact(ContactLaw(stiffness=STIFFNESS, damping=1e7))
    assert found.indentation == pytest.approx(29.71e-6, rel=1e-3)
    assert found.restitution == pytest.approx(0.951, abs=1e-3)


@pytest.mark.parametrize("exponent", [10 / 9, 1.5])
def test_small_dissipation_takes_two_thirds_of_epsilon_v(exponent):
    """Restitution is 1 - 2/3 eps v to first order, whatever the exponent (Hunt and Crossley 1975)."""
    small = 1e-3
    found = impact(ContactLaw(exponent=exponent, dissipation=small / LANDING_SPEED))
    assert 1.0 - found.restitution == pytest.approx(2.0 / 3.0 * small, rel=3e-3)


@every_law
def test_no_force_inside_the_gap(law):
    """Bodies apart, or only just touching, leave each other alone; a little deeper they do not."""
    record = as_record(law)
    for indentation in (-1e-3, -1e-9, -0.0, 0.0):
        assert normal_force(indentation, -1.0, record) == normal_force(indentation, 1.0, record) == 0.0
        assert elastic_force(indentation, record) == 0.0
        assert elastic_energy(indentation, record) == 0.0
    assert normal_force(1e-6, 0.0, record) > 0.0


@every_law
def test_no_adhesion(law):
    """However fast bodies part, the force does not pull; approaching, damping only adds, rounding apart."""
    record = as_record(law)
    for indentation in np.geomspace(1e-10, 1e-4, 25):
        elastic = elastic_force(indentation, record)
        assert elastic > 0.0
        for speed in np.geomspace(1e-4, 1e3, 29):
            assert 0.0 <= normal_force(indentation, -speed, record) <= elastic * (1.0 + ROUNDING)
            assert normal_force(indentation, speed, record) >= elastic * (1.0 - ROUNDING)


@every_law
def test_a_closed_cycle_dissipates(law):
    """Work done on a contact over a cycle of indentation, gap included, is not negative."""
    record = as_record(law)
    phase, frequency = np.arange(20_000) * (2.0 * math.pi / 20_000), 500.0
    turning = 2.0 * math.pi * frequency
    indentation = 5e-6 + 20e-6 * np.cos(phase)
    rate = -20e-6 * turning * np.sin(phase)
    force = np.array([normal_force(d, v, record) for d, v in zip(indentation, rate, strict=True)])
    loss = np.mean(force * rate) / frequency
    scale = elastic_energy(25e-6, record)
    assert force.max() > 0.0
    assert force.min() == 0.0
    if law == LAWS["Hertz (2.1)"]:
        assert abs(loss) < 1e-9 * scale
    else:
        assert loss > 1e-5 * scale


@every_law
@pytest.mark.parametrize("indentation", [1e-7, 8e-5])
def test_force_is_the_slope_of_the_energy(law, indentation):
    """d/dd of the stored energy is the elastic force, and that is the force at rest."""
    record = as_record(law)
    step = 1e-4 * indentation
    rise = elastic_energy(indentation + step, record) - elastic_energy(indentation - step, record)
    force = elastic_force(indentation, record)
    assert force == pytest.approx(rise / (2.0 * step), rel=1e-7)
    assert force == pytest.approx(law.stiffness * indentation**law.exponent, rel=1e-14)
    assert normal_force(indentation, 0.0, record) == pytest.approx(force, rel=ROUNDING)


def test_terms_of_the_law_add_up():
    """Each damping constant acts alone as its equation says."""
    d, v = 7e-6, 0.04
    elastic = STIFFNESS * d**1.5
    terms = {"damping": (1e7, 1e7 * d), "dissipation": (0.12, 0.12 * elastic), "viscous": (150.0, 150.0)}
    for name, (constant, per_speed) in terms.items():
        record = as_record(ContactLaw(**{name: constant}))
        assert normal_force(d, v, record) - elastic == pytest.approx(per_speed * v, rel=1e-9)
        assert normal_force(d, v, record) == pytest.approx(stated_force(d, v, record), rel=1e-14)
