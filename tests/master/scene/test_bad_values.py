"""Names and values that cannot be: one line that names them, a status, and nothing left behind."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest
from commands import SCENE, SHORT, Command, Ended
from places import COMMAND

from touchdown.master.common.errors import FAILED


def test_the_command_itself(tmp_path: Path):
    """Once as a process; the other tests call its main function."""
    done = subprocess.run(
        [*COMMAND, "run", "no-such-scene", "-o", str(tmp_path / "out")],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == FAILED
    assert "no-such-scene" in Ended(done.returncode, done.stderr).line
    assert not (tmp_path / "out").exists()


# -- names and values --------------------------------------------------------------------------------


def test_unknown_scene(run: Command):
    line = run("disk-caged-simplifed").line
    assert "unknown scene disk-caged-simplifed" in line
    assert f"did you mean {SCENE}" in line


@pytest.mark.parametrize(
    ("settings", "named"),
    [
        ("bering.clearance=1e-4", "no component bering; did you mean bearing"),
        ("bearing.clearence=1e-4", "no variable clearence; did you mean clearance"),
        ("bearing=1", "cannot set bearing"),
        ("bearing.clearance", "write NAME=VALUE"),
        ("bearing.contact.force=1", "bearing.contact.force"),
        ("run.macrostep=1e-5", "run.macrostep is not a known key"),
        ("run.scheme=interfaces", "unknown scheme interfaces; did you mean interface"),
        ("--swap bearing=bushings", "no FMU called bushings; did you mean bushing"),
        ("--swap bearing", "write NAME=VALUE"),
        ("bearing.clearance=-1e-4", "bearing.clearance = -0.0001 m"),
        ("bearing.clearance=0.3",
         "clearance = 0.3 m is out of all proportion to journal_radius = 0.0097 m; it may be half of "
         "that at most. A plain number is in m; write '0.3 mm' where mm are meant"),
        ("bearing.balls.play=5e-3", "balls.play = 0.005 m is out of all proportion to half of"),
        ("amb.shutdown_time=-1", "amb.shutdown_time = -1 s must be at least 0 s"),
        ("bearing.friction.kind=0,bearing.friction.static=0.3",
         "friction.static = 0.3 does nothing with friction.kind = 0 (Coulomb), whose coefficient is "
         "friction.dynamic = 0.1; leave it out, or take friction.kind = 1"),
        ("rotor.mass=-1", "rotor.mass = -1 kg"),
        ("rotor.mass=nan", "rotor.mass = 'nan'"),
        ("bearing.clearance=3 kg", "bearing.clearance = '3 kg' has the unit kg; it is"),
        ("bearing.clearance=3 furlong", "furlong"),
        ("bearing.clearance=wide", "bearing.clearance = 'wide' is not a number"),
        ("bearing.balls.count=2", "bearing.balls.count = 2"),
        ("bearing.balls.count=9.5", "whole number"),
        ("bearing.balls.count=31", "do not fit"),
        ("run.macro_step=0", "run.macro_step = '0' must be above 0"),
        ("run.duration=-1", "run.duration = '-1' must be above 0"),
        ("run.record_every=1.5", "run.record_every = '1.5'"),
    ],
)  # fmt: skip
def test_a_value_that_cannot_be(settings: str, named: str, run: Command, tmp_path: Path):
    """Settings, parted by commas, or a swap."""
    swap = settings.removeprefix("--swap ")
    given = ["--swap", swap] if swap != settings else [a for s in settings.split(",") for a in ("--set", s)]
    ended = run(SCENE, *SHORT, *given)
    assert named in ended.line
    assert ended.status == FAILED
    assert not (tmp_path / "out" / "result.h5").exists()


@pytest.mark.parametrize(
    ("bearing", "setting", "named"),
    [
        ("detailed_caged", "balls.pitch_diameter=16 mm", "balls of 0.0064 m do not fit"),
        ("detailed_caged", "cage.clearance=-1 um", "smaller than its ball"),
        ("detailed_caged", "cage.clearance=5", "cage.clearance = 5 m is out of all proportion"),
        ("detailed_caged", "inner_profile.amplitude=0.01", "inner_profile.amplitude = 0.01 m"),
        ("detailed_caged", "micro_step=-1 us", "micro_step = -1e-06 s"),
        ("detailed_cageless", "balls.bunching=2", "balls.bunching = 2"),
        ("detailed_cageless", "outer_profile.wear=0.5 mm,outer_profile.wear_width=0.05",
         "outer_profile.wear = 0.0005 m bends the race"),
        ("detailed_cageless", "race_friction.g2=5", "race_friction.g2 = 5"),
        ("simplified_caged", "slip=2", "slip = '2' is not one of its choices: off (0), on (1)"),
        ("bushing", "contact.damping_ratio=0.1", "needs contact.mass"),
    ],
)  # fmt: skip
def test_a_bearing_that_cannot_be_built(
    bearing: str, setting: str, named: str, run: Command, tmp_path: Path
):
    settings = [part for one in setting.split(",") for part in ("--set", f"bearing.{one}")]
    ended = run("disk-caged-detailed", *SHORT, "--swap", f"bearing={bearing}", "--in-process", *settings)
    assert named in ended.line
    assert ended.status == FAILED
    assert not (tmp_path / "out" / "result.h5").exists()


def test_macro_step_longer_than_the_run(run: Command, tmp_path: Path):
    """Such a run cannot start, so it leaves nothing."""
    ended = run(SCENE, "--set", "run.macro_step=10 s")
    assert "run.macro_step = 10 s is longer than the run of 5.005 s" in ended.line
    assert ended.status == FAILED
    assert not (tmp_path / "out" / "result.h5").exists()
