"""Captured, lost or undecided: of made motions, and of a disk whose magnets can lift it or not."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from systems import run_to_end

from touchdown.master.results.capture import HOLD, WITHIN, CaptureVerdict, judge
from touchdown.master.scene.file import load_scene

CLEARANCE = 0.3e-3  # m
END = 1.0  # s
TIME = np.linspace(-0.2, END, 12_001)


def verdict(
    free: float, inside: float, end: float = END, lost: str = "", again: float = 9.0
) -> CaptureVerdict:
    """In contact up to `free`, beyond half the clearance up to `inside`; in contact `again` (s)."""
    here = end >= TIME
    radius = np.where(inside > TIME, 0.9 * CLEARANCE, 0.2 * CLEARANCE)
    force = np.where((free > TIME) | (np.abs(TIME - again) < 1e-3), 50.0, 0.0)
    return judge(TIME[here], radius[here], force[here], CLEARANCE, HOLD, lost)


def test_captured_from_when_it_stays():
    found = verdict(0.02, 0.03)
    assert (found.words, found.peak_force) == ("captured", 50.0)
    assert found.after == pytest.approx(0.03, abs=2e-4)
    assert found.last_contact == pytest.approx(0.02, abs=2e-4)


def test_without_any_contact_after_the_command():
    found = verdict(-0.1, 0.01)
    assert (found.words, found.last_contact, found.peak_force) == ("captured", None, 0.0)


def test_a_contact_at_the_end_undoes_it():
    assert verdict(0.02, 0.03, again=0.9).words == "lost: rebounds"


def test_a_late_capture_is_none():
    assert verdict(0.02, WITHIN - 0.01).words == "captured"
    assert verdict(0.02, WITHIN + 0.01).words == "lost: rebounds"


def of_radius(radius: np.ndarray, end: float) -> CaptureVerdict:
    """In contact for 20 ms after the command, then of a radius (m) at `TIME` up to `end` (s)."""
    here = end >= TIME
    return judge(TIME[here], radius[here], np.where(TIME[here] < 0.02, 50.0, 0.0), CLEARANCE, HOLD)


@pytest.mark.parametrize(
    ("rate", "end", "words"),
    [
        (2.0, 0.9, "undecided: cannot tell yet, it leaves half the clearance again"),
        (2.0, 0.4, "undecided: cannot tell yet, it moves ever farther"),
        (-2.0, 0.9, "captured"),
        (0.0, 0.9, "captured"),
        (0.1, 0.9, "captured"),  # it leaves in 4 s: nothing in a drop can tell it from a beat
    ],
)
def test_a_rotor_that_leaves_half_the_clearance_is_not_captured_yet(rate: float, end: float, words: str):
    """Of 0.3 times half the clearance at first, growing by a rate (1/s): it comes to all at 0.6 s."""
    radius = 0.15 * CLEARANCE * np.exp(rate * TIME) * (1.0 + 0.02 * np.sin(200.0 * TIME))
    assert of_radius(radius, end).words == words


def test_a_rotor_that_is_pushed_out_for_a_moment_is_not_captured_yet_and_what_grows_in_noise_is():
    pushed = np.where(np.abs(TIME - 0.8) < 0.01, 0.7, 0.1) * CLEARANCE
    assert of_radius(pushed, 1.0).words.startswith("undecided: cannot tell yet")
    assert of_radius(np.where(TIME < 0.7, 1e-12, 2e-12), 1.0).words == "captured"


def test_growth_beyond_any_number_and_quarters_without_rows_are_judged():
    """Out of rest, which tells no growth; out of next to nothing; rows twice as far apart as a quarter."""
    late = np.where(TIME < 0.25, 0.0, 0.1) * CLEARANCE
    assert of_radius(late, 0.3).words == "captured"
    assert of_radius(np.maximum(late, 1e-300), 0.3).words.endswith("it moves ever farther")
    rare = np.arange(3) * 0.15
    inside = np.full(3, 0.1 * CLEARANCE)
    assert judge(rare, inside, np.zeros(3), CLEARANCE, HOLD).words == "captured"


def test_why_it_is_lost():
    assert verdict(9.0, 9.0).words == "lost: not lifted"
    assert verdict(0.5, 9.0, lost="whirl").words == "lost: whirl"
    assert verdict(0.02, 0.03, lost="through the gap").words == "captured"


def test_a_run_that_ends_early_is_undecided():
    assert verdict(0.02, 9.0, end=WITHIN).words == "undecided: the run ends too early"
    assert verdict(0.02, 0.03, end=0.03 + HOLD / 2).words.startswith("undecided")


@pytest.mark.parametrize(("limit", "words"), [(6.0, "captured"), (2.0, "lost")])
def test_a_disk_that_its_magnets_can_lift_or_not(tmp_path: Path, limit: float, words: str):
    """2.50 A in the upper coils lift it; it is asked for 40 ms after the drop."""
    scene = load_scene("disk-caged-relevitated").set(
        {"amb.amplifier.current_limit": limit, "controller.event[2].time": "45 ms", "run.duration": "0.6 s"}
    )
    summary = run_to_end(scene, tmp_path)
    assert summary["seats"]["A"]["capture"].partition(":")[0] == words
    assert summary["capture_command_time"] == pytest.approx(0.04)
    assert 0.0 < summary["largest_coil_current"] < 8.0
    assert (summary["time_at_current_limit"] > 0.1) == (limit < 2.5)


def test_a_drop_without_a_command_says_nothing_of_it(tmp_path: Path):
    scene = load_scene("disk-caged-simplified").set({"run.duration": "20 ms"})
    assert not any("capture" in key for key in run_to_end(scene, tmp_path))
