"""Pictures of a run, and the spectra they show."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from master.figures_style import LAST, zooms
from master.run import run_scene
from master.scene import load
from master.spectra import BEGIN, LENGTH, POINTS, velocity_spectrum, windows

RATE = 10e3  # Hz


def times(end: float, rate: float = RATE) -> np.ndarray:
    """Of a recording from 5 ms before the shutdown to `end` (s), summed up as a run does."""
    steps = np.full(round((end + 5e-3) * rate), 1.0 / rate)
    return -5e-3 + np.concatenate([[0.0], np.cumsum(steps)])


@pytest.mark.parametrize("frequency", [28.0, 972.0, 3900.0])
def test_a_sine_comes_out_of_the_spectrum(frequency: float) -> None:
    """At 3900 Hz the mean over the interval takes a quarter off, which the function has to put back."""
    speed = 1e-3  # m/s
    time = times(3.0)
    turn = 2.0 * np.pi * frequency
    position = speed / turn * np.sin(turn * time + 0.7) + 3e-6 - 2e-5 * time
    f, amplitude = velocity_spectrum(time, position, BEGIN, LENGTH, POINTS)
    peak = int(np.argmax(amplitude))
    assert f[1] == pytest.approx(RATE / POINTS)
    assert f[peak] == pytest.approx(frequency, abs=f[1])
    assert amplitude[peak] == pytest.approx(speed, rel=0.01)


def test_two_sines_stay_apart() -> None:
    time = times(3.0)
    first, second = 2.0 * np.pi * 100.0, 2.0 * np.pi * 104.0
    position = 1e-3 / first * np.sin(first * time) + 1e-5 / second * np.sin(second * time)
    f, amplitude = velocity_spectrum(time, position, BEGIN, LENGTH, POINTS)
    near = np.abs(f - 104.0) < 0.5
    assert np.max(amplitude[near]) == pytest.approx(1e-5, rel=0.05)


def test_a_fast_vibration_hardly_shows_as_an_alias() -> None:
    speed, frequency = 1.0, 50_400.0
    time = times(3.0)
    turn = 2.0 * np.pi * frequency
    f, amplitude = velocity_spectrum(time, speed / turn * np.sin(turn * time), BEGIN, LENGTH, POINTS)
    assert f[np.argmax(amplitude)] == pytest.approx(400.0, abs=0.1)
    assert np.max(amplitude) < 0.01 * speed


def test_a_finer_recording_than_the_points_is_not_cut_short() -> None:
    time = times(0.11, rate=100e3)
    turn = 2.0 * np.pi * 1000.0
    f, amplitude = velocity_spectrum(time, 1e-3 / turn * np.sin(turn * time), 0.0, 0.1, 4096)
    assert len(f) == 1 + 10_000 // 2
    assert np.max(amplitude) == pytest.approx(1e-3, rel=0.01)


def test_a_window_beyond_the_recording_is_refused() -> None:
    time = times(2.0)
    with pytest.raises(ValueError, match="the recording ends before"):
        velocity_spectrum(time, np.zeros_like(time), BEGIN, LENGTH, POINTS)


@pytest.mark.parametrize(
    ("end", "count"), [(0.1, 0), (2.3, 0), (BEGIN + LENGTH, 1), (2.4, 1), (5.0, 3), (6.2429, 4)]
)
def test_whole_windows_follow_one_another(end: float, count: int) -> None:
    time = np.linspace(0.0, end, 1 + round(end * RATE))
    starts = windows(time)
    np.testing.assert_allclose(starts, BEGIN + LENGTH * np.arange(count))
    for start in starts:
        velocity_spectrum(time, np.zeros_like(time), start, LENGTH, POINTS)


def test_zooms_of_short_runs_do_not_repeat() -> None:
    assert zooms(times(5.0), 0.5) == [
        (0.0, 0.5),
        (0.0, pytest.approx(5.0)),
        (pytest.approx(5.0 - LAST), pytest.approx(5.0)),
    ]
    assert len(zooms(times(0.1), 0.5)) == 2
    assert len(zooms(times(0.02), 0.5)) == 1
    assert zooms(np.array([-5e-3, -1e-3]), 0.5) == [(-5e-3, -1e-3)]


@pytest.mark.parametrize(
    ("name", "more"),
    [
        ("disk-caged-detailed", {"contacts.png"}),
        ("disk-cageless-simplified", set()),
    ],
)
@pytest.mark.parametrize("duration", [0.05, 0.002])
def test_a_short_run_has_its_pictures(name: str, more: set[str], duration: float, tmp_path: Path) -> None:
    scene = load(name).with_setting("run.duration", duration)
    pictures = run_scene(scene, tmp_path, in_process=True).pictures
    assert {p.name for p in pictures} == {"orbit.png", "force.png", "speeds.png", "energy.png"} | more
    for picture in pictures:
        assert picture.read_bytes().startswith(b"\x89PNG")
