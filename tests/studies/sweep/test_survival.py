"""How many drops a machine survives: closed forms, the interval, what counts, and the command."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scipy.stats import gamma

import touchdown
from touchdown.command.cli import main
from touchdown.master.common.errors import Ended, TouchdownError
from touchdown.master.quantities import named
from touchdown.master.results.settling import EARLY, UNSETTLED
from touchdown.studies.sweep.definition import define
from touchdown.studies.sweep.design import Design, parse_all
from touchdown.studies.sweep.members import Member
from touchdown.studies.sweep.survival import (
    DEFAULT,
    Limit,
    Survival,
    first_order,
    lines,
    read_limit,
    survival,
    undamped,
    unspent,
)


def member(number: int, safety: float, failed: str = "", drops: float = 1e9) -> Member:
    seat = {"lowest_static_safety": safety, "drops_until_fatigue": drops}
    return Member(number, {}, {} if failed else {"seats": {"A": seat}}, failed)


@pytest.mark.parametrize("drops", [15, 30])
def test_exponential_shares_add_up_to_gammas(drops: int) -> None:
    """Mean 0.05: the sum of N has Gamma's distribution of shape N. Shares of a hundredth end at 100."""
    assert unspent(np.full(5, 0.01), 99) == pytest.approx(1.0, abs=1e-9)
    assert unspent(np.full(5, 0.01), 101) == pytest.approx(0.0, abs=1e-9)
    quantiles = (np.arange(200_000) + 0.5) / 200_000
    shares = -0.05 * np.log1p(-quantiles)
    assert unspent(shares, drops) == pytest.approx(gamma(drops, scale=0.05).cdf(1.0), abs=2.5e-4)


def test_the_interval_holds_the_truth() -> None:
    """Of 100 campaigns of 60 drops with a chance of 0.1, in 95 at least, for one drop and for ten."""
    draw = np.random.default_rng(5)
    broken = draw.binomial(60, 0.1, 100)
    for drops in (1, 10):
        told = [Survival(DEFAULT, int(k), 60, {}).after(drops) for k in broken]
        assert sum(one.low <= 0.9**drops <= one.high for one in told) >= 95


def test_what_counts() -> None:
    """Dents and failures are beyond the limit; drops that were not run do not count."""
    members = [
        member(1, 3.0),
        member(2, 0.9),
        member(3, 0.0, failed="stopped"),
        Member(4, {}, {}, "not run", Ended.INTERRUPTED),
    ]
    found = survival(members)
    assert (found.broken, found.count) == (2, 3)
    assert found.after(2).value == pytest.approx(1.0 / 9.0)
    with pytest.raises(TouchdownError, match="no drop of the sweep has a quantity bearing_heat; "):
        survival(members, Limit(named("bearing_heat")[0], 1.0))


def test_a_bearing_that_was_touched_and_does_not_tell_is_not_survived() -> None:
    """Whatever the other one tells; one that was not touched does not count."""
    first = {"lowest_static_safety": 3.0, "first_contact_time": 0.01}
    touched, untouched = (
        Member(1, {}, {"seats": {"A": first, "B": {"lowest_static_safety": None, "first_contact_time": t}}})
        for t in (0.01, None)
    )
    assert DEFAULT.broken(touched)
    assert not DEFAULT.broken(untouched)
    assert DEFAULT.worst(untouched) == 3.0
    # drops that end in the air are survived, whether they tell nothing, or what balls bear by themselves
    silent, told = ({"first_contact_time": None, **more} for more in ({}, {"lowest_static_safety": None}))
    in_the_air = [Member(k, {}, {"seats": {"A": seat, "B": seat}}) for k, seat in ((2, silent), (3, told))]
    found = survival([member(1, 3.0), *in_the_air])
    assert (found.broken, found.count, found.untouched) == (0, 3, 2)
    assert any("2 of them ended before the rotor touched a bearing" in line for line in lines(found, [1]))


