"""Scenes on native FMUs: recorded to the last bit as in process, and a bearing in C in one of them."""

from __future__ import annotations

import subprocess
from pathlib import Path

import h5py
import pytest
from places import COMMAND, ROOT

from touchdown.command.cli import main
from touchdown.fmus.build import is_sealed
from touchdown.fmus.native.compiler import host_target
from touchdown.master.common.errors import FAILED

EXAMPLE = ROOT / "examples" / "rubber_ring.py"
DISK = """
title = "A disk drops onto a bushing"
attach = [["bearing.journal", "rotor.A"], ["bearing.housing", "housing.seat"]]
[run]
duration = "30 ms"
macro_step = "50 us"
[components.rotor]
fmu = "rigid_rotor"
[components.housing]
fmu = "housing"
[components.bearing]
fmu = "bushing"
"""

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(host_target() is None, reason="native FMUs are not built for this machine"),
]


@pytest.fixture
def disk(tmp_path: Path) -> Path:
    """A scene of the models that are cheap to build."""
    path = tmp_path / "disk.toml"
    path.write_text(DISK)
    return path


def run(*arguments: object) -> None:
    """`touchdown run`, quietly."""
    assert main(["run", *map(str, arguments), "--quiet", "--no-pictures"]) == 0


def test_native_fmus_and_none_at_all_exclude_each_other(disk: Path, capsys: pytest.CaptureFixture[str]):
    assert main(["run", str(disk), "--native", "--in-process"]) == FAILED
    assert "exclude each other" in capsys.readouterr().err


def test_a_bearing_in_c_is_built_checked_and_swapped_into_a_scene(
    disk: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
):
    """It catches the disk: hit hard enough, it gives way, and not by more than its clearance and a half."""
    assert main(["build", "--native", str(EXAMPLE), "-o", str(tmp_path)]) == 0
    fmu = tmp_path / "rubber_ring.fmu"
    assert not is_sealed(fmu)  # C code of a user's own runs in a process of its own
    assert main(["check", str(fmu), "--as", "bearing"]) == 0
    assert "it can stand in for a bearing" in capsys.readouterr().out
    run(disk, "--swap", f"bearing={fmu}", "--in-process", "-o", tmp_path / "drop")
    with h5py.File(tmp_path / "drop" / "result.h5") as file:
        height, force = file["rotor/A.y"][...], file["bearing/journal.fy"][...]  # type: ignore[index]
    assert -0.3e-3 < height.min() < -0.2e-3
    assert force.max() > 50.0


def test_its_refusals_are_its_own_and_the_fmi_sides(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    assert main(["build", "--native", str(EXAMPLE), "-o", str(tmp_path)]) == 0
    disk = tmp_path / "disk.toml"
    disk.write_text(DISK.replace('fmu = "bushing"', 'fmu = "rubber_ring.fmu"\nset = {clearance = 0.02}'))
    assert main(["run", str(disk), "--quiet", "-o", str(tmp_path / "run")]) == FAILED
    assert "clearance = 0.02 m is no touchdown bearing's; take less than 10 mm" in capsys.readouterr().err


def test_mistakes_in_a_bearing_in_c_are_named(tmp_path: Path):
    """By the compiler's first line; the Python file's by its error."""
    for name in ("rubber_ring.py", "rubber_ring.c"):
        text = (EXAMPLE.parent / name).read_text()
        (tmp_path / name).write_text(text.replace("m->p.stiffness", "m->p.stifness"))
    done = subprocess.run(
        [*COMMAND, "build", "--native", "rubber_ring.py"],
        cwd=tmp_path, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == FAILED
    assert "stifness" in done.stderr
    assert len(done.stderr.splitlines()) == 1
    (tmp_path / "rubber_ring.py").write_text("1 / 0\n")
    assert main(["build", "--native", str(tmp_path / "rubber_ring.py")]) == FAILED
