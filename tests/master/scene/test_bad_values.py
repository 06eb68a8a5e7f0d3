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


def test_unknown_scene_to_show(command: Command):
    assert "unknown scene nope" in command("scenes", "nope").line


@pytest.mark.parametrize(
    ("arguments", "named"),
    [
        (("--set", "bering.clearance=1e-4"), "no component bering; did you mean bearing"),
        (("--set", "bearing.clearence=1e-4"), "no variable clearence; did you mean clearance"),
        (("--set", "bearing=1"), "cannot set bearing"),
        (("--set", "bearing.clearance"), "write NAME=VALUE"),
        (("--set", "bearing.contact.force=1"), "bearing.contact.force"),
        (("--set", "run.macrostep=1e-5"), "run.macrostep is not a known key"),
        (("--set", "run.scheme=interfaces"), "unknown scheme interfaces; did you mean interface"),
        (("--set", "run.scheme=none"), "unknown scheme none"),
        (("--swap", "bering=bushing"), "no component bering"),
        (("--swap", "bearing=bushings"), "no FMU called bushings; did you mean bushing"),
        (("--swap", "bearing"), "write NAME=VALUE"),
        (("--set", "bearing.clearance=-1e-4"), "bearing.clearance = -0.0001 m"),
        (("--set", "bearing.clearance=0"), "clearance = 0 m"),
        (
            ("--set", "bearing.clearance=0.3"),
            "clearance = 0.3 m is out of all proportion to journal_radius = 0.0097 m; it may be half of "
            "that at most. A plain number is in m; write '0.3 mm' where mm are meant",
        ),
        (("--set", "bearing.balls.play=5e-3"), "balls.play = 0.005 m is out of all proportion to half of"),
        (("--set", "bearing.balls.play=-5"), "balls.play = -5 m is out of all proportion"),
        (
            ("--set", "bearing.contact.expected_indentation=1e-2"),
            "contact.expected_indentation = 0.01 m is out of all proportion",
        ),
        (("--set", "amb.shutdown_time=-1"), "amb.shutdown_time = -1 s must be at least 0 s"),
        (
            ("--set", "bearing.friction.kind=0", "--set", "bearing.friction.static=0.3"),
            "friction.static = 0.3 does nothing with friction.kind = 0 (Coulomb), whose coefficient is "
            "friction.dynamic = 0.1; leave it out, or take friction.kind = 1",
        ),
        (("--set", "rotor.mass=-1"), "rotor.mass = -1 kg"),
        (("--set", "rotor.mass=0"), "mass = 0 kg"),
        (("--set", "rotor.mass=nan"), "rotor.mass = 'nan'"),
        (("--set", "rotor.mass=inf"), "rotor.mass = 'inf'"),
        (("--set", "bearing.clearance=3 kg"), "bearing.clearance = '3 kg' has the unit kg; it is"),
        (("--set", "bearing.clearance=3 furlong"), "furlong"),
        (("--set", "bearing.clearance=wide"), "bearing.clearance = 'wide' is not a number"),
        (("--set", "bearing.balls.count=2"), "bearing.balls.count = 2"),
        (("--set", "bearing.balls.count=9.5"), "whole number"),
        (("--set", "bearing.balls.count=31"), "do not fit"),
        (("--set", "run.macro_step=nan"), "run.macro_step = 'nan'"),
        (("--set", "run.macro_step=0"), "run.macro_step = '0' must be above 0"),
        (("--set", "run.macro_step=-1e-5"), "run.macro_step = '-1e-5' must be above 0"),
        (("--set", "run.macro_step=1 kg"), "run.macro_step = '1 kg' has the unit kg"),
        (("--set", "run.duration=-1"), "run.duration = '-1' must be above 0"),
        (("--set", "run.record_every=1.5"), "run.record_every = '1.5'"),
    ],
    ids=lambda value: " ".join(value) if isinstance(value, tuple) else "",
)
def test_a_value_that_cannot_be(arguments: tuple[str, ...], named: str, run: Command, tmp_path: Path):
    ended = run(SCENE, *SHORT, *arguments)
    assert named in ended.line
    assert ended.status == FAILED
    assert not (tmp_path / "out" / "result.h5").exists()


@pytest.mark.parametrize(
    ("bearing", "setting", "named"),
    [
        ("detailed_caged", "balls.pitch_diameter=16 mm", "balls of 0.0064 m do not fit"),
        ("detailed_caged", "balls.count=31", "do not fit balls.pitch_diameter"),
        ("detailed_caged", "cage.clearance=-1 um", "smaller than its ball"),
        ("detailed_caged", "cage.clearance=5", "cage.clearance = 5 m is out of all proportion"),
        ("detailed_caged", "cage.mass=0", "cage.mass = 0 kg"),
        ("detailed_caged", "inner_profile.amplitude=0.01", "inner_profile.amplitude = 0.01 m"),
        ("detailed_caged", "micro_step=-1 us", "micro_step = -1e-06 s"),
        ("detailed_cageless", "balls.bunching=2", "balls.bunching = 2"),
        (
            "detailed_cageless",
            "outer_profile.wear=0.5 mm,outer_profile.wear_width=0.05",
            "outer_profile.wear = 0.0005 m bends the race",
        ),
        ("detailed_cageless", "race_friction.g2=5", "race_friction.g2 = 5"),
        ("simplified_caged", "slip=2", "slip = '2' is none of its choices: off (0), on (1)"),
        ("bushing", "contact.damping_ratio=0.1", "needs contact.mass"),
        ("bushing", "clearance=0.3", "clearance = 0.3 m is out of all proportion to journal_radius"),
    ],
)
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
