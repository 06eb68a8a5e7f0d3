"""What a verdict rests on: the phase of the contact force, the turns, and what the screen says of them."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from orbits import CLEARANCE, FRICTION, Made, after_one_another, circle, over_the_top, pendulum, star, turns

from touchdown.master.coupling.connections import Attachment
from touchdown.master.results.final_state import FinalState
from touchdown.master.results.whirl.contacts import Orbit
from touchdown.master.results.whirl.evidence import evidence, hint
from touchdown.master.results.whirl.verdict import (
    TOO_COARSE,
    force_phase,
    has_verdict,
    recorded_too_coarsely,
)

SLIDING = math.atan(FRICTION)
STANDS_OFF = replace(circle(-60.0, centre=0.4 - 0.2j), bore=0.4 - 0.2j)
HIGHEST = math.sqrt(4.0 * 9.81 / CLEARANCE)  # rad/s at the bottom, of a pendulum that just reaches the top


class Unbalanced(FinalState):
    """A rotor in a bearing, as far as a hint asks for it."""

    def __init__(self) -> None:
        super().__init__({}, [Attachment("bearing", "journal", "rotor", "A")], [])

    def __contains__(self, name: str) -> bool:
        return name == "rotor.unbalance_angle"


Seat = dict[str, Any]


def phases(made: Made, factor: complex = 1.0) -> list[float | None]:
    """Phase (rad) of the force, turned by a factor, in each whirl of an orbit."""
    orbit = Orbit(made.time, CLEARANCE * np.real(made.z), CLEARANCE * np.imag(made.z), CLEARANCE)
    force = factor * (made.force[0] + 1j * made.force[1])
    whirls = made.judged().episodes
    return [force_phase(orbit, (np.real(force), np.imag(force)), e, made.spin) for e in whirls]


@pytest.mark.parametrize(
    ("made", "phase"),
    [
        (circle(-80.0), SLIDING),
        (circle(-80.0).spinning(-900.0), -SLIDING),
        (circle(-140.0, rate=2e3), SLIDING),
        (circle(-90.0, 1.04).noisy(0.004, 7), SLIDING),
        (star(130.0, 45.0), -SLIDING),
        (STANDS_OFF, SLIDING),
        (turns(1.3, -50.0), SLIDING),
    ],
)
def test_friction_drives_a_backward_whirl_and_brakes_a_forward_one(made: Made, phase: float) -> None:
    (found,) = phases(made)
    assert found == pytest.approx(phase, abs=0.02)


def test_each_whirl_has_its_own_phase() -> None:
    made = after_one_another((0.3, 60.0), (0.2, 0.0), (0.3, -60.0))
    assert phases(made) == [pytest.approx(-SLIDING, abs=0.01), pytest.approx(SLIDING, abs=0.01)]


def test_the_size_of_the_force_does_not_count_but_its_direction_does() -> None:
    made = circle(-80.0)
    assert phases(made, 1e-3) == pytest.approx(phases(made))
    assert phases(made, np.exp(0.1j)) == [pytest.approx(SLIDING + 0.1, abs=1e-3)]


def test_without_a_force_there_is_no_phase() -> None:
    assert phases(circle(-80.0), 0.0) == [None]


@pytest.mark.parametrize(
    ("made", "marched"),
    [
        (turns(3.0, -50.0), 3.0),
        (turns(0.1, 50.0), 0.1),
        (pendulum(200.0), 200.0 / 180.0),
        (circle(60.0), 30.0),
        (over_the_top(300.0), 2.0 * math.asin(300.0 / HIGHEST) / math.pi),
        (circle(60.0, 0.8), 0.0),
    ],
)  # fmt: skip
def test_how_far_contacts_went_one_way(made: Made, marched: float) -> None:
    assert made.judged().marched == pytest.approx(marched, abs=0.02)


def told(words: str, turns: float, marched: float, phase: float | None = None) -> str:
    """What the screen says of a seat."""
    (line,) = evidence({"seats": {"A": whirl(words, turns, marched, phase)}})
    return line


def whirl(
    words: str | None, turns: float | None, marched: float | None, phase: float | None = None
) -> Seat:
    """A seat's verdict; phase: deg."""
    return {
        "whirl": words,
        "whirl_revolutions": turns,
        "whirl_force_phase": phase and math.radians(phase),
        "most_turns_one_way": marched,
    }


