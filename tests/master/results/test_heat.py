"""Heat, temperatures and gaps of bearings in a run's figures and in its report."""

from __future__ import annotations

import numpy as np
import pytest

import touchdown
from touchdown.master.report.blocks import Remark, Series, Table
from touchdown.master.report.chapters.heat import heat
from touchdown.master.report.subject import Subject
from touchdown.master.results import heat as results_heat
from touchdown.master.results.final_state import Finished
from touchdown.master.results.heat import PARTS, closing, warmed
from touchdown.master.results.result import Result
from touchdown.master.results.summary import touchdown_seats

SPECIFIC = 460.0  # J/(kg K)


@pytest.fixture(scope="module")
def dropped() -> Result:
    """The first impacts of the disk."""
    scene = touchdown.load("disk-caged-simplified").set({"run.duration": "15 ms"})
    return touchdown.run(scene, in_process=True, pictures=False)


def number(result: Result, key: str) -> float:
    return float(str(result.summary[key]))


def test_heat_by_part_is_all_heat(dropped: Result) -> None:
    parts = sum(number(dropped, f"bearing_heat_{part}_J") for part in PARTS)
    assert parts > 1e-3
    assert parts == pytest.approx(number(dropped, "bearing_heat_J"), rel=1e-12)
    assert number(dropped, "bearing_sliding_work_J") > 0.0


def test_without_conduction_a_ring_keeps_its_heat(dropped: Result) -> None:
    """By its mass and steel's specific heat; what flows off in milliseconds is little."""
    mass = dropped.ending.value("bearing.ring.mass")
    adiabatic = number(dropped, "temperature_rise_inner_adiabatic_K")
    assert adiabatic == pytest.approx(number(dropped, "bearing_heat_inner_J") / (mass * SPECIFIC), rel=1e-9)
    assert number(dropped, "temperature_rise_inner_K") == pytest.approx(adiabatic, rel=0.01)


def test_heat_stays_in_the_bearing_but_for_what_leaves(dropped: Result) -> None:
    """Of 15 ms next to nothing leaves: capacities times temperatures are the heat."""
    finished = Finished(dropped.scene, dropped.ending, dropped.recording)
    found = warmed(finished, touchdown_seats(finished.system)[0])
    assert found is not None
    housing = SPECIFIC / dropped.ending.value("bearing.housing.inv_m")
    kept = found.capacities @ found.warmth[-1, :4] + housing * found.warmth[-1, 4]
    assert kept == pytest.approx(number(dropped, "bearing_heat_J"), rel=2e-3)


def test_the_report_tells_temperatures_and_what_they_rest_on(dropped: Result) -> None:
    blocks = heat(Subject(dropped))
    tables = [b for b in blocks if isinstance(b, Table)]
    assert [len(t.rows) for t in tables] == [1, 2, 1]
    assert any(isinstance(b, Series) for b in blocks)
    assert not any(isinstance(b, Remark) for b in blocks)  # nothing gets warm


def test_a_bushing_has_heat_and_no_temperatures() -> None:
    scene = touchdown.load("disk-caged-simplified").swap(bearing="bushing").set({"run.duration": "12 ms"})
    result = touchdown.run(scene, in_process=True, pictures=False)
    assert number(result, "bearing_heat_inner_J") > 0.0
    assert not [key for key in result.summary if key.startswith("temperature_")]
    assert not any(isinstance(b, Series) for b in heat(Subject(result)))


TIME = np.linspace(0.0, 1.0, 201)


@pytest.mark.parametrize(
    ("rising", "runs_away"),
    [
        (np.exp(3.0 * TIME), True),  # by 35 % more in each tenth of the run
        (20.0 * TIME, False),  # evenly, as by a drag that stays
        (20.0 * (1.0 - np.exp(-3.0 * TIME)), False),  # towards a steady state
        (0.3 * np.exp(3.0 * TIME), False),  # too little to matter
    ],
)
def test_a_preload_that_grows_ever_faster_runs_away(rising: np.ndarray, runs_away: bool) -> None:
    """Of 5 um of play, less what heat takes."""
    found = closing(TIME, 5e-6 - 1e-6 * rising)
    assert found is not None
    assert found.preload == pytest.approx(1e-6 * rising[-1] - 5e-6)
    assert found.rate == pytest.approx(1e-5 * (rising[-1] - rising[180]))
    assert found.runs_away == runs_away


def test_play_that_is_left_is_no_preload() -> None:
    assert closing(TIME, 5e-6 - 4e-6 * TIME**4) is None


def test_heat_that_closes_the_play_is_warned_of(monkeypatch: pytest.MonkeyPatch) -> None:
    """Bearings without play in a whirl that grows: half a micrometre of preload, ever faster."""
    monkeypatch.setattr(results_heat, "NOTED_PRELOAD", 1e-7)
    scene = touchdown.load("rotor1-18000-225um").set({"run.duration": "0.12 s", "bearing_*.thermal": 1})
    result = touchdown.run(scene, in_process=True, pictures=False)
    lines = [text for text in result.warnings if "heat has closed its play to a preload of 0." in text]
    assert [line.partition(":")[0] for line in lines] == ["bearing_A", "bearing_B"]
    remarks = [b.text for b in heat(Subject(result)) if isinstance(b, Remark)]
    assert f"{lines[0]}." in remarks
