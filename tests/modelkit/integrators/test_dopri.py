"""Dormand-Prince 5(4): its table, its order, its control of the error, and its ways to give up.

Order conditions: Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, 2nd ed., section II.2.
"""

from __future__ import annotations

import math
from functools import partial
from typing import NamedTuple

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from touchdown.modelkit.integrators import dopri
from touchdown.modelkit.integrators.control import MAX_STEPS
from touchdown.modelkit.integrators.dopri import ALL_COORDINATES, StateParts, integrate, scratch
from touchdown.modelkit.kernel import kernel
from touchdown.modelkit.status import OK, STEP_UNDERFLOW, TOO_MANY_STEPS

A = np.array([
    [0, 0, 0, 0, 0, 0, 0],
    [dopri.A21, 0, 0, 0, 0, 0, 0],
    [dopri.A31, dopri.A32, 0, 0, 0, 0, 0],
    [dopri.A41, dopri.A42, dopri.A43, 0, 0, 0, 0],
    [dopri.A51, dopri.A52, dopri.A53, dopri.A54, 0, 0, 0],
    [dopri.A61, dopri.A62, dopri.A63, dopri.A64, dopri.A65, 0, 0],
    [dopri.B1, 0, dopri.B3, dopri.B4, dopri.B5, dopri.B6, 0],
])  # fmt: skip
B = A[6]
E = np.array([dopri.E1, 0, dopri.E3, dopri.E4, dopri.E5, dopri.E6, dopri.E7])
C = np.array([0, dopri.C2, dopri.C3, dopri.C4, dopri.C5, 1, 1])

ORDER_CONDITIONS = {  # by tree: order, elementary weight without b, one over the density
    "t": (1, np.ones(7), 1),
    "[t]": (2, C, 1 / 2),
    "[t,t]": (3, C**2, 1 / 3),
    "[[t]]": (3, A @ C, 1 / 6),
    "[t,t,t]": (4, C**3, 1 / 4),
    "[t,[t]]": (4, C * (A @ C), 1 / 8),
    "[[t,t]]": (4, A @ C**2, 1 / 12),
    "[[[t]]]": (4, A @ A @ C, 1 / 24),
    "[t,t,t,t]": (5, C**4, 1 / 5),
    "[t,t,[t]]": (5, C**2 * (A @ C), 1 / 10),
    "[[t],[t]]": (5, (A @ C) ** 2, 1 / 20),
    "[t,[t,t]]": (5, C * (A @ C**2), 1 / 15),
    "[t,[[t]]]": (5, C * (A @ A @ C), 1 / 30),
    "[[t,t,t]]": (5, A @ C**3, 1 / 20),
    "[[t,[t]]]": (5, A @ (C * (A @ C)), 1 / 40),
    "[[[t,t]]]": (5, A @ A @ C**2, 1 / 60),
    "[[[[t]]]]": (5, A @ A @ A @ C, 1 / 120),
}

# Slots of the diary that the kernels below write into; the last two are for the poisoned problem.
CALLS, ACCEPTED, LAST_TIME, DISORDER, COMPONENT, POISON_TIME = range(6)


@kernel
def observe(t, q, m):
    """Count accepted steps, and those whose time does not come after the one before."""
    m[ACCEPTED] += 1.0
    if not t > m[LAST_TIME]:
        m[DISORDER] += 1.0
    m[LAST_TIME] = t


@kernel
def swinging(t, q, dq, m):
    """Driven pendulum, smooth and nonlinear; q[2] is its clock, so that it may be cut into spans."""
    m[CALLS] += 1.0
    dq[0] = q[1]
    dq[1] = -math.sin(q[0]) + 0.3 * math.cos(2.0 * q[2])
    dq[2] = 1.0


