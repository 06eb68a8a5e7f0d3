"""Pictures of a run, and the spectra they show."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest
from matplotlib.colors import to_hex
from matplotlib.text import Text

from touchdown import open_result
from touchdown.master.coupling.connections import Attachment, housing_port
from touchdown.master.results.final_state import FinalState, FinalValues, Finished
from touchdown.master.results.folder import PICTURES
from touchdown.master.results.recording import Recording
from touchdown.master.results.run import run_scene
from touchdown.master.results.spectra import (
    POINTS,
    WINDOW_S,
    WINDOW_START_S,
    full_spectra,
    on_grid,
    spectral_lines,
    velocity_spectrum,
    waterfall,
    window_starts,
)
from touchdown.master.results.summary import touchdown_seats
from touchdown.master.scene.file import load_scene
from touchdown.reports.figures.energy import STYLES, energy
from touchdown.reports.figures.forces import forces
from touchdown.reports.figures.motion import BY_TIME, draw_orbit, paths, speeds
from touchdown.reports.figures.plot import OF_BEARING, draw_all
from touchdown.reports.figures.spectra import has_waterfall, motion_waterfall, spectrum
from touchdown.reports.figures.style import BLUE, CALM, LAST_ZOOM_S, calm, draw_dense, sheet, zooms

RATE = 10e3  # Hz


def times(end: float, rate: float = RATE) -> np.ndarray:
    """Of a recording from 5 ms before the shutdown to `end` (s), summed up as a run does."""
    steps = np.full(round((end + 5e-3) * rate), 1.0 / rate)
    return -5e-3 + np.concatenate([[0.0], np.cumsum(steps)])


def sine(time: np.ndarray, frequency: float, speed: float) -> np.ndarray:
    """Positions (m) of a vibration at `frequency` (Hz) whose velocity has the amplitude `speed` (m/s)."""
    turn = 2.0 * np.pi * frequency
    return speed / turn * np.sin(turn * time + 0.7)


@pytest.mark.parametrize("frequency", [28.0, 3900.0])
def test_a_sine_comes_out_of_the_spectrum(frequency: float) -> None:
    """At 3900 Hz the mean over the interval takes a quarter off, which the function has to put back.

    A line of a hundredth beside it is not lost.
    """
    speed, time = 1e-3, times(3.0)  # m/s
    position = sine(time, frequency, speed) + sine(time, frequency + 4.0, 1e-2 * speed) + 3e-6 - 2e-5 * time
    f, amplitude = velocity_spectrum(time, position, WINDOW_START_S, WINDOW_S, POINTS)
    peak = int(np.argmax(amplitude))
    assert f[1] == pytest.approx(RATE / POINTS)
    assert f[peak] == pytest.approx(frequency, abs=f[1])
    assert amplitude[peak] == pytest.approx(speed, rel=0.01)
    assert np.max(amplitude[np.abs(f - frequency - 4.0) < 0.5]) == pytest.approx(1e-2 * speed, rel=0.1)


def test_fast_vibrations_and_fine_recordings() -> None:
    """The alias of what is too fast hardly shows; all points of a finer recording are used."""
    time = times(3.0)
    f, amplitude = velocity_spectrum(time, sine(time, 50_400.0, 1.0), WINDOW_START_S, WINDOW_S, POINTS)
    assert f[np.argmax(amplitude)] == pytest.approx(400.0, abs=0.1)
    assert np.max(amplitude) < 0.01
    time = times(0.11, rate=100e3)
    f, amplitude = velocity_spectrum(time, sine(time, 1000.0, 1e-3), 0.0, 0.1, 4096)
    assert len(f) == 1 + 10_000 // 2
    assert np.max(amplitude) == pytest.approx(1e-3, rel=0.01)
    with pytest.raises(ValueError, match="the recording ends before"):
        velocity_spectrum(time, np.zeros_like(time), WINDOW_START_S, WINDOW_S, POINTS)


@pytest.mark.parametrize(
    ("end", "count"), [(0.1, 0), (2.3, 0), (WINDOW_START_S + WINDOW_S, 1), (2.4, 1), (5.0, 3), (6.2429, 4)]
)
def test_whole_windows_follow_one_another(end: float, count: int) -> None:
    time = np.linspace(0.0, end, 1 + round(end * RATE))
    starts = window_starts(time)
    np.testing.assert_allclose(starts, WINDOW_START_S + WINDOW_S * np.arange(count))
    for start in starts:
        velocity_spectrum(time, np.zeros_like(time), start, WINDOW_S, POINTS)


@pytest.mark.parametrize("window", ["hann", "boxcar"])
def test_a_waterfall_follows_a_line_that_moves(window: str) -> None:
    """Each part has its own frequency, exactly on the spectrum's grid, and its own amplitude."""
    rate, points, spectra = 20e3, 4096, 4
    size = 5000
    time = 0.3 + np.arange(spectra * size) / rate
    spacing = rate / points
    part = np.arange(len(time)) // size
    values = 7.0 + (1.0 + part) * np.cos(2.0 * np.pi * spacing * (100 - 10 * part) * (time - 0.3) + 0.4)
    f, centres, amplitude = waterfall(time, values, points, rate, spectra, window)
    assert f[1] == pytest.approx(spacing)
    np.testing.assert_allclose(centres, 0.3 + (np.arange(spectra) + 0.5) * size / rate)
    assert amplitude.shape == (spectra, 1 + points // 2)
    np.testing.assert_array_equal(np.argmax(amplitude, axis=1), 100 - 10 * np.arange(spectra))
    np.testing.assert_allclose(np.max(amplitude, axis=1), 1.0 + np.arange(spectra), rtol=1e-3)


def test_a_waterfall_resamples_nothing() -> None:
    time = np.arange(20_000) / 10e3
    with pytest.raises(ValueError, match="must have the rate 20000 Hz"):
        waterfall(time, time, 1024)
    uneven = np.insert(time, 500, 0.5 * (time[499] + time[500]))
    with pytest.raises(ValueError, match="throughout"):
        waterfall(uneven, uneven, 1024, 10e3)
    assert np.array_equal(uneven[on_grid(uneven)], time)
    with pytest.raises(ValueError, match="each of 8 parts has 2500 values"):
        waterfall(time, time, 4096, 10e3)


def test_the_tallest_lines_are_picked() -> None:
    """Between the spectrum's frequencies, without the side lobes of the tallest."""
    time = np.arange(32768) / 20e3
    tones = ((33.3, 1.0), (61.77, 2e-2), (90.05, 0.3), (120.0, 5.0))
    values = sum(a * np.sin(2.0 * np.pi * f * time + f) for f, a in tones)
    f, _, amplitude = waterfall(time, np.asarray(values), spectra=1)
    found = spectral_lines(f, amplitude[0], 10.0, 100.0, 3)
    assert [x for x, _ in found] == pytest.approx([33.3, 90.05, 61.77], abs=0.02)
    assert [y for _, y in found] == pytest.approx([1.0, 0.3, 2e-2], rel=0.04)
    assert spectral_lines(f, amplitude[0], 10.0, 100.0, 1) == found[:1]
    assert spectral_lines(f, np.zeros_like(f), 10.0, 100.0, 3) == []


def test_zooms_of_short_runs_do_not_repeat() -> None:
    assert zooms(times(5.0), 0.5) == [
        (0.0, 0.5),
        (0.0, pytest.approx(5.0)),
        (pytest.approx(5.0 - LAST_ZOOM_S), pytest.approx(5.0)),
    ]
    assert len(zooms(times(0.1), 0.5)) == 2
    assert len(zooms(times(0.02), 0.5)) == 1
    assert zooms(np.array([-5e-3, -1e-3]), 0.5) == [(-5e-3, -1e-3)]


@pytest.fixture(scope="module")
def landed(tmp_path_factory: pytest.TempPathFactory) -> Finished:
    """A drop on the caged bearing with balls as bodies, over its first impact."""
    scene, folder = (
        load_scene("disk-caged-detailed").set({"run.duration": 0.014}),
        tmp_path_factory.mktemp("landed"),
    )
    result = run_scene(scene, folder, in_process=True, draw=draw_all)
    assert {p.name for p in result.pictures} == {*PLAIN, "contacts.png"}
    return Finished(result.scene, result.ending, result.recording)


PLAIN = {"orbit.png", "force.png", "speeds.png", "energy.png"}


def test_a_run_that_touches_nothing_has_its_pictures(tmp_path: Path) -> None:
    """Without an inset; a later run knows their files, to remove them."""
    scene = load_scene("disk-caged-simplified").set({"run.duration": 0.002})
    result = run_scene(scene, tmp_path, in_process=True, draw=draw_all)
    assert {p.name for p in result.pictures} == PLAIN
    assert all(picture.read_bytes().startswith(b"\x89PNG") for picture in result.pictures)
    assert {picture.name for picture in OF_BEARING} <= set(PICTURES)
    run = Finished(result.scene, result.ending, result.recording)
    assert not forces(sheet(), run, *touchdown_seats(run.system))[0].child_axes


def made_up(
    path: Path, end: float, rate: float = RATE, **columns: Callable[[np.ndarray], Any]
) -> Recording:
    """A recording up to a time (s), of functions of time by variables of the rotor at A."""
    time = times(end, rate)
    with h5py.File(path, "w") as file:
        file["time"] = time
        for name, values in columns.items():
            file[f"rotor/A.{name}"] = values(time)
        file["bearing/ring.x"] = 1e-6 * columns["x"](time)
    return Recording(path)


def test_a_circle_is_on_the_side_of_its_sense() -> None:
    """With its radius; what swings is on both sides, each with half its amplitude."""
    time = np.arange(20_000) / RATE
    turns = np.exp(2j * np.pi * 300.0 * time), 0.1 * np.exp(-2j * np.pi * 80.0 * time)
    z = turns[0] + turns[1] + 0.4 * np.cos(2.0 * np.pi * 40.0 * time) + 5.0 + 3.0j
    frequency, middles, amplitude = full_spectra(time, z, 0.1, 8)
    assert np.all(np.diff(frequency) > 0.0)
    assert middles[[0, -1]] == pytest.approx([0.05, 1.95], abs=1e-3)
    found = {
        round(hertz): amplitude[:, np.argmin(np.abs(frequency - hertz))] for hertz in (300, -80, 40, -40)
    }
    for hertz, height in ((300, 1.0), (-80, 0.1), (40, 0.2), (-40, 0.2)):
        np.testing.assert_allclose(found[hertz], height, rtol=1e-3)
    assert amplitude[:, np.abs(frequency + 300.0) < 5.0].max() < 1e-6


SPIN = 900.0  # rad/s


@pytest.mark.parametrize(
    ("end", "rate", "there"), [(1.0, RATE, True), (0.2, RATE, False), (1.0, 400.0, False)]
)
@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_a_waterfall_tells_with_the_spin_from_against_it(
    end: float, rate: float, there: bool, sense: float, tmp_path: Path
) -> None:
    """A whirl at 60 Hz against the spin of a rotor that slows down; names stand apart."""
    whirl = -sense * 2.0 * np.pi * 60.0
    recording = made_up(
        tmp_path / "made.h5", end, rate,
        omega=lambda t: sense * (SPIN - 100.0 * t),
        x=lambda t: 1e-4 * np.cos(whirl * t), y=lambda t: 1e-4 * np.sin(whirl * t),
    )  # fmt: skip
    seat = Attachment("bearing", "journal", "rotor", "A")
    assert has_waterfall(recording, seat) is there
    if there:
        run = Finished(load_scene("disk-caged-simplified"), FinalState({}, [], []), recording)
        figure, marks = sheet(), [(61.0, "pendulum"), (62.0, "mode"), (2000.0, "bending")]
        near, wide = motion_waterfall(figure, run, seat, marks)
        figure.draw_without_rendering()
        (mesh,) = near.collections
        height, field = mesh.get_coordinates()[:-1, 0, 1], np.ma.getdata(mesh.get_array())
        assert height[np.argmax(field[:, len(field[0]) // 2])] == pytest.approx(-60.0, abs=10.0)
        assert field.max() == pytest.approx(100.0, rel=0.02)
        assert "bearing" in figure.get_suptitle()
        names = [text.get_text() for text in near.texts]
        assert names == ["1x", "mode", "pendulum", "pendulum", "mode", "1x"]
        assert [text.get_text() for text in wide.texts] == ["bending", "bending"]
        boxes = [Text.get_window_extent(text) for text in near.texts]
        assert not any(a.overlaps(b) for i, a in enumerate(boxes) for b in boxes[:i])
        (top,) = near.child_axes
        shown = [float(label.get_text()) for label in top.get_xticklabels()]
        assert shown == pytest.approx(30.0 / np.pi * (SPIN - 100.0 * top.get_xticks()), abs=2.0)
    recording.close()


def test_few_lines_of_many_windows_are_drawn(tmp_path: Path) -> None:
    """Of a run with 15 windows four from the first to the last, each in its own colour."""
    recording = made_up(tmp_path / "made.h5", 21.0, 1e3, omega=lambda t: 900.0 - t, x=np.sin)
    run = Finished(load_scene("disk-caged-simplified"), FinalState({}, [], []), recording)
    for axes in spectrum(sheet(), run, Attachment("bearing", "journal", "rotor", "A")):
        lines = [line for line in axes.lines if not str(line.get_label()).startswith("_")]
        assert [str(line.get_label())[:6] for line in lines] == ["1.00 s", "7.55 s", "12.80 ", "19.35 "]
        assert len({line.get_color() for line in lines}) == 4
    recording.close()


def test_every_curve_of_energy_can_be_told_from_the_others(tmp_path: Path) -> None:
    """By colour, mark and style, for a dozen components; small ones are named, those of zero are not."""
    names = [f"part_{i}" for i in range(12)]
    time = times(0.01, 1e4)
    with h5py.File(tmp_path / "made.h5", "w") as file:
        file["time"] = time
        for i, name in enumerate(names):
            for kind in STYLES:
                file[f"{name}/energy.{kind}"] = 1e-6 * time if i == 11 else time * (i < 10)
    recording = Recording(tmp_path / "made.h5")
    figure = sheet()
    told: dict[str, Any] = {f"energy.{kind}": None for kind in STYLES}
    components = {name: FinalValues(told, {}) for name in names}
    run = Finished(load_scene("disk-caged-simplified"), FinalState(components, [], []), recording)
    flows, _ = energy(figure, run)
    looks = [(c.get_color(), c.get_marker(), c.get_linestyle()) for c in flows.lines]
    assert len(looks) == 30
    assert len(set(looks)) == 30
    offsets = [c.get_markevery()[0] for c in flows.lines]
    assert len({round(offset, 6) for offset in offsets}) == 30, "marks of equal curves stand apart"
    legend = flows.get_legend()
    assert legend is not None
    assert len(legend.get_texts()) == 30
    assert "part_11 kinetic" in flows.get_title()
    assert "part_10" not in flows.get_title()
    recording.close()


def test_the_first_impact_is_an_inset_of_the_forces(dropped: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Which hides none of them; forces die down here, as those of later impacts are left out."""
    result, read = open_result(dropped), Recording.__getitem__
    run = Finished(result.scene, result.ending, result.recording)
    early = result.recording.time < 0.012
    fading = lambda self, name: read(self, name) * (early if name.endswith(".force") else 1.0)  # noqa: E731
    monkeypatch.setattr(Recording, "__getitem__", fading)
    (seat,) = touchdown_seats(run.system)
    figure = sheet()
    panels = forces(figure, run, seat)
    (inset,) = panels[0].child_axes
    (curve,) = inset.lines
    time, force = np.asarray(curve.get_data())
    assert inset.get_xlim() == pytest.approx((-0.5, 5.0))
    assert force[time < -0.05].max() == 0.0
    assert force.max() == pytest.approx(run.recording["bearing.contact.force"].max())
    assert 0.1 < time[np.argmax(force)] < 1.2  # ms
    figure.draw_without_rendering()
    for axes in panels:
        for inset in axes.child_axes:
            left, bottom = axes.transAxes.inverted().transform(inset.get_window_extent().p0)
            for line in axes.lines:
                x, y = axes.transAxes.inverted().transform(axes.transData.transform(line.get_xydata())).T
                assert y[x > left].max(initial=0.0) < bottom


def test_the_true_peak_is_marked(landed: Finished) -> None:
    """As a dot, which is no lower than any recorded value; the bearing is named above."""
    (seat,) = touchdown_seats(landed.system)
    figure = sheet()
    panels = forces(figure, landed, seat)
    (dot,) = (line for line in panels[0].lines if line.get_marker() == "o")
    (time, force), recording = dot.get_xydata()[0], landed.recording
    assert force == landed.system.value("bearing.contact.peak_force")
    assert force >= recording["bearing.contact.force"].max()
    assert recording["bearing.contact.peak_force"][recording.time < time].max() < force
    assert "\nbearing: largest contact force" in figure.get_suptitle()


def test_an_orbit_tells_time_and_sense(landed: Finished) -> None:
    """The colours of the way are those of the key, in their order; the arrow turns as the rotor spins."""
    (seat,) = touchdown_seats(landed.system)
    axes = draw_orbit(sheet().subplots(), landed, seat)
    ways = [line for line in axes.lines if line.get_label() == "_rotor"]
    assert [line.get_color() for line in ways] == [to_hex(BY_TIME(k)) for k in range(BY_TIME.N)]
    assert np.all(np.diff([line.get_zorder() for line in ways]) < 0.0), "the landing is in front"
    assert sum(len(line.get_xdata()) for line in ways) >= len(landed.recording.time)
    (spin,) = (np.asarray(line.get_xydata()) for line in axes.lines if line.get_label() == "_spin")
    turned = spin[0][0] * spin[-1][1] - spin[0][1] * spin[-1][0]
    assert (turned > 0.0) == (landed.system.value("rotor.speed") > 0.0)
    assert not [line for line in axes.lines if line.get_label() == "_whirl"]


def test_the_clearance_is_about_the_housing(landed: Finished, monkeypatch: pytest.MonkeyPatch) -> None:
    """Also where that stands beside the axis of the magnets; the landing is drawn from near."""
    (seat,) = touchdown_seats(landed.system)
    port = housing_port(landed.system, seat.bearing)
    assert port is not None
    columns = {name: landed.recording[name] for name in (f"{port}.x", seat.motion("x"))}
    read = Recording.__getitem__
    monkeypatch.setattr(
        Recording, "__getitem__", lambda self, name: read(self, name) + 2e-4 * (name in columns)
    )
    whole, near, *_ = paths(sheet(), landed, seat)
    (circle,) = (np.asarray(line.get_xydata()) for line in whole.lines if line.get_label() == "clearance")
    radius = 1e6 * landed.system.value("bearing.clearance")
    assert circle.min(axis=0) == pytest.approx([200.0 - radius, -radius], abs=0.5)
    assert circle.max(axis=0) == pytest.approx([200.0 + radius, radius], abs=0.5)
    touched = 1e6 * np.array([columns[seat.motion("x")][-1], 0.0])[0] + 200.0
    assert near.get_xlim()[0] < touched < near.get_xlim()[1]
    assert near.get_xlim()[1] - near.get_xlim()[0] == pytest.approx(radius)
    assert all("bearing" in axes.get_title() for axes in (whole, near))


def test_a_dense_curve_is_drawn_by_what_it_lies_between() -> None:
    """Of a minute of swings all extremes are kept, to the last value; a short run is a line."""
    time = np.linspace(0.0, 60.0, 60_001)
    values = np.sin(300.0 * time) * np.linspace(1.0, 3.0, len(time))
    values[[777, -1]] = 9.0, -8.0
    axes = sheet().subplots()
    draw_dense(axes, time, values, BLUE, "gap")
    high, low = (np.asarray(line.get_ydata()) for line in axes.lines)
    assert (high.max(), low.min(), low[-1]) == (9.0, -8.0, -8.0)
    assert len(high) < 1000
    assert np.all(high > low)
    assert len(axes.collections) == 1
    assert axes.get_legend_handles_labels()[1] == ["gap"]
    draw_dense(axes, time[:600], values[:600], BLUE, "short")
    np.testing.assert_array_equal(axes.lines[-1].get_ydata(), values[:600])
    draw_dense(axes, time, time, BLUE, "smooth")
    assert len(axes.collections) == 1


def test_forces_that_grow_have_no_inset(landed: Finished, monkeypatch: pytest.MonkeyPatch) -> None:
    """Rather than a panel that is empty but for its lowest part."""
    (seat,) = touchdown_seats(landed.system)
    read, end = Recording.__getitem__, landed.recording.time[-1]
    grown = 1e4 * np.clip(landed.recording.time / end, 0.0, 1.0) ** 3
    shown = lambda self, name: grown if name == "bearing.contact.force" else read(self, name)  # noqa: E731
    monkeypatch.setattr(Recording, "__getitem__", shown)
    panel = forces(sheet(), landed, seat)[0]
    assert not panel.child_axes
    assert panel.get_ylim()[1] < 1.2e4


@pytest.mark.parametrize(("noise", "calmed"), [(1e-12, True), (1.0, False)])
def test_rounding_fills_no_panel(noise: float, calmed: bool) -> None:
    """A curve that rises to 100 and stays: its end is drawn no larger than a part of that."""
    axes = sheet().subplots()
    values = np.append(np.linspace(0.0, 100.0, 50), 100.0 + noise * np.array([-20.0, 20.0]))
    axes.plot([0.0, 1.0], values[-2:])
    calm(axes, [values])
    low, high = axes.get_ylim()
    assert (high - low == pytest.approx(CALM * float(np.ptp(values)))) == calmed


def test_a_calm_panel_shows_nothing_below_zero_of_what_has_no_sign() -> None:
    axes = sheet().subplots()
    axes.plot([0.0, 1.0], [0.0, 0.0])
    calm(axes, [np.array([0.0, 500.0, 0.0])])
    low, high = axes.get_ylim()
    assert (low, high) == pytest.approx((-0.5, 9.5))


def test_no_two_curves_of_a_panel_look_the_same(landed: Finished) -> None:
    """In colour or line; each that has a name has one of its own, and the bearing's is in the title."""
    (seat,) = touchdown_seats(landed.system)
    for draw in (forces, speeds, paths):
        figure = sheet()
        for axes in draw(figure, landed, seat):
            named = [line for line in axes.lines if not str(line.get_label()).startswith("_")]
            looks = [(line.get_color(), line.get_linestyle(), line.get_marker()) for line in named]
            assert len(set(looks)) == len(looks)
            assert len({line.get_label() for line in named}) == len(named)
        assert "bearing" in figure.get_suptitle()


def test_speeds_are_in_rpm_with_cage_and_balls_apart(landed: Finished) -> None:
    """What rolls without slip is as fast as the geometry of the bearing says."""
    (seat,) = touchdown_seats(landed.system)
    panels = speeds(sheet(), landed, seat)
    drawn = {line.get_label(): np.asarray(line.get_ydata())[-1] for axes in panels for line in axes.lines}
    value = landed.system.value
    assert drawn["rotor"] == pytest.approx(value("rotor.speed") * 30.0 / np.pi, rel=0.01)
    assert drawn["inner ring without slip"] == pytest.approx(0.97 * drawn["rotor"], rel=1e-6)
    ratio = value("bearing.balls.diameter") / value("bearing.balls.pitch_diameter")
    assert drawn["inner ring"] > 500.0
    assert drawn["cage"] == pytest.approx(0.5 * (1.0 - ratio) * drawn["inner ring"], rel=0.2)
    assert drawn["balls, mean"] > drawn["inner ring"], "of the last panels: the balls' spin"
    assert {axes.get_ylabel() for axes in panels} >= {"rotor, ring [rpm]", "round the axis [rpm]"}


def test_the_legend_of_energies_stands_beside_the_curves(landed: Finished) -> None:
    figure = sheet()
    flows, _ = energy(figure, landed)
    figure.draw_without_rendering()
    legend = flows.get_legend()
    assert legend is not None
    assert legend.get_window_extent().x0 > flows.get_window_extent().x1
    ends = {line.get_label(): np.asarray(line.get_ydata())[-1] for line in flows.lines}
    named = [ends[text.get_text()] for text in legend.get_texts()]
    assert named == sorted(named, reverse=True)
