"""Tables of text, as spreadsheets leave them: the file, what parts its cells, and their headings."""

from __future__ import annotations

import re
from pathlib import Path

from touchdown.rotor.imports.mistakes import ImportedRotorError

_HEAD = re.compile(r"^\s*([^\[(]+?)\s*(?:[\[(]\s*(.*?)\s*[\])])?\s*$")


def text_of(path: Path) -> str:
    """The text of a file. Raises ImportedRotorError where it cannot be read, or is none."""
    try:
        return path.read_text(encoding="utf-8-sig")
    except OSError as error:
        raise ImportedRotorError(f"{path}: cannot be read: {error.strerror}") from None
    except UnicodeDecodeError as error:
        raise ImportedRotorError(
            f"{path}: is not text in UTF-8 (byte {error.start}); save it as UTF-8"
        ) from None


def separator(head: str) -> str:
    """What parts the cells of a table with this header: a tab, a semicolon or a comma."""
    return max("\t;,", key=head.count)


def named(head: str) -> tuple[str, str]:
    """Name and unit of a heading such as "length [mm]"; without brackets the unit is ""; "": no name."""
    match = _HEAD.match(head)
    return (match[1], match[2] or "") if match else ("", "")
