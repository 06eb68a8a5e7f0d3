"""Layers: physics knows nothing of FMI, the master nothing of physics."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
PROJECT = {"modelkit", "rotor", "bearings", "fmus", "master"}
SCIENCE = {"numpy", "scipy", "numba"}

ALLOWED = {  # package: what it may import beside the standard library
    "modelkit": {"modelkit"} | SCIENCE,
    "rotor": {"modelkit", "rotor"} | SCIENCE,
    "bearings": {"modelkit", "bearings"} | SCIENCE,
    "fmus": {"modelkit", "rotor", "bearings", "fmus", "pythonfmu"} | SCIENCE,
    "master": {"modelkit", "fmus", "master", "fmpy", "h5py", "matplotlib", "tqdm", "numpy", "scipy"}
    | {"fmu_manipulation_toolbox"},
}


def imports(path: Path) -> set[str]:
    """Top-level packages a module imports, anywhere in it."""
    found: set[str] = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            found |= {name.name.partition(".")[0] for name in node.names}
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path}: relative import; sources are rewritten by their full names"
            found.add((node.module or "").partition(".")[0])
    return found


def third_party(names: set[str]) -> set[str]:
    """Names that are not the standard library's."""
    import sys

    return {name for name in names if name not in sys.stdlib_module_names}


@pytest.mark.parametrize("package", sorted(PROJECT))
def test_a_layer_imports_only_what_it_may(package: str) -> None:
    files = sorted((ROOT / package).rglob("*.py"))
    assert files
    for path in files:
        extra = third_party(imports(path)) - ALLOWED[package]
        assert not extra, f"{path.relative_to(ROOT)} imports {sorted(extra)}"


def test_only_one_module_speaks_fmi() -> None:
    speakers = {p.name for p in (ROOT / "master").rglob("*.py") if "fmpy" in imports(p)}
    assert speakers == {"fmi.py", "check.py", "trial.py"}  # the last runs in a process of its own


def test_only_the_twin_steps_models_in_the_master() -> None:
    users = set()
    for path in (ROOT / "master").rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.ImportFrom) and node.module == "modelkit.model":
                # errors of a model's may be caught anywhere
                users |= {path.name for name in node.names if name.name != "ModelError"}
            elif isinstance(node, ast.Import):
                users |= {path.name for name in node.names if name.name == "modelkit.model"}
    assert users == {"twin.py"}
