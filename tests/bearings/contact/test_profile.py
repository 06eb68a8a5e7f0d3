"""Races that are not circles: the contact found is the nearest point, however the search was started."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq

from touchdown.bearings.contact import profile as outline
from touchdown.bearings.contact.pair import INSIDE, OUTSIDE, ContactPlace, slip
from touchdown.modelkit.ports import Motion
from touchdown.modelkit.variables import as_record, as_tuple, layout

BALL = 3.2e-3  # m, radius
RACES = {"outer": (INSIDE, 18.7e-3), "inner": (OUTSIDE, 12.3e-3)}
CIRCLE = outline.RaceProfile(search=1)
PROFILES = {
    "oval": outline.RaceProfile(amplitude=20e-6, phase=0.4),
    "lobed": outline.RaceProfile(lobes=7, amplitude=-8e-6, phase=-1.1),
    "wavy": outline.RaceProfile(lobes=60, amplitude=1e-6),
    "worn": outline.RaceProfile(wear=30e-6, wear_angle=2.0),
    "both": outline.RaceProfile(lobes=3, amplitude=15e-6, wear=12e-6, wear_angle=-2.5, wear_width=0.1),
    "sharp": outline.RaceProfile(lobes=8, amplitude=0.6e-3),
}
every_race = pytest.mark.parametrize(("side", "radius"), RACES.values(), ids=RACES)
every_profile = pytest.mark.parametrize("profile", PROFILES.values(), ids=PROFILES)


def empty_report() -> Any:
    """A report to be written to."""
    return np.array([as_tuple(outline.SearchReport())], dtype=layout(outline.SearchReport))[0]


@dataclass
class Ring:
    """A race on a ring at (x, y), turned by `angle`, with what its search remembers of one ball."""

    side: float
    radius: float
    profile: outline.RaceProfile = CIRCLE
    x: float = 0.0
    y: float = 0.0
    angle: float = 0.0
    starts: np.ndarray = field(default_factory=lambda: np.full(2, math.nan))
    report: Any = field(default_factory=empty_report)

    def __post_init__(self) -> None:
        self.record = as_record(self.profile)

    def find(self, x: float, y: float) -> ContactPlace:
        """Contact with a ball at (x, y)."""
        ball, race = (
            outline.BallOutline(x, y, BALL),
            outline.Outline(self.x, self.y, self.angle, self.radius),
        )
        return ContactPlace(
            *outline.race_place(0, self.side, ball, race, self.record, self.starts, self.report)
        )

    def fresh(self, **changes: Any) -> Ring:
        """The same ring with nothing remembered."""
        return replace(self, starts=np.full(2, math.nan), report=empty_report(), **changes)

    def count(self) -> tuple[int, int]:
        """(Cold searches, failed ones)."""
        return int(self.report["cold"]), int(self.report["failed"])

    def r(self, s):
        """Polar radius at the frame's angle s, as documented; for complex s too."""
        p, off = self.profile, s - self.angle
        dent = p.wear * np.exp((np.cos(off - p.wear_angle) - 1.0) / p.wear_width**2)
        return self.radius + p.amplitude * np.cos(p.lobes * (off - p.phase)) + self.side * dent

    def point(self, s) -> tuple[Any, Any]:
        """Point of the curve at the frame's angle s."""
        return self.x + self.r(s) * np.cos(s), self.y + self.r(s) * np.sin(s)

    def normal(self, s: float) -> np.ndarray:
        """Unit normal at s, outwards; the slope comes from a complex step, which does not cancel."""
        tx, ty = (p.imag / 1e-30 for p in self.point(s + 1e-30j))
        return np.array([ty, -tx]) / math.hypot(tx, ty)

    def seated(self, s: float, indentation: float) -> np.ndarray:
        """Where a ball is that touches the race at s."""
        return np.array(self.point(s)) - self.side * (BALL - indentation) * self.normal(s)


def random_ring(rng: np.random.Generator, side: float, radius: float, profile: outline.RaceProfile) -> Ring:
    """A ring anywhere near the origin, turned by up to some turns."""
    x, y = rng.uniform(-1e-3, 1e-3, 2)
    return Ring(side, radius, profile, x, y, rng.uniform(-20.0, 20.0))


def across(rng: np.random.Generator, ring: Ring) -> np.ndarray:
    """A ball in some direction, up to 50 um from touching where the race is a circle."""
    s = rng.uniform(-math.pi, math.pi)
    out = ring.radius - ring.side * (BALL + rng.uniform(-50e-6, 50e-6))
    return np.array([ring.x + out * math.cos(s), ring.y + out * math.sin(s)])


@every_race
@every_profile
def test_normal_and_levers(side, radius, profile):
    """n is normal to the curve at the contact; both levers lead to the ball's point."""
    rng = np.random.default_rng(3)
    levers = []
    for _ in range(50):
        ring = random_ring(rng, side, radius, profile)
        s, depth = rng.uniform(-math.pi, math.pi), rng.uniform(-20e-6, 20e-6)
        ball = ring.seated(s, depth)
        found = ring.find(*ball)
        n, t = np.array([found.nx, found.ny]), np.array([-found.ny, found.nx])
        np.testing.assert_allclose(n, ring.normal(s), rtol=0, atol=1e-11)
        assert found.indentation == pytest.approx(depth, rel=0, abs=1e-16)
        from_ball = ball + found.first * n
        from_ring = np.array([ring.x, ring.y]) + found.second * n + found.across * t
        np.testing.assert_allclose(from_ball, from_ring, rtol=0, atol=1e-16)
        levers.append(abs(found.across))
    assert max(levers) > 1e-6


