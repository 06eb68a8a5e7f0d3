"""Peaks between samples, against impacts whose peak is known, and where samples are no parabola."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from touchdown.bearings.contact.journal import ContactMemory, ContactReport, Touched, watch_contact
from touchdown.bearings.contact.peaks import Samples, crest
from touchdown.modelkit.ports import PARTING_TOLERANCE, Motion
from touchdown.modelkit.variables import as_record, as_tuple, layout

PHASES = np.linspace(0.0, 1.0, 41)
STEPS = {0.2: 0.01, 0.4: 0.12, 0.6: 0.6, 0.8: 1.7}  # h w: error at most, %, as the module's docstring says


def memory_of(kind: type) -> np.void:
    """A writable record, as a model starts with."""
    return np.array([as_tuple(kind())], layout(kind))[0]


def highest(times, values, places=None) -> float:
    """The largest crest of a series of samples."""
    samples = memory_of(Samples)
    places = np.zeros(len(times), int) if places is None else places
    return max(crest(samples, t, f, b) for t, f, b in zip(times, values, places, strict=True))


def sampled(step: float, phase: float, end: float) -> np.ndarray:
    """Instants from before an impact at 0 to behind its `end`."""
    return np.arange(-3.0 + phase, end / step + 3.0) * step


@pytest.fixture(scope="module")
def hertz_impact():
    """The same with Hertz's law F = d^1.5: (force over its peak, of w t; end of the contact).

    Depth (5/4)^(2/5) at the turn, from the energy; w is that of small swings there.
    """
    depth = 1.25**0.4
    frequency = math.sqrt(1.5 * math.sqrt(depth))

    def rhs(_, y):
        return y[1], -(max(y[0], 0.0) ** 1.5)

    motion = solve_ivp(rhs, (0.0, 6.0), (0.0, 1.0), rtol=1e-10, atol=1e-12, dense_output=True).sol

    def force(t):
        return np.where(t > 0.0, np.maximum(motion(np.clip(t / frequency, 0.0, 6.0))[0], 0.0) ** 1.5, 0.0)

    return (lambda t: force(t) / depth**1.5), 5.0


@pytest.mark.parametrize("step", STEPS)
def test_peak_of_a_hertz_impact(hertz_impact, step):
    """k d^1.5 with d = (5/4 m v^2/k)^(2/5), at most and on the average."""
    force, end = hertz_impact
    errors = []
    for phase in PHASES:
        times = sampled(step, phase, end)
        errors.append(100.0 * abs(highest(times, force(times)) - 1.0))
    assert max(errors) < STEPS[step]
    assert np.mean(errors) < 0.45 * STEPS[step]


def test_a_parabola_is_found_exactly():
    """To rounding, with unequal steps."""
    times = np.array([0.0, 0.3, 1.0, 1.2])
    assert highest(times, 5.0 - (times - 0.55) ** 2) == pytest.approx(5.0, rel=1e-15)


def test_a_sliver_makes_no_peak():
    """A step of a billionth of the one before, over which the force jumps a little, as at a restart."""
    times = np.array([0.0, 1.0, 1.0 + 1e-9, 2.0, 3.0])
    assert highest(times, np.array([1.0, 2.0, 2.001, 1.9, 1.0])) < 2.2


def test_no_parabola_over_two_balls():
    """The largest force passes from one ball to the next: the samples are all that is known."""
    times = np.arange(3.0)
    values = np.array([1.0, 2.0, 1.8])
    assert highest(times, values) > 2.0
    for places in ([0, 0, 1], [0, 1, 1], [0, 1, 0]):
        assert highest(times, values, np.array(places)) == 2.0


def test_no_parabola_where_contact_begins_or_ends():
    """A force that jumps up at the touch and fades, as linear damping has it, is not overshot."""
    times = np.arange(-2.0, 12.0)
    values = np.where(times >= 0.0, np.exp(-0.1 * times), 0.0)
    assert highest(times, values) == 1.0
    assert highest(times, values[::-1]) == 1.0


def test_the_first_impact_outlasts_a_rattle():
    """A ring that parts from the journal for less than PARTING_TOLERANCE does not end it; a bounce does."""
    report, memory = memory_of(ContactReport), memory_of(ContactMemory)
    step = 1e-5

    def watch(first, last, indentation):
        for number in range(first, last):
            touched = as_record(Touched(max(indentation, 0.0), indentation, 0.0))
            watch_contact(number * step, Motion(0.0, 0.0, 0.0, 0.0, 0.0), touched, report, memory)

    free = round(PARTING_TOLERANCE / step)
    watch(0, 5, -1.0)
    watch(5, 9, 1.0)
    watch(9, 8 + free, -1.0)
    assert report["over_time"] < 0.0
    watch(8 + free, 40, 2.0)
    watch(40, 40 + free + 2, -1.0)
    over = float(report["over_time"])
    assert over == pytest.approx((40 + free) * step, abs=1.5 * step)
    watch(200, 210, 3.0)
    assert report["over_time"] == over