@kernel
def poisoned(t, q, dq, m):
    """Unit slopes, but one component has none (NaN) from a certain time on."""
    m[CALLS] += 1.0
    for i in range(3):
        dq[i] = 1.0
    if t > m[POISON_TIME]:
        dq[int(m[COMPONENT])] = math.nan


@kernel
def gathering(t, q, dq, m):
    """A pendulum in q[4:], and two quadratures of it in q[:2]; what lies between is not in use."""
    m[CALLS] += 1.0
    dq[0], dq[1], dq[2], dq[3] = q[4] * q[5], t * q[4], 0.0, 0.0
    dq[4], dq[5] = q[5], -math.sin(q[4])


@kernel
def run_gathering(parts, m, q, n, weight, work, span, h, tolerance):
    """One span of `gathering`, the state in `StateParts`."""
    return integrate(gathering, observe, m, q, parts, n, weight, work, span, h, tolerance)


@kernel
def run_swinging(m, q, n, weight, work, span, h, tolerance):
    """One span of `swinging`."""
    return integrate(swinging, observe, m, q, ALL_COORDINATES, n, weight, work, span, h, tolerance)


@kernel
def run_poisoned(m, q, n, weight, work, span, h, tolerance):
    """One span of `poisoned`."""
    return integrate(poisoned, observe, m, q, ALL_COORDINATES, n, weight, work, span, h, tolerance)


class Outcome(NamedTuple):
    """What `integrate` returned, and its diary."""

    step: float
    status: int
    evaluations: int
    diary: np.ndarray


def advance(run, q, span, h, tolerance, weight=None, poison=(0, math.inf)) -> Outcome:
    """Advance `q` in place over `span` by the kernel `run`; the rest as `integrate` takes it."""
    diary = np.zeros(6)
    diary[COMPONENT], diary[POISON_TIME] = poison
    weights = np.ones(len(q)) if weight is None else np.array(weight)
    result = run(diary, q, len(q), weights, scratch(len(q)), span, h, tolerance)
    return Outcome(*result, diary)


def test_order_conditions():
    """All seventeen trees up to order five for the solution; up to order four for the estimate."""
    np.testing.assert_allclose(A.sum(axis=1), C, atol=1e-14)
    for tree, (order, weight, density) in ORDER_CONDITIONS.items():
        assert B @ weight == pytest.approx(density, abs=1e-14), tree
        assert order == 5 or E @ weight == pytest.approx(0.0, abs=1e-14), tree
    companion = [5179 / 57600, 0, 7571 / 16695, 393 / 640, -92097 / 339200, 187 / 2100, 1 / 40]
    np.testing.assert_allclose(E, B - companion, atol=1e-15)  # as printed in table 5.2


SWING_START = (1.0, 0.0, 0.0)


def swung(span: float) -> np.ndarray:
    """The driven pendulum after `span`, by another method and as exactly as doubles allow."""

    def rhs(t, q):
        return [q[1], -math.sin(q[0]) + 0.3 * math.cos(2.0 * t)]

    run = solve_ivp(rhs, (0.0, span), SWING_START[:2], method="DOP853", rtol=2.5e-14, atol=1e-15)
    return run.y[:, -1]


def error_of_equal_steps(steps: int, span: float) -> float:
    """Error after `span` in equal steps: each is a span of its own, and no error is too large."""
    q = np.array(SWING_START)
    for _ in range(steps):
        done = advance(run_swinging, q, span / steps, 1.0, 1e9)
        assert (done.status, done.evaluations) == (OK, 7)
    return float(np.linalg.norm(q[:2] - swung(span)))


def test_order_on_a_smooth_problem():
    """The error falls with the fifth power of the step."""
    steps = np.array([20, 28, 40, 56, 80, 112])
    errors = [error_of_equal_steps(int(n), 2.0) for n in steps]
    order = -np.polyfit(np.log(steps), np.log(errors), 1)[0]
    assert order == pytest.approx(5.0, abs=0.15)
    assert errors[-1] > 1e-13, "still above rounding, else the fit means nothing"


