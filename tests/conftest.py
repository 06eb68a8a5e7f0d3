"""Shared by all tests: the project's FMUs, the command, and processes that run without the project."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator, Mapping
from functools import cache
from pathlib import Path
from typing import Any

import pytest
from commands import Command, Ended
from fmpy import extract
from places import PACKAGES, ROOT, SUPPORT

from touchdown.command.cli import main
from touchdown.fmus.build import cached_fmu
from touchdown.fmus.recipes import fmu_names, recipe
from touchdown.master.components.compile_ahead import NewModel, compile_beside
from touchdown.modelkit.kernel.cache_folder import VARIABLE, own_folder

os.environ.setdefault("OMP_NUM_THREADS", "1")  # tests run beside each other: one thread each

# Head of every process that must do without the project, which may be installed in the interpreter.
WALL = """
import importlib.abc, sys
PROJECT = {project!r}
class Wall(importlib.abc.MetaPathFinder):
    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] in PROJECT:
            raise ModuleNotFoundError("walled off: " + name, name=name)
sys.meta_path.insert(0, Wall())
sys.path.append({tests!r})
def importable():
    found = []
    for name in PROJECT:
        try:
            __import__(name)
        except ImportError:
            continue
        found.append(name)
    return found
def loaded_from_project():
    files = [getattr(module, "__file__", None) or "" for module in list(sys.modules.values())]
    packages = [{root!r} + "/" + name + "/" for name in ("src", *PROJECT)]
    return [f for f in files if any(f.startswith(package) for package in packages)]
"""


def pytest_sessionstart(session: pytest.Session) -> None:
    """A session of all tests begins with every model compiled; one of chosen tests compiles as it goes.

    Left to the tests, two workers and the processes they start would compile the same kernels at once.
    """
    config = session.config
    whole = config.args_source is pytest.Config.ArgsSource.TESTPATHS and not config.option.keyword
    if whole and not config.option.collectonly and not hasattr(config, "workerinput"):
        models = []
        for name in fmu_names():
            model = recipe(name).model
            for effects in [(), model.effects[:1]] if model.effects else [()]:
                models.append(NewModel(name, name, "", True, model.memory.itemsize, effects))
        compile_beside(sorted(models, key=lambda model: -model.size), str)


def pytest_terminal_summary(terminalreporter: Any) -> None:
    """Say how to have the tests that were skipped for want of a browser."""
    skipped = [str(report.longrepr) for report in terminalreporter.stats.get("skipped", ())]
    lacking = sum("no Chromium" in reason for reason in skipped)
    if lacking:
        terminalreporter.write_line(
            f"{lacking} tests of reports in a browser were skipped. To have them: "
            "apt-get install chromium chromium-driver"
        )


class OnDemand(Mapping[str, Path]):
    """Something made of each of the project's FMUs when it is first asked for."""

    def __init__(self, make: Callable[[str], Path]) -> None:
        self._made = cache(make)

    def __getitem__(self, name: str) -> Path:
        return self._made(name)

    def __iter__(self) -> Iterator[str]:
        return iter(fmu_names())

    def __len__(self) -> int:
        return len(fmu_names())


@pytest.fixture(scope="session")
def built() -> Mapping[str, Path]:
    """The project's FMUs by name, built from the present sources, which compiles their models."""
    session = os.environ.get(VARIABLE)

    def make(name: str) -> Path:
        with pytest.MonkeyPatch.context() as patch:  # whatever cache the test that asks first has
            patch.setenv(VARIABLE, session) if session else patch.delenv(VARIABLE, raising=False)
            return cached_fmu(recipe(name))

    return OnDemand(make)


@pytest.fixture(scope="session")
def unpacked(built: Mapping[str, Path], tmp_path_factory: pytest.TempPathFactory) -> Mapping[str, Path]:
    """Folders of the unpacked FMUs by name."""
    folder = tmp_path_factory.mktemp("unpacked")
    return OnDemand(lambda name: Path(extract(str(built[name]), str(folder / name))))


@pytest.fixture(scope="session")
def alone(tmp_path_factory: pytest.TempPathFactory) -> Callable[..., subprocess.CompletedProcess[str]]:
    """Run a script in a process of its own that cannot import the project; returns what it left."""
    folder = tmp_path_factory.mktemp("alone")
    wall = WALL.format(project=("touchdown", *PACKAGES), tests=str(SUPPORT), root=str(ROOT))

    def run(script: str, *arguments: object, **environment: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            [sys.executable, "-I", "-c", f"{wall}\n{script}", *map(str, arguments)],
            cwd=folder,
            env={**os.environ, **environment},
            capture_output=True,
            text=True,
            timeout=300,
            check=False,
        )

    return run


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
