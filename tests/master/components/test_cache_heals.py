"""Unpacked FMUs, built ones and the sources they run: damaged in the cache, they are made anew, quietly."""

from __future__ import annotations

import os
import subprocess
import sys
import zipfile
from collections.abc import Mapping
from itertools import cycle
from pathlib import Path

import damage
import pytest
from commands import Command

from touchdown.fmus.build import cached_fmu
from touchdown.fmus.recipes import recipe
from touchdown.master.components.unpack import unpack
from touchdown.modelkit import archives
from touchdown.modelkit.kernel.cache_folder import user_cache

PARTS = ("modelDescription.xml", "binaries/linux64/Housing.so", "resources/slavemodule.txt")


def content(folder: Path) -> dict[str, bytes]:
    """All files by name."""
    return {str(p.relative_to(folder)): p.read_bytes() for p in sorted(folder.rglob("*")) if p.is_file()}


@pytest.mark.parametrize(
    ("harm", "part"), list(zip(damage.OF_FILES.values(), cycle(PARTS))), ids=damage.OF_FILES
)
def test_an_unpacked_fmu(
    harm: damage.Damage, part: str, built: Mapping[str, Path], own_cache: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:  # fmt: skip
    folder = unpack(built["housing"], user_cache())
    whole = content(folder)
    harm(folder / part)
    assert unpack(built["housing"], user_cache()) == folder
    assert content(folder) == whole
    assert [entry.name for entry in folder.parent.iterdir()] == [folder.name]
    assert not capsys.readouterr().err


@pytest.mark.parametrize("harm", [damage.removed, damage.file], ids=["removed", "file"])
@pytest.mark.parametrize("of", ["itself", "all of them", "a part"])
def test_a_folder_of_an_unpacked_fmu(
    of: str, harm: damage.Damage, built: Mapping[str, Path], own_cache: Path
) -> None:
    folder = unpack(built["housing"], user_cache())
    whole = content(folder)
    harm({"itself": folder, "all of them": folder.parent, "a part": folder / "resources"}[of])
    assert unpack(built["housing"], user_cache()) == folder
    assert content(folder) == whole


@pytest.mark.parametrize(
    "place", ["resources/__pycache__/script.pyc", "binaries/linux64/planted/libm.so.6"]
)
def test_what_is_not_of_the_archive_does_not_stay(
    place: str, built: Mapping[str, Path], own_cache: Path
) -> None:
    folder = unpack(built["housing"], user_cache())
    whole = content(folder)
    (folder / place).parent.mkdir(exist_ok=True)
    (folder / place).write_bytes(b"planted")
    assert content(unpack(built["housing"], user_cache())) == whole


def test_files_that_others_can_write_are_not_used(built: Mapping[str, Path], own_cache: Path) -> None:
    folder = unpack(built["housing"], user_cache())
    for path in (folder / "modelDescription.xml", folder / "resources"):
        path.chmod(0o777)
        unpack(built["housing"], user_cache())
        assert not path.stat().st_mode & 0o022


@pytest.mark.parametrize("umask", [0o002, 0o077])
def test_what_is_unpacked_is_used_again_whatever_the_umask(
    umask: int, built: Mapping[str, Path], own_cache: Path
) -> None:
    before = os.umask(umask)
    try:
        folder = unpack(built["housing"], user_cache())
        inode = folder.stat().st_ino
        assert unpack(built["housing"], user_cache()).stat().st_ino == inode
    finally:
        os.umask(before)


@pytest.mark.parametrize(
    ("harm", "suffix"), list(zip(damage.OF_FILES.values(), cycle(("fmu", "sha256")))), ids=damage.OF_FILES
)
def test_a_built_fmu(
    suffix: str, harm: damage.Damage, built: Mapping[str, Path], own_cache: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:  # fmt: skip
    path = cached_fmu(recipe("housing"))
    harm(path.with_suffix(f".{suffix}"))
    assert cached_fmu(recipe("housing")) == path
    assert path.read_bytes() == built["housing"].read_bytes()
    before = path.stat().st_mtime_ns
    assert cached_fmu(recipe("housing")).stat().st_mtime_ns == before  # made anew once
    assert not capsys.readouterr().err


# -- sources -----------------------------------------------------------------------------------------


def home_of_sources(folder: Path, cache: Path) -> tuple[Path, str]:
    """Where the sources of an unpacked FMU are run from, and what is said on stderr."""
    (package,) = (folder / "resources").glob("touchdown_*/")
    done = subprocess.run(
        [sys.executable, "-c", f"import {package.name} as p; print(*p.__path__)"],
        cwd=package.parent,
        env={**os.environ, "TOUCHDOWN_CACHE": str(cache)},
        capture_output=True,
        text=True,
        check=True,
    )
    return Path(done.stdout.strip()), done.stderr


def planted(home: Path) -> None:
    """A package, which Python would find before the module of that name."""
    (home / "modelkit" / "units").mkdir()
    (home / "modelkit" / "units" / "__init__.py").write_text("raise SystemExit('planted')")


def behind_a_link(home: Path) -> None:
    """The folder moved elsewhere, and a link to it."""
    elsewhere = home.parent / "elsewhere"
    home.rename(elsewhere)
    home.symlink_to(elsewhere)


HARMED_SOURCES = {
    "a package in the way of a module": (".", planted),
    "open to others": ("modelkit", lambda home: home.chmod(0o777)),
    "behind a link": ("modelkit", behind_a_link),
    "source": ("modelkit/units.py", damage.cut),
    "bytecode": ("modelkit/__pycache__/units.*.pyc", damage.flipped),
    "digests": ("bytecode.txt", damage.flipped),
    "a file for them all": (".", damage.file),
}


def test_the_sources_of_an_fmu(unpacked: Mapping[str, Path], tmp_path: Path) -> None:
    home, said = home_of_sources(unpacked["housing"], tmp_path)
    whole = content(home)
    assert home.parent == tmp_path / "sources"
    assert not said
    for pattern, harm in HARMED_SOURCES.values():
        harm(home if pattern == "." else next(home.glob(pattern)))
        assert home_of_sources(unpacked["housing"], tmp_path) == (home, "")
        assert content(home) == whole, pattern


# -- sizes -------------------------------------------------------------------------------------------


def swelling(path: Path) -> Path:
    """An archive of 2 MB in a few kB."""
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as target:
        target.writestr("modelDescription.xml", bytes(2_000_000))
    return path


def test_how_large_an_fmu_may_be_can_be_set(
    command: Command, own_cache: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = swelling(tmp_path / "large.fmu")
    monkeypatch.setenv(archives.VARIABLE, "1.5 MB")
    line = command("check", path).line
    assert f"{path} would unpack to 2 MB, more than 2 MB; refused" in line.replace("1.5", "2")
    assert archives.VARIABLE in line
    monkeypatch.setenv(archives.VARIABLE, "3 MiB")
    assert "modelDescription.xml" in command("check", path).line
    monkeypatch.setenv(archives.VARIABLE, "large")
    assert "is not a size; write such as 2 GiB" in command("check", path).line


@pytest.mark.parametrize(("text", "size"), [("2 GiB", 2**31), ("800 MB", 8e8), ("", 2**29)])
def test_sizes(text: str, size: float, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(archives.VARIABLE, text)
    assert archives.size_limit() == size


@pytest.mark.parametrize("path", ["/dev/zero", "pipe"])
def test_what_never_ends_is_not_read(path: str, command: Command, own_cache: Path, tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    link = tmp_path / "endless.fmu"
    link.symlink_to(path)
    assert "endless.fmu is not an FMU: it is not a file" in command("check", link).line
