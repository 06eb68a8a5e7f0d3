"""Stresses of rotor II beside Table 4 of the dissertation: like with like."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, cast

import numpy as np
import pytest

from touchdown.master.common.errors import TouchdownError
from touchdown.master.common.progress import Progress
from touchdown.master.coupling.observer import RunState
from touchdown.master.coupling.simulation import open_system
from touchdown.master.quantities import Summary
from touchdown.master.scene.file import load_scene
from touchdown.rotor.file import rotor_named
from touchdown.rotor.modal.modes import basis
from touchdown.studies.drop.impact_watch import shortened
from touchdown.validation.dissertation import stress_readings
from touchdown.validation.dissertation.drop_cache import Drops, numbers
from touchdown.validation.dissertation.stress_readings import (
    ASSUMPTIONS,
    AT_FIRST_PEAK,
    AT_LARGEST,
    COLUMNS,
    OTHER_ROTOR,
    READINGS,
    SOURCE,
    WAIT,
    Change,
    FirstPeak,
    as_read,
    instants,
    medians,
    read_as,
    resultants,
    rms_of_logarithms,
    spread,
    whirls,
)

STEP = 1e-5  # s
TOUCHED = 2e-3  # s

CHANGES = [
    (c, change) for rows in (AT_FIRST_PEAK, AT_LARGEST) for c, them in rows.items() for change in them
]


def first_peak(stress: Callable[[float], float], wait: float = WAIT, end: float = 0.02) -> float | None:
    """When the peak was (s after contact) at which `FirstPeak` ends a run; None: it never did.

    stress: over the time from the run's start (s). What it is before contact counts as kept, too.
    """
    largest, kept = 0.0, 0.0
    now = RunState(cast(Any, None), 0.0, round(end / STEP))
    touched = lambda: np.array([TOUCHED if now.time >= TOUCHED else -1.0])  # noqa: E731
    watch = FirstPeak(lambda: np.array([kept]), [touched, lambda: np.array([-1.0])], wait)
    for number in range(now.steps):
        now.move(number + 1, STEP)
        if abs(stress(now.time)) > largest:
            largest, kept = abs(stress(now.time)), now.time
        watch.stepped(now)
        if now.ended is not None:
            return kept - TOUCHED
    return None


def risen(time: float, frequency: float) -> float:
    """A mode's answer to a load from contact on: 1 - cos."""
    return 1.0 - math.cos(2.0 * math.pi * frequency * (time - TOUCHED)) if time > TOUCHED else 0.0


@pytest.mark.parametrize(
    ("stress", "at"),
    [
        (lambda t: risen(t, 500.0), 1e-3),  # one mode
        (lambda t: -risen(t, 500.0), 1e-3),  # in compression
        # ripples of a mode above the third on the way up, which make maxima of their own
        (lambda t: risen(t, 500.0) + 0.3 * risen(t, 5000.0), 0.90e-3),
        # before contact it swings less: those peaks are not looked at
        (lambda t: risen(t, 500.0) or 0.2 * math.sin(2.0 * math.pi * 700.0 * t), 1e-3),
        # a later and larger peak is not waited for
        (lambda t: risen(t, 500.0) * (1.0 + 200.0 * max(0.0, t - 4e-3)), 1e-3),
    ],
    ids=["one mode", "compression", "ripples", "before contact", "larger later"],
)
def test_the_first_distinct_peak_is_found(stress: Callable[[float], float], at: float) -> None:
    assert first_peak(stress) == pytest.approx(at, abs=2.0 * STEP)


def test_without_contact_or_while_it_grows_there_is_no_peak() -> None:
    assert first_peak(lambda t: math.sin(2.0 * math.pi * 300.0 * t), end=TOUCHED - STEP) is None
    assert first_peak(lambda t: max(0.0, t - TOUCHED)) is None
    scene = shortened(load_scene("rotor2-case1")).set({"run.duration": "7.5 ms"})
    with pytest.raises(TouchdownError, match=r"no distinct peak within 0.0075 s; .*run.duration"):
        stress_readings.first_peak(scene)
    # a shorter wait takes a ripple for the peak
    found = first_peak(lambda t: risen(t, 500.0) + 0.3 * risen(t, 5000.0), wait=3e-5)
    assert found is not None
    assert found < 0.75e-3


def test_the_root_mean_square_of_logarithms() -> None:
    assert rms_of_logarithms([2.0, 3.0], [2.0, 3.0]) == 0.0
    assert rms_of_logarithms([1.1, 1.0 / 1.1], [1.0, 1.0]) == pytest.approx(math.log(1.1))
    assert rms_of_logarithms([1.0, 1.0, 1.0, math.e], [1.0] * 4) == pytest.approx(0.5)
    assert math.isnan(rms_of_logarithms([1.0, 0.0], [1.0, 1.0]))
    assert math.isnan(rms_of_logarithms([math.nan], [1.0]))


def drop(stresses: tuple[float, ...], read: float | None = None, **seats: Mapping[str, object]) -> Summary:
    """A summary of a drop; stresses in MPa, read at a time (s)."""
    rotor = dict(zip(COLUMNS, (1e6 * stress for stress in stresses), strict=True))
    return {"seats": seats, "components": {"rotor": {**rotor, "kept_stress_time": read}}}


