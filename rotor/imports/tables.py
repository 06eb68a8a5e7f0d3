"""Named arrays and tables of text, each mistake said in one line."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from difflib import get_close_matches
from pathlib import Path
from typing import Any

import numpy as np
from scipy import sparse

from ...modelkit.model import ModelError
from ..beams.superelement import by


class ImportedRotorError(ModelError):
    """An import that is impossible: file, place, value and remedy in one line."""


@dataclass(frozen=True)
class Given:
    """Data of an imported file, and the file's name for messages."""

    file: str
    data: Mapping[str, Any]

    def error(self, says: str) -> ImportedRotorError:
        """The error to raise."""
        return ImportedRotorError(f"{self.file}: {says}")

    def only(self, *known: str) -> None:
        """Raises ImportedRotorError for the first name that is not known."""
        for name in self.data:
            if name not in known:
                near = get_close_matches(str(name), known, n=1)
                remedy = f"did you mean {near[0]}" if near else f"there are: {', '.join(known)}"
                raise self.error(f"{name} is not known; {remedy}")

    def has(self, name: str) -> bool:
        """Whether it is there."""
        return self.data.get(name) is not None

    def names(self, name: str) -> np.ndarray:
        """Texts, or whole numbers as texts, at least one row of them. Raises ImportedRotorError."""
        values = np.atleast_1d(np.asarray(self.data[name]))
        if values.dtype.kind == "f" and np.all(values == np.round(values)):
            values = values.astype(int)
        if values.dtype.kind not in "iuUS":
            raise self.error(f"{name} must be an array of texts or whole numbers")
        return values.astype(str)

    def numbers(self, name: str, *sizes: tuple[int, ...]) -> np.ndarray:
        """Finite real numbers as one of `sizes`, any where none is given.

        Raises ImportedRotorError, also where they are missing.
        """
        if not self.has(name):
            raise self.error(f"{name} is missing")
        try:
            values = self.data[name]
            values = np.asarray(values.toarray() if sparse.issparse(values) else values)
            if values.dtype.kind not in "iuf":
                raise TypeError
            values = values.astype(float)
        except (TypeError, ValueError):
            raise self.error(f"{name} must be an array of real numbers") from None
        if sizes and values.shape not in sizes:
            wanted = " or ".join(by(size) for size in sizes)
            raise self.error(f"{name} is {by(values.shape)}; it must be {wanted}")
        if not np.all(np.isfinite(values)):
            where = ", ".join(str(i + 1) for i in np.argwhere(~np.isfinite(values))[0])
            raise self.error(f"{name} holds what is no finite number, first at [{where}]")
        return values


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
    """The separator of a table with this header: a tab, a semicolon or a comma."""
    return max("\t;,", key=head.count)


def named(head: str) -> tuple[str, str]:
    """Name and unit of a heading such as "length [mm]"; without brackets the unit is ""; "": no name."""
    match = _HEAD.match(head)
    return (match[1], match[2] or "") if match else ("", "")
