"""The command `touchdown check cache`, and what goes by itself."""

from __future__ import annotations

import os
import time
from pathlib import Path

import pytest
from commands import Command

from touchdown.command.cli import main
from touchdown.master.common import cache
from touchdown.master.common.cache import DAY, Entry, cache_entries, stale
from touchdown.modelkit.kernel.cache_folder import TAG, own_folder

NOW = 1e9


def entry(name: str, days: float, size: int = 10, kind: str = "fmus") -> Entry:
    """One not used for some days."""
    return Entry(Path(name), kind, size, NOW - days * DAY)


@pytest.mark.parametrize(
    ("held", "limit", "going"),
    [
        ([entry("old", 31), entry("new", 29)], 1000, ["old"]),
        ([entry("a", 3), entry("b", 5), entry("c", 2)], 15, ["b", "a"]),
        ([entry("a", 3), entry("b", 5), entry("c", 2)], 20, ["b"]),
        ([entry("a", 0.5), entry("b", 0.9)], 0, []),
        ([entry(".unfinished", 1.1), entry(".at it", 0.1)], 1000, [".unfinished"]),
        ([entry("named by scenes", 99, kind="rotors"), entry("env", 99, kind="peers")], 0, []),
        ([], 0, []),
    ],
)
def test_what_is_outworn(held: list[Entry], limit: int, going: list[str]) -> None:
    assert [str(one.path) for one in stale(held, NOW, limit=limit)] == going


def filled(kind: str, name: str, days: float, size: int = 1000) -> Path:
    """An entry of the cache, not used for some days."""
    folder = own_folder(kind, name)
    (folder / "content").write_bytes(bytes(size))
    os.utime(folder, (time.time() - days * DAY,) * 2)
    return folder


def test_old_ones_go_by_themselves(own_cache: Path) -> None:
    old, new = filled("machine-code", "old", 40), filled("machine-code", "new", 1)
    cache.remove_stale()
    assert old.exists()  # looked at a while ago
    os.utime(own_cache / TAG, (time.time() - 2 * cache.LOOK_INTERVAL_S,) * 2)
    cache.remove_stale()
    assert not old.exists()
    assert new.exists()


def test_it_shows_what_there_is(own_cache: Path, capsys: pytest.CaptureFixture[str]) -> None:
    filled("machine-code", "a", 3.2, 2_000_000)
    filled("fmus", "b", 1, 500_000)
    assert main(["check", "cache"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == str(own_cache)
    assert lines[1].split()[:4] == ["machine-code", "1", "2.0", "MB"]
    assert "unused for 3 days at most" in lines[1]
    assert lines[2].split()[:4] == ["fmus", "1", "0.5", "MB"]
    assert lines[-1].split() == ["in", "all", "2", "2.5", "MB"]


def test_it_removes_what_was_not_used(own_cache: Path, capsys: pytest.CaptureFixture[str]) -> None:
    old, new = filled("unpacked", "old", 8), filled("unpacked", "new", 6)
    assert main(["check", "cache", "--unused-for", "7"]) == 0
    assert "removed 1 of 2, 0.0 MB" in capsys.readouterr().out
    assert (old.exists(), new.exists()) == (False, True)


def test_it_clears(own_cache: Path) -> None:
    filled("unpacked", "one", 0)
    rotor = filled("rotors", "two", 0)
    (own_cache / "letter").write_text("not of the cache")
    assert main(["check", "cache", "--clear"]) == 0
    assert [entry.path for entry in cache_entries(own_cache)] == [rotor], "scenes name it"
    assert (own_cache / "letter").is_file()


def test_it_follows_no_link(own_cache: Path, tmp_path: Path) -> None:
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "elsewhere" / "letter").write_text("x")
    (own_folder("unpacked") / "link").symlink_to(tmp_path / "elsewhere")
    assert main(["check", "cache", "--clear"]) == 0
    assert (tmp_path / "elsewhere" / "letter").is_file()


def test_it_clears_no_folder_of_other_things(command: Command, own_cache: Path) -> None:
    (own_cache / "sources").mkdir(parents=True)
    (own_cache / "letter").write_text("x")
    line = command("check", "cache", "--clear").line
    assert f"{own_cache} holds other things than the cache; remove by hand what is to go" in line
    assert (own_cache / "sources").is_dir()


@pytest.mark.parametrize(("days", "why"), [("-1", "must not be negative"), ("many", "--unused-for")])
def test_days_that_are_none(days: str, why: str, command: Command, own_cache: Path) -> None:
    assert why in command("check", "cache", f"--unused-for={days}").line
