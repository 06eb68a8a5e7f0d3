"""What users get wrong: one line on stderr that names the thing, a status, and never a traceback."""

from __future__ import annotations

import json
import re
import signal
import stat
import subprocess
import sys
import time
import zipfile
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import NamedTuple

import h5py
import pytest
from places import COMMAND

import touchdown.master.common.archives
from touchdown.master.cli import main
from touchdown.master.common.errors import FAILED, STOPPED
from touchdown.master.scene.file import shipped

SCENE = "disk-caged-simplified"
SHORT = ("--set", "run.duration=2e-3")
PATIENCE = 120.0  # s; a test that waits longer has failed


class Ended(NamedTuple):
    """How a command ended."""

    status: int
    stderr: str

    @property
    def line(self) -> str:
        """Its complaint, which must be one line, come from `touchdown`, and mean failure."""
        lines = self.stderr.splitlines()
        assert self.status != 0
        assert len(lines) == 1, self.stderr
        assert lines[0].startswith("touchdown: ")
        return lines[0]


Command = Callable[..., Ended]


@pytest.fixture
def touchdown(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> Command:
    """The command, run here in an empty folder."""
    (tmp_path / "here").mkdir()
    monkeypatch.chdir(tmp_path / "here")

    def run(*arguments: object) -> Ended:
        capsys.readouterr()
        try:
            status = main([str(argument) for argument in arguments])
        except SystemExit as stop:  # argparse
            status = int(stop.code or 0)
        return Ended(status, capsys.readouterr().err)

    return run


@pytest.fixture
def run(touchdown: Command, tmp_path: Path) -> Command:
    """The command `touchdown run`, its models stepped in process, its results in out/."""

    def run(scene: object, *arguments: object) -> Ended:
        quiet = ("--in-process", "--no-pictures", "--quiet", "-o", tmp_path / "out")
        return touchdown("run", scene, *arguments, *quiet)

    return run


@pytest.fixture
def own_cache(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Path:
    """A cache folder of the test's own."""
    monkeypatch.setenv("TOUCHDOWN_CACHE", str(tmp_path / "cache"))
    return tmp_path / "cache"


def scene_file(folder: Path, *changes: tuple[str, str]) -> Path:
    """A copy of the shipped scene with text replaced."""
    text = shipped()[SCENE].read_text(encoding="utf-8")
    for old, new in changes:
        assert old in text
        text = text.replace(old, new, 1)
    path = folder / "mine.toml"
    path.write_text(text, encoding="utf-8")
    return path


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


def test_unknown_scene_to_show(touchdown: Command):
    assert "unknown scene nope" in touchdown("scenes", "nope").line


@pytest.mark.parametrize(
    ("arguments", "named"),
    [
        (("--set", "bering.clearance=1e-4"), "no component bering; did you mean bearing"),
        (("--set", "bearing.clearence=1e-4"), "no variable clearence; did you mean clearance"),
        (("--set", "bearing=1"), "cannot set bearing"),
        (("--set", "bearing.clearance"), "write NAME=VALUE"),
        (("--set", "bearing.contact.force=1"), "bearing.contact.force"),
        (("--set", "run.macrostep=1e-5"), "unknown key macrostep"),
        (("--scheme", "interfaces"), "unknown scheme interfaces; did you mean interface"),
        (("--set", "run.scheme=none"), "unknown scheme none"),
        (("--swap", "bering=bushing"), "no component bering"),
        (("--swap", "bearing=bushings"), "no FMU called bushings; did you mean bushing"),
        (("--swap", "bearing"), "write NAME=VALUE"),
        (("--set", "bearing.clearance=-1e-4"), "bearing.clearance = -0.0001 m"),
        (("--set", "bearing.clearance=0"), "clearance = 0 m"),
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
        (("--macro-step", "nan"), "run.macro_step = 'nan'"),
        (("--macro-step", "0"), "run.macro_step = 0 must be above 0"),
        (("--macro-step=-1e-5",), "run.macro_step = -1e-5 must be above 0"),
        (("--macro-step", "-1"), "run.macro_step = -1 must be above 0"),
        (("--macro-step", "1 kg"), "run.macro_step = '1 kg' has the unit kg"),
        (("--set", "run.duration=-1"), "run.duration = -1 must be above 0"),
        (("--set", "run.record_every=1.5"), "run.record_every = 1.5"),
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
        ("simplified_caged", "slip=2", "slip = 2"),
        ("bushing", "contact.damping_ratio=0.1", "needs contact.mass"),
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


@pytest.mark.parametrize(
    ("arguments", "named"),
    [
        (("--duration", "-1 s"), "--duration -1 s must be above 0 s"),
        (("--duration", "5 kg"), "--duration = '5 kg' has the unit kg"),
        (("--ensemble", "0"), "--ensemble 0 must be a whole number above 0"),
        (("--ensemble", "1.5"), "--ensemble 1.5"),
    ],
)
def test_a_comparison_that_cannot_be(arguments: tuple[str, ...], named: str, touchdown: Command):
    assert named in touchdown("compare-bearings", *arguments).line


def test_a_negative_macro_step_with_an_exponent(run: Command):
    """Written apart from its option it must not be taken for another option."""
    assert "macro" in run(SCENE, *SHORT, "--macro-step", "-1e-5").line


def test_macro_step_longer_than_the_run(run: Command, tmp_path: Path):
    """Such a run cannot start, so it leaves nothing."""
    ended = run(SCENE, "--macro-step", "10 s")
    assert "run.macro_step = 10 s is longer than the run of 5.005 s" in ended.line
    assert ended.status == FAILED
    assert not (tmp_path / "out" / "result.h5").exists()


# -- connections -------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("connect", "named"),
    [
        ('["rotor.A.z", "housing.seat.fx"]', "component rotor (rigid_rotor, in process) has no variable A"),
        ('["rotor.A.x", "bearing.journal.z"]', "has no variable journal.z"),
        ('["rotr.A.x", "bearing.journal.x"]', "no component rotr; did you mean rotor"),
        ('["bearing.housing.fy", "housing.seat.fx"]', "housing.seat.fx has two sources"),
        ('["rotor.A.x", "bearing.journal.vx"]', "the units m and m/s differ"),
        ('["rotor.A.x", "rotor.A.y"]', "rotor.A.y has the causality"),
        ('["rotor.A.fx", "housing.seat.fx"]', "rotor.A.fx has the causality"),
        ('["rotor.A.fx"]', "connect must be a list of pairs"),
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
        ('"amb.journal"', '"amb.jornal"', "has no variable jornal.x"),
        ('"bearing.journal"', '"amb.journal"', "amb.journal.x has two sources"),
        ('["amb.journal", "rotor.amb"]', '["amb.journal"]', "attach must be a list of pairs"),
    ],
)
def test_an_attachment_that_cannot_be(old: str, new: str, named: str, run: Command, tmp_path: Path):
    assert named in run(scene_file(tmp_path, (old, new))).line


# -- FMUs --------------------------------------------------------------------------------------------


def archive(path: Path, entries: Mapping[str, bytes]) -> Path:
    """A zip file with these entries, whatever their names."""
    with zipfile.ZipFile(path, "w") as target:
        for name, content in entries.items():
            target.writestr(name, content)
    return path


def entries_of(fmu: Path) -> dict[str, bytes]:
    """All entries of an FMU."""
    with zipfile.ZipFile(fmu) as source:
        return {name: source.read(name) for name in source.namelist()}


def marked(content: bytes, offset: int, value: int) -> bytes:
    """A zip's bytes with one byte of each entry of its directory changed."""
    changed = bytearray(content)
    at = content.find(b"PK\x01\x02")
    while at >= 0:
        changed[at + offset] = value
        at = content.find(b"PK\x01\x02", at + 4)
    return bytes(changed)


def garbled(content: bytes) -> bytes:
    """A zip's bytes with a letter of the model description changed."""
    at = content.index(b"<fmiModelDescription") + 5
    return content[:at] + b"?" + content[at + 1 :]


def damaged(kind: str, good: Path, folder: Path) -> Path:
    """A damaged FMU of this kind."""
    path, content, entries = folder / "bad.fmu", good.read_bytes(), entries_of(good)
    whole = {
        "empty": b"",
        "truncated": content[: len(content) // 2],
        "random": bytes((7 * i * i + 13 * i) % 251 for i in range(5000)),
        "garbled": garbled(content),
        "encrypted": marked(content, 8, 1),
        "strange compression": marked(content, 10, 97),
    }
    if kind in whole:
        path.write_bytes(whole[kind])
        return path
    description = entries["modelDescription.xml"]
    binary = next(name for name in entries if name.endswith(".so"))
    return archive(
        path,
        {
            "no description": {"readme.txt": b"nothing"},
            "description that is no XML": {"modelDescription.xml": b"<fmiModelDescription"},
            "description of something else": {"modelDescription.xml": b"<html/>"},
            "no binary": {"modelDescription.xml": description},
            "file that is a folder": {"modelDescription.xml": description, "a": b"", "a/b": b""},
            "library that is none": entries | {binary: b"no library"},
        }[kind],
    )


DAMAGES = {
    "empty": "damaged",
    "truncated": "damaged",
    "random": "damaged",
    "garbled": "damaged",
    "encrypted": "",
    "strange compression": "",
    "no description": "no modelDescription.xml",
    "description that is no XML": "modelDescription.xml",
    "description of something else": "modelDescription.xml",
    "no binary": "no binary",
    "file that is a folder": "",
    "library that is none": "cannot load",
}


@pytest.mark.parametrize(("kind", "named"), DAMAGES.items(), ids=DAMAGES)
def test_a_damaged_fmu(
    kind: str, named: str, run: Command, touchdown: Command, built: Mapping[str, Path], own_cache: Path,
    tmp_path: Path,
):  # fmt: skip
    path = damaged(kind, built["bushing"], tmp_path)
    for ended in (run(SCENE, "--swap", f"bearing={path}"), touchdown("check", path)):
        assert str(path) in ended.line
        assert named in ended.line
        assert ended.status == FAILED


def test_a_library_that_cannot_be_loaded_leaves_the_working_directory(
    touchdown: Command, built: Mapping[str, Path], own_cache: Path, tmp_path: Path
):
    before = Path.cwd()
    touchdown("check", damaged("library that is none", built["bushing"], tmp_path))
    assert Path.cwd() == before


@pytest.mark.parametrize("way", ["../evil", "a/../../evil", "/{folder}/evil", "..\\evil", "C:evil"])
def test_an_fmu_that_leads_out_of_its_folder(
    way: str, touchdown: Command, built: Mapping[str, Path], own_cache: Path, tmp_path: Path
):
    """Nothing of it is written, inside or outside."""
    entry = way.format(folder=str(tmp_path).lstrip("/"))
    path = archive(tmp_path / "bad.fmu", {**entries_of(built["housing"]), entry: b"evil"})
    ended = touchdown("check", path)
    assert "evil" in ended.line
    assert ended.status == FAILED
    assert list(tmp_path.rglob("*evil*")) == []
    assert list(own_cache.rglob("*")) == [own_cache / "unpacked"]


def checked_and_swapped(path: Path, run: Command, touchdown: Command) -> list[str]:
    """What `check` and a run with the FMU at `path` say; both must refuse it by one line."""
    found = []
    for ended in (touchdown("check", path), run(SCENE, "--swap", f"bearing={path}")):
        assert ended.status == FAILED
        assert str(path) in ended.line
        found.append(ended.line)
    return found


def test_an_fmu_that_holds_a_link(
    run: Command, touchdown: Command, built: Mapping[str, Path], own_cache: Path, tmp_path: Path
):
    path = tmp_path / "bad.fmu"
    with zipfile.ZipFile(path, "w") as target:
        for name, content in entries_of(built["bushing"]).items():
            target.writestr(name, content)
        link = zipfile.ZipInfo("resources/link")
        link.external_attr = (stat.S_IFLNK | 0o777) << 16
        target.writestr(link, "/etc/passwd")
    for line in checked_and_swapped(path, run, touchdown):
        assert "holds a link, 'resources/link'" in line
    assert list(own_cache.rglob("*")) == [own_cache / "unpacked"]


@pytest.mark.parametrize(
    ("limit", "named"), [("LARGEST", "would unpack to 10 MB"), ("MOST", "entries, more than 5")]
)
def test_an_fmu_that_swells(
    limit: str, named: str, run: Command, touchdown: Command, built: Mapping[str, Path], own_cache: Path,
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch,
):  # fmt: skip
    """Refused before anything is written; the limits are lowered here to keep the test small."""
    monkeypatch.setattr(touchdown.master.common.archives, limit, 5_000_000 if limit == "LARGEST" else 5)
    path = tmp_path / "bad.fmu"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as target:
        target.writestr("modelDescription.xml", entries_of(built["bushing"])["modelDescription.xml"])
        for k in range(9):
            target.writestr(f"resources/{k}", bytes(1_100_000))
    assert path.stat().st_size < 200_000
    for line in checked_and_swapped(path, run, touchdown):
        assert named in line
    assert list(own_cache.rglob("*")) == [own_cache / "unpacked"]


def test_an_fmu_that_states_too_small_a_size(touchdown: Command, own_cache: Path, tmp_path: Path):
    """An entry never unpacks to more than it states."""
    path = tmp_path / "bad.fmu"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as target:
        target.writestr("modelDescription.xml", bytes(1_000_000))
    content = path.read_bytes()
    path.write_bytes(content.replace((1_000_000).to_bytes(4, "little"), (1000).to_bytes(4, "little")))
    assert "damaged" in touchdown("check", path).line
    assert list(own_cache.rglob("*")) == [own_cache / "unpacked"]


def described_as(built: Path, folder: Path, old: str, new: str) -> Path:
    """A copy of an FMU whose model description says something else."""
    entries = entries_of(built)
    text, count = re.subn(old, new, entries["modelDescription.xml"].decode(), count=1)
    assert count == 1
    return archive(folder / "bad.fmu", {**entries, "modelDescription.xml": text.encode()})


REFERENCE = r'(name="%s" valueReference=)"\d+"'
LIES = {  # what the description of the bushing says: what becomes of it, and what the user is told
    "reference too large": (REFERENCE % "clearance", r'\1"4294967296"', "value reference 4294967296"),
    "reference negative": (REFERENCE % "clearance", r'\1"-1"', "value reference -1"),
    "reference no number": (REFERENCE % "clearance", r'\1"one"', "modelDescription.xml"),
    "references shared": (REFERENCE % "journal_radius", r'\1"5"', "share the value reference 5"),
    "name twice": ('name="journal_radius"', 'name="clearance"', "clearance is declared twice"),
    "name of the library": ('modelIdentifier="', 'modelIdentifier="../../', "'../../Bushing' is no name"),
    "entities": (
        r"(<fmiModelDescription)", r'<!DOCTYPE a [<!ENTITY b SYSTEM "/etc/passwd">]>\1', "document type",
    ),
}  # fmt: skip


@pytest.mark.parametrize(("old", "new", "named"), LIES.values(), ids=LIES)
def test_a_description_that_cannot_be_true(
    old: str, new: str, named: str, run: Command, touchdown: Command, built: Mapping[str, Path],
    own_cache: Path, tmp_path: Path,
):  # fmt: skip
    path = described_as(built["bushing"], tmp_path, old, new)
    for line in checked_and_swapped(path, run, touchdown):
        assert named in line


FALSE = {  # what only the library can tell
    "a variable it does not have": (REFERENCE % "journal.fy", r'\1"123456"', "value reference 123456"),
    "an input that is an output": (
        r'(name="contact.force"[^>]*) causality="local" variability="continuous" initial="calculated">'
        r'(\s*<Real[^>]*)/>',
        r'\1 causality="input" variability="continuous">\2 start="1.0"/>',
        "contact.force cannot be set",
    ),
    "a real that is an integer": (
        r'(name="friction.kind"[^>]* variability=)"fixed"([^>]*>\s*)<Integer[^>]*/>',
        r'\1"fixed"\2<Real start="2.0"/>',
        "friction.kind cannot be set as real",
    ),
}  # fmt: skip


@pytest.mark.parametrize(("old", "new", "named"), FALSE.values(), ids=FALSE)
def test_a_description_that_is_not_true(
    old: str, new: str, named: str, built: Mapping[str, Path], own_cache: Path, tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
):  # fmt: skip
    """Found by a dry run."""
    path = described_as(built["bushing"], tmp_path, old, new)
    assert main(["check", str(path)]) == FAILED
    said = capsys.readouterr().out
    assert [line for line in said.splitlines() if line.startswith("  problem: dry run") and named in line]


def test_a_run_with_a_variable_that_is_not_there(
    run: Command, built: Mapping[str, Path], own_cache: Path, tmp_path: Path
):
    path = described_as(built["bushing"], tmp_path, *FALSE["a variable it does not have"][:2])
    ended = run(SCENE, *SHORT, "--swap", f"bearing={path}")
    assert "component bearing: " in ended.line
    assert "value reference 123456 cannot be read" in ended.line


@pytest.mark.parametrize("script", [b"", b"../../evil", b"\xff\xfe", b"no_such_module", b"a b"])
def test_an_fmu_without_its_script(
    script: bytes,
    run: Command,
    touchdown: Command,
    built: Mapping[str, Path],
    own_cache: Path,
    tmp_path: Path,
):
    """pythonfmu's library would end the process."""
    entries = {**entries_of(built["bushing"]), "resources/slavemodule.txt": script}
    for line in checked_and_swapped(archive(tmp_path / "bad.fmu", entries), run, touchdown):
        assert "lacks the script" in line


def test_an_fmu_for_another_platform(
    run: Command, touchdown: Command, built: Mapping[str, Path], own_cache: Path, tmp_path: Path
):
    entries = {n: e for n, e in entries_of(built["bushing"]).items() if not n.endswith(".so")}
    for line in checked_and_swapped(archive(tmp_path / "bad.fmu", entries), run, touchdown):
        assert "no binary for this platform (linux64); it has: win64" in line


@pytest.mark.parametrize("path", ["missing.fmu", "/no/such/folder/missing.fmu"])
def test_a_missing_fmu(path: str, run: Command, touchdown: Command):
    assert path in run(SCENE, "--swap", f"bearing={path}").line
    assert path in touchdown("check", path).line


def test_a_folder_for_an_fmu(run: Command, tmp_path: Path):
    (tmp_path / "folder.fmu").mkdir()
    assert "folder.fmu" in run(SCENE, "--swap", f"bearing={tmp_path / 'folder.fmu'}").line


def test_unknown_fmu_to_check_or_build(touchdown: Command):
    for verb in ("check", "build"):
        assert "no FMU called bushings; did you mean bushing" in touchdown(verb, "bushings").line


def test_a_foreign_fmu_without_the_port(run: Command, built: Mapping[str, Path]):
    line = run(SCENE, "--swap", f"bearing={built['housing']}").line
    assert "attach bearing.journal on rotor.A" in line
    assert "housing.fmu has no variable journal.x" in line


def test_a_component_of_the_wrong_kind(run: Command):
    """The scene needs a rotor with two seats."""
    assert "has no variable" in run(SCENE, "--swap", "rotor=bushing").line


# -- folders -----------------------------------------------------------------------------------------


def test_a_folder_that_cannot_be_written(touchdown: Command, tmp_path: Path):
    (tmp_path / "file").write_text("in the way")
    out = tmp_path / "file" / "out"
    for arguments in (("run", SCENE, "--quiet", "--in-process"), ("build", "housing")):
        assert f"cannot write to {out}" in touchdown(*arguments, "-o", out).line


@pytest.mark.parametrize("name", ["result.h5", "summary.json", "result.csv"])
def test_a_result_that_cannot_be_written(name: str, run: Command, tmp_path: Path):
    (tmp_path / "out" / name).mkdir(parents=True)
    assert name in run(SCENE, *SHORT, "--csv").line


# -- scene files -------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("old", "new", "named"),
    [
        ("[run]", "[run", "not valid TOML"),
        ("[run]", "[extra]\nkey = 1\n[run]", "unknown key extra"),
        ("duration = 5.0", "duraton = 5.0", "unknown key duraton; did you mean duration"),
        ("duration = 5.0", 'duration = "long"', "run.duration = 'long' is not a number"),
        ("duration = 5.0", "scheme = 3", "unknown scheme 3"),
        ('fmu = "amb"', 'fmu = "amb"\ncolour = "red"', "[components.amb] has an unknown key colour"),
        ('fmu = "amb"', "", "[components.amb] needs fmu"),
        ('fmu = "amb"', "fmu = 3", "[components.amb] needs fmu"),
        ('fmu = "amb"', 'fmu = "amc"', "no FMU called amc"),
        ('fmu = "amb"', 'fmu = "fmus/amb.fmu"', "fmus/amb.fmu"),
        ('mass = "1.65 kg"', "mass = [1.65]", "rotor.mass = [1.65] is not a number"),
        ('mass = "1.65 kg"', "mass = true", "rotor.mass = True is not a number"),
        ('mass = "1.65 kg"', "mass = nan", "rotor.mass = nan is not a finite number"),
        ('mass = "1.65 kg"', "weight = 1.65", "no variable weight"),
        ('zero = "amb.shutdown_time"', 'zero = "amb.shutdown"', "no variable shutdown"),
        ('zero = "amb.shutdown_time"', 'zero = "amb"', "amb"),
        ('zero = "amb.shutdown_time"', "zero = 0.005", "zero"),
        ('"rotor.gravity"', '"rotor.gravitation"', "no variable gravitation"),
        ('"rotor.gravity"', "9.81", "energy_scale"),
        ('["rotor.mass", "rotor.gravity", "bearing.clearance"]', "0.005", "energy_scale"),
        ('["rotor.mass", "rotor.gravity", "bearing.clearance"]', '"rotor.mass"', "energy_scale"),
    ],
)
def test_a_bad_scene_file(old: str, new: str, named: str, run: Command, tmp_path: Path):
    ended = run(scene_file(tmp_path, (old, new)), *SHORT)
    assert named in ended.line
    assert ended.status == FAILED


@pytest.mark.parametrize(
    ("content", "named"),
    [(b"", "[components]"), (b"\xff\xfe\x00", "not valid TOML"), (b"components = 3", "[components]")],
)
def test_a_file_that_is_no_scene(content: bytes, named: str, run: Command, tmp_path: Path):
    path = tmp_path / "mine.toml"
    path.write_bytes(content)
    assert named in run(path).line


def test_a_missing_scene_file(run: Command, tmp_path: Path):
    assert f"cannot read scene {tmp_path / 'none.toml'}" in run(tmp_path / "none.toml").line


# -- runs that stop ----------------------------------------------------------------------------------


def left_behind(folder: Path) -> tuple[dict[str, object], int]:
    """Summary and number of rows of a run that ended early."""
    summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
    with h5py.File(folder / "result.h5") as file:
        time, journal = file["time"], file["rotor/A.y"]
        assert isinstance(time, h5py.Dataset)
        assert isinstance(journal, h5py.Dataset)
        assert len(time) == len(journal)
        return summary, len(time)


@pytest.mark.parametrize(("step", "seconds"), [("200 us", 2e-4), ("2 ms", 2e-3)])
def test_a_macro_step_too_long_for_the_scene(step: str, seconds: float, run: Command, tmp_path: Path):
    """The ledger stops the run, says where energy comes from and what to try; what was recorded stays."""
    ended = run(SCENE, "--scheme", "hold", "--macro-step", step, "--set", "run.record_every=1")
    assert ended.status == STOPPED
    assert re.search(r"energy ledger of \w+\.\w+ on \w+\.\w+", ended.line)
    advice = re.search(r"try --macro-step ([-.\de]+)", ended.line)
    assert advice is not None
    assert 0.0 < float(advice[1]) < seconds
    summary, rows = left_behind(tmp_path / "out")
    assert summary["completed"] is False
    assert rows > 1


def process(folder: Path, *head: str) -> subprocess.Popen[str]:
    """The whole scene, run through its FMUs by a process of its own, results in `folder`."""
    return subprocess.Popen(
        [*(head or COMMAND), "run", SCENE, "--no-pictures", "--quiet", "-o", str(folder)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def interrupt(running: subprocess.Popen[str], ready: Callable[[], bool]) -> Ended:
    """Press Ctrl-C as soon as `ready`."""
    deadline = time.monotonic() + PATIENCE
    while not ready():
        assert running.poll() is None, "it ended before it could be interrupted"
        assert time.monotonic() < deadline
        time.sleep(0.002)
    running.send_signal(signal.SIGINT)
    return finished(running)


def finished(running: subprocess.Popen[str]) -> Ended:
    """Wait for its end."""
    try:
        _, stderr = running.communicate(timeout=PATIENCE)
    finally:
        running.kill()
    return Ended(running.returncode, stderr)


def check_interrupted(ended: Ended, folder: Path) -> None:
    """Interrupted: said in one line, and what was recorded is there."""
    assert ended.status == 130, ended.stderr
    assert "interrupted" in ended.line
    summary, rows = left_behind(folder)
    assert summary["completed"] is False
    assert rows > 0


def test_ctrl_c_in_mid_run(tmp_path: Path):
    """A file of this size holds its first rows, so the loop is running."""
    result = tmp_path / "result.h5"
    ended = interrupt(process(tmp_path), lambda: result.exists() and result.stat().st_size > 100_000)
    check_interrupted(ended, tmp_path)


def test_ctrl_c_as_soon_as_there_is_a_result(tmp_path: Path):
    check_interrupted(interrupt(process(tmp_path), (tmp_path / "result.h5").exists), tmp_path)


PRESSED_AT = """
import signal, sys
from touchdown.master.{room} import {module}
original = {module}.{function}
def pressed(*arguments, **options):
    found = original(*arguments, **options)
    signal.raise_signal(signal.SIGINT)
    return found
{module}.{function} = pressed
from touchdown.master.cli import main
sys.exit(main())
"""


def test_ctrl_c_before_the_first_step(tmp_path: Path):
    """Just after the recording was opened: as in mid-run."""
    script = PRESSED_AT.format(room="results", module="recording", function="Recorder.__init__")
    check_interrupted(finished(process(tmp_path, sys.executable, "-c", script)), tmp_path)


def test_ctrl_c_while_loading(tmp_path: Path):
    """Nothing is there yet, and nothing breaks."""
    script = PRESSED_AT.format(room="components", module="fmu", function="FmuComponent.__init__")
    ended = finished(process(tmp_path, sys.executable, "-c", script))
    assert ended.status == 130, ended.stderr
    assert "interrupted" in ended.line
