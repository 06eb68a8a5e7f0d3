"""What the number of modes costs: the comparison's figures, its command, and what it refuses."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from commands import records

from touchdown.master.common.errors import TouchdownError
from touchdown.master.common.progress import Progress
from touchdown.master.scene.file import load_scene
from touchdown.studies.comparison.engine import Comparison, Options
from touchdown.studies.comparison.modes import STRESS_METHODS, compare, mode_counts
from touchdown.studies.drop.impact_watch import AVERAGING_TIME, Trace

ROTOR_I = "rotor1-9000"


def trace(time: np.ndarray, fy: np.ndarray) -> Trace:
    """A vertical force, and as the contact's what it has been at most."""
    zero = np.zeros_like(time)
    return Trace(time, zero, zero, zero, fy, np.maximum.accumulate(fy), zero)


def test_the_first_impact_ends_where_the_journal_stays_free() -> None:
    """A rattle of 40 kHz opens the contact for 12 us at a time; a second impact is not the first."""
    time = 5e-7 * np.arange(1, 8001)
    rattle = 100.0 * (1.0 + np.sign(np.sin(2.0 * np.pi * 40e3 * (time - 2.5e-7))))
    first, second = (time > 1e-3) & (time < 1.6e-3), time > 3e-3
    found = trace(time, rattle * first + 1e3 * second)
    impact = found.first_impact()
    assert impact is not None
    assert impact == pytest.approx((1.0005e-3, 1.5875e-3), abs=1e-6)
    peaks = found.peaks(impact[1])
    assert peaks.force == pytest.approx(100.0, rel=1e-6)  # the mean over two periods
    assert peaks.contact == 200.0
    assert trace(1e-6 * np.arange(1, 9), np.zeros(8)).first_impact() is None  # no touch


def test_an_average_does_not_hang_on_the_macro_step() -> None:
    """A half sine of 1 ms: its mean over AVERAGE at the top, also with steps that do not divide it."""
    exact = 400.0 * np.sin(np.pi * AVERAGING_TIME / 2e-3) / (np.pi * AVERAGING_TIME / 2e-3)
    for step in (1e-6, 3e-6, 7e-6):
        time = step * np.arange(1, round(2e-3 / step))
        edges = np.concatenate([[0.0], time])
        impulse = -np.cos(np.pi * np.clip(edges, 0.0, 1e-3) / 1e-3) * 400.0 * 1e-3 / np.pi
        found = trace(time, np.diff(impulse) / step)
        assert found.peaks(2e-3).force == pytest.approx(exact, rel=1e-4)


@pytest.fixture(scope="module")
def rotor_i() -> Comparison:
    """Rotor I, levitated for 1 ms."""
    assert mode_counts(["12", " 3", "5", "3"], "--modes") == (3, 5, 12)
    scene = load_scene(ROTOR_I).set({f"amb_{name}.shutdown_time": 1e-3 for name in "AB"})
    pieces: list[int] = []
    found = compare(scene, Options(modes=[3]), Progress(pieces.append, lambda: pieces.append(-1)))
    assert pieces[0] == 6 == -sum(pieces[1:])
    return found


@pytest.mark.slow
def test_the_reference_is_better_than_what_is_measured_with_it(rotor_i: Comparison) -> None:
    coupling, exact = rotor_i.beside
    assert 7.6e-3 < rotor_i.reference.drop.first < 7.8e-3
    assert exact.values["energy"] < 0.01
    assert not rotor_i.warnings
    assert coupling.errors["orbit"] < 0.02 * rotor_i.rows[1].errors["orbit"]
    for seat in "AB":
        assert abs(coupling.errors[f"force error {seat}"]) < 2e-3
        assert coupling.values[f"force {seat}"] == pytest.approx(exact.values[f"force {seat}"], rel=2e-3)
    text = rotor_i.lines
    assert "macro step 1 us, energy residual" in text[1]
    assert text[2].startswith("  A: first impact 7.")
    assert [line.split()[0] for line in text[-4:]] == ["3", "3", "all,", "all,"]


def test_what_residual_vectors_and_mode_acceleration_bring(rotor_i: Comparison) -> None:
    """Residual vectors hold what the loads at the seats would add; acceleration finds the shear missed."""
    few, residual = (row.errors for row in rotor_i.rows)
    assert few["orbit"] > 2.0 * residual["orbit"]
    assert max(abs(few[f"force error {seat}"]) for seat in "AB") > 0.2
    assert max(abs(residual[f"force error {seat}"]) for seat in "AB") < 0.15
    assert few["shear error displacement"] < -0.4
    assert few["shear error acceleration"] == pytest.approx(0.0, abs=0.25)
    displacement, acceleration = (rotor_i.rows[1].values[f"shear {way}"] for way in STRESS_METHODS)
    assert displacement == pytest.approx(acceleration, rel=1e-3)
    bending, vector = (row.values["frequency"] for row in rotor_i.rows)
    assert bending == pytest.approx(1600.0, rel=0.01)  # the first bending mode
    assert vector == pytest.approx(6509.0, rel=0.01)  # of the stiffer residual vector
    assert "frequency" not in rotor_i.beside[1].values  # more modes than a seat has places for


def test_what_is_written(rotor_i: Comparison, tmp_path: Path) -> None:
    rotor_i.write(tmp_path)
    rows = records(tmp_path / "modes.csv")
    assert [row["variant"] for row in rows] == ["3", "3 residual", "all, coupling", "all, reference"]
    assert [float(row["macro_step_s"]) for row in rows] == [2e-6, 2e-6, 2e-6, 1e-6]
    for row, found in zip(rows, (*rotor_i.rows, *rotor_i.beside), strict=True):
        assert float(row["journal_force_N_B"]) == found.values["force B"]
        assert float(row["orbit_error_m"]) == found.errors["orbit"]
    assert float(rows[3]["journal_force_error_relative_A"]) == 0.0
    assert rows[3]["highest_frequency_Hz"] == ""
    assert (tmp_path / "modes.png").stat().st_size > 10_000
    with pytest.raises(TouchdownError, match="choose another folder with -o"):
        rotor_i.write(tmp_path / "missing")
