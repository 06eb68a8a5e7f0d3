"""The leapfrog method on its own: order, energy, and friction far steeper than its step."""

from __future__ import annotations

import math

import numpy as np
import pytest

from touchdown.modelkit.integrators import verlet
from touchdown.modelkit.kernel import kernel
from touchdown.modelkit.status import STEP_UNDERFLOW

RESOLUTION = 0.8  # rad
STIFFNESS, FRICTION, KICK, FASTEST, LATER, KICKS, TAKEN = range(7)


@kernel
def rhs(t, q, dq, m):
    """Mass 1 kg on a spring, braked by no more than stops it in a kick; q[2] is a quadrature."""
    braking = m[FRICTION] if m[KICK] * m[FRICTION] <= 1.0 else 1.0 / m[KICK]
    dq[0] = q[1]
    dq[1] = -m[STIFFNESS] * q[0] - braking * q[1]
    dq[2] = -m[STIFFNESS] * q[0] * q[1]


@kernel
def drift(trial, q, v, h, m):
    trial[0] = q[0] + h * v[1]


@kernel
def forecast(trial, dq, h, kick, m):
    m[KICK] = kick
    m[KICKS] += kick


@kernel
def fastest(m):
    return m[FASTEST]


@kernel
def kicked(q, dq, kick, m):
    m[TAKEN] += kick


@kernel
def observe(t, q, m):
    """From 0.5 s on the contact is another one."""
    if t >= 0.5:
        m[FASTEST] = m[LATER]


@kernel
def run(q, m, work, span, longest):
    rhs(0.0, q, work[0], m)
    steps = verlet.Steps(longest, RESOLUTION)
    return verlet.integrate(rhs, drift, forecast, fastest, kicked, observe, m, q, 3, work, span, steps, 0.0)


def parameters(stiffness: float, friction: float, fastest: float) -> np.ndarray:
    """What the kernels above go by."""
    return np.array([stiffness, friction, 0.0, fastest, fastest, 0.0, 0.0])


def advanced(span: float, step: float, stiffness: float, friction: float = 0.0, fastest: float = 0.0):
    """(State after `span`, evaluations) from x = 1 m at rest."""
    q = np.array([1.0, 0.0, 0.0])
    m = parameters(stiffness, friction, fastest)
    status, evaluations, _ = run(q, m, np.zeros((8, 3)), span, step)
    assert status == 0
    return q, evaluations


def test_second_order_without_friction() -> None:
    steps = 1e-2 / 2.0 ** np.arange(4)
    errors = [abs(advanced(1.0, h, 9.0)[0][0] - math.cos(3.0)) for h in steps]
    slope = np.polyfit(np.log(steps), np.log(errors), 1)[0]
    assert slope == pytest.approx(2.0, abs=0.02)


def test_energy_comes_back_every_period() -> None:
    """A thousand periods of ten steps each: no drift, where a Runge-Kutta method would lose all of it.

    The energy of ten steps a period swings by (w h)^2 / 4, a tenth, at most; rounding adds 1e-12.
    """
    q, _ = advanced(1000.0 * 2.0 * math.pi, 2.0 * math.pi / 10.0, 1.0)
    assert 0.5 * q[1] ** 2 + 0.5 * q[0] ** 2 == pytest.approx(0.5, rel=0.15)


def test_steep_friction_takes_speed_out_without_reversing_it() -> None:
    """1e6 times steeper than the step: the mass creeps, it does not chatter."""
    q, _ = advanced(1.0, 1e-2, 1.0, friction=1e8)
    assert -1e-2 < q[1] <= 0.0
    assert 0.9 < q[0] <= 1.0


def test_the_fastest_contact_bounds_the_step() -> None:
    _, evaluations = advanced(1.0, 1.0, 1.0, fastest=100.0)
    assert evaluations == pytest.approx(100.0 / RESOLUTION + 1.0, abs=1.0)


def test_kicks_are_told_as_they_are_taken() -> None:
    """Together they fill the span, also where a hit found within it shortens the step that was planned."""
    for early, later in ((0.0, 0.0), (300.0, 20.0), (20.0, 3000.0)):
        q, m = np.array([1.0, 0.0, 0.0]), parameters(1.0, 0.0, early)
        m[LATER] = later
        run(q, m, np.zeros((8, 3)), 1.0, 0.013)
        assert m[TAKEN] == pytest.approx(1.0, rel=1e-12)
        first = 1.0 / math.ceil(1.0 / min(0.013, RESOLUTION / early if early else 1.0))
        planned = 0.5 * first + m[KICKS]
        assert (planned > 1.0 + 1e-9) == (later > 1000.0)  # and else as long


@kernel
def bounced(t, q, dq, m):
    """Mass 1 kg between walls at 1 m either way, stiffness 1 N/m^1.5."""
    beyond = max(abs(q[0]) - 1.0, 0.0)
    dq[0], dq[2] = q[1], 0.0
    dq[1] = -math.copysign(beyond**1.5, q[0])
    m[FASTEST] = math.sqrt(1.5 * math.sqrt(beyond))


@kernel
def rattled(q, m, work, span, longest):
    """(Status, frequency of late) of `verlet.integrate` over a hundred spans."""
    bounced(0.0, q, work[0], m)
    steps, status, lately = verlet.Steps(longest, RESOLUTION), 0, 0.0
    for _ in range(100):
        if status == 0:
            status, _, lately = verlet.integrate(
                bounced, drift, forecast, fastest, kicked, unchanged, m, q, 3, work, span, steps, lately
            )
    return status, lately


@kernel
def unchanged(t, q, m):
    """The contact stays as `bounced` finds it."""


@pytest.mark.parametrize("speed", [0.3, 10.0])
def test_an_undamped_rattle_neither_grows_nor_dies(speed: float) -> None:
    """Some 500 hits, in steps that every speed but the least shortens: energy within a factor of two.

    Steps bounded by the contact of the moment multiply it by more than a hundred.
    """
    q, m = np.array([0.0, speed, 0.0]), parameters(0.0, 0.0, 0.0)
    longest = RESOLUTION / 1.2  # of a hit at 0.3 m/s with little to spare
    status, _ = rattled(q, m, np.zeros((8, 3)), 30.0 / math.sqrt(speed), longest)
    kept = (0.5 * q[1] ** 2 + 0.4 * max(abs(q[0]) - 1.0, 0.0) ** 2.5) / (0.5 * speed**2)
    assert status == 0
    assert 0.5 < kept < 2.0


@pytest.mark.parametrize("fastest", [math.inf, math.nan])
def test_a_step_too_short_is_said(fastest: float) -> None:
    q, m = np.array([1.0, 0.0, 0.0]), parameters(1.0, 0.0, fastest)
    assert run(q, m, np.zeros((8, 3)), 1.0, 1e-3)[0] == STEP_UNDERFLOW
