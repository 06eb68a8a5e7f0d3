"""The folder of the cache: the user's own, or a temporary one and a line that says why."""

from __future__ import annotations

import errno
import os
import stat
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from touchdown.modelkit.kernel import cache_folder
from touchdown.modelkit.kernel.cache_folder import (
    SIGNATURE,
    TAG,
    VARIABLE,
    made_in_cache,
    own_folder,
    user_cache,
)


@pytest.fixture(autouse=True)
def fresh(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Iterator[None]:
    """As in a process that has not asked for the cache yet; temporary ones go with the test."""
    monkeypatch.setattr(cache_folder, "_settled", {})
    monkeypatch.setattr(cache_folder, "_temporary", {})
    monkeypatch.setattr(cache_folder.tempfile, "tempdir", str(tmp_path))
    monkeypatch.setenv(VARIABLE, str(tmp_path / "cache"))
    yield
    monkeypatch.undo()


def ours(folder: Path) -> bool:
    """Whether nobody else can read it."""
    return stat.S_IMODE(folder.stat().st_mode) == 0o700


def test_it_is_made_for_the_user_alone(tmp_path: Path) -> None:
    assert own_folder("machine-code", "one") == tmp_path / "cache" / "machine-code" / "one"
    for folder in (tmp_path / "cache", *(tmp_path / "cache").rglob("*/")):
        assert ours(folder)
    assert (tmp_path / "cache" / TAG).read_text() == SIGNATURE


@pytest.mark.parametrize("part", [".", "machine-code"])
def test_one_that_others_can_write_is_neither_used_nor_closed(
    part: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """What they put there while they could would be run."""
    (tmp_path / "cache" / "machine-code").mkdir(parents=True, mode=0o700)
    open_to_all = tmp_path / "cache" / part
    open_to_all.chmod(0o777)
    assert not own_folder("machine-code").is_relative_to(tmp_path / "cache")
    assert stat.S_IMODE(open_to_all.stat().st_mode) == 0o777
    assert "(others can write it; remove it, or chmod -R go-w it)" in said(capsys)


@pytest.mark.parametrize("parts", [("fmus",), ("fmus", "one")])
def test_a_link_inside_it_is_replaced_and_the_folder_behind_it_left_alone(
    parts: tuple[str, ...], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    theirs, link = tmp_path / "theirs", (tmp_path / "cache").joinpath(*parts)
    theirs.mkdir(mode=0o755)
    own_folder(*parts[:-1])
    link.symlink_to(theirs)
    assert own_folder("fmus", "one").is_dir()
    assert not link.is_symlink()
    assert stat.S_IMODE(theirs.stat().st_mode) == 0o755
    assert not any(theirs.iterdir())
    assert not capsys.readouterr().err


@pytest.mark.parametrize("whose", ["the user's", "another user's"])
def test_the_tag_follows_no_link(whose: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """One that somebody puts there between two looks: the folder's content is listed before."""
    (tmp_path / "cache").mkdir(mode=0o700)
    (tmp_path / "theirs").write_text("kept")
    (tmp_path / "cache" / TAG).symlink_to(tmp_path / "theirs")
    monkeypatch.setattr(cache_folder.os, "listdir", lambda folder: [])
    if whose != "the user's":
        monkeypatch.setattr(cache_folder.os, "geteuid", lambda: 12345)
        with pytest.raises(PermissionError, match="belongs to another user"):
            cache_folder._usable(tmp_path / "cache")
        (tmp_path / "cache" / TAG).unlink()  # not even without a link is there a tag
        with pytest.raises(PermissionError):
            cache_folder._usable(tmp_path / "cache")
        assert not any((tmp_path / "cache").iterdir())
    else:
        cache_folder._usable(tmp_path / "cache")
    assert (tmp_path / "theirs").read_text() == "kept"


def test_a_folder_of_other_things_is_left_as_it_is(tmp_path: Path) -> None:
    (tmp_path / "cache").mkdir(mode=0o755)
    (tmp_path / "cache" / "letters").mkdir(mode=0o755)
    assert user_cache() == tmp_path / "cache"
    assert not ours(tmp_path / "cache")
    assert not cache_folder.is_cache(tmp_path / "cache")


def file_in_its_place(cache: Path) -> None:
    cache.write_text("x")


def where_nothing_can_be_made(cache: Path) -> None:
    os.environ[VARIABLE] = "/proc/touchdown"


def others_can_write_it(cache: Path) -> None:
    cache.mkdir()
    (cache / "letters").write_text("x")
    cache.chmod(0o777)


def no_home(cache: Path) -> None:
    del os.environ[VARIABLE]
    os.environ["HOME"] = ""
    os.environ["XDG_CACHE_HOME"] = "relative"


UNUSABLE: dict[str, tuple[Callable[[Path], None], str]] = {
    "file in its place": (file_in_its_place, "cache (File exists)"),
    "where nothing can be made": (where_nothing_can_be_made, "/proc/touchdown ("),
    "others can write it": (
        others_can_write_it,
        "cache (others can write it; remove it, or chmod -R go-w it)",
    ),
    "no home": (no_home, "(nothing says where: HOME is not set)"),
}


def said(capsys: pytest.CaptureFixture[str]) -> str:
    """The one line on stderr."""
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith("touchdown: warning: cannot use the cache ")
    return line


@pytest.mark.parametrize(("make", "why"), UNUSABLE.values(), ids=UNUSABLE)
def test_one_that_cannot_be_used(
    make: Callable[[Path], None], why: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:  # fmt: skip
    """A temporary one takes its place, for processes that are started from here, too."""
    for name in ("HOME", "XDG_CACHE_HOME"):
        monkeypatch.setenv(name, str(tmp_path))
    make(tmp_path / "cache")
    folder = own_folder("machine-code", "one")
    assert folder.is_dir()
    assert ours(user_cache())
    assert user_cache().parent == tmp_path
    assert os.environ[VARIABLE] == str(user_cache())
    assert why in said(capsys)
    assert own_folder("fmus").parent == user_cache()
    assert cache_folder.why_temporary()
    assert not capsys.readouterr().err


@pytest.mark.parametrize("part", [".", "machine-code"])
def test_another_users(
    part: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    own_folder("machine-code")
    theirs = os.stat(tmp_path / "cache" / part)
    whose = os.stat_result((*theirs[:4], 12345, *theirs[5:]))
    real = Path.stat
    monkeypatch.setattr(cache_folder, "_settled", {})
    monkeypatch.setattr(
        Path, "stat", lambda path, **how: whose if path == tmp_path / "cache" / part else real(path, **how)
    )
    assert own_folder("machine-code").parent != tmp_path / "cache"
    assert "it belongs to another user" in said(capsys)


@pytest.mark.parametrize("number", [errno.ENOSPC, errno.EROFS])
def test_no_room(number: int, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Found when something is written: it is written into a temporary one."""

    def write(folder: Path) -> Path:
        if folder.is_relative_to(tmp_path / "cache"):
            raise OSError(number, os.strerror(number), str(folder))
        return folder

    assert made_in_cache(write, "unpacked").name == "unpacked"
    assert os.strerror(number) in said(capsys)


BEGINS = """
import os, sys, time
from touchdown.modelkit.kernel.cache_folder import own_folder
print("ready", flush=True)
sys.stdin.read()
print(own_folder("machine-code", "one"))
"""


def test_processes_that_begin_at_once_share_an_empty_cache(tmp_path: Path) -> None:
    start = [sys.executable, "-c", BEGINS]
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}
    processes = [subprocess.Popen(start, **pipes) for _ in range(8)]
    for process in processes:
        assert process.stdout is not None
        assert process.stdout.readline() == "ready\n"
    for process in processes:
        assert process.stdin is not None
        process.stdin.close()
        process.stdin = None
    said = [process.communicate() for process in processes]
    assert set(said) == {(f"{tmp_path / 'cache' / 'machine-code' / 'one'}\n", "")}
