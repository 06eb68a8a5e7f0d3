"""What nobody foresaw, and screens that take nothing or only ASCII: one line, and where the log is."""

from __future__ import annotations

import os
import re
import subprocess
import tempfile
from pathlib import Path

import pytest
from commands import Command
from places import COMMAND, ROOT

from touchdown.command.fault import FAULT
from touchdown.fmus.version import VERSION
from touchdown.master.common.errors import FAILED
from touchdown.master.scene import file

pytestmark = pytest.mark.slow

LONG = "scenes disk-caged-simplified --variables bearing"  # more than a buffer holds


def test_a_fault_is_one_line_with_version_and_log(
    command: Command, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    monkeypatch.setattr(file, "shipped_scenes", lambda: 1 / 0)
    ended = command("scenes", "disk-caged-simplified")
    assert ended.status == FAULT
    assert "ZeroDivisionError: division by zero" in ended.line
    assert VERSION in ended.line
    (log,) = tmp_path.glob("*.log")
    assert ended.line.endswith(f"the log {log}")
    text = log.read_text(encoding="utf-8")
    assert "touchdown scenes disk-caged-simplified" in text
    assert "Traceback (most recent call last)" in text
    assert log.stat().st_mode & 0o077 == 0
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path / "nowhere"))
    assert "no log could be written" in command("scenes", "disk-caged-simplified").line


def spoken(*arguments: str, stdout: object = subprocess.PIPE, **environment: str) -> tuple[int, str, str]:
    """Status, output and complaints of the command in a process of its own."""
    ended = subprocess.run(
        [*COMMAND, *arguments],
        env={**os.environ, "PYTHONPATH": str(ROOT / "src"), **environment},
        stdout=stdout,  # type: ignore[arg-type]
        stderr=subprocess.PIPE,
        encoding="utf-8",
        timeout=120,
        check=False,
    )
    return ended.returncode, ended.stdout, ended.stderr


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="a device of Linux")
@pytest.mark.parametrize(("arguments", "unbuffered"), [("scenes", "1"), ("--version", ""), (LONG, "")])
def test_a_screen_that_is_full(arguments: str, unbuffered: str) -> None:
    with open("/dev/full", "w") as full:
        status, _, complaint = spoken(*arguments.split(), stdout=full, PYTHONUNBUFFERED=unbuffered)
    assert status == FAILED
    said = "cannot write what it has to say: No space left on device; make room for it"
    assert complaint == f"touchdown: {said}\n"


def test_a_reader_that_has_seen_enough() -> None:
    read, write = os.pipe()
    os.close(read)
    assert spoken("scenes", stdout=write) == (0, None, "")
    os.close(write)


@pytest.mark.parametrize(
    "environment",
    [{"PYTHONIOENCODING": "ascii"}, {"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"}],
    ids=lambda environment: "-".join(environment),
)
def test_a_screen_that_knows_ascii_only(environment: dict[str, str], tmp_path: Path) -> None:
    scene = tmp_path / "scene.toml"
    scene.write_text('extends = "disk-caged-simplified"\ntitle = "5 µm"\n', encoding="utf-8")
    status, output, complaint = spoken("scenes", str(scene), **environment)
    assert (status, complaint) == (0, "")
    assert output.startswith(r"5 \xb5m")
    status, _, complaint = spoken("scenes", "µ.toml", **environment)
    assert status == FAILED
    assert re.fullmatch("touchdown: cannot read scene .*toml: No such file or directory\n", complaint)
