"""A running instance of every model: what its saved state holds, and where it can be restored."""

from __future__ import annotations

import numpy as np
import pytest
from slave_driver import TOUCHING

from touchdown.fmus.recipes import fmu_names, recipe
from touchdown.modelkit.instance import Instance
from touchdown.modelkit.model import Model, ModelError, slots

STEP = 2e-5  # s
every_model = pytest.mark.parametrize(
    "name", [name for name in fmu_names() if name not in ("rotor_II", "compressor_rotor")]
)


def started(model: Model, factor: float = 1.0) -> Instance:
    """With all real parameters times `factor`, within their bounds; a bearing's journal is in contact."""
    found = Instance(model)
    for slot in slots(model):
        if slot.causality == "parameter" and slot.variable.spec.kind == "real":
            highest = slot.variable.spec.maximum
            scaled = found.reals[slot.index] * factor
            found.reals[slot.index] = scaled if highest is None else min(scaled, highest)
        elif slot.causality == "input" and slot.variable.name in TOUCHING:
            found.reals[slot.index] = TOUCHING[slot.variable.name]
    found.start(0.0)
    return found


def run(instance: Instance, first: int, count: int) -> bytes:
    """Some macro steps; the whole memory at their end."""
    for k in range(first, first + count):
        instance.step(k * STEP, STEP)
    return instance.memory.tobytes()


@every_model
def test_a_state_goes_on_in_any_instance_of_its_model(name: str) -> None:
    """To the last bit: where it was, in one that was never started, in one of other parameters."""
    model = recipe(name).model
    origin = started(model)
    run(origin, 0, 4)
    state = origin.save()
    expected = run(origin, 4, 6)
    other = started(model, 1.01)
    assert run(other, 0, 4) != expected
    for instance in (origin, Instance(model), other):
        instance.restore(state)
        assert instance.save() == state
        assert run(instance, 4, 6) == expected
    other.start(0.0)
    assert run(other, 0, 4) == run(started(model), 0, 4)


def test_constants_that_follow_from_the_parameters_are_not_saved() -> None:
    """Of a flexible rotor they are nine tenths."""
    instance = started(recipe("rotor_I").model)
    before = instance.memory.nbytes - len(instance.save())
    assert before == instance.memory["d"].nbytes + instance.memory["message_numbers"].nbytes
    assert before > 0.9 * instance.memory.nbytes


def test_constants_are_derived_again_only_for_other_parameters() -> None:
    """Rollback at every macro step costs no more than copying."""
    model = recipe("rotor_I").model
    instance, other = started(model), started(model, 1.01)
    marked = instance.record["d"]["mass"] = 17.0  # derived again it would be the rotor's
    instance.restore(instance.save())
    instance.step(0.0, STEP)
    assert instance.record["d"]["mass"] == marked
    instance.restore(other.save())
    instance.step(0.0, STEP)
    assert instance.memory["d"].tobytes() == other.memory["d"].tobytes()


def test_a_state_with_parameters_that_cannot_be_says_so() -> None:
    """Saved before they were checked, and stepped without a start."""
    model = recipe("rotor_I").model
    unchecked, instance = Instance(model), started(model)
    unchecked.record["p"]["modes"] = 1
    instance.restore(unchecked.save())
    with pytest.raises(ModelError, match="modes = 1 must be"):
        instance.step(0.0, STEP)


@pytest.mark.parametrize(
    ("name", "field"), [("bushing", "x"), ("simplified_caged", "vy"), ("amb", "ax_free")]
)
def test_a_mode_whose_motion_is_not_finite_is_named(name: str, field: str) -> None:
    """Of those that the journal has; what stands in places not in use is not read."""
    instance = Instance(recipe(name).model)
    modes = instance.record["u"]["journal"]["mode"]
    modes[0]["inv_m"], modes[0]["k_over_m"] = 0.3, 1e8
    instance.record["u"]["journal"]["inv_m"] = 1.0
    instance.start(0.0)
    modes[1][field] = np.nan
    instance.step(0.0, STEP)
    modes[0][field] = np.nan
    with pytest.raises(ModelError, match=rf"input journal\.mode\[1\]\.{field} is nan"):
        instance.step(STEP, STEP)
