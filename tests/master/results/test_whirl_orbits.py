"""Verdicts on made orbits with known answers: none is falsely a whirl, and no whirl is missed."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import pytest
from orbits import (
    BOTTOM,
    CLEARANCE,
    HELD,
    TOUCHING,
    TURN,
    Made,
    after_one_another,
    along,
    bouncing,
    circle,
    ellipse,
    over_the_top,
    pendulum,
    star,
    times,
    turns,
)

SUSTAINED_FORWARD = "forward whirl, still so at the end"
SUSTAINED_BACKWARD = "backward whirl, still so at the end"
TRANSIENT_BACKWARD = "transient backward whirl"
TRANSIENT_FORWARD = "transient forward whirl"
NO_WHIRL = "no whirl"
RUB = "no whirl, partial rub"
FREE = "no whirl, orbits without contact"
CREEP = "no whirl, creeps along the bore"


class Case(NamedTuple):
    """An orbit and its answer; `alone`: the orbit gives it also where no force was recorded."""

    name: str
    orbit: Made
    words: str
    alone: bool = True


def whirls() -> list[Case]:
    cases = [
        Case(f"circle {f:g} Hz of {r:g}, {rate:g} Hz", circle(f, r, rate=rate), words)
        for (f, words), r, rate in (
            ((60.0, SUSTAINED_FORWARD), 1.001, 50e3),
            ((60.0, SUSTAINED_FORWARD), 1.3, 5e3),
            ((-140.0, SUSTAINED_BACKWARD), 1.001, 5e3),
            ((-140.0, SUSTAINED_BACKWARD), 1.02, 20e3),
        )
    ]
    cases += [
        Case(f"{f:g} Hz, spin {s:g}", circle(f).spinning(s), words)
        for f, s, words in (
            (80.0, -900.0, SUSTAINED_BACKWARD),
            (-80.0, -900.0, SUSTAINED_FORWARD),
            (80.0, 0.0, SUSTAINED_FORWARD),
        )
    ]
    cases += [Case("four values a turn", circle(-500.0, rate=2e3), SUSTAINED_BACKWARD)]
    cases += [
        Case(f"noise {size:g}", circle(-90.0, 1.0 + 4.0 * size).noisy(size, 7), SUSTAINED_BACKWARD)
        for size in (0.002, 0.02)
    ]
    cases += [
        Case(f"star of {hop:g} degrees, {f:g} Hz, {rate:g} Hz", star(hop, f, rate=rate), words)
        for hop in (60.0, 110.0, 130.0, 150.0)
        for f, words, rate in ((45.0, SUSTAINED_FORWARD, 10e3), (-70.0, SUSTAINED_BACKWARD, 20e3))
    ]
    cases += [
        *(Case(f"star of {hop:g}, gravity bends it", bent(hop, f), SUSTAINED_BACKWARD)
          for hop, f in ((90.0, -40.0), (120.0, -60.0), (150.0, -60.0))),
        Case("star of 150 with noise", star(150.0, -50.0, 1.03).noisy(0.005, 3), SUSTAINED_BACKWARD),
        Case("nearly round", ellipse(-80.0, 0.97), SUSTAINED_BACKWARD),
        Case("bore stands off", off_the_centre(0.3), SUSTAINED_FORWARD, alone=False),
        Case("bore far off", off_the_centre(1.2), SUSTAINED_FORWARD, alone=False),
        Case("over the top", over_the_top(420.0), SUSTAINED_FORWARD),
        Case("1.05 turns", turns(1.05, -50.0), TRANSIENT_BACKWARD),
        Case("1.05 turns with noise", turns(1.05, 50.0).noisy(0.004, 5), TRANSIENT_FORWARD),
        Case("3 turns", turns(3.0, 70.0), TRANSIENT_FORWARD),
        Case("sets out late", turns(1e9, -70.0, begin=0.4), SUSTAINED_BACKWARD),
        Case("long forward, short backward to the end", after_one_another((0.8, 60.0), (0.05, -60.0)),
             SUSTAINED_BACKWARD),
        Case("short, long back, rest", after_one_another((0.05, -60.0), (0.5, 60.0), (0.3, 0.0)),
             TRANSIENT_FORWARD),
        Case("long, rest, short to the end", after_one_another((0.5, -60.0), (0.2, 0.0), (0.03, -60.0)),
             SUSTAINED_BACKWARD),
        Case("hit back after a turn and a half", after_one_another((0.03, 50.0), (0.03, -50.0)),
             SUSTAINED_BACKWARD),
    ]  # fmt: skip
    return cases


def no_whirls() -> list[Case]:
    return [*circles_and_ellipses(), *swings(), *short_of_a_whirl()]


def circles_and_ellipses() -> list[Case]:
    """Round and round, but free of the bore, or at it in places."""
    cases = [
        Case(f"free circle of {r:g}, {f:g} Hz", circle(f, r), FREE, alone=r < 0.95)
        for r in (0.4, 0.8, 0.9, 0.97, 0.999)
        for f in (60.0, -120.0)
    ]
    cases += [Case(f"levitated in {r:g}", circle(150.0, r), NO_WHIRL) for r in (0.0, 0.05)]
    cases += [
        Case(f"circle of {r:g} about {c:g}, {f:g} Hz", circle(f, r, c), RUB)
        for r, c in ((0.85, 0.17), (0.85, 0.2j), (0.6, 0.42), (0.52, -0.5), (0.42, 0.6j), (0.25, 0.77))
        for f in (70.0, -70.0)
    ]
    cases += [
        Case(f"ellipse {ratio:g}, {tilt:g} degrees", ellipse(-80.0, ratio, tilt), RUB)
        for ratio in (0.25, 0.4, 0.6, 0.7, 0.8)
        for tilt in (0.0, 35.0, 90.0)
    ]
    cases += [Case("flat ellipse, a bounce", ellipse(80.0, 0.05), NO_WHIRL)]
    cases += [Case("free ellipse", ellipse(80.0, 0.6, 20.0, 0.9), FREE)]
    return cases


def swings() -> list[Case]:
    """To and fro along the bore, also over the top and back."""
    cases = [
        Case(f"swings {a:g} degrees, dying at {d:g}", pendulum(a, d), "pendulum")
        for a in (10.0, 90.0, 178.0, 200.0, 300.0)
        for d in (0.0, 12.0)
    ]
    cases += [
        Case(f"swings {a:g} degrees with noise", pendulum(a, 2.0).noisy(0.005, 11), "pendulum")
        for a in (30.0, 170.0, 260.0)
    ]
    cases += [
        Case(f"swings 250 degrees until {end:g} s", pendulum(250.0, end=end), "pendulum")
        for end in (0.085, 0.095, 0.105, 0.12)
    ]
    cases += [
        Case(f"as gravity swings, {v:g} rad/s", over_the_top(v), "pendulum") for v in (100.0, 300.0, 355.0)
    ]
    return cases


def short_of_a_whirl() -> list[Case]:
    """Near misses, what creeps, bounces or rests."""
    cases = [
        Case(
            f"{count:g} turn at {f:g} Hz",
            turns(count, f),
            f"no whirl, short of one turn: {said:.2f} turn {sense}",
        )
        for count, said in ((0.82, 0.82), (0.88, 0.88), (0.91, 0.91), (0.95, 0.95))
        for f, sense in ((50.0, "forward"), (-80.0, "backward"))
    ]
    cases += [Case("half a turn", turns(0.5, 50.0), NO_WHIRL)]
    cases += [
        Case(
            "half a turn twice, a rest between",
            after_one_another((0.012, 50.0), (0.1, 0.0), (0.012, 50.0)),
            CREEP,
        ),
        *(
            Case(f"creeps at {f:g} Hz", along(t := times(4.0, 5e3), BOTTOM + TURN * f * t), CREEP)
            for f in (0.4, 0.8, -2.0, 5.0)
        ),
        Case("creeps with noise", along(t := times(2.0), BOTTOM + TURN * 1.5 * t).noisy(0.003, 4), CREEP),
        Case("creeps less than a turn", along(t := times(0.5), BOTTOM + TURN * 1.8 * t), NO_WHIRL),
        *(Case(f"bounces, {seed}", bouncing(seed), NO_WHIRL) for seed in range(4)),
        Case("bounces from top to bottom", top_to_bottom(), NO_WHIRL),
        Case("rests", turns(0.0, 50.0), NO_WHIRL),
        Case("rests with noise", turns(0.0, 50.0).noisy(0.004, 2), NO_WHIRL),
        Case("star of 175 degrees, a bounce that turns", star(175.0, 40.0), NO_WHIRL),
        Case("contacts that come back each turn", backwards_and_round(), RUB),
    ]
    return cases


def off_the_centre(away: float) -> Made:
    """A whirl in a bore whose centre stands off."""
    made = circle(60.0, centre=away)
    return Made(made.time, made.z, bore=away)


def bent(hop: float, frequency: float) -> Made:
    """A star whose flights are the parabolas that gravity makes of them."""
    made = star(hop, frequency)
    each = hop / 360.0 / abs(frequency)
    flown = np.maximum(np.mod(made.time, each) - HELD, 0.0)
    sag = 0.5 * 9.81 / CLEARANCE * flown * (each - HELD - flown)
    return Made(made.time, made.z - 1j * sag)


def top_to_bottom() -> Made:
    """Straight through the centre."""
    time = times(0.5)
    return Made(time, 1j * TOUCHING * np.sin(TURN * 40.0 * time))


def backwards_and_round() -> Made:
    """A free orbit that grazes the bore at one place every turn and a quarter."""
    time = times(0.5)
    graze = np.maximum(np.cos(TURN * 60.0 / 1.25 * time), 0.0) ** 40
    return along(time, BOTTOM + TURN * 60.0 * time, 0.7 + 0.31 * graze)


CASES = [*whirls(), *no_whirls()]


@pytest.mark.parametrize("case", CASES, ids=lambda c: c.name)
def test_the_verdict(case: Case) -> None:
    assert case.orbit.judged().words == case.words


@pytest.mark.parametrize("case", [c for c in CASES if c.alone], ids=lambda c: c.name)
def test_the_verdict_without_forces(case: Case) -> None:
    assert case.orbit.judged(with_force=False).words == case.words