def test_what_is_read_of_an_ensemble() -> None:
    whirl = {"whirl_episodes": [{"direction": "backward"}]}
    drops = [
        drop((3.0, 4.0, 0.6, 0.8), 0.0079, A={"first_contact_time": 0.008, **whirl},
             B={"first_contact_time": 0.007}),
        drop((4.0, 3.0, 0.8, 0.6), 0.009, A=whirl, B={"whirl_episodes": []}),
        drop((5.0, 0.0, 1.0, 0.0), A={"whirl_episodes": []}, B={"whirl_episodes": None}),
    ]  # fmt: skip
    assert medians(drops) == pytest.approx([4.0, 3.0, 0.8, 0.6])
    assert resultants(drops) == pytest.approx((5.0, 1.0))
    assert instants(drops[:1]) == pytest.approx([0.9])
    assert whirls(drops) == "A 2, B 0 of 3 whirl"
    assert all(math.isnan(value) for value in (*medians([]), *resultants([])))


def test_every_assumption_is_printed_with_what_it_sets() -> None:
    text = "\n".join(stress_readings.assumption_lines())
    for assumption in ASSUMPTIONS:
        assert assumption.about in text
        assert assumption.because in text
        for name, value in assumption.settings.items():
            assert f".{name.partition('.')[2]} = {value}" in text


def test_every_case_has_both_readings() -> None:
    assert set(READINGS) == set(SOURCE) == {*AT_FIRST_PEAK, *AT_LARGEST}
    assumed = {name: value for a in ASSUMPTIONS for name, value in a.settings.items()}
    for case, readings in READINGS.items():
        source, true = list(readings.values())[:2]
        assert source.items() <= assumed.items()  # it sets nothing that is not an assumption
        for settings in readings.values():
            open_system(read_as(case, settings), in_process=True).close()
        assert not {"rotor.modes", "rotor.residual", "rotor.stress.mode_acceleration"} & set(true)
        assert not any("friction" in name for name in true)


@pytest.mark.parametrize(("case", "change"), CHANGES, ids=[f"{c}: {change.about}" for c, change in CHANGES])
def test_every_change_can_be_assembled_and_changes_something(case: str, change: Change) -> None:
    changed = as_read(case, change)
    assert change.wait != WAIT or changed.resolved()["components"] != as_read(case).resolved()["components"]
    open_system(changed, in_process=True).close()


def test_the_other_rotor_is_as_the_first_and_made_otherwise() -> None:
    """Mass, polar inertia, seats and the frequencies of Table 2; lengths and diameters differ by much."""
    first, other = rotor_named("rotor_II"), rotor_named(str(OTHER_ROTOR))
    assert other.mass == pytest.approx(first.mass, rel=1e-3)
    assert other.polar_inertia == pytest.approx(first.polar_inertia, rel=1e-3)
    assert np.array(other.positions())[[1, 24]] == pytest.approx(
        np.array(first.positions())[[1, 24]], abs=1e-5
    )
    assert basis(other, 6).omega[2:] == pytest.approx(basis(first, 6).omega[2:], rel=1e-3)
    lengths, diameters = (
        np.array([getattr(e, name) for e in other.elements])
        / np.array([getattr(e, name) for e in first.elements])
        for name in ("length", "outer_diameter")
    )
    assert lengths.max() > 1.4
    assert diameters.max() > 1.15


def test_read_as_the_source_reads_it_the_first_impact_agrees() -> None:
    """One unbalance phase of case 1: rms of logarithms at most 0.1, 0.9 ms after contact."""
    scene = shortened(as_read("1").set({"run.duration": "12 ms"}))
    figures, _ = stress_readings.first_peak(scene)
    assert rms_of_logarithms(medians([figures]), SOURCE["1"][:4]) < 0.1
    assert instants([figures])[0] == pytest.approx(0.93, abs=0.05)


@pytest.mark.slow
def test_a_table_of_one_short_drop(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The source's figures, both readings, assumptions, changes; and as many drops as announced."""
    short = {"run.duration": 9e-3, "amb_A.shutdown_time": "2 ms", "amb_B.shutdown_time": "2 ms"}
    readings = {"1": {"as read": {**READINGS["1"]["as the dissertation reads"], **short}, "true": short}}
    monkeypatch.setattr(stress_readings, "READINGS", readings)
    changes = {"1": (Change("support", {"housing_A.stiffness": 134e6}),)}
    monkeypatch.setattr(stress_readings, "AT_FIRST_PEAK", changes)
    monkeypatch.setattr(stress_readings, "AT_LARGEST", {})
    planned, done = [], []
    drops = Drops(tmp_path, 1, Progress(planned.append, lambda: done.append(1)))
    lines = stress_readings.stress_readings(drops, 1)
    assert len(done) == sum(planned) == 4
    text = [line.split() for line in lines]
    assert text[1] == ["case", "1,", "the", "source:", "no", "whirl", "8.76", "2.28", "0.59", "0.16"]
    assert [line[:2] for line in text[2::2][:3]] == [["as", "read"], ["the", "same"], ["true", text[6][1]]]
    assert float(text[2][2]) == pytest.approx(8.76, rel=0.1)
    assert lines[3].endswith("A 0, B 0 of 1 whirl")
    assert "rms of logarithms 0.0" in lines[3]
    moved = next(line for line in text if line[:1] == ["support"])
    assert float(moved[7]) > 0.01
    assert not any("stopped" in line for line in lines)


def test_a_figure_that_no_drop_has_is_a_dash() -> None:
    drops = [{"seats": {"A": {"whirl_revolutions": turns}}} for turns in (1.0, 3.0, 8.0, None)]
    assert spread(numbers([*drops, {}], "whirl_revolutions")) == "3 (1 to 8)"
    assert spread(numbers(drops, "whirl_radius")) == "-"