def test_error_follows_the_tolerance():
    """The error after a while is some tolerances large, and the work grows as their fifth root."""
    tolerances = 10.0 ** -np.arange(8.0, 13.0)
    work = []
    for tolerance in tolerances:
        q = np.array(SWING_START)
        done = advance(run_swinging, q, 20.0, 0.1, tolerance)
        assert done.status == OK
        error = np.linalg.norm(q[:2] - swung(20.0))
        assert 1.0 * tolerance < error < 20.0 * tolerance
        work.append(done.evaluations)
    slope = np.polyfit(np.log(tolerances), np.log(work), 1)[0]
    assert slope == pytest.approx(-0.2, abs=0.01)


@pytest.mark.parametrize(("h", "span"), [(1e-3, 1.0), (0.3, 0.7), (50.0, 1e-3)])
def test_span_is_hit_exactly(h, span):
    """The last accepted time is the span to the bit, and times only ever advance."""
    done = advance(run_swinging, np.array(SWING_START), span, h, 1e-7)
    assert done.status == OK
    assert done.diary[LAST_TIME] == span
    assert done.diary[DISORDER] == 0.0
    assert done.diary[ACCEPTED] >= 1.0


def test_evaluations_are_counted():
    """One to begin with, six a step (the last slope is the next first one), rejected steps included."""
    smooth = advance(run_swinging, np.array(SWING_START), 3.0, 0.01, 1e9)
    assert smooth.evaluations == smooth.diary[CALLS] == 1 + 6 * smooth.diary[ACCEPTED]
    too_bold = advance(run_swinging, np.array(SWING_START), 3.0, 3.0, 1e-6)
    assert too_bold.evaluations == too_bold.diary[CALLS]
    rejected = (too_bold.evaluations - 1) / 6 - too_bold.diary[ACCEPTED]
    assert rejected >= 1
    assert rejected == int(rejected)


@pytest.mark.parametrize("weights", [(0.0, 0.0), (1e3, 1e3), (0.0, 1e3)])
def test_quadratures_apart_are_the_same_to_the_bit(weights):
    """State, number of steps and the next one as where every component is a coordinate."""
    found = []
    for parts in (StateParts(2, 4), ALL_COORDINATES):
        q = np.array([0.0, 0.0, 0.0, 0.0, 1.0, 0.5])
        weight = np.array([*weights, 0.0, 0.0, 1.0, 1.0])
        run = partial(run_gathering, parts)
        found.append((*advance(run, q, 3.0, 0.1, 1e-7, weight=weight)[:3], q.tobytes()))
    assert found[0] == found[1]
    assert found[0][2] > 100


@pytest.mark.parametrize(("component", "when", "weight"), [(0, -1.0, 1.0), (1, 0.0, 0.0), (2, 0.5, 1.0)])
def test_nan_ends_in_underflow(component, when, weight):
    """Whichever slope is not a number, the step is refused until it underflows; the state stays clean."""
    q = np.zeros(3)
    weights = np.ones(3)
    weights[component] = weight
    done = advance(run_poisoned, q, 1.0, 0.1, 1e-6, weight=weights, poison=(component, when))
    assert done.status == STEP_UNDERFLOW
    assert np.all(np.isfinite(q))
    assert done.diary[LAST_TIME] <= max(when, 0.0)
    np.testing.assert_allclose(q, max(when, 0.0), atol=1e-9)
    assert done.evaluations < 10_000
    assert done.evaluations == done.diary[CALLS]


def test_a_span_too_long_is_given_up():
    """No more than a set number of steps is spent on one span."""
    done = advance(run_swinging, np.array(SWING_START), 1e8, 0.1, 1e-6)
    assert done.status == TOO_MANY_STEPS
    assert done.evaluations == 1 + 6 * MAX_STEPS
    assert 0.0 < done.diary[LAST_TIME] < 1e8
