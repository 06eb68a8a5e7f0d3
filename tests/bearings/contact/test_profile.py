"""Races that are not circles: the contact found is the nearest point, however the search was started."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq, minimize_scalar

from touchdown.bearings.contact.pair import INSIDE, OUTSIDE, Place, slip
from touchdown.bearings.contact.profile import (
    Disc,
    Outline,
    RaceProfile,
    SearchReport,
    curvature,
    on_race,
    problem,
    problems,
    race_place,
    sharpest,
)
from touchdown.modelkit.ports import Motion
from touchdown.modelkit.variables import as_record, as_tuple, layout

BALL = 3.2e-3  # m, radius
RACES = {"outer": (INSIDE, 18.7e-3), "inner": (OUTSIDE, 12.3e-3)}
CIRCLE = RaceProfile(search=1)
PROFILES = {
    "oval": RaceProfile(amplitude=20e-6, phase=0.4),
    "lobed": RaceProfile(lobes=7, amplitude=-8e-6, phase=-1.1),
    "wavy": RaceProfile(lobes=60, amplitude=1e-6),
    "worn": RaceProfile(wear=30e-6, wear_angle=2.0),
    "both": RaceProfile(lobes=3, amplitude=15e-6, wear=12e-6, wear_angle=-2.5, wear_width=0.1),
    "sharp": RaceProfile(lobes=8, amplitude=0.6e-3),
}
every_race = pytest.mark.parametrize(("side", "radius"), RACES.values(), ids=RACES)
every_profile = pytest.mark.parametrize("profile", PROFILES.values(), ids=PROFILES)


def empty_report() -> Any:
    """A report to be written to."""
    return np.array([as_tuple(SearchReport())], dtype=layout(SearchReport))[0]


@dataclass
class Ring:
    """A race on a ring at (x, y), turned by `angle`, with what its search remembers of one ball."""

    side: float
    radius: float
    profile: RaceProfile = CIRCLE
    x: float = 0.0
    y: float = 0.0
    angle: float = 0.0
    starts: np.ndarray = field(default_factory=lambda: np.full(2, math.nan))
    report: Any = field(default_factory=empty_report)

    def __post_init__(self) -> None:
        self.record = as_record(self.profile)

    def find(self, x: float, y: float) -> Place:
        """Contact with a ball at (x, y)."""
        ball, race = Disc(x, y, BALL), Outline(self.x, self.y, self.angle, self.radius)
        return Place(*race_place(0, self.side, ball, race, self.record, self.starts, self.report))

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

    def distance(self, x: float, y: float) -> float:
        """Of (x, y) from the curve, by brute force."""

        def to(s):
            px, py = self.point(s)
            return np.hypot(px - x, py - y)

        around = np.linspace(0.0, 2.0 * math.pi, 4001)
        near = around[np.argmin(to(around))]
        bounds = (near - 2e-3, near + 2e-3)
        return float(minimize_scalar(to, bounds=bounds, method="bounded", options={"xatol": 1e-12}).fun)


def random_ring(rng: np.random.Generator, side: float, radius: float, profile: RaceProfile) -> Ring:
    """A ring anywhere near the origin, turned by up to some turns."""
    x, y = rng.uniform(-1e-3, 1e-3, 2)
    return Ring(side, radius, profile, x, y, rng.uniform(-20.0, 20.0))


def across(rng: np.random.Generator, ring: Ring) -> np.ndarray:
    """A ball in some direction, up to 50 um from touching where the race is a circle."""
    s = rng.uniform(-math.pi, math.pi)
    out = ring.radius - ring.side * (BALL + rng.uniform(-50e-6, 50e-6))
    return np.array([ring.x + out * math.cos(s), ring.y + out * math.sin(s)])


def rotated(vector, angle: float) -> np.ndarray:
    """Turned counter-clockwise."""
    c, s = math.cos(angle), math.sin(angle)
    return np.array([c * vector[0] - s * vector[1], s * vector[0] + c * vector[1]])


@every_race
def test_a_circle_found_is_the_circle(side, radius):
    """Searched for, a circle gives the indentation along the line of centres, and no lever across it."""
    rng = np.random.default_rng(1)
    for _ in range(200):
        ring = random_ring(rng, side, radius, CIRCLE)
        x, y = across(rng, ring)
        found = ring.find(x, y)
        dx, dy = x - ring.x, y - ring.y
        distance = math.hypot(dx, dy)
        assert found.indentation == pytest.approx(side * (distance - radius) + BALL, rel=0, abs=1e-16)
        assert (found.nx, found.ny) == pytest.approx((dx / distance, dy / distance), rel=0, abs=1e-13)
        assert found.first == side * BALL
        assert found.second == pytest.approx(distance + side * BALL, rel=0, abs=1e-16)
        assert found.across == pytest.approx(0.0, abs=1e-16)
        assert ring.count() == (1, 0)


@every_race
@every_profile
def test_contact_is_the_nearest_point(side, radius, profile):
    """No point of the race is closer to the ball's centre than the one found, and that one is."""
    rng = np.random.default_rng(2)
    for _ in range(25):
        ring = random_ring(rng, side, radius, profile)
        x, y = across(rng, ring)
        found = ring.find(x, y)
        assert found.indentation == pytest.approx(BALL - ring.distance(x, y), rel=0, abs=1e-15)
        assert ring.count() == (1, 0)


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
def test_moving_along_the_normal(side, radius, profile):
    """The ball moved along n goes as much deeper, and keeps its n."""
    rng = np.random.default_rng(4)
    for move in (-30e-6, -1e-6, 1e-6, 30e-6):
        ring = random_ring(rng, side, radius, profile)
        x, y = across(rng, ring)
        here = ring.find(x, y)
        there = ring.find(x + move * here.nx, y + move * here.ny)
        assert there.indentation - here.indentation == pytest.approx(side * move, rel=0, abs=1e-16)
        assert there[:2] == pytest.approx(here[:2], rel=0, abs=1e-11)
        assert ring.count() == (1, 0)


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
@every_profile
def test_turning_everything_turns_the_normal(side, radius, profile):
    """Ball, ring and its angle turned about the origin: the same contact in another frame."""
    rng = np.random.default_rng(6)
    for _ in range(25):
        ring, by = random_ring(rng, side, radius, profile), rng.uniform(-math.pi, math.pi)
        ball = across(rng, ring)
        x, y = rotated((ring.x, ring.y), by)
        here = ring.find(*ball)
        there = ring.fresh(x=x, y=y, angle=ring.angle + by).find(*rotated(ball, by))
        np.testing.assert_allclose(there[:2], rotated(here[:2], by), rtol=0, atol=1e-11)
        np.testing.assert_allclose(there[2:], here[2:], rtol=0, atol=1e-13)


