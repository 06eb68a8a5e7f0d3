"""The recipes of docs/architecture.md: each is followed to the letter in a copy of the repository.

Machine code of models in process is kept by the path of their source, so a copy would compile anew; that
of FMUs is kept by content, so the commands here run FMUs.
"""

from __future__ import annotations

import csv
import os
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import h5py
import numpy as np
import pytest
from places import PACKAGES, ROOT

pytestmark = pytest.mark.slow

PARTS = ("src/touchdown", *PACKAGES)
PAGE = (ROOT / "docs" / "architecture.md").read_text(encoding="utf-8")
BLOCK = re.compile(r"^```(\w+)\n(.*?)^```", re.MULTILINE | re.DOTALL)
INSERTED = re.compile(r"# in (\S+), after: (.*)\n")
LINKED = re.compile(r"^File: \[(\S+)\]\(\.\./(\S+)\)\.$", re.MULTILINE)


@pytest.fixture
def repository(tmp_path: Path) -> Path:
    """A copy of what is needed to run."""
    top = tmp_path / "repository"
    dropped = shutil.ignore_patterns("__pycache__", *(Path(part).name for part in PARTS[1:]))
    for part in PARTS:
        ignore = dropped if part == PARTS[0] else shutil.ignore_patterns("__pycache__")
        shutil.copytree(ROOT / part, top / part, ignore=ignore)
    shutil.copy(ROOT / "pyproject.toml", top)
    return top


def follow(recipe: str, top: Path) -> list[list[str]]:
    """Do in `top` what the page says under the heading `recipe`; returns the commands that end it."""
    text = PAGE.partition(f"\n### {recipe}\n")[2].partition("\n### ")[0]
    commands: list[list[str]] = []
    for target, source in LINKED.findall(text):
        assert source == f"examples/extending/{target}"
        assert not (top / target).exists()
        shutil.copy(ROOT / source, top / target)
    for kind, block in BLOCK.findall(text):
        first, rest = block.split("\n", 1)
        if kind == "sh":
            commands = [shlex.split(line) for line in block.splitlines()]
        elif inserted := INSERTED.match(block):
            insert(top / inserted[1], inserted[2], rest)
        else:
            new = top / first.strip("{# }")
            assert not new.exists()
            new.write_text(rest, encoding="utf-8")
    return commands


def insert(path: Path, line: str, text: str) -> None:
    """Put `text` behind the one line of a file that reads `line`."""
    before, found, after = path.read_text(encoding="utf-8").partition(f"\n{line}\n")
    assert found, f"{path} has no line {line}"
    path.write_text(before + found + text + after, encoding="utf-8")


def run(recipe: str, top: Path) -> tuple[str, Path]:
    """Follow a recipe, and run its commands: what the last one printed, and where its results are."""
    for name, *arguments in follow(recipe, top):
        assert name == "touchdown"
        ended = subprocess.run(
            [sys.executable, "-m", "touchdown", *arguments],
            cwd=top,
            env={**os.environ, "PYTHONPATH": str(top / "src")},
            capture_output=True,
            text=True,
            timeout=600,
            check=False,
        )
        assert ended.returncode == 0, ended.stderr
    return ended.stdout, top / arguments[-1]


def test_add_a_bearing(repository: Path) -> None:
    """Rotor and bearing are FMUs; the disk swings on the rubber as a damped oscillator does."""
    printed, folder = run("Add a bearing", repository)
    with h5py.File(folder / "result.h5") as file:
        time, y = (np.asarray(file[name]) for name in ("time", "rotor/A.y"))
    sag, rate, decay = 2.0 * 9.81 / 20e3, (20e3 / 2.0) ** 0.5, 20.0 / (2.0 * 2.0)
    swing = (rate**2 - decay**2) ** 0.5
    wanted = sag * (
        np.exp(-decay * time) * (np.cos(swing * time) + decay / swing * np.sin(swing * time)) - 1.0
    )
    assert np.ptp(wanted) > sag
    np.testing.assert_allclose(y, wanted, rtol=0.0, atol=1e-4 * sag)
    farthest, force = (
        float(re.findall(rf"{re.escape(head)}\s+(\S+)", printed)[0])
        for head in (
            "largest distance of the journal from the middle [um]",
            "largest force on the journal [N]",
        )
    )
    assert farthest == pytest.approx(1e6 * np.max(np.abs(wanted)), rel=1e-3)
    assert force == pytest.approx(20e3 * np.max(np.abs(wanted)), rel=5e-3)  # there nothing moves
    assert (folder / "held.png").stat().st_size > 10_000


def test_add_a_quantity(repository: Path) -> None:
    """The ring's speed at the end, as it was recorded; test_quantities.py looks where else it stands."""
    printed, folder = run("Add a quantity", repository)
    with h5py.File(folder / "result.h5") as file:
        speed = float(np.asarray(file["bearing/ring.omega"])[-1])
    assert speed > 10.0  # rad/s
    shown = re.findall(r"speed of the ring at the end \[rpm\] +(\S+)", printed)
    assert shown == [f"{30.0 / np.pi * speed:.6g}"]


def test_add_a_coupling_scheme(repository: Path) -> None:
    printed, folder = run("Add a coupling scheme", repository)
    assert re.search(r"scheme\s+halves\n", printed)
    with h5py.File(folder / "result.h5") as file:
        assert np.max(np.asarray(file["bearing/contact.force"])) > 100.0  # N; it landed


def test_add_a_figure(repository: Path) -> None:
    _, folder = run("Add a figure", repository)
    assert (folder / "gap.png").stat().st_size > 10_000


def test_add_a_chapter_of_the_report(repository: Path) -> None:
    _, page = run("Add a chapter of the report", repository)
    text = page.read_text(encoding="utf-8")
    chapter = text.partition('<section id="touching"')[2].partition("</section>")[0]
    assert "How long the rotor touches</h2>" in chapter
    part = re.search(r'<th scope="row">A</th><td class="number">(.+) %</td>', chapter)
    assert part is not None
    assert 0.0 < float(part[1]) < 50.0
    assert "<p>Most of the time the rotor flies.</p>" in chapter


def test_add_a_comparison(repository: Path) -> None:
    """The scene has 0.3 mm; it falls further and hits harder."""
    printed, folder = run("Add a comparison", repository)
    assert re.search(r"^clearance +first impact", printed, re.MULTILINE)
    with (folder / "clearances.csv").open(encoding="utf-8") as file:
        rows = {row["variant"]: float(row["first_impact_contact_force_N"]) for row in csv.DictReader(file)}
    assert list(rows) == ["0.2 mm", "0.25 mm", "unchanged"]
    assert rows["0.2 mm"] < rows["0.25 mm"] < rows["unchanged"]


def test_add_a_study(repository: Path) -> None:
    printed, _ = run("Add a study", repository)
    forces = [float(force) for force in re.findall(r"0\.[23] mm +(\d+) N", printed)]
    assert len(forces) == 2
    assert 100.0 < forces[0] < forces[1]  # it falls further