@every_race
@every_profile
def test_rate_is_that_of_the_indentation(side, radius, profile):
    """The indentation's rate from both bodies' velocities is what the search finds a moment later."""
    rng = np.random.default_rng(5)
    step = 3e-7  # s; waves pass by, so the difference leaves out 6e-6 of the rate
    for _ in range(20):
        ring = random_ring(rng, side, radius, profile)
        ball = Motion(*across(rng, ring), *rng.normal(0.0, 0.1, 2), rng.normal(0.0, 900.0))
        body = Motion(ring.x, ring.y, *rng.normal(0.0, 0.1, 2), rng.normal(0.0, 300.0))
        _, rate = slip(ball, body, ring.find(ball.x, ball.y), side)
        depths = []
        for time in (-step, step):
            moved = ring.fresh(
                x=body.x + time * body.vx, y=body.y + time * body.vy, angle=ring.angle + time * body.spin
            )
            depths.append(moved.find(ball.x + time * ball.vx, ball.y + time * ball.vy).indentation)
        assert (depths[1] - depths[0]) / (2.0 * step) == pytest.approx(rate, rel=1e-4, abs=1e-6)


@every_race
@pytest.mark.parametrize(("lobes", "angle"), [(8, 1e6), (1000, 1e3)])
def test_profiles_up_to_the_limit_are_found(side, radius, lobes, angle):
    """What `problem` accepts, the search finds, with lobes as many and as sharp as they may be.

    After many turns, too, as exactly as the ring's angle is known.
    """
    limit = brentq(
        lambda a: 1.0 if refusal(outline.RaceProfile(lobes, a), radius, side) else -1.0, 1e-9, 5e-3
    )
    rng = np.random.default_rng(lobes)
    ring = Ring(side, radius, outline.RaceProfile(lobes, 0.999 * limit), angle=angle)
    for i in range(100):
        ring.starts[:] = math.nan
        ball = ring.seated(rng.uniform(-math.pi, math.pi), 10e-6)
        for _ in range(2):  # the second time from where it is
            assert ring.find(*ball).indentation == pytest.approx(10e-6, rel=0, abs=3e-18 * angle)
        assert ring.count() == (i + 1, 0)


@every_race
@every_profile
@pytest.mark.parametrize("off", [0.1, math.pi])
def test_a_wrong_start_recovers(side, radius, profile, off):
    """Started elsewhere, the search ends at the contact all the same, and goes on from there."""
    rng = np.random.default_rng(9)
    anew = 0
    for _ in range(30):
        ring = random_ring(rng, side, radius, profile)
        s = rng.uniform(-math.pi, math.pi)
        ball = ring.seated(s, 5e-6)
        expected = ring.fresh().find(*ball)
        ring.starts[:] = s + (0.0 if side == INSIDE else math.pi), s + off
        np.testing.assert_allclose(ring.find(*ball), expected, rtol=0, atol=1e-11)
        cold, failed = ring.count()
        anew += cold
        assert cold <= 1
        assert failed == 0
        np.testing.assert_allclose(ring.find(*ball), expected, rtol=0, atol=1e-11)
        assert ring.count() == (cold, 0)
    assert anew > 15 or abs(off) < 3.0, "the far side leads nowhere"


def is_nothing(found: ContactPlace) -> bool:
    """Whether a contact says that it was not found."""
    return bool(np.isnan(found[:3]).all())


def test_middle_of_a_circle_is_nowhere():
    """All points are equally near: no contact, and the report says so; a little aside there is one."""
    ring = Ring(INSIDE, 18.7e-3)
    assert is_nothing(ring.find(0.0, 0.0))
    assert ring.count() == (1, 1)
    found = ring.find(1e-9, 0.0)
    assert (found.nx, found.indentation) == pytest.approx((1.0, BALL - 18.7e-3 + 1e-9), abs=1e-12)
    assert ring.count() == (2, 1)


@every_race
@every_profile
@pytest.mark.parametrize("bad", [(math.nan, 0.0), (0.0, -math.inf)])
def test_no_place_for_no_position(side, radius, profile, bad):
    """A position that is none has no contact, said at once; the next is found from the last good one."""
    ring = Ring(side, radius, profile)
    ball = ring.seated(0.3, 5e-6)
    good = ring.find(*ball)
    assert is_nothing(ring.find(*bad))
    assert ring.count() == (2, 1)
    np.testing.assert_allclose(ring.find(*ball), good, rtol=0, atol=1e-11)
    assert ring.count() == (2, 1)


def refusal(profile: outline.RaceProfile, radius: float, side: float) -> str | None:
    """What is wrong with a race of this profile, or None."""
    told = np.zeros(4)
    number = outline.profile_problem(as_record(profile), radius, BALL, side, told)
    return outline.profile_problems("race")[number - 1].format(*told) if number else None


@every_race
@pytest.mark.parametrize(
    ("profile", "cause"),
    [
        (outline.RaceProfile(lobes=200, amplitude=-20e-6), "amplitude"),
        (outline.RaceProfile(lobes=2, amplitude=15e-3), "amplitude"),
        (outline.RaceProfile(wear=5e-3, wear_width=0.05), "wear"),
        (outline.RaceProfile(wear=0.1e-3, wear_width=0.01, lobes=6, amplitude=50e-6), "wear"),
        (outline.RaceProfile(wear=20e-6, lobes=100, amplitude=15e-6), "amplitude"),
        (outline.RaceProfile(wear=1e-8, wear_width=1e-5, wear_angle=0.1), "wear"),
    ],
)
def test_the_cause_is_named(side, radius, profile, cause):
    """Too sharp a profile is refused by what makes it so, even a scratch between two samples."""
    text = refusal(profile, radius, side)
    assert text is not None
    assert text.startswith(f"race.{cause} = {getattr(profile, cause):g} m ")