@every_race
@every_profile
def test_profile_turns_with_the_ring(side, radius, profile):
    """A ring turned by some angle is one whose lobes and dent were that much further on at the start."""
    rng = np.random.default_rng(7)
    for _ in range(10):
        by = rng.uniform(-math.pi, math.pi)
        further = replace(profile, phase=profile.phase + by, wear_angle=profile.wear_angle + by)
        ring = Ring(side, radius, profile, angle=by)
        ball = across(rng, ring)
        np.testing.assert_allclose(Ring(side, radius, further).find(*ball), ring.find(*ball), atol=1e-14)


@every_race
@every_profile
@pytest.mark.parametrize("turns", [-3, 160, 16_000])
def test_full_turns_change_nothing(side, radius, profile, turns):
    """A ring that has run for long is found as surely as at the start, up to the digits of its angle."""
    rng = np.random.default_rng(8)
    for _ in range(20):
        ring = Ring(side, radius, profile, angle=rng.uniform(0.0, 2.0 * math.pi))
        ball = across(rng, ring)
        later = ring.fresh(angle=ring.angle + turns * 2.0 * math.pi)
        np.testing.assert_allclose(later.find(*ball), ring.find(*ball), rtol=0, atol=1e-9)
        assert later.find(*ball).indentation == pytest.approx(ring.find(*ball).indentation, abs=1e-12)
        assert later.count() == ring.count() == (1, 0)


@every_race
@every_profile
def test_following_a_ball_searches_once(side, radius, profile):
    """Around a turning race in steps of 5 mrad, each search starts from the last: no cold one is needed."""
    ring = Ring(side, radius, profile)
    for i in range(1300):
        s = 5e-3 * i
        ring.angle = -0.7 * s
        depth = 10e-6 * math.cos(11.0 * s)
        found = ring.find(*ring.seated(s, depth))
        assert found.indentation == pytest.approx(depth, rel=0, abs=1e-16)
        if i % 50 == 0:
            np.testing.assert_allclose(found, ring.fresh().find(*ring.seated(s, depth)), rtol=0, atol=1e-11)
    assert ring.count() == (1, 0)


@every_race
@pytest.mark.parametrize("angle", [1e3, 1e6])
@pytest.mark.parametrize("lobes", [8, 30, 300, 1000])
def test_profiles_up_to_the_limit_are_found(side, radius, lobes, angle):
    """What `problem` accepts, the search finds, with lobes as many and as sharp as they may be.

    After many turns, too, as exactly as the ring's angle is known.
    """
    limit = brentq(lambda a: 1.0 if refusal(RaceProfile(lobes, a), radius, side) else -1.0, 1e-9, 5e-3)
    rng = np.random.default_rng(lobes)
    ring = Ring(side, radius, RaceProfile(lobes, 0.999 * limit), angle=angle)
    for i in range(100):
        ring.starts[:] = math.nan
        ball = ring.seated(rng.uniform(-math.pi, math.pi), 10e-6)
        for _ in range(2):  # the second time from where it is
            assert ring.find(*ball).indentation == pytest.approx(10e-6, rel=0, abs=3e-18 * angle)
        assert ring.count() == (i + 1, 0)


