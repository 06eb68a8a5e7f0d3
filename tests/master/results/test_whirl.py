"""What the whirl classifier says of made orbits: turns, frequency, times. Which: `test_whirl_orbits`."""

from __future__ import annotations

import math
from pathlib import Path

import h5py
import numpy as np
import pytest

from touchdown.master.coupling.simulation import Outcome, open_system
from touchdown.master.results.recording import Recording
from touchdown.master.results.run import run_scene
from touchdown.master.results.summary import summarise
from touchdown.master.results.table import result_table
from touchdown.master.results.whirl.verdict import OrbitVerdict, WhirlVerdict, classify
from touchdown.master.scene.file import load_scene

CLEARANCE = 3e-4  # m
BOTTOM = -0.5 * math.pi
SPIN = 900.0  # rad/s


def times(end: float, rate: float = 20e3) -> np.ndarray:
    return np.arange(round(end * rate) + 1) / rate


def judged(
    time: np.ndarray, angle: np.ndarray, radius: np.ndarray | float = 1.02, spin: float = SPIN
) -> OrbitVerdict:
    """Verdict on an orbit given by its angle (rad) and its radius over the clearance."""
    r = CLEARANCE * np.asarray(radius)
    return classify(time, r * np.cos(angle), r * np.sin(angle), CLEARANCE, spin)


def turning(time: np.ndarray, frequency: float, begin: float = 0.0, end: float = math.inf) -> np.ndarray:
    """Angle that stands at the bottom but for turning (Hz, counter-clockwise) from `begin` to `end` (s)."""
    return BOTTOM + 2.0 * math.pi * frequency * (np.clip(time, begin, end) - begin)


@pytest.mark.parametrize("rate", [12.5e3, 11e3])
def test_a_whirl_that_is_recorded_too_coarsely_cannot_be_told(rate: float) -> None:
    time = times(0.1, rate)
    found = judged(time, turning(time, 5000.0))
    assert found.words == "cannot tell: sampled too coarsely"
    assert judged(times(0.1, 80e3), turning(times(0.1, 80e3), 5000.0)).verdict == WhirlVerdict.FORWARD


@pytest.mark.parametrize(
    ("frequency", "spin", "verdict", "rate"),
    [
        (60.0, SPIN, "forward whirl", 10e3),
        (-60.0, -SPIN, "forward whirl", 20e3),
        (-2000.0, SPIN, "backward whirl", 10e3),
    ],
)
def test_a_whirl_to_the_end(frequency: float, spin: float, verdict: str, rate: float) -> None:
    time = times(1.0, rate)
    found = judged(time, turning(time, frequency, begin=0.2), spin=spin)
    assert found.verdict == verdict
    assert found.words == f"{verdict}, still so at the end"
    assert found.goes_on
    assert found.revolutions == pytest.approx(0.8 * abs(frequency))
    assert found.frequency == pytest.approx(abs(frequency), rel=1e-6)
    assert found.radius == pytest.approx(1.02 * CLEARANCE)
    assert found.start == pytest.approx(0.2, abs=1e-3)
    assert found.end == pytest.approx(1.0, abs=1e-3)


def test_rest_with_noise_after_a_whirl_is_not_timed() -> None:
    """The largest angle of the rest comes anywhere in it, also at its end."""
    time = times(1.0)
    noise = np.radians(1.0) * np.sin(400.0 * time) * time
    found = judged(time, turning(time, 40.0, 0.2, 0.3) + noise)
    assert found.words == "transient forward whirl"
    assert found.frequency == pytest.approx(40.0, rel=0.05)
    assert (found.start, found.end) == (pytest.approx(0.2, abs=2e-3), pytest.approx(0.3, abs=2e-3))


@pytest.mark.parametrize(("low", "width"), [(0.3, 0.002), (0.6, 0.012)])
def test_a_flight_ends_a_whirl(low: float, width: float) -> None:
    """Past the centre, or further round than a hop; it goes on in the same direction afterwards."""
    time = times(1.0)
    radius = np.where(np.abs(time - 0.4) < width, low, 1.02)
    found = judged(time, turning(time, -50.0), radius)
    assert found.words == "backward whirl, still so at the end"
    assert found.revolutions == pytest.approx(50.0 * (0.6 - width), abs=0.2)
    assert found.start == pytest.approx(0.4 + width, abs=1e-3)


def test_a_reversal_ends_a_whirl() -> None:
    """The one that goes on counts, though the other was longer."""
    time = times(1.0)
    found = judged(time, turning(time, 50.0, end=0.7) + turning(time, -50.0, begin=0.7) - BOTTOM)
    assert found.words == "backward whirl, still so at the end"
    assert found.revolutions == pytest.approx(15.0, abs=0.1)
    assert found.start == pytest.approx(0.7, abs=1e-3)
    assert [(e.direction, e.goes_on) for e in found.episodes] == [("forward", False), ("backward", True)]
    assert found.episodes[0].revolutions == pytest.approx(35.0, abs=0.1)
    assert found.episodes[0].end == pytest.approx(0.7, abs=1e-3)