def test_drops_that_ended_too_early_are_told() -> None:
    """The worst seat counts: early are drops of which no seat had the time."""
    settled, moving = "settled at 0.2 s: at rest", f"{UNSETTLED}: swings, decaying"
    of = [
        (EARLY, EARLY),
        (EARLY, None),
        (EARLY, moving),
        (settled, moving),
        (settled, settled),
        (None, None),
    ]
    members = [
        Member(
            k,
            {},
            {
                "seats": {
                    s: {"lowest_static_safety": 3.0, "settled": w} for s, w in zip("AB", words, strict=True)
                }
            },
        )
        for k, words in enumerate(of, start=1)
    ]
    found = survival(members)
    assert (found.count, found.early, found.unsettled) == (6, 2, 2)
    told = "\n".join(lines(found, [1]))
    assert "2 of them ended within a swing of the first contact, before a whirl can build up; " in told
    assert "2 of them had not settled; " in told
    assert "of them" not in "\n".join(lines(survival(members[4:]), [1]))


def test_first_order_indices() -> None:
    """Of y = 3 a + b with even a and b: 0.9 and 0.1; of what it does not follow none, but for chance."""
    draw = np.random.default_rng(2)
    a, b, other = draw.uniform(size=(3, 4000))
    found = [first_order(x, 3.0 * a + b) for x in (a, b, other)]
    assert found == pytest.approx([0.9, 0.1, 0.0], abs=0.03)


def test_limits_are_read_with_their_units() -> None:
    seat = {"peak_ball_force": 900.0, "lowest_static_safety": 3.0}
    gap = {"least": 2e-5, "touches": 0}
    summary = {"seats": {"A": seat}, "gaps": {"seal": gap}, "least_gap": 2e-5, "end_time": 1.0}
    told = [Member(1, {}, summary)]

    def of(text: str) -> tuple[str, float, bool]:
        limit = read_limit(text, told)
        return limit.quantity.key, limit.value, limit.at_least

    assert of("peak_ball_force=1.695 kN") == ("peak_ball_force", 1695.0, False)
    assert of("least=0.01 mm") == ("least", pytest.approx(1e-5), True)
    assert of("ball_pressure=4.2 GPa") == ("largest_ball_pressure", pytest.approx(4.2e9), False)
    assert of("least_gap=10 um") == ("least_gap", pytest.approx(1e-5), True)
    assert of("lowest_static_safety=1.5") == ("lowest_static_safety", 1.5, True)
    assert read_limit("least_gap=10 um", told).words() == "least gap left of all below 10 um"
    assert read_limit("touches=0", told).broken(Member(1, {}, {"gaps": {"seal": {"touches": 2}}}))
    turns = read_limit("whirl_turns=3", told)
    seats = {"A": {"whirl_revolutions": 4.0, "whirl_radius": 1e-6}, "B": {"whirl_revolutions": 2.0}}
    assert turns.worst(Member(1, {}, {"seats": seats})) == 4.0
    assert turns.words() == "turns of the whirl above 3"
    # of one seat: what the other bears, or whether it was touched, does not count; a gap likewise
    at_a = {"peak_contact_force": 900.0, "first_contact_time": 0.01}
    for at_b, broken in ((800.0, True), (600.0, False), (None, False)):
        b = {"peak_contact_force": at_b, "first_contact_time": None if at_b is None else 0.02}
        one = Member(1, {}, {"seats": {"A": at_a, "B": b}, "gaps": {"seal": {"least": 2e-5}}})
        limit = read_limit("seats.B.peak_contact_force=700 N", [one, Member(2, {}, {"seats": {"B": at_a}})])
        assert limit.broken(one) is broken
        assert limit.words() == "largest contact force, B above 700 N"
        assert read_limit("gaps.seal.least=30 um", [one]).broken(one)
    for wrong, message in (
        ("peak_ball_force=x", "'x' is not a number"),
        ("peak_ball_force=1695", "has no unit; write .* such as '1 N'"),
        ("ball_pressure=4.2", "has no unit; write .* such as '4 GPa'"),
        ("peak_ball_forces=1 N", "no drop has a quantity peak_ball_forces; did you mean peak_ball_force"),
        ("seats.C.peak_ball_force=1 N", "did you mean seats.A.peak_ball_force"),
        ("heat=x", "^limit heat"),
        ("peak_ball_force", "^limit peak_ball_force: write NAME=VALUE$"),
        ("end_time=1 s", "neither more nor less of end_time is worse"),
    ):
        with pytest.raises(TouchdownError, match=message):
            read_limit(wrong, told)


