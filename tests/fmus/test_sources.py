"""The sources that an FMU in Python carries."""

from __future__ import annotations

import ast
from pathlib import Path

from touchdown.fmus.python.packed_sources import write_sources


def test_they_import_nothing_of_the_project_that_may_be_installed(tmp_path: Path) -> None:
    """Nor do functions, which import when they are called."""
    files = list(write_sources(tmp_path).rglob("*.py"))
    assert len(files) > 20
    nodes = [node for path in files for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))]
    imported = {node.module or "" for node in nodes if isinstance(node, ast.ImportFrom)}
    imported |= {alias.name for node in nodes if isinstance(node, ast.Import) for alias in node.names}
    assert len(imported) > 20
    assert [name for name in imported if name.split(".")[0] == "touchdown"] == []
