"""What the number of modes costs: the comparison's figures, its command, and what it refuses."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pytest

from touchdown.command.cli import main
from touchdown.master.common.errors import FAILED, TouchdownError
from touchdown.master.scene.file import load_scene
from touchdown.studies.comparison.modes import Comparison, compare_modes, findings, parse_modes, runs
from touchdown.studies.drop.first_impact import AVERAGING_TIME, Trace

ROTOR_I = "rotor1-9000"
SHORT = ("--set", "amb_A.shutdown_time=1 ms", "--set", "amb_B.shutdown_time=1 ms", "--macro-step", "5 us")


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


def test_an_average_does_not_hang_on_the_macro_step() -> None:
    """A half sine of 1 ms: its mean over AVERAGE at the top, also with steps that do not divide it."""
    exact = 400.0 * np.sin(np.pi * AVERAGING_TIME / 2e-3) / (np.pi * AVERAGING_TIME / 2e-3)
    for step in (1e-6, 3e-6, 7e-6):
        time = step * np.arange(1, round(2e-3 / step))
        edges = np.concatenate([[0.0], time])
        impulse = -np.cos(np.pi * np.clip(edges, 0.0, 1e-3) / 1e-3) * 400.0 * 1e-3 / np.pi
        found = trace(time, np.diff(impulse) / step)
        assert found.peaks(2e-3).force == pytest.approx(exact, rel=1e-4)


def test_no_touch_is_no_impact() -> None:
    assert trace(1e-6 * np.arange(1, 9), np.zeros(8)).first_impact() is None


def compared(modes: list[int]) -> Comparison:
    """Rotor I, levitated for 1 ms."""
    scene = load_scene(ROTOR_I)
    for name in "AB":
        scene = scene.set({f"amb_{name}.shutdown_time": 1e-3})
    calls: list[int] = []
    found = compare_modes(scene, modes, 2e-6, done=lambda: calls.append(1))
    assert len(calls) == runs(modes)
    return found


@pytest.fixture(scope="module")
def rotor_i() -> Comparison:
    return compared([3])


def test_the_reference_is_better_than_what_is_measured_with_it(rotor_i: Comparison) -> None:
    assert 7.6e-3 < rotor_i.first < 7.8e-3
    assert rotor_i.reference.energy < 0.01
    assert not rotor_i.warnings
    assert rotor_i.coupling.orbit < 0.02 * rotor_i.rows[1].orbit
    for seat, exact in rotor_i.reference.seats.items():
        assert rotor_i.coupling.seats[seat].force == pytest.approx(exact.force, rel=2e-3)


def test_residual_flexibility_brings_motion_and_force_closer(rotor_i: Comparison) -> None:
    few, residual = rotor_i.rows
    assert few.orbit > 2.0 * residual.orbit
    errors = [
        max(
            abs(row.seats[seat].force / exact.force - 1.0)
            for seat, exact in rotor_i.reference.seats.items()
        )
        for row in (few, residual)
    ]
    assert errors[0] > 0.2
    assert errors[1] < 0.15


def test_mode_acceleration_finds_the_shear_that_few_modes_miss(rotor_i: Comparison) -> None:
    few, residual = rotor_i.rows
    exact = rotor_i.reference.displacement
    assert few.displacement.shear < 0.6 * exact.shear
    assert few.acceleration.shear == pytest.approx(exact.shear, rel=0.25)
    # residual vectors hold what the loads at the seats would add
    assert residual.displacement.shear == pytest.approx(residual.acceleration.shear, rel=1e-3)


def test_the_highest_frequency_is_known_where_the_seats_are_told_of_it(rotor_i: Comparison) -> None:
    few, residual = (row.frequency for row in rotor_i.rows)
    assert few == pytest.approx(1600.0, rel=0.01)  # the first bending mode
    assert residual == pytest.approx(6509.0, rel=0.01)  # of the stiffer residual vector
    assert rotor_i.reference.frequency is None  # more modes than a seat has places for


def test_the_table_says_what_the_reference_is(rotor_i: Comparison) -> None:
    text = findings(rotor_i).lines
    assert "macro step 1 us, energy residual" in text[1]
    assert text[2].startswith("  A: first impact 7.")
    assert [line.split()[0] for line in text[-3:]] == ["3", "3", "all"]
    assert len({len(line) for line in text[-3:]}) == 1


def test_what_is_written(rotor_i: Comparison, tmp_path: Path) -> None:
    findings(rotor_i).write(tmp_path)
    rows = table(tmp_path)
    assert [row["run"] for row in rows] == ["reference", "coupling", "modes", "modes"]
    assert [row["modes"] for row in rows] == ["all", "all", "3", "3"]
    assert [float(row["macro_step_s"]) for row in rows] == [1e-6, 2e-6, 2e-6, 2e-6]
    for row, found in zip(rows, (rotor_i.reference, rotor_i.coupling, *rotor_i.rows), strict=True):
        assert float(row["journal_force_N_B"]) == found.seats["B"].force
        assert float(row["orbit_error_um"]) == 1e6 * found.orbit
    assert float(rows[0]["journal_force_error_percent_A"]) == 0.0
    assert rows[0]["highest_frequency_Hz"] == ""
    assert (tmp_path / "modes.png").stat().st_size > 10_000
    with pytest.raises(TouchdownError, match="choose another folder with -o"):
        findings(rotor_i).write(tmp_path / "missing")


def table(folder: Path) -> list[dict[str, str]]:
    with (folder / "modes.csv").open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


@pytest.mark.long
def test_many_modes_leave_no_error() -> None:
    found = compared([20])
    residual = found.rows[1]
    assert residual.frequency is not None
    assert residual.frequency > 1e5
    assert residual.orbit < 0.05e-6
    assert residual.acceleration.shear == pytest.approx(found.reference.acceleration.shear, rel=0.03)
    for seat, exact in found.reference.seats.items():
        assert residual.seats[seat].force == pytest.approx(exact.force, rel=2e-3)
        assert residual.seats[seat].contact == pytest.approx(exact.contact, rel=2e-2)


@pytest.mark.long
def test_the_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    arguments = ("--modes", "2", "--duration", "0.3 ms", "--quiet", "-o", str(tmp_path))
    assert main(["compare-modes", ROTOR_I, *SHORT, *arguments]) == 0
    shown = capsys.readouterr()
    assert "up to 0.30" in shown.out
    rows = table(tmp_path)
    assert [row["modes"] for row in rows] == ["all", "all", "2", "2"]
    assert rows[2]["highest_frequency_Hz"] == ""  # rigid


@pytest.mark.parametrize(
    ("arguments", "named"),
    [
        (("disk-caged-simplified",), "has no flexible rotor"),
        (("rotor1",), "unknown scene rotor1; did you mean"),
        ((ROTOR_I, "--modes", "3,99"), "modes = 99 must be from 2 (rigid) to 40"),
        ((ROTOR_I, "--modes", "3,1"), "1 is less than 2, the rigid modes per plane"),
        ((ROTOR_I, "--modes", "0"), "all modes are the reference"),
        ((ROTOR_I, "--modes", "3,,5"), "'nothing' is not a whole number"),
        ((ROTOR_I, "--modes", "3.5"), "'3.5' is not a whole number"),
        ((ROTOR_I, "--macro-step", "-1e-6"), "--macro-step = -1e-06 s must be above 0"),
        ((ROTOR_I, "--macro-step", "2 m"), "--macro-step"),
        ((ROTOR_I, "--duration", "0"), "--duration = 0 s must be above 0"),
        ((ROTOR_I, "--set", "rotor.modes=3"), "--set rotor.modes: compare-modes sets it itself"),
        ((ROTOR_I, "--set", "run.macro_step=1e-5"), "use --macro-step"),
        ((ROTOR_I, "--set", "rotor.mode=3"), "no variable mode"),
    ],
)
def test_what_cannot_be_compared_is_one_line(
    arguments: tuple[str, ...], named: str, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    assert main(["compare-modes", *arguments, "--quiet", "-o", str(tmp_path)]) == FAILED
    complaint = capsys.readouterr().err
    assert len(complaint.splitlines()) == 1
    assert named in complaint


def test_a_drop_that_never_lands() -> None:
    scene = load_scene(ROTOR_I).set({"run.duration": 1e-3})
    with pytest.raises(TouchdownError, match=r"nothing touches down within run\.duration = 0\.001 s"):
        compare_modes(scene, [2], 1e-5)


def test_numbers_of_modes_are_put_in_order() -> None:
    assert parse_modes("12, 3,5,3") == (3, 5, 12)
