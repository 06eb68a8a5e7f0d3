"""Friction coefficients: their signs, bounds and limits, and the peak of Makkar's curve."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from friction_records import prepared

from touchdown.bearings.contact import friction
from touchdown.modelkit.variables import as_record

KINDS = {"Coulomb": friction.COULOMB, "Stribeck": friction.STRIBECK, "Makkar": friction.MAKKAR}
EXACT = 1e-12  # of a coefficient's size: the exponentials in it are found to 3e-13
SPEEDS = np.concatenate(([1e-12, 1e-9], np.geomspace(1e-7, 100.0, 4001)))


def curve(law: friction.FrictionLaw, speeds: np.ndarray = SPEEDS) -> np.ndarray:
    """Coefficient over sliding speed, with what is derived filled in."""
    record = prepared(law)
    return np.array([friction.coefficient(v, record) for v in speeds])


@pytest.mark.parametrize("kind", KINDS.values(), ids=KINDS)
@pytest.mark.parametrize(("static", "dynamic"), [(0.15, 0.10), (0.10, 0.10)])
def test_every_curve_is_odd_bounded_and_ends_on_its_plateau(kind, static, dynamic):
    """Never above static friction, in fast slip dynamic friction; Makkar's viscous term comes on top."""
    law = friction.FrictionLaw(kind=kind, static=static, dynamic=dynamic)
    forward = curve(law)
    assert np.all(forward > 0.0)
    np.testing.assert_array_equal(curve(law, -SPEEDS), -forward)
    assert curve(law, np.zeros(1))[0] == 0.0
    viscous = law.g6 if kind == friction.MAKKAR else 0.0
    excess = forward - viscous * SPEEDS - static
    assert -0.5 * static < excess.max() <= 1e-12
    for speed in (2.0, 10.0):
        assert curve(law, np.array([speed]))[0] == pytest.approx(dynamic + viscous * speed, rel=1e-9)


def test_coulomb_is_the_regularised_step():
    """(2.13): dynamic tanh(slope v), and nothing of the static coefficient."""
    law = friction.FrictionLaw(kind=friction.COULOMB, slope=40.0)
    np.testing.assert_allclose(curve(law), 0.10 * np.tanh(40.0 * SPEEDS), rtol=0.0, atol=EXACT)


def test_stribeck_blends_static_into_dynamic():
    """Past the regularised rise friction is static; at the Stribeck speed 1/e of the excess is left."""
    law = friction.FrictionLaw(kind=friction.STRIBECK, slope=1e5, stribeck_speed=0.05)
    near, faded = curve(law, np.array([5e-4, 0.05]))
    assert near == pytest.approx(0.15, rel=1e-4)
    assert faded == pytest.approx(0.10 + 0.05 / math.e, rel=1e-12)
    assert np.all(np.diff(curve(law)[SPEEDS > 5e-4]) <= 0.0)


@pytest.mark.parametrize(
    ("static", "dynamic", "amplitude"), [(0.15, 0.10, 0.068943), (0.03, 0.02, 0.013786)]
)
def test_makkar_amplitude(static, dynamic, amplitude):
    """g1 for the source's two pairs of coefficients (its Fig 22), to the digits known."""
    law = prepared(friction.FrictionLaw(kind=friction.MAKKAR, static=static, dynamic=dynamic))
    assert law["g1"] == pytest.approx(amplitude, abs=0.5e-6)


def test_makkar_by_its_formula():
    """All six constants at their places."""
    g1, g2, g3, g4, g5, g6 = 0.07, 90.0, 8.0, 0.11, 60.0, 2e-3
    law = friction.FrictionLaw(kind=friction.MAKKAR, g1=g1, g2=g2, g3=g3, dynamic=g4, slope=g5, g6=g6)
    v = SPEEDS
    expected = g1 * (np.tanh(g2 * v) - np.tanh(g3 * v)) + g4 * np.tanh(g5 * v) + g6 * v
    np.testing.assert_allclose(curve(law), expected, rtol=0.0, atol=EXACT)


def test_no_peak_where_the_plateau_is_as_high():
    """Static no higher than dynamic leaves g1 at zero: the curve has no hump."""
    law = friction.FrictionLaw(kind=friction.MAKKAR, static=0.08, dynamic=0.10)
    assert prepared(law)["g1"] == 0.0
    assert friction.makkar_amplitude(as_record(replace(law, static=0.10))) == 0.0
    values = curve(law)
    assert np.all(np.diff(values) >= 0.0)
    assert values.max() > 0.10


def refusal(law: friction.FrictionLaw, usual: float) -> str | None:
    """What is wrong with a law whose static coefficient is `usual` by default, or None."""
    told = np.zeros(4)
    number = friction.law_problem(as_record(law), usual, told)
    return friction.law_problems("friction")[number - 1].format(*told) if number else None


@pytest.mark.parametrize(
    ("static", "dynamic", "refused"),
    [(0.15, 0.1, False), (0.15, 0.27, False), (0.27, 0.27, False), (0.3, 0.1, True), (0.0, 0.1, True)],
)
def test_coulomb_has_no_static_coefficient(static, dynamic, refused):
    """One that was set and says otherwise is refused; the default beside any dynamic one is not."""
    found = refusal(friction.FrictionLaw(friction.COULOMB, static, dynamic), 0.15)
    assert (found is not None) == refused
    if found:
        assert f"friction.static = {static:g} does nothing" in found
    for kind in (friction.STRIBECK, friction.MAKKAR):
        assert refusal(friction.FrictionLaw(kind, static, dynamic), 0.15) is None


def test_each_law_has_its_own_default():
    """0.03 is what a ball has, and no sign of having been set; 0.15 is."""
    assert refusal(friction.FrictionLaw(friction.COULOMB, 0.03, 0.01), 0.03) is None
    assert "friction.static = 0.15" in str(
        refusal(friction.FrictionLaw(friction.COULOMB, 0.15, 0.01), 0.03)
    )


def test_makkar_needs_a_steeper_rise():
    """Both exponentials fall on each other where g2 is g3."""
    assert "g2 = 10 s/m must be above friction.g3 = 10 s/m" in str(
        refusal(friction.FrictionLaw(g2=10.0), 0.15)
    )


def test_an_amplitude_out_of_proportion_does_not_exist():
    """g2 a hair above g3: no g1 below a hundred times the static coefficient."""
    assert math.isnan(prepared(friction.FrictionLaw(g2=10.01, g3=10.0))["g1"])
