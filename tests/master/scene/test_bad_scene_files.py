"""Scene files that cannot be: one line that names what is wrong in them."""

from __future__ import annotations

from pathlib import Path

import pytest
from commands import SCENE, SHORT, Command

from touchdown.master.common.errors import FAILED
from touchdown.master.scene.file import shipped_scenes


def scene_file(folder: Path, *changes: tuple[str, str]) -> Path:
    """A copy of the shipped scene with text replaced."""
    text = shipped_scenes()[SCENE].read_text(encoding="utf-8")
    for old, new in changes:
        assert old in text
        text = text.replace(old, new, 1)
    path = folder / "mine.toml"
    path.write_text(text, encoding="utf-8")
    return path


@pytest.mark.parametrize(
    ("old", "new", "named"),
    [
        ("[run]", "[run", "not valid TOML"),
        ("[run]", "[extra]\nkey = 1\n[run]", "extra is not a known key"),
        ("duration = 5.0", "duraton = 5.0", "run.duraton is not a known key; did you mean duration"),
        ("duration = 5.0", 'duration = "long"', "run.duration = 'long' is not a number"),
        ("duration = 5.0", "scheme = 3", "unknown scheme 3"),
        ('fmu = "amb"', 'fmu = "amb"\ncolour = "red"', "components.amb.colour is not a known key"),
        ("[components.amb]", '[components."a/b"]', "the name of a component = 'a/b' must be"),
        ("[components.amb]", '[components."."]', "the name of a component = '.'"),
        ('fmu = "amb"', "", "components.amb.fmu is missing"),
        ('fmu = "amb"', "fmu = 3", "components.amb.fmu = 3 must be the name"),
        ('fmu = "amb"', 'fmu = "amc"', "no FMU called amc"),
        ('fmu = "amb"', 'fmu = "amb"\nsettings = ""', "cannot read settings"),
        ('mass = "1.65 kg"', "mass = [1.65]", "rotor.mass = [1.65] is not a number"),
        ('mass = "1.65 kg"', "mass = nan", "rotor.mass = nan is not a finite number"),
        ('mass = "1.65 kg"', "weight = 1.65", "no variable weight"),
        ('zero = "amb.shutdown_time"', 'zero = "amb.shutdown"', "no variable shutdown"),
        ('zero = "amb.shutdown_time"', 'zero = "20 mm"',
         "zero = '20 mm' has the unit mm; it is measured in s"),
        ('zero = "amb.shutdown_time"', "zero = true", "zero = True must be the name of a variable"),
        ('zero = "amb.shutdown_time"', 'zero = "bearing.clearance"',
         "zero = bearing.clearance is measured in m; it must be a time"),
        ('"rotor.gravity"', '"rotor.gravitation"', "no variable gravitation"),
        ('"rotor.gravity"', "9.81", "energy_scale"),
        ('["rotor.mass", "rotor.gravity", "bearing.clearance"]', '"rotor.mass"', "energy_scale"),
    ],
)  # fmt: skip
def test_a_bad_scene_file(old: str, new: str, named: str, run: Command, tmp_path: Path):
    ended = run(scene_file(tmp_path, (old, new)), *SHORT)
    assert named in ended.line
    assert ended.status == FAILED


@pytest.mark.parametrize(
    ("content", "named"),
    [
        (b"", "add [components.NAME]"),
        (b"\xff\xfe\x00", "is not text in UTF-8 (byte 0)"),
        (b"components = 3", "components = 3 must be a table"),
        (b"x = " + 3000 * b"[" + 3000 * b"]", "too deep in each other"),
        (b"[" + b".".join(3000 * [b"a"]) + b"]", "32 deep in each other"),
        (b'extends = "disk-caged-simplified"\n[components.amb' + 99 * b".a" + b"]", "32 deep"),
        (b"x = 1" + 5000 * b"0", "not valid TOML: Exceeds the limit"),
        (b'extends = "a\\u0000b.toml"', "holds a NUL character"),
        (b'[components."a\\u0000b"]', "holds a NUL character"),
        (b'extends = "disk-caged-simplified"\n[components.rotor.set]\nmass = 1' + 400 * b"0", "308 digits"),
    ],
)
def test_a_file_that_is_no_scene(content: bytes, named: str, run: Command, tmp_path: Path):
    path = tmp_path / "mine.toml"
    path.write_bytes(content)
    assert named in run(path).line


def test_a_byte_order_mark_is_understood(run: Command, tmp_path: Path):
    """As some editors begin a file with; the rest is read."""
    path = scene_file(tmp_path, ("duration = 5.0", "duraton = 5.0"))
    path.write_bytes(b"\xef\xbb\xbf" + path.read_bytes())
    assert "duraton is not a known key" in run(path).line


def test_a_missing_scene_file(run: Command, tmp_path: Path):
    assert f"cannot read scene {tmp_path / 'none.toml'}" in run(tmp_path / "none.toml").line


# -- connections -------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("connect", "named"),
    [
        ('["rotor.A.q", "housing.seat.fx"]', "component rotor (rigid_rotor, in process) has no variable A"),
        ('["rotor.A.x", "bearing.journal.q"]', "has no variable journal.q"),
        ('["bearing.housing.fy", "housing.seat.fx"]', "housing.seat.fx has two sources"),
        ('["rotor.A.x", "bearing.journal.vx"]', "the units m and m/s differ"),
        ('["rotor.A.fx", "housing.seat.fx"]', "rotor.A.fx has the causality"),
        ('["rotor.A.fx"]', "connect = ['rotor.A.fx'] must be a pair"),
    ],
)
def test_a_connection_that_cannot_be(connect: str, named: str, run: Command, tmp_path: Path):
    ended = run(scene_file(tmp_path, ("attach = [", f"connect = [{connect}]\nattach = [")))
    assert named in ended.line
    assert ended.status == FAILED


@pytest.mark.parametrize(
    ("old", "new", "named"),
    [
        ('"amb.journal"', '"amc.journal"', "no component amc"),
        ('"bearing.journal"', '"amb.journal"', "amb.journal.x has two sources"),
        ('["amb.journal", "rotor.amb"]', '["amb.journal"]', "attach = ['amb.journal'] must be a pair"),
    ],
)
def test_an_attachment_that_cannot_be(old: str, new: str, named: str, run: Command, tmp_path: Path):
    assert named in run(scene_file(tmp_path, (old, new))).line
