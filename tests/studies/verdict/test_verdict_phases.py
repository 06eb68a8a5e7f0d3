"""Windows, edges, strays and shares of made circles of verdicts, of which the answers are known."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np
import pytest

from touchdown.studies.verdict.study import (
    Edge,
    distance,
    edges,
    furthest,
    grid,
    onwards,
    refinement,
    strays,
    turned,
    whirling_share,
    windows,
)

WHIRL = "backward whirl, still so at the end"
BRIEF = "transient backward whirl"


def made(whirling: Callable[[float], bool | str], phases: list[float]) -> dict[float, str]:
    """Verdicts of a rule that says for each phase (deg) whether it whirls, or how."""
    said = {phase: whirling(phase) for phase in phases}
    return {phase: words if isinstance(words, str) else WHIRL * words for phase, words in said.items()}


def explored(
    whirling: Callable[[float], bool | str], spacing: float, resolution: float, through: float = 0.0
) -> dict[float, str]:
    """What a study would see of the rule."""
    verdicts = made(whirling, grid(spacing, through))
    while more := refinement(verdicts, verdicts, resolution):
        verdicts |= made(whirling, more)
    return verdicts


def inside(begin: float, end: float) -> Callable[[float], bool]:
    """Whirls from `begin` on to `end` (deg)."""
    return lambda phase: onwards(begin, phase) < onwards(begin, end)


def row(text: str, spacing: float = 10.0) -> dict[float, str]:
    """Verdicts evenly from 0 on, W for a whirl."""
    return {i * spacing: WHIRL if letter == "W" else "" for i, letter in enumerate(text)}


@pytest.mark.parametrize(
    ("begin", "end", "way", "short"),
    [(350.0, 2.0, 12.0, 12.0), (2.0, 350.0, 348.0, 12.0), (5.0, 5.0, 0.0, 0.0), (0.0, 180.0, 180.0, 180.0)],
)
def test_the_circle_closes(begin: float, end: float, way: float, short: float) -> None:
    assert onwards(begin, end) == way
    assert distance(begin, end) == distance(end, begin) == short
    assert turned(begin, way) == end
    assert turned(359.9999999999, 0.0) == turned(0.0, -1e-12) == 0.0  # rounded to the whole circle


@pytest.mark.parametrize(
    ("spacing", "through", "count"), [(12.0, 0.0, 30), (12.0, 7.5, 30), (7.0, 0.0, 52), (180.0, 350.0, 2)]
)
def test_the_grid_is_even_and_no_coarser(spacing: float, through: float, count: int) -> None:
    phases = grid(spacing, through)
    assert len(set(phases)) == count
    assert phases[0] == through
    gaps = np.diff([*sorted(phases), min(phases) + 360.0])
    assert gaps == pytest.approx(360.0 / count)
    assert max(gaps) <= spacing + 1e-6


@pytest.mark.parametrize("seed", range(12))
def test_a_window_as_wide_as_the_grid_is_found(seed: int) -> None:
    """Also across 0; its edges are where they are, within what they are said to be known to."""
    random = np.random.default_rng(seed)
    width = (12.4, 347.0, random.uniform(12.4, 347.0))[seed % 3]
    begin, through = random.uniform(0.0, 360.0), random.uniform(0.0, 12.0)
    end = (begin + width) % 360.0
    verdicts = explored(inside(begin, end), 12.0, 4.0, through)
    (window,) = windows(verdicts)
    assert window.begin is not None
    assert window.end is not None
    for edge, there in ((window.begin, begin), (window.end, end)):
        assert edge.gap <= 4.0
        assert onwards(edge.low, there) <= edge.gap
    assert window.width == pytest.approx(width, abs=4.0)
    assert whirling_share(verdicts).value == pytest.approx(width / 360.0, abs=4.0 / 360.0)
    assert strays(verdicts) == []


@pytest.mark.parametrize("resolution", [12.0, 3.0, 0.1])
def test_refinement_is_as_fine_as_asked(resolution: float) -> None:
    verdicts = explored(inside(77.7, 123.4), 12.0, resolution)
    found = edges(verdicts)
    assert all(0.5 * resolution < edge.gap <= resolution for edge in found)
    halvings = np.ceil(np.log2(12.0 / resolution))
    assert len(verdicts) == 30 + 2 * halvings  # nothing is run that does not narrow an edge
    for equal in (row("WWWW", 90.0), row("...."), {0.0: WHIRL}):
        assert refinement(equal, (), resolution) == []
    two = row("W.", 180.0)  # a phase without a verdict is not asked for again
    assert sorted(refinement(two, two, 60.0)) == [90.0, 270.0]
    assert refinement(two, [*two, 90.0], 60.0) == [270.0]


def test_other_ways_to_whirl_are_refined_and_are_one_window() -> None:
    verdicts = explored(lambda phase: BRIEF if phase < 100.0 else WHIRL * (phase < 200.0), 12.0, 4.0)
    (window,) = windows(verdicts)
    assert {verdicts[phase] for phase in window.phases} == {WHIRL, BRIEF}
    changes = [phase for phase in verdicts if 96.0 < phase < 108.0]
    assert changes  # between 96 and 108 is the change from one to the other


@pytest.mark.parametrize(
    ("text", "alone"),
    [
        ("..W.........", [20.0]),
        ("W...........", [0.0]),
        ("...........W", [110.0]),
        ("WW.WWWWW....", [20.0]),
        (".WWWWWWWWWWW", [0.0]),
        ("WWWW........", []),
        ("W.W.W.W.W.W.", []),
        ("WW.W..WW....", []),
        ("............", []),
        ("WWWWWWWWWWWW", []),
        ("W", []),
        ("W.", []),
    ],
)
def test_strays_stand_alone(text: str, alone: list[float]) -> None:
    assert strays(row(text, 30.0 if len(text) == 1 else 10.0)) == alone


def test_strays_neither_make_nor_part_a_window() -> None:
    (window,) = windows(row("....WWW.WWWW...W...", 20.0))
    assert window.begin == Edge(60.0, 80.0)
    assert window.end == Edge(220.0, 240.0)
    assert window.phases == (80.0, 100.0, 120.0, 160.0, 180.0, 200.0, 220.0)
    assert windows(row("....W....")) == []
    found = windows(row("WW....WWW.......WW", 20.0))  # in their order, and one across zero
    assert [window.phases for window in found] == [(120.0, 140.0, 160.0), (320.0, 340.0, 0.0, 20.0)]
    assert [window.width for window in found] == [60.0, 80.0]
    assert edges(row("WW....WWW.......WW", 20.0))[-1] == Edge(20.0, 40.0)
    (window,) = windows(row("WWWW", 90.0))  # all round, without edges
    assert (window.begin, window.width) == (None, 360.0)
    assert edges(row("WWWW", 90.0)) == windows(row("....", 90.0)) == []


@pytest.mark.parametrize(
    ("whirl", "count", "low", "high"),
    [(0, 10, 0.0, 0.3085), (10, 10, 0.6915, 1.0), (1, 20, 0.0013, 0.2487), (5, 10, 0.1871, 0.8129)],
)
def test_the_interval_is_clopper_and_pearsons(whirl: int, count: int, low: float, high: float) -> None:
    """Of equal weights; their tables."""
    found = whirling_share(row("W" * whirl + "." * (count - whirl), 360.0 / count))
    assert found.value == pytest.approx(whirl / count)
    assert found.low == pytest.approx(low, abs=1e-4)
    assert found.high == pytest.approx(high, abs=1e-4)


def test_refined_phases_count_for_what_they_stand_for() -> None:
    """Phases crowded at an edge neither move the share nor narrow its interval as if they were spread."""
    coarse = made(inside(0.0, 180.0), grid(12.0, 0.0))
    crowded = coarse | made(inside(0.0, 180.0), np.linspace(169.0, 191.0, 100).tolist())
    plain, refined = whirling_share(coarse), whirling_share(crowded)
    assert refined.value == pytest.approx(0.5, abs=0.02)
    assert refined.high - refined.low == pytest.approx(plain.high - plain.low, rel=0.1)


def test_the_interval_holds_what_it_says() -> None:
    """Phases drawn at random: the share is within the interval in at least 95 % of 2000 draws."""
    random = np.random.default_rng(5)
    held = 0
    for _ in range(2000):
        verdicts: Mapping[float, str] = {i * 12.0: WHIRL * bool(random.random() < 0.2) for i in range(30)}
        found = whirling_share(verdicts)
        held += found.low <= 0.2 <= found.high
    assert held >= 1900
    with pytest.raises(ValueError, match="no verdicts"):
        whirling_share({})


def test_how_far_edges_are_from_those_known() -> None:
    known = [Edge(358.0, 2.0), Edge(98.0, 102.0)]
    assert furthest([Edge(354.0, 358.0), Edge(100.0, 102.0)], known) == 4.0
    assert furthest([], known) is None
    assert furthest(known, []) is None
