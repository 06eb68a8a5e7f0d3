"""The order at which every scheme errs is the one its derivation gives, smooth or through an impact.

A rotor with unbalance on two springs without damping: one stiff magnetic bearing, and beside it another
one (smooth) or a bushing that it strikes (impact). Within a macro step of length H, motion that is held
is wrong by v s after the time s, extrapolated motion by a s^2/2 and a' s^3/6, and the load with it; a mean
load without slope moves a body wrongly by H^2 F'/(12 m). A load that is one step late is wrong by H F'.
The interface model only misses how the other bearing's load changes, by s^3/6 of its rate again; a
parabola through both ends misses s^2 (s - H) x'''/6.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from systems import rotor_on

from touchdown.master.coupling.simulation import open_system, simulate
from touchdown.master.scene.run_spec import RunSpec
from touchdown.master.scene.scene import ComponentSpec, Scene
from touchdown.master.scene.schemes import SCHEMES
from touchdown.studies.drop.monolithic import Monolith

FINE = 1e-13  # tolerance of micro-steps
SPRING = {"damping": 0.0, "shutdown_time": 1.0, "force_limit": 1e6, "interface.tolerance": FINE}
ELASTIC = {
    "contact.stiffness": 1e7,
    "contact.exponent": 1.0,
    "contact.damping": 0.0,
    "friction.dynamic": 0.0,
    "friction.static": 0.0,
    "friction.g6": 0.0,
    "interface.tolerance": FINE,
}
MOTION = ["rotor.A.x", "rotor.A.y", "rotor.A.vx", "rotor.A.vy"]
WEIGHT = np.array([1.0, 1.0, 2e-4, 2e-4])  # a velocity counts as its motion over a tenth of the swing
END = 2e-3  # s; the impact begins after 0.6 ms and is over before
WITH_ORDER = [name for name, scheme in SCHEMES.items() if scheme.error_order]
CLEARANCES = 12e-6 + 0.11e-6 * np.arange(6)  # m; the impact falls into different places of a macro step


def scene(clearance: float | None, scheme: str, step: float) -> Scene:
    """The rotor between two springs, or a spring and a bushing."""
    rotor = {"mass": 1.65, "eccentricity": 50e-6, "speed": 1500.0}
    other = ComponentSpec("amb", {"stiffness": 5e6, **SPRING})
    if clearance is not None:
        other = ComponentSpec("bushing", {"clearance": clearance, **ELASTIC})
    return Scene(
        "test",
        "test",
        {
            "rotor": ComponentSpec("rigid_rotor", rotor),
            "amb": ComponentSpec("amb", {"stiffness": 2e7, **SPRING}),
            "other": other,
        },
        attach=(("other.journal", "rotor.A"), ("amb.journal", "rotor.amb")),
        run=RunSpec(
            duration=END, macro_step=step, scheme=SCHEMES[scheme], tolerance=1e-16, stop_residual=1e9
        ),
    )


@cache
def exact(clearance: float | None) -> np.ndarray:
    """Motion at the end, solved as one system of equations."""
    solution = Monolith(scene(clearance, "hold", 1e-5)).solve(np.array([END]), MOTION, 1e-12, "DOP853")
    return np.array([solution.series[name][-1] for name in MOTION])


def error(clearance: float | None, scheme: str, step: float) -> float:
    """Distance from it (m)."""
    setting = scene(clearance, scheme, step)
    system = open_system(setting, in_process=True)
    outcome = simulate(setting, system)
    assert not outcome.reason
    found = np.array([system.value(name) for name in MOTION])
    return float(np.linalg.norm((found - exact(clearance)) * WEIGHT))


def order(errors: list[float], steps: tuple[float, ...]) -> float:
    """Slope of the errors over the steps, both logarithmic."""
    return float(np.polyfit(np.log(steps), np.log(errors), 1)[0])


def steps_for(scheme: str) -> tuple[float, ...]:
    """Those of the first order err so much that the motion itself changes with long steps."""
    return (2.5e-6, 5e-6, 1e-5) if SCHEMES[scheme].error_order == 1 else (2e-5, 4e-5, 8e-5)


@pytest.mark.parametrize("scheme", WITH_ORDER)
def test_order_of_a_smooth_motion(scheme: str) -> None:
    steps = steps_for(scheme)
    found = order([error(None, scheme, step) for step in steps], steps)
    assert found == pytest.approx(SCHEMES[scheme].error_order, abs=0.15)


@pytest.mark.parametrize("scheme", WITH_ORDER)
def test_order_through_an_impact(scheme: str) -> None:
    steps = steps_for(scheme)
    errors = [
        float(np.sqrt(np.mean([error(clearance, scheme, step) ** 2 for clearance in CLEARANCES])))
        for step in steps
    ]
    assert order(errors, steps) == pytest.approx(SCHEMES[scheme].error_order, abs=0.15)


def test_spin_is_repeated_as_displacement_is() -> None:
    """A light rotor braked by friction that depends on its spin: the moment within the step matters."""
    braked = {"mass": 1.65, "inertia": 1e-6, "speed": 2.0, "y": -0.302e-3}
    friction = {"friction.kind": 0, "friction.static": 0.2, "friction.dynamic": 0.2, "friction.slope": 10.0}

    def spin(scheme: str, step: float) -> float:
        found = rotor_on(
            "bushing",
            braked,
            ELASTIC | friction,
            duration=4e-4,
            macro_step=step,
            scheme=scheme,
            tolerance=1e-16,
        )
        system = open_system(found, in_process=True)
        assert not simulate(found, system).reason
        return system.value("rotor.A.omega")

    exact = spin("interface", 1e-6)
    steps = (1e-5, 2e-5, 4e-5)
    assert order([abs(spin("iterated", step) - exact) for step in steps], steps) > 1.7


def test_halving_errs_as_its_tolerance_says() -> None:
    """The error falls with the tolerance, nearly in proportion, whatever the macro step."""
    errors = []
    for tolerance in (1e-9, 1e-12):
        given = scene(None, "halving", 1e-4)
        given = replace(given, run=replace(given.run, tolerance=tolerance))
        system = open_system(given, in_process=True)
        assert not simulate(given, system).reason
        found = np.array([system.value(name) for name in MOTION])
        errors.append(float(np.linalg.norm((found - exact(None)) * WEIGHT)))
    assert errors[0] < 1e-8
    assert errors[1] < 0.05 * errors[0]
