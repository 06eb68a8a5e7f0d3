"""The command, run in the test's own process and folder."""

from __future__ import annotations

import os
import shutil
from pathlib import Path

import pytest
from commands import Command, Ended

from touchdown.master.cli import main
from touchdown.modelkit.kernel.cache_folder import own_folder


@pytest.fixture
def command(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Command:
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
def run(command: Command, tmp_path: Path) -> Command:
    """The command `touchdown run`, its models stepped in process, its results in out/."""

    def run(scene: object, *arguments: object) -> Ended:
        quiet = ("--in-process", "--no-pictures", "--quiet", "-o", tmp_path / "out")
        return command("run", scene, *arguments, *quiet)

    return run


@pytest.fixture
def own_cache(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Path:
    """A cache folder of the test's own."""
    monkeypatch.setenv("TOUCHDOWN_CACHE", str(tmp_path / "cache"))
    return tmp_path / "cache"


@pytest.fixture
def compiled_cache(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Path:
    """A cache folder of the test's own, in which all that the session compiled is at hand."""
    code, cache = own_folder("machine-code"), tmp_path / "cache"
    cache.mkdir(mode=0o700)
    shutil.copytree(code, cache / "machine-code", copy_function=os.link)  # a link is not followed there
    monkeypatch.setenv("TOUCHDOWN_CACHE", str(cache))
    return cache
