"""The page of the rotor file has every key that the reader knows, and its example is one."""

from __future__ import annotations

import ast
import re
from pathlib import Path

from touchdown.rotor.file import parse, reader

PAGE = (Path(__file__).parents[3] / "docs" / "rotor-file.md").read_text(encoding="utf-8")


def known_keys() -> set[str]:
    """What the reader takes: the keys that it asks its tables for."""
    asked = {"only", "tables", "get", "text", "integer", "number", "quantity", "node", "table"}
    found: set[str] = set()
    for node in ast.walk(ast.parse(Path(reader.__file__).read_text(encoding="utf-8"))):
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute) and node.func.attr in asked:
            names = node.args if node.func.attr in ("only", "tables") else node.args[:1]
            found |= {
                one.value for one in names if isinstance(one, ast.Constant) and isinstance(one.value, str)
            }
    return found | {*reader.DIAMETERS, *reader.FIELDS, *reader.SUPPORT}


def test_every_key_is_there() -> None:
    keys = known_keys()
    assert {"levitated_at", "shear_factor", "damping_y", "shapes"} <= keys
    assert {key for key in keys if not re.search(rf"[`\[.]{key}[`\].]", PAGE)} == set()


def test_its_example_is_a_rotor() -> None:
    (text,) = re.findall(r"```toml\n(.*?)```", PAGE, re.DOTALL)
    assert parse(text, "stub.toml").mass > 0.5