@every_race
@every_profile
@pytest.mark.parametrize("off", [0.1, 1.0, -2.0, math.pi])
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


@every_race
@every_profile
def test_any_start_will_do(side, radius, profile):
    """Wherever the search starts on both outlines, it ends at the contact."""
    rng = np.random.default_rng(11)
    ring = Ring(side, radius, profile)
    for _ in range(300):
        s, ring.angle = rng.uniform(-math.pi, math.pi, 2)
        ring.starts[:] = rng.uniform(-math.pi, math.pi, 2)
        assert ring.find(*ring.seated(s, 5e-6)).indentation == pytest.approx(5e-6, rel=0, abs=1e-15)
    assert ring.count()[1] == 0


@every_profile
def test_far_side_is_no_contact(profile):
    """On an inner race the far side has points that are nearest around, too, where it is hollowed out."""
    rng = np.random.default_rng(10)
    ring = Ring(*RACES["inner"], profile)
    for _ in range(300):
        s, ring.angle = rng.uniform(-math.pi, math.pi, 2)
        ring.starts[:] = s + math.pi, s + math.pi + rng.uniform(-0.5, 0.5)
        assert ring.find(*ring.seated(s, 5e-6)).indentation == pytest.approx(5e-6, rel=0, abs=1e-15)
    assert ring.count()[1] == 0


def is_nothing(found: Place) -> bool:
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
@pytest.mark.parametrize("bad", [(math.nan, 0.0), (0.0, math.nan), (math.inf, 0.0), (0.0, -math.inf)])
def test_no_place_for_no_position(side, radius, profile, bad):
    """A position that is none has no contact, said at once; the next is found from the last good one."""
    ring = Ring(side, radius, profile)
    ball = ring.seated(0.3, 5e-6)
    good = ring.find(*ball)
    assert is_nothing(ring.find(*bad))
    assert ring.count() == (2, 1)
    np.testing.assert_allclose(ring.find(*ball), good, rtol=0, atol=1e-11)
    assert ring.count() == (2, 1)


def test_a_ring_without_an_angle_is_not_found():
    """An angle that is not a number leaves no contact to find."""
    ring = Ring(INSIDE, 18.7e-3, PROFILES["oval"], angle=math.nan)
    assert is_nothing(ring.find(15.5e-3, 0.0))
    assert ring.count() == (1, 1)


@every_race
@every_profile
def test_points_of_a_race(side, radius, profile):
    """A point of the race lies on it; its tangent and the tangent's derivative are the curve's."""
    ring = Ring(side, radius, profile, 1e-3, -2e-3, 0.8)
    h = 1e-4
    for s in np.linspace(-3.0, 3.0, 200):
        place = (ring.x, ring.y, ring.angle, radius, ring.record, side)
        before, here, after = (np.array(on_race(s + d, *place)) for d in (-h, 0.0, h))
        np.testing.assert_allclose(here[:2], ring.point(s), rtol=0, atol=1e-17)
        slopes = (after - before) / (2.0 * h)
        np.testing.assert_allclose(slopes[:4], here[2:], rtol=0, atol=2e-5 * radius)


@every_race
@every_profile
def test_curvature(side, radius, profile):
    """Curvature is the change of the curve's direction per length, by differences."""
    ring = Ring(side, radius, profile)
    s = np.linspace(0.0, 2.0 * math.pi, 20_000, endpoint=False)
    h = 5e-5  # between rounding, which grows with 1/h^2, and what is left out, with h^2: 3e-7 in all
    (xa, ya), (x, y), (xb, yb) = (ring.point(s + d) for d in (-h, 0.0, h))
    tx, ty, cx, cy = (xb - xa) / 2, (yb - ya) / 2, xb - 2 * x + xa, yb - 2 * y + ya
    expected = (tx * cy - ty * cx) / np.hypot(tx, ty) ** 3
    found = np.array([curvature(at, radius, ring.record, side) for at in s])
    scale = np.max(np.abs(expected))
    np.testing.assert_allclose(found, expected, rtol=0, atol=3e-6 * scale)
    assert sharpest(radius, ring.record, side) == pytest.approx(np.max(side * expected), abs=1e-4 * scale)


