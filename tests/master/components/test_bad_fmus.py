"""FMUs that are damaged, lie or lead astray: refused by one line that names the file."""

from __future__ import annotations

import re
import stat
import zipfile
from collections.abc import Callable, Mapping
from pathlib import Path

import pytest
from archives import archive, entries_of
from commands import SCENE, SHORT, Command

from touchdown.command.cli import main
from touchdown.master.common.errors import FAILED
from touchdown.modelkit import archives
from touchdown.modelkit.kernel.cache_folder import TAG


def marked(content: bytes, offset: int, value: int) -> bytes:
    """A zip's bytes with one byte of each entry of its directory changed."""
    changed = bytearray(content)
    at = content.find(b"PK\x01\x02")
    while at >= 0:
        changed[at + offset] = value
        at = content.find(b"PK\x01\x02", at + 4)
    return bytes(changed)


def garbled(fmu: Path) -> bytes:
    """A zip's bytes with one in the middle of the packed model description changed."""
    with zipfile.ZipFile(fmu) as source:
        entry = source.getinfo("modelDescription.xml")
    content = bytearray(fmu.read_bytes())
    begin = entry.header_offset + 30 + len(entry.filename)  # behind its header, which ends with its name
    content[begin + entry.compress_size // 2] ^= 0xFF
    return bytes(content)


def damaged(kind: str, good: Path, folder: Path) -> Path:
    """A damaged FMU of this kind."""
    path, content, entries = folder / "bad.fmu", good.read_bytes(), entries_of(good)
    whole = {
        "empty": b"",
        "truncated": content[: len(content) // 2],
        "garbled": garbled(good),
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


Refused = Callable[[Path], list[str]]


@pytest.fixture
def refused(run: Command, command: Command, own_cache: Path) -> Refused:
    """What `check` and a run with the FMU at a path say; both must refuse it by one line that names it."""

    def lines(path: Path) -> list[str]:
        here, both = Path.cwd(), (command("check", path), run(SCENE, "--swap", f"bearing={path}"))
        assert Path.cwd() == here
        assert [ended.status for ended in both] == [FAILED, FAILED]
        assert all(str(path) in ended.line for ended in both)
        return [ended.line for ended in both]

    return lines


@pytest.mark.parametrize(("kind", "named"), DAMAGES.items(), ids=DAMAGES)
def test_a_damaged_fmu(kind: str, named: str, refused: Refused, built: Mapping[str, Path], tmp_path: Path):
    """The working directory stays, too, where a library cannot be loaded."""
    assert all(named in line for line in refused(damaged(kind, built["bushing"], tmp_path)))


@pytest.mark.parametrize(
    ("way", "why"),
    [
        ("../evil", "that leads out of its folder"),
        ("/{folder}/evil", "that leads out of its folder"),
        ("..\\evil", "with a backslash"),
        ("C:evil", "with a colon"),
    ],
)
def test_an_fmu_with_an_entry_that_lies_elsewhere(
    way: str, why: str, command: Command, built: Mapping[str, Path], own_cache: Path, tmp_path: Path
):
    """Nothing of it is written, inside or outside."""
    entry = way.format(folder=str(tmp_path).lstrip("/"))
    path = archive(tmp_path / "bad.fmu", {**entries_of(built["housing"]), entry: b"evil"})
    ended = command("check", path)
    assert "evil" in ended.line
    assert why in ended.line
    assert ended.status == FAILED
    assert list(tmp_path.rglob("*evil*")) == []
    assert files_in(own_cache) == [TAG]


def files_in(folder: Path) -> list[str]:
    """Names of all files."""
    return [path.name for path in folder.rglob("*") if path.is_file()]


def test_an_fmu_that_holds_a_link(
    refused: Refused, built: Mapping[str, Path], own_cache: Path, tmp_path: Path
):
    path = tmp_path / "bad.fmu"
    with zipfile.ZipFile(path, "w") as target:
        for name, content in entries_of(built["bushing"]).items():
            target.writestr(name, content)
        link = zipfile.ZipInfo("resources/link")
        link.external_attr = (stat.S_IFLNK | 0o777) << 16
        target.writestr(link, "/etc/passwd")
    for line in refused(path):
        assert "holds a link, 'resources/link'" in line
    assert files_in(own_cache) == [TAG]


@pytest.mark.parametrize(
    ("limit", "named"), [("MAX_BYTES", "would unpack to 10 MB"), ("MAX_ENTRIES", "entries, more than 5")]
)
def test_an_fmu_that_swells(
    limit: str, named: str, refused: Refused, built: Mapping[str, Path], own_cache: Path, tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
):  # fmt: skip
    """Refused before anything is written; the limits are lowered here to keep the test small."""
    monkeypatch.setattr(archives, limit, 5_000_000 if limit == "MAX_BYTES" else 5)
    path = tmp_path / "bad.fmu"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as target:
        target.writestr("modelDescription.xml", entries_of(built["bushing"])["modelDescription.xml"])
        for k in range(9):
            target.writestr(f"resources/{k}", bytes(1_100_000))
    assert path.stat().st_size < 200_000
    for line in refused(path):
        assert named in line
    assert files_in(own_cache) == [TAG]


def test_an_fmu_that_states_too_small_a_size(command: Command, own_cache: Path, tmp_path: Path):
    """An entry never unpacks to more than it states."""
    path = tmp_path / "bad.fmu"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as target:
        target.writestr("modelDescription.xml", bytes(1_000_000))
    content = path.read_bytes()
    path.write_bytes(content.replace((1_000_000).to_bytes(4, "little"), (1000).to_bytes(4, "little")))
    assert "damaged" in command("check", path).line
    assert files_in(own_cache) == [TAG]


def described_as(built: Path, folder: Path, old: str, new: str) -> Path:
    """A copy of an FMU whose model description says something else, by a pattern."""
    entries = entries_of(built)
    text, count = re.subn(old, new, entries["modelDescription.xml"].decode(), count=1)
    assert count == 1
    return archive(folder / "bad.fmu", {**entries, "modelDescription.xml": text.encode()})


REFERENCE = r'(name="%s" valueReference=)"\d+"'
LARGE = {
    "attribute": (r'(description=)"[^"]*"', rf'\1"{"x" * 3_000_000}"', "a tag of it has more than 1 MB"),
    "elements": (r"(<ModelVariables>)", rf"\1{'<a>' * 300}{'</a>' * 300}", "more than 200 deep"),
}  # fmt: skip


@pytest.mark.parametrize("kind", LARGE)
def test_a_description_that_swells(
    kind: str, refused: Refused, built: Mapping[str, Path], tmp_path: Path
) -> None:
    old, new, named = LARGE[kind]
    for line in refused(described_as(built["bushing"], tmp_path, old, new)):
        assert named in line


LIES = {  # what the description of the bushing says: what becomes of it, and what the user is told
    "reference too large": (REFERENCE % "clearance", r'\1"4294967296"', "value reference 4294967296"),
    "reference negative": (REFERENCE % "clearance", r'\1"-1"', "value reference -1"),
    "reference no number": (REFERENCE % "clearance", r'\1"one"', "modelDescription.xml"),
    "references shared": (REFERENCE % "journal_radius", r'\1"5"', "share the value reference 5"),
    "name twice": ('name="journal_radius"', 'name="clearance"', "clearance is declared twice"),
    "name of the library": ('modelIdentifier="', 'modelIdentifier="../../', "'../../Bushing' is not a na"),
    "entities": (
        r"(<fmiModelDescription)", r'<!DOCTYPE a [<!ENTITY b SYSTEM "/etc/passwd">]>\1', "document type",
    ),
}  # fmt: skip


@pytest.mark.parametrize(("old", "new", "named"), LIES.values(), ids=LIES)
def test_a_description_that_cannot_be_true(
    old: str, new: str, named: str, refused: Refused, built: Mapping[str, Path], tmp_path: Path
):
    path = described_as(built["bushing"], tmp_path, old, new)
    for line in refused(path):
        assert named in line


def test_a_variable_that_is_not_there_is_found_by_a_dry_run_and_by_a_run(
    run: Command, built: Mapping[str, Path], compiled_cache: Path, tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
):  # fmt: skip
    """Only the library can tell that a description is not true."""
    path = described_as(built["bushing"], tmp_path, REFERENCE % "journal.fy", r'\1"123456"')
    assert main(["check", str(path)]) == FAILED
    said = [line for line in capsys.readouterr().out.splitlines() if line.startswith("  problem: dry run")]
    assert "value reference 123456" in said[0]
    ended = run(SCENE, *SHORT, "--swap", f"bearing={path}")
    assert "component bearing: " in ended.line
    assert "value reference 123456 cannot be read" in ended.line


@pytest.mark.parametrize("script", [b"", b"no_such_module"])
def test_an_fmu_without_its_script(
    script: bytes, refused: Refused, built: Mapping[str, Path], tmp_path: Path
):
    """pythonfmu's library ends the process."""
    entries = {**entries_of(built["bushing"]), "resources/slavemodule.txt": script}
    for line in refused(archive(tmp_path / "bad.fmu", entries)):
        assert "its FMU crashed with SIGSEGV in fmi2Instantiate" in line


@pytest.mark.parametrize("more", [(), ("binaries/linux64/", "binaries/linux64/other.so")])
def test_an_fmu_for_another_platform(
    more: tuple[str, ...], refused: Refused, built: Mapping[str, Path], tmp_path: Path
):
    """The library is missed by its name, whatever else lies where it should."""
    entries = {n.replace("linux64", "win64"): e for n, e in entries_of(built["bushing"]).items()}
    entries |= dict.fromkeys(more, b"")
    lacking = (
        "no binary for this platform (linux64): it lacks binaries/linux64/Bushing.so, and has binaries/"
    )
    for line in refused(archive(tmp_path / "bad.fmu", entries)):
        assert lacking in line
        assert "binaries/win64/Bushing.so" in line
        assert "binaries/linux64/," not in line


def test_a_missing_fmu(run: Command, command: Command):
    path = "/no/such/folder/missing.fmu"
    assert path in run(SCENE, "--swap", f"bearing={path}").line
    assert path in command("check", path).line


def test_a_folder_for_an_fmu(run: Command, tmp_path: Path):
    (tmp_path / "folder.fmu").mkdir()
    assert "folder.fmu" in run(SCENE, "--swap", f"bearing={tmp_path / 'folder.fmu'}").line


def test_unknown_fmu_to_check_or_build(command: Command):
    for verb in ("check", "build"):
        assert "no FMU called bushings; did you mean bushing" in command(verb, "bushings").line


def test_a_foreign_fmu_without_the_port(run: Command, built: Mapping[str, Path]):
    line = run(SCENE, "--swap", f"bearing={built['housing']}").line
    assert "attach bearing.journal on rotor.A" in line
    assert "housing.fmu has no variable journal.x" in line
