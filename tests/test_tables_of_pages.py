"""Tables of the documentation that are made of declarations are those of the code."""

from __future__ import annotations

import sys

import pytest
from places import ROOT

sys.path.insert(0, str(ROOT / "docs"))
import tables


@pytest.mark.parametrize("path", tables.pages(), ids=lambda path: path.name)
def test_a_page_has_its_tables(path) -> None:
    text = path.read_text(encoding="utf-8")
    assert tables.filled(text) == text, "run docs/tables.py"


def test_every_table_is_on_a_page() -> None:
    named = {block[2] for text in tables.pages().values() for block in tables.BLOCK.finditer(text)}
    assert named == {*tables.DECLARED, "requirements", "quantities"}


def test_a_key_says_what_it_must_be_and_its_default() -> None:
    """With the unit of its size, and all of it from the declaration."""
    assert "| `count` | a whole number from 1 on | 1 | how many follow each other |" in tables.table(
        "element"
    )
    assert any(line.startswith("| `macro_step` | s, above 0 | 20 us |") for line in tables.table("run"))
    assert "| `heat` | at most, such as 500 J | `bearing_heat` | friction in a bearing |" in tables.table(
        "requirements"
    )