def test_the_screen_says_what_a_verdict_rests_on() -> None:
    assert told("backward whirl, still so at the end", 18.18, 18.18, 3.54) == (
        "A: backward whirl, still so at the end: the contact went round 18.2 times, and its force "
        "drives it by 3.5 deg"
    )
    assert told("transient forward whirl", 3.0, 3.0, -8.5).endswith("and its force brakes it by 8.5 deg")
    assert told("transient forward whirl", 3.0, 3.0, 0.4).endswith("went round 3 times")
    assert told("transient forward whirl", 3.0, 3.0).endswith("went round 3 times")
    assert told("pendulum", 0.0, 0.187) == (
        "A: pendulum: the contact swung either way by 10 deg or more; it went 0.19 of a turn one "
        "way at most, and a whirl takes 1"
    )
    assert "1.4 turns one way at most and back, or with rests, and a whirl" in told("pendulum", 0.0, 1.4)


def test_what_swings_not_is_no_pendulum_however_far_it_goes() -> None:
    """And what is short of a turn is never told as one, in the words or beside them."""
    line = told("no whirl, short of one turn: 0.99 turn backward", 0.0, 0.997)
    assert "did not swing to both sides by 10 deg; it went 0.99 of a turn" in line


@pytest.mark.parametrize(
    ("turned", "marched", "near"),
    [(0.0, 0.7, False), (0.0, 0.8, True), (1.1, 1.1, True), (1.3, 1.3, False), (1.3, 5.0, False)],
)
def test_near_a_turn_is_near_the_edge(turned: float, marched: float, near: bool) -> None:
    assert told("some verdict", turned, marched).endswith("so it is near the edge") is near


def test_a_run_that_ends_before_contact_says_so() -> None:
    """Not "no whirl": nothing was tried yet. One bearing that was touched is enough for verdicts."""
    untouched = whirl("no whirl", 0.0, 0.0)
    for seats in (["A"], ["A", "B"]):
        none = {"seats": {name: untouched | {"first_contact_time": None} for name in seats}}
        assert [line.partition(":")[0] for line in evidence(none)] == ["no bearing has been touched"]
        assert not list(hint("mine", Unbalanced(), none))
    assert list(hint("mine", Unbalanced(), {"seats": {"A": untouched}}))
    one = {"A": untouched | {"first_contact_time": None}, "B": {"first_contact_time": 0.0079}}
    assert evidence({"seats": one}) == ["A: no whirl: no contact that could swing or go round"]


def test_what_was_recorded_too_coarsely_is_no_verdict() -> None:
    """It does not count as settled, unless another seat is known to whirl."""
    line = told(TOO_COARSE, 0.0, 0.4)
    assert line.startswith("A: cannot tell: sampled too coarsely: from one recorded row")
    assert line.endswith("a smaller run.record_every or run.macro_step resolves it")
    coarse = whirl(TOO_COARSE, 0.0, 0.4)
    assert recorded_too_coarsely({"seats": {"A": coarse}})
    assert not has_verdict({"seats": {"A": coarse}})
    beside = whirl("backward whirl, still so at the end", 9.0, 9.0)
    assert has_verdict({"seats": {"A": coarse, "B": beside}})


def test_without_a_clearance_nothing_is_told() -> None:
    summary = {"seats": {"A": whirl(None, None, None)}}
    assert evidence(summary) == ["A: no verdict on whirl, since the bearing states no clearance"]
