"""One import name, however the project is installed, beside whatever lies next to a user's script."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import tarfile
import zipfile
from collections.abc import Mapping
from pathlib import Path

import pytest
from places import PACKAGES, ROOT

pytest.importorskip("hatchling", reason="hatchling, which builds the project, is not installed")

NEEDED = ("pyproject.toml", "README.md", "LICENSE", ".gitignore", ".ci", "src", *PACKAGES)
LAYOUTS = ("wheel", "editable", "checkout")


def no_links(folder: str, names: list[str]) -> list[str]:
    """What a checkout on Windows does not have, and what no checkout should."""
    return [name for name in names if name == "__pycache__" or Path(folder, name).is_symlink()]


@pytest.fixture(scope="module")
def checkout(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A copy of the checkout without the links to its packages."""
    folder = tmp_path_factory.mktemp("checkout")
    for name in NEEDED:
        if (ROOT / name).is_dir():
            shutil.copytree(ROOT / name, folder / name, ignore=no_links)
        else:
            shutil.copy(ROOT / name, folder)
    assert sorted(p.name for p in (folder / "src" / "touchdown").iterdir() if p.is_dir()) == []
    return folder


def packed(project: Path, target: str, folder: Path) -> Path:
    """What hatchling makes of a project."""
    command = [sys.executable, "-m", "hatchling", "build", "-t", target, "-d", str(folder)]
    subprocess.run(command, cwd=project, check=True, capture_output=True)
    (made,) = folder.iterdir()
    return made


def entries(wheel: Path) -> dict[str, bytes]:
    """Content of a wheel's files by name."""
    with zipfile.ZipFile(wheel) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


@pytest.fixture(scope="module")
def wheels(checkout: Path, tmp_path_factory: pytest.TempPathFactory) -> Mapping[str, Path]:
    """Wheels: of the checkout, of its source archive, and the one that an editable install is."""
    folder = tmp_path_factory.mktemp("built")
    with tarfile.open(packed(checkout, "sdist", folder / "sdist")) as archive:
        # Python 3.11 knows filters from 3.11.4 on; Debian 12 has 3.11.2
        archive.extraction_filter = getattr(tarfile, "data_filter", lambda member, path: member)
        archive.extractall(folder / "unpacked")
    (source,) = (folder / "unpacked").iterdir()
    editable = shutil.copytree(checkout, folder / "checkout")  # it gets links
    return {
        "wheel": packed(checkout, "wheel", folder / "wheel"),
        "sdist": packed(source, "wheel", folder / "from sdist"),
        "editable": packed(editable, "wheel:editable", folder / "editable"),
    }


@pytest.fixture(scope="module")
def installed(
    wheels: Mapping[str, Path], checkout: Path, tmp_path_factory: pytest.TempPathFactory
) -> Mapping[str, Path]:
    """What each layout puts on the search path; a wheel of pure Python is installed by unpacking it."""
    found = {"checkout": checkout / "src", "editable": named_by(wheels["editable"])}
    found["wheel"] = tmp_path_factory.mktemp("site-packages")
    with zipfile.ZipFile(wheels["wheel"]) as archive:
        archive.extractall(found["wheel"])
    return found


def named_by(editable: Path) -> Path:
    """The one folder that an editable install puts on the search path."""
    (path,) = (content for name, content in entries(editable).items() if name.endswith(".pth"))
    (line,) = path.decode().splitlines()
    return Path(line)


def test_a_wheel_has_one_name_and_the_command(wheels: Mapping[str, Path]) -> None:
    """So has an editable install; the source archive makes the same wheel."""
    wheel = entries(wheels["wheel"])
    assert entries(wheels["sdist"]) == wheel
    assert {top for top in (name.split("/")[0] for name in wheel) if ".dist-" not in top} == {"touchdown"}
    (scripts,) = (c for n, c in wheel.items() if n.endswith("entry_points.txt"))
    command = ["[console_scripts]", "touchdown = touchdown.command.cli:main"]
    assert scripts.decode().split("\n")[:2] == command
    assert [path.name for path in named_by(wheels["editable"]).iterdir()] == ["touchdown"]
    own = [name for name in entries(wheels["editable"]) if ".dist-" not in name]
    assert all(name.endswith(".pth") for name in own)


def test_a_wheel_has_every_file_of_the_packages(wheels: Mapping[str, Path], checkout: Path) -> None:
    """The shipped scenes and rotors among them, and nothing else."""
    files = {path.relative_to(checkout) for path in checkout.rglob("*") if path.is_file()}
    own = {path.as_posix() for path in files if path.parts[0] in PACKAGES}
    own |= {path.name for path in files if path.parts[0] == "src"}
    found = {name.removeprefix("touchdown/") for name in entries(wheels["wheel"]) if ".dist-" not in name}
    assert found == own
    assert any(name.endswith(".toml") for name in found)


SCRIPT = """
import json
import bearings, master, rotor, tests
import touchdown, touchdown.bearings.catalogue, touchdown.rotor.file
from touchdown.command.cli import main
assert main(["scenes"]) == 0
print(json.dumps({
    "mine": [module.WHOSE for module in (bearings, master, rotor, tests)],
    "theirs": [module.__file__ for module in (touchdown, touchdown.bearings, touchdown.rotor)],
}))
"""


@pytest.fixture
def mine(tmp_path: Path) -> Path:
    """A user's folder whose files bear the names of our packages."""
    for name in ("master", "tests"):
        (tmp_path / name).mkdir()
    for name in ("rotor.py", "bearings.py", "master/__init__.py", "tests/__init__.py"):
        (tmp_path / name).write_text("WHOSE = 'mine'\n")
    (tmp_path / "script.py").write_text(SCRIPT)
    return tmp_path


def python(folder: Path, path: Path, *arguments: str) -> str:
    """Standard output of Python run in `folder` with `path` on its search path."""
    done = subprocess.run(
        [sys.executable, *arguments],
        cwd=folder,
        env={**os.environ, "PYTHONPATH": str(path)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert (done.returncode, done.stderr) == (0, "")
    return done.stdout


@pytest.mark.parametrize("layout", LAYOUTS)
def test_a_users_own_modules_do_no_harm(layout: str, installed: Mapping[str, Path], mine: Path) -> None:
    """A script beside its own rotor.py, bearings.py, master/ and tests/ has them, and the project."""
    scenes, _, last = python(mine, installed[layout], "script.py").rstrip().rpartition("\n")
    found = json.loads(last)
    assert found["mine"] == ["mine"] * 4
    top = installed[layout].parent if layout in ("editable", "checkout") else installed[layout]
    assert [file for file in found["theirs"] if not Path(file).is_relative_to(top)] == []
    assert "disk-caged-simplified" in scenes
    if layout == "checkout":  # also as a module, in a folder that Python then searches first
        assert scenes in python(mine, installed[layout], "-m", "touchdown", "scenes")


def test_the_links_for_editors_lead_to_the_packages() -> None:
    """They are in the repository; wheels leave them out."""
    folder = ROOT / "src" / "touchdown"
    links = {path.name: path.resolve() for path in folder.iterdir() if path.is_symlink()}
    assert links == {name: ROOT / name for name in PACKAGES}