def test_what_a_drop_uses_up() -> None:
    """Half a life a drop: one is survived, two are not. It counts only where a drop ends nothing."""
    half = survival([member(k, 5.0, drops=2.0) for k in range(10)])
    assert half.after(1).value == pytest.approx(1.0)
    assert half.after(2).value == pytest.approx(0.0, abs=1e-9)
    assert any("cannot be excluded (rule of three)" in line for line in lines(half, [1, 2]))
    # every second drop dents and takes a whole life; the others take none: one in two, one in four
    dents = survival([member(k, *((0.5, "", 1.0) if k % 2 else (5.0, "", 1e9))) for k in range(40)])
    assert [dents.after(k).value for k in (1, 2)] == pytest.approx([0.5, 0.25])
    # 0.6 of a life of either of two bearings: of four drops, one of them takes two or more, always
    shares = {"A": np.array([0.6, 0.0]), "B": np.array([0.0, 0.6])}
    either = Survival(DEFAULT, 0, 2, shares)
    assert [either.after(k).value for k in (1, 4)] == pytest.approx([1.0, 0.0], abs=1e-9)


@pytest.mark.parametrize(
    ("settings", "varied", "said"),
    [
        ({}, "bearing.clearance=0.2,0.3 mm", True),
        ({"bearing.balls.dissipation": "0 s/m"}, "bearing.clearance=0.2,0.3 mm", True),
        ({"bearing.balls.dissipation": "0.12 s/m"}, "bearing.clearance=0.2,0.3 mm", False),
        ({}, "bearing.balls.damping_ratio=0,0.02", False),
    ],
)
def test_balls_without_damping_are_said(settings: dict[str, object], varied: str, said: bool) -> None:
    scene = touchdown.load("disk-caged-simplified").set(settings)
    found = undamped(define(scene, Design.grid(parse_all([varied])), in_process=True))
    assert [line.startswith("balls of bearing have no damping") for line in found] == [True] * said


def test_of_a_sweep_by_the_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Text and picture, and a chapter of the sweep's page."""
    scene = touchdown.load("disk-caged-simplified").set({"run.duration": "12 ms"})
    design = touchdown.Design.latin({"bearing.clearance": "0.2:0.3 mm"}, 8, seed=1)
    touchdown.sweep(scene, design, tmp_path, in_process=True, jobs=1)
    assert main(["survival", str(tmp_path), "--drops", "1:3"]) == 0
    said, warned = capsys.readouterr()
    assert "balls of bearing have no damping" in warned
    assert "0 of 8 drops: lowest static safety below 1" in said
    assert "one in 3 cannot be excluded" in said
    assert "bearing.clearance: -1.00" in said  # a farther fall hits harder
    assert (tmp_path / "survival.png").is_file()
    assert main(["survival", str(tmp_path), "--limit", "peak_ball_force=150 N"]) == 0
    assert "drops: largest ball load above 150 N" in capsys.readouterr().out
    (page,) = touchdown.report(tmp_path)
    assert "How many drops it survives" in page.read_text(encoding="utf-8")
    assert main(["survival", str(tmp_path), "--drops", "3:1"]) == 2