def test_the_radius_may_grow_beyond_the_clearance() -> None:
    time = times(1.0)
    found = judged(time, turning(time, -100.0), 1.0 + 2.0 * time)
    assert found.words == "backward whirl, still so at the end"
    assert found.radius == pytest.approx(2.0 * CLEARANCE, rel=1e-2)
    assert found.revolutions == pytest.approx(100.0)


@pytest.mark.parametrize("count", [0, 2])
def test_next_to_nothing_recorded(count: int) -> None:
    assert judged(times(1.0)[:count], turning(times(1.0)[:count], 50.0)) == OrbitVerdict(WhirlVerdict.NONE)


def test_values_that_are_no_numbers_are_passed_over() -> None:
    time = times(1.0)
    angle = turning(time, 50.0)
    angle[-1000:] = np.nan
    assert judged(time, angle).words == "transient forward whirl"


# -- in the summary ----------------------------------------------------------------------------------


def test_the_summary_judges_the_journal_in_its_housing(tmp_path: Path) -> None:
    """A recorded drop whose motion is replaced by a made one: the housing moves as far as the journal."""
    scene = load_scene("disk-caged-simplified").set({"run.duration": 0.1})
    run_scene(scene, tmp_path, in_process=True)
    with h5py.File(tmp_path / "result.h5", "a") as file:
        time = np.asarray(file["time"])
        angle = turning(time, -100.0, 0.02, 0.08)
        for axis, part in (("x", np.cos(angle)), ("y", np.sin(angle))):
            away = 4e-4 * np.sin(700.0 * time)
            file[f"housing/seat.{axis}"][...] = away
            file[f"rotor/A.{axis}"][...] = away + 1.02 * CLEARANCE * part
        for axis, part in (("x", np.cos(angle)), ("y", np.sin(angle))):
            file[f"bearing/journal.f{axis}"][...] = -1e3 * part
        file["bearing/contact.force"][...] = 1e3 * time
        file["bearing/contact.peak_force"][...] = 500.0
    system = open_system(scene, in_process=True)
    recording = Recording(tmp_path / "result.h5")
    summary = summarise(scene, system, Outcome(steps=1, zero=5e-3, end=0.105), recording)
    recording.close()
    system.close()
    seat = summary["seats"]["A"]
    assert seat["whirl"] == "transient backward whirl, 0.0199 to 0.08 s"
    assert seat["whirl_revolutions"] == pytest.approx(6.0)
    assert seat["whirl_radius"] == pytest.approx(1.02 * CLEARANCE)
    assert seat["whirl_frequency"] == pytest.approx(100.0)
    assert seat["whirl_largest_force"] == pytest.approx(80.0, abs=0.2)
    assert seat["whirl_episodes"] == [
        {
            "direction": "backward",
            "start": pytest.approx(0.02, abs=1e-4),
            "end": pytest.approx(0.08, abs=1e-4),
            "revolutions": seat["whirl_revolutions"],
            "frequency": seat["whirl_frequency"],
            "radius": seat["whirl_radius"],
            "largest_force": seat["whirl_largest_force"],
            "force_phase": pytest.approx(0.0, abs=1e-9),  # without friction
            "goes_on": False,
        }
    ]
    assert seat["most_turns_one_way"] == pytest.approx(6.0)
    assert next(line for line in result_table(summary).splitlines() if "counted" in line).split()[-1] == "1"


def test_a_rotor_dropped_far_out_of_line_whirls(tmp_path: Path) -> None:
    """Rotor I at 18000 rpm, 450 um out of line: a turn takes 4 ms from the first contact on."""
    scene = load_scene("rotor1-18000-225um").set({"run.duration": 0.04, "run.macro_step": 4e-5})
    seat = run_scene(scene, tmp_path, in_process=True).summary["seats"]["A"]
    assert seat["whirl"].startswith("backward whirl, at 0.04 s still whirling, ")
    (episode,) = seat["whirl_episodes"]
    assert episode["direction"] == "backward"
    assert episode["goes_on"]
    assert episode["revolutions"] == seat["whirl_revolutions"] > 3.0
    assert episode["largest_force"] == pytest.approx(seat["peak_contact_force"])
    assert episode["radius"] == pytest.approx(300e-6, rel=0.05)
    friction = 0.15
    assert 0.0 < math.tan(episode["force_phase"]) <= friction  # it drives the whirl
