"""What kernels derive of the parameters, against scipy's solvers over random parameter sets."""

from __future__ import annotations

import math
import subprocess
import sys
from typing import Any

import numpy as np
import pytest
from scipy_constants import REFERENCES, angles, imbalance

from touchdown.fmus.recipes import recipe
from touchdown.modelkit.instance import Instance
from touchdown.modelkit.model import ModelError
from touchdown.modelkit.variables import Scalar, from_record

SETS = 20  # of each bearing
CHOICES: dict[str, list[float]] = {
    "balls.play": [0.0, 5e-6, 20e-6, -5e-6],
    "balls.outer_conformity": [0.0, 1.001, 1.06, 1.8],
    "balls.first_angle": [-0.5 * math.pi, 0.3, 7.0],
    "balls.rows": [1, 2, 8],
    "balls.damping_ratio": [0.0, 0.02, 0.4],
    "balls.bunching": [0.0, 0.0, 0.5, 1.0],
    "contact.damping_ratio": [0.0, 0.1],
    "contact.mass": [0.0, 1.65],
    "cage.inertia": [0.0, 1e-6],
    "micro_step": [0.0, 5e-7, 2.5e-6, 1e-5],
}
DRAWN = ("kind", "hertz", "slip", "corrected_pitch")
SPREAD = 0.3  # standard deviation of the logarithm of all other parameters over their defaults
NUMBERS = 1e-12  # relative; scipy's brentq is asked for 1e-15, on a peak known to 1e-16
AMPLITUDE = 1e-13  # absolute, of g1: the same beside coefficients of friction of about 0.1


def draw(instance: Instance, rng: np.random.Generator) -> None:
    """Random parameters within their bounds."""
    drawn: dict[str, float] = {}
    for slot in instance.slots:
        name, spec = slot.variable.name, slot.variable.spec
        if slot.causality != "parameter":
            continue
        value = slot.variable.default
        if name in CHOICES:
            value = rng.choice(CHOICES[name])
        elif name == "balls.count":
            value = rng.integers(5, 33)
        elif name.endswith(DRAWN) and spec.kind is Scalar.INTEGER:
            value = rng.integers(int(spec.minimum or 0), int(spec.maximum or 0) + 1)
        elif spec.kind is Scalar.REAL and not name.endswith(("static", "dynamic")):
            value *= math.exp(SPREAD * rng.normal())
            value = value if spec.maximum is None else min(value, spec.maximum)
        drawn[name] = value
        store = instance.reals if spec.kind is Scalar.REAL else instance.integers
        store[slot.index] = float(value) if spec.kind is Scalar.REAL else int(value)
    p = instance.record["p"]
    if "balls" in p.dtype.names:  # they fit
        b = p["balls"]
        b["conformity"] = 1.0 + 10.0 ** rng.uniform(-3.0, 0.0)
        b["pitch_diameter"] = 1.01 * b["diameter"] / math.sin(math.pi / b["count"]) * rng.uniform(1.0, 1.5)


def members(record: Any, prefix: str = "") -> dict[str, Any]:
    """The values of a record by dotted names."""
    found: dict[str, Any] = {}
    for name in record.dtype.names:
        value = record[name]
        group = getattr(value, "dtype", None) is not None and value.dtype.names
        found |= members(value, f"{prefix}{name}.") if group else {f"{prefix}{name}": value}
    return found


def random_cases(name: str) -> list[Instance]:
    """Instances of random parameters, derived; those that are refused are left out."""
    rng = np.random.default_rng(15)
    cases = []
    for _ in range(SETS):
        instance = Instance(recipe(name).model)
        draw(instance, rng)
        if instance.model.derive(instance.words) == 0:
            cases.append(instance)
    assert len(cases) > SETS / 3
    return cases


@pytest.mark.parametrize("name", REFERENCES)
def test_constants_are_those_that_scipy_finds(name: str) -> None:
    for instance in random_cases(name):
        p = from_record(instance.model.parameters, instance.record["p"])
        found = members(instance.record["d"])
        for key, expected in REFERENCES[name](p).items():
            value = np.ravel(found[key])[: np.size(expected)]
            exact = pytest.approx(
                np.ravel(expected), rel=NUMBERS, abs=AMPLITUDE if key.endswith("g1") else 0.0
            )
            assert value == exact, key


