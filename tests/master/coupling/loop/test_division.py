"""Macro steps in which two bearings hit a rotor: which they are, and what dividing them is good for."""

from __future__ import annotations

import numpy as np
import pytest

from touchdown.master.common.errors import TouchdownError
from touchdown.master.coupling.loop.division import NO_CONTACT_TIME, ImpactSubsteps
from touchdown.master.coupling.loop.kernels.signal_exchange import IMPACT_S, SEAT, met
from touchdown.master.coupling.simulation import Outcome, opened, simulate
from touchdown.master.coupling.steppers import stepper
from touchdown.master.scene.file import load_scene
from touchdown.modelkit.ports import PARTING_TOLERANCE

STEP = 2e-5  # s
FAR, NEAR = 1.0, 0.0  # s, until the journal touches


def divided(reaches: list[tuple[float, ...]], bodies: tuple[int, ...] = (0, 0)) -> list[bool]:
    """Which macro steps are divided where the bearings on `bodies` say so step by step."""
    seats = np.array([(i, body, NO_CONTACT_TIME, NO_CONTACT_TIME) for i, body in enumerate(bodies)], SEAT)
    return [met(seats, np.array(told), number * STEP, STEP) for number, told in enumerate(reaches)]


def test_two_bearings_that_are_hit_at_once() -> None:
    assert divided([(FAR, FAR), (NEAR, FAR), (NEAR, NEAR), (NEAR, NEAR)]) == [False, False, True, True]


def test_a_touch_that_is_about_to_come_counts() -> None:
    assert divided([(NEAR, 3.0 * STEP), (NEAR, 1.5 * STEP)]) == [False, True]


def test_bearings_of_different_bodies_do_not_meet() -> None:
    assert divided([(NEAR, NEAR)] * 3, bodies=(0, 1)) == [False] * 3
    assert divided([(NEAR, NEAR, NEAR)] * 2, bodies=(0, 1, 0)) == [True] * 2


def test_contacts_that_last_are_no_impacts() -> None:
    lasting = round(IMPACT_S / STEP) + 2
    found = divided([(NEAR, NEAR)] * lasting)
    assert found[: lasting - 3] == [True] * (lasting - 3)
    assert not found[-1]


def test_a_ring_that_rattles_is_not_hit_anew_and_one_that_was_free_is() -> None:
    lasting, free = round(IMPACT_S / STEP) + 2, round(PARTING_TOLERANCE / STEP)
    rattling = [(NEAR, NEAR)] * lasting + [(NEAR, FAR)] * (free - 2) + [(NEAR, NEAR)]
    parted = [(NEAR, NEAR)] * lasting + [(NEAR, FAR)] * (free + 2) + [(NEAR, NEAR)]
    assert not divided(rattling)[-1]
    assert divided(parted)[-1]


def test_into_how_many_parts(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of 20 us; FMUs of one step length, longer steps and schemes that go elsewhere are not divided."""
    scene = load_scene("rotor1-9000")
    with opened(scene, in_process=True) as system:
        system.initialise()

        def parts(**run: object) -> int:
            changed = scene.set({f"run.{key}": value for key, value in run.items()})
            return ImpactSubsteps(stepper(system, changed.run)).parts

        assert [parts(), parts(impact_step="3 us")] == [40, 14]
        assert {parts(impact_step=0.0), parts(impact_step="1 ms")} == {1}
        assert {parts(scheme="jacobi-lead"), parts(scheme="halving")} == {1}
        for step in (1e-320, 1e-12):
            with pytest.raises(TouchdownError, match="more than 100000 parts"):
                parts(impact_step=step)
        monkeypatch.setattr(system.components["housing_A"], "any_step", False)
        assert parts() == 1
    longer = scene.set({"bearing_A.every": 2})
    with opened(longer, in_process=True) as system:
        system.initialise()
        assert ImpactSubsteps(stepper(system, longer.run)).parts == 1


def test_one_bearing_alone_is_not_watched() -> None:
    with opened(load_scene("disk-caged-simplified"), in_process=True) as system:
        assert system.hit_together == ()
        assert "bearing.contact.reach" not in system.position


# -- what it is good for -------------------------------------------------------------------------------

DROP = {
    "rotor.unbalance_angle": "216 deg",
    "run.duration": "8 ms",
    "bearing_A.micro_step": 0.0,
    "bearing_B.micro_step": 0.0,
}


def peak_and_outcome(step: str, impact_step: object) -> tuple[float, Outcome]:
    """Peak force (N) of the contact at A; its error does not come from steps inside the bearings."""
    scene = load_scene("rotor1-9000").set(DROP | {"run.macro_step": step, "run.impact_step": impact_step})
    with opened(scene, in_process=True) as system:
        outcome = simulate(scene, system)
        return system.value("bearing_A.contact.peak_force"), outcome


def test_peaks_of_two_impacts_at_once() -> None:
    """A drop in which whole steps of 20 us are 5.2 % off, by how rings rattle within them.

    Divided steps are 0.1 % off; the limit leaves room for rounding, which the rattle makes much of.
    """
    right, _ = peak_and_outcome("1 us", 0.0)
    whole, none = peak_and_outcome("20 us", 0.0)
    fine, some = peak_and_outcome("20 us", "1 us")
    assert none.divided_in_impacts == 0
    assert 0 < some.divided_in_impacts < 0.1 * some.steps
    assert some.steps == none.steps
    assert abs(whole / right - 1.0) > 0.02
    assert abs(fine / right - 1.0) < 0.01
