"""Loops measured in the nonlinear run: against closed forms, and against the linear loops."""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path

import levitation as lev
import numpy as np
import pytest
from places import ROOT
from pythonfmu import FmuBuilder

import touchdown
from touchdown.command.cli import main
from touchdown.master.scene.file import load_scene, read_names
from touchdown.studies.loop import measured_response
from touchdown.studies.loop.over_speed import Found

DISK = "disk-caged-relevitated"


@pytest.fixture(autouse=True)
def few_lines(monkeypatch: pytest.MonkeyPatch):
    """Odd multiples of 20 Hz to 2 kHz or so, so that a period has 500 samples."""
    monkeypatch.setattr(measured_response, "FIRST", 20.0)
    monkeypatch.setattr(measured_response, "LAST", 0.2)
    monkeypatch.setattr(measured_response, "RATIO", 1.4)


def measured(scene: touchdown.Scene, amplitude: str = "0.1 um") -> Found:
    """At the scene's own speed alone."""
    return touchdown.amb_margins(scene, speeds=["9000 rpm"], measure=True, amplitude=amplitude)


def by_hand(omega: np.ndarray) -> Mapping[str, np.ndarray]:
    """Of the disk's axis: P with the sample until a set point acts, C of z, L and S."""
    z, ahead = np.exp(1j * omega * lev.PERIOD), lev.from_sample_to_sample(lev.PERIOD)
    plant = np.array([np.linalg.solve(one * np.eye(4) - ahead[:4, :4], ahead[:4, 4])[3] / one for one in z])
    slope = lev.KD * lev.FILTER * (z - 1) / ((1 + lev.FILTER * lev.PERIOD) * z - 1)
    law = lev.KP + lev.KI * lev.PERIOD * z / (z - 1) + slope
    return {"P": plant, "C": law, "L": law * plant, "S": 1 / (1 + law * plant)}


def test_the_disk_at_a_small_amplitude_is_that_by_hand():
    """S to 2e-4, which falls with the square of the amplitude: it is the cubic part of the magnets' law.

    P is known where |L| is not small; the compliance far above the loop's band is 1/(m omega^2).
    """
    found = measured(lev.Loop().scene(1.0, 1e-4)).measured
    assert found is not None
    omega, values = found.answers.omega, found.answers.values
    assert omega[0] == pytest.approx(2 * math.pi * 20.0, rel=1e-12)
    assert omega[-1] > 2 * math.pi * 1500.0
    hand, loud = by_hand(omega), np.abs(by_hand(omega)["L"]) > 0.1
    for k in (0, 1):
        assert values["S"][:, k] == pytest.approx(hand["S"], rel=5e-4)
        assert values["C"][:, k] == pytest.approx(hand["C"], rel=5e-5)
        assert values["P"][loud, k] == pytest.approx(hand["P"][loud], rel=5e-4)
        assert values["G"][-1, k] == pytest.approx(-1 / (lev.MASS * omega[-1] ** 2), rel=2e-2)
        assert found.deviation("G", k) < 5e-4  # the swing of the linear loops under a force
        off = np.abs(values["S"][:, k] / hand["S"] - 1).max()
        assert found.deviation("S", k) == pytest.approx(off, rel=0.3)
    assert found.halved < 5e-4
    assert found.remarks == ()


def test_limits_and_a_large_amplitude_show(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
):
    """Of a current limit just above the bias and the holding current; with the columns of the table."""
    monkeypatch.setattr(measured_response, "PERIODS", 8)
    words = ["amb-margins", DISK, "--speeds", "9000 rpm", "--measure", "--amplitude", "1.5 um"]
    assert main([*words, "--set", "amb.amplifier.current_limit=2.6", "-o", str(tmp_path)]) == 0
    said = capsys.readouterr().out
    assert "excited at amb.axis[1], amb was at its current limit for" in said
    (changed,) = [line for line in said.splitlines() if "at half the amplitude" in line]
    assert float(changed.split()[-2]) > 1.0  # per cent
    head, first = (tmp_path / "answers.csv").read_text("utf-8").splitlines()[:2]
    assert "measured Re(S) [1] amb.axis[2]" in head
    assert first.endswith(",")  # a line of the linear loops alone
    assert (tmp_path / "bode.png").exists()


@pytest.mark.slow
def test_a_controller_of_others_gives_the_same(tmp_path: Path):
    """And the unbalance, left out, does not show; what is left of transients differs by 1.3e-4."""
    FmuBuilder.build_FMU(ROOT / "examples" / "pid_controller.py", dest=tmp_path)
    names = read_names(ROOT / "examples" / "pid_controller.toml")
    own = load_scene(DISK).set({"rotor.eccentricity": "10 um"})
    fmu = own.swap(controller=str(tmp_path / "PidController.fmu")).with_names("controller", names)
    ours, theirs = (measured(one).measured for one in (own, fmu.set({"controller.sampled": "100 us"})))
    assert ours is not None
    assert theirs is not None
    for name in "SPCG":
        assert theirs.answers.values[name] == pytest.approx(ours.answers.values[name], rel=4e-4)


def test_loops_that_do_not_levitate_are_not_measured():
    found = measured(load_scene(DISK).set({"controller.gain.derivative": 0.0}))
    assert found.faults
    assert found.measured is None