@every_race
def test_a_circle_is_bent_evenly(side, radius):
    """1/R all around."""
    circle = as_record(CIRCLE)
    for s in np.linspace(-4.0, 4.0, 50):
        assert curvature(s, radius, circle, side) == pytest.approx(1.0 / radius, rel=1e-14)


def touches_at(ring: Ring, s: float) -> float:
    """How far from s (rad) a ball that is pushed into the race along that direction first touches it."""
    around = np.linspace(s - 0.5, s + 0.5, 20_001)
    px, py = ring.point(around)

    def gap(out: float) -> float:
        near = np.min(np.hypot(px - out * math.cos(s), py - out * math.sin(s)))
        return float(near) - BALL

    middle = float(ring.r(s)) - ring.side * BALL
    out = brentq(gap, middle - ring.side * 1e-3, middle + ring.side * 1e-3, xtol=1e-16)
    near = np.argmin(np.hypot(px - out * math.cos(s), py - out * math.sin(s)))
    return abs(float(around[near]) - s)


def refusal(profile: RaceProfile, radius: float, side: float) -> str | None:
    """What is wrong with a race of this profile, or None."""
    told = np.zeros(4)
    number = problem(as_record(profile), radius, BALL, side, told)
    return problems("race")[number - 1].format(*told) if number else None


HOLLOWS = {"lobes": (8, 64.0), "many": (40, 1600.0), "dent": (0, 1.0 / 0.1**2), "notch": (0, 1.0 / 0.02**2)}


def hollowed(side: float, radius: float, lobes: int, sharpness: float, bend: float) -> tuple[Ring, float]:
    """A race whose sharpest hollow has the radius of curvature `bend`, and where that is.

    At a hollow of depth a the race's second derivative is a n^2 inwards, or w/b^2 for a dent.
    """

    def excess(depth: float) -> float:
        r = radius + side * depth
        return (sharpness * depth + side * r) / r**2 - 1.0 / bend

    depth = float(brentq(excess, 0.0, 0.4 * radius, xtol=1e-16))
    if lobes:
        phase = 0.9 if side == INSIDE else 0.9 - math.pi / lobes
        return Ring(side, radius, RaceProfile(lobes, depth, phase)), 0.9
    dent = RaceProfile(wear=depth, wear_angle=0.9, wear_width=sharpness**-0.5)
    return Ring(side, radius, dent), 0.9


@every_race
@pytest.mark.parametrize(("lobes", "sharpness"), HOLLOWS.values(), ids=HOLLOWS)
def test_limit_is_where_a_ball_touches_twice(side, radius, lobes, sharpness):
    """A hollow wider than the ball is touched in its middle and accepted; a narrower one on its flanks."""

    def verdict(ring: Ring) -> str | None:
        return refusal(ring.profile, radius, side)

    wide, s = hollowed(side, radius, lobes, sharpness, 1.03 * BALL)
    assert touches_at(wide, s) < 1e-4
    assert verdict(wide) is None
    close, s = hollowed(side, radius, lobes, sharpness, 1.01 * BALL)
    assert touches_at(close, s) < 1e-4
    assert verdict(close) is not None, "room is kept"
    narrow, s = hollowed(side, radius, lobes, sharpness, 0.9 * BALL)
    assert touches_at(narrow, s) > 2e-3
    text = verdict(narrow)
    assert text is not None
    assert text.startswith("race.amplitude = " if lobes else "race.wear = ")
    assert float(text.split("a radius of ")[1].split()[0]) == pytest.approx(0.9 * BALL, rel=1e-3)


@every_race
@every_profile
def test_gentle_profiles_have_no_problem(side, radius, profile):
    """The profiles of these tests are roughly what a ball can follow, and a circle is no question."""
    assert refusal(profile, radius, side) is None
    assert refusal(CIRCLE, radius, side) is None
    assert refusal(RaceProfile(), radius, side) is None


@every_race
@pytest.mark.parametrize(
    ("profile", "cause"),
    [
        (RaceProfile(lobes=200, amplitude=-20e-6), "amplitude"),
        (RaceProfile(lobes=2, amplitude=15e-3), "amplitude"),
        (RaceProfile(wear=5e-3, wear_width=0.05), "wear"),
        (RaceProfile(wear=0.1e-3, wear_width=0.01, lobes=6, amplitude=50e-6), "wear"),
        (RaceProfile(wear=20e-6, lobes=100, amplitude=15e-6), "amplitude"),
        (RaceProfile(wear=1e-8, wear_width=1e-5, wear_angle=0.1), "wear"),
    ],
)
def test_the_cause_is_named(side, radius, profile, cause):
    """Too sharp a profile is refused by what makes it so, even a scratch between two samples."""
    text = refusal(profile, radius, side)
    assert text is not None
    assert text.startswith(f"race.{cause} = {getattr(profile, cause):g} m ")
