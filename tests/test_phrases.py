"""Phrases that read badly must not return: in pages, and in texts of the code."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from places import PACKAGES, ROOT

BETTER = {  # what must not be written, and what reads better
    r"(?<!there )\bis no (?!longer|more|less|better)\w": "is not a",
    r"(?<!there )\bis none\b": "does not exist, is missing",
    r"\bas it is\b": "unchanged; or name the state",
    r"\bwhatever\b": "any, at every",
    r"\bso that it\b": "which, and",
    r"\bnobody\b": "say who does not",
    r"\bone's own\b": "your own",
    r"\bthe source(?:'s)?(?! (?:of|code|file|and)\b)(?=[ ,.;:)]|$)": "Halminen (2016), the dissertation",
}
PAGES = [
    *(ROOT / name for name in ("README.md", "CONTRIBUTING.md")),
    *sorted((ROOT / "docs").glob("*.md")),
    *sorted((ROOT / "docs" / "notebooks").glob("*.md")),
]
CODE = re.compile(r"^```.*?^```|`[^`\n]*`", re.MULTILINE | re.DOTALL)


def found(text: str) -> Iterator[str]:
    """Each phrase in a text, with what reads better."""
    for phrase, better in BETTER.items():
        for match in re.finditer(phrase, " ".join(text.split()), re.IGNORECASE):
            yield f"{match[0]!r}: {better}"


@pytest.mark.parametrize("path", PAGES, ids=lambda path: path.name)
def test_pages_read_well(path: Path) -> None:
    assert not list(found(CODE.sub("", path.read_text(encoding="utf-8"))))


TEMPLATES = sorted((ROOT / "reports" / "templates").rglob("*.html"))
MARKUP = re.compile(r"\{[{%#].*?[}%#]\}|<[^>]*>", re.DOTALL)


def test_templates_read_well() -> None:
    assert TEMPLATES
    texts = {path.name: MARKUP.sub("", path.read_text(encoding="utf-8")) for path in TEMPLATES}
    assert not {name: wrong for name, text in texts.items() if (wrong := list(found(text)))}


@pytest.mark.parametrize("package", PACKAGES)
def test_texts_of_the_code_read_well(package: str) -> None:
    """Messages, help and docstrings."""
    wrong = {}
    for path in sorted((ROOT / package).rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Constant) and isinstance(node.value, str):
                for told in found(node.value):
                    wrong[f"{path.relative_to(ROOT)}:{node.lineno}"] = told
    assert not wrong


def test_what_must_not_be_written_is_found() -> None:
    assert [told.split(":")[0] for told in found("It is no bearing, whatever the\nsource's is.")] == [
        "'is no b'",
        "'whatever'",
        '"the source\'s"',
    ]
    assert not list(
        found("There is no load. The source and its target. The source of heat is no longer there.")
    )
