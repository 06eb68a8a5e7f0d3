"""Texts name modules, files and functions that exist; tests stand in folders of the code."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from places import PACKAGES, ROOT

SUBPACKAGES = (
    "components",
    "coupling",
    "interop",
    "results",
    "scene",
)  # of master
DOTTED = re.compile(rf"`(?:touchdown\.)?((?:{'|'.join(PACKAGES + SUBPACKAGES)})(?:\.(?!toml\b)\w+)+)`")
WRITTEN = re.compile(r"`((?:[\w-]+/)*(?:[\w-]+\.py|[\w-]+/))`")
DEFINED_IN = re.compile(r"`(?:\w+\.)?(\w+)` in `([\w/]+\.py)`")
FOREIGN = {"master.sequence_order"}  # an option of cofmupy
READMES = sorted(ROOT.glob("*/README.md"))
PAGES = [
    ROOT / "CONTRIBUTING.md",
    *READMES,
    *sorted(p for p in (ROOT / "docs").glob("*.md") if p not in READMES),
]


def missing(name: str) -> bool:
    """Whether a dotted name leads to nothing. `rotor.speed` and the like are variables of a scene."""
    first, *others = name.split(".")
    at = ROOT / ("master" if first in SUBPACKAGES else "") / first
    for i, part in enumerate(others):
        if (at / part).is_dir() or (at / f"{part}.py").is_file():
            at /= part
            continue
        module = at / "__init__.py" if at.is_dir() else at.with_suffix(".py")
        is_variable = i == 0 and first in ("rotor", *SUBPACKAGES)
        return not is_variable and not re.search(rf"\b{part}\b", module.read_text(encoding="utf-8"))
    return False


def stale(path: Path) -> Iterator[str]:
    """Names in a file's text that lead to nothing."""
    text = path.read_text(encoding="utf-8")
    yield from (name for name in DOTTED.findall(text) if name not in FOREIGN and missing(name))
    for name, file in DEFINED_IN.findall(text) if path.suffix == ".md" else ():
        if not re.search(rf"^\s*(?:def|class) {name}\b|^{name}\b", (ROOT / file).read_text(), re.MULTILINE):
            yield f"{name} in {file}"
    for name in WRITTEN.findall(text) if path in READMES else ():
        if not (any(path.parent.rglob(name.rstrip("/"))) or (ROOT / name).exists()):
            yield name


@pytest.mark.parametrize("package", [*PACKAGES, "tests", "benchmarks", "examples", "docs", ".ci"])
def test_docstrings_and_comments_name_what_there_is(package: str) -> None:
    paths = sorted((ROOT / package).rglob("*.py"))
    assert paths
    assert not {str(path.relative_to(ROOT)): found for path in paths if (found := list(stale(path)))}


def test_pages_name_what_there_is() -> None:
    assert not {str(path.relative_to(ROOT)): found for path in PAGES if (found := list(stale(path)))}


def test_tests_have_the_folders_of_the_code() -> None:
    folders = {path.parent.relative_to(ROOT / "tests") for path in (ROOT / "tests").rglob("test_*.py")}
    own = {Path("scenes"), Path("master/fuzz"), Path("master/interop/peers")}
    assert len(folders) > 10
    assert not {str(folder) for folder in folders - own if not (ROOT / folder).is_dir()}