@pytest.mark.parametrize("name", [name for name in REFERENCES if name != "bushing"])
def test_the_ring_rests_where_forces_balance(name: str) -> None:

    for instance in random_cases(name):
        p, d = from_record(instance.model.parameters, instance.record["p"]), instance.record["d"]
        place, weight = (float(d["rest_x"]), float(d["rest_y"])), p.ring.mass * p.gravity
        depth = (weight / (p.balls.rows * d["stiffness"]["series"])) ** (2.0 / 3.0)
        if place == (0.0, 0.0):  # no ball within a quarter turn of the bottom on one of its sides
            assert np.max(np.diff(np.sort(angles(p.balls) % (2.0 * math.pi)))) > 0.5 * math.pi
            continue
        rounding = NUMBERS * (1.0 + abs(p.balls.play) / depth)
        assert np.max(np.abs(imbalance(p.balls, weight)(place))) < rounding


@pytest.mark.parametrize("name", ["simplified_cageless", "detailed_cageless"])
def test_a_ring_that_no_ball_holds_starts_in_the_middle(name: str) -> None:
    """Three balls side by side at the top."""
    instance = Instance(recipe(name).model)
    b = instance.record["p"]["balls"]
    b["count"], b["first_angle"], b["bunching"] = 3, 0.5 * math.pi, 1.0
    instance.start(0.0)
    assert (instance.record["d"]["rest_x"], instance.record["d"]["rest_y"]) == (0.0, 0.0)


@pytest.mark.parametrize(
    ("name", "parameter", "value", "says"),
    [
        ("bushing", "friction.g2", 10.0001, "it cannot start (friction.g1 is not a finite number)"),
        ("simplified_caged", "balls.density", 1e308, "it cannot start (mass is not a finite number)"),
        ("detailed_caged", "cage.mass", 1e-320, "it cannot start (cage_answer is not a finite number)"),
    ],
)
def test_a_constant_that_does_not_exist_is_named(
    name: str, parameter: str, value: float, says: str
) -> None:
    instance = Instance(recipe(name).model)
    slot = next(s for s in instance.slots if s.variable.name == parameter)
    instance.reals[slot.index] = value
    with pytest.raises(ModelError) as error:
        instance.start(0.0)
    assert says in str(error.value)
    assert "out of all proportion" in str(error.value)


def test_parameters_are_no_different_after_others_were_refused() -> None:
    """Constants of a refused set do not stay behind."""
    instance = Instance(recipe("simplified_caged").model)
    instance.start(0.0)
    good, constants = instance.save(), instance.memory["d"].tobytes()
    instance.record["p"]["race_friction"]["g2"] = 5.0
    bad = instance.save()
    instance.restore(bad)
    with pytest.raises(ModelError, match=r"race_friction\.g2 = 5 s/m must be above"):
        instance.step(0.0, 2e-5)
    instance.restore(good)
    instance.step(0.0, 2e-5)
    assert instance.memory["d"].tobytes() == constants


def test_a_saved_state_out_of_bounds_is_refused() -> None:
    """Kernels count on bounds: a thousand balls have no room."""
    instance = Instance(recipe("detailed_cageless").model)
    instance.record["p"]["balls"]["count"] = 1000
    state = instance.save()
    other = Instance(recipe("detailed_cageless").model)
    other.start(0.0)
    other.restore(state)
    with pytest.raises(ModelError, match=r"balls\.count = 1000 must be at most 32"):
        other.step(0.0, 2e-5)


def test_no_solver_of_scipy_is_loaded_at_the_start() -> None:
    """numba loads its linear algebra, for itself."""
    script = """
import sys
from touchdown.bearings import bushing, detailed_caged
from touchdown.modelkit.instance import Instance
for model in (bushing.MODEL, detailed_caged.MODEL):
    Instance(model).start(0.0)
print([name for name in ("scipy.optimize", "scipy.special", "scipy.sparse") if name in sys.modules])
"""
    left = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert left.stdout.strip() == "[]"
