"""How the command ended, and what it then has to say."""

from __future__ import annotations

import csv
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

SCENE = "disk-caged-simplified"
SHORT = ("--set", "run.duration=2e-3")


class Ended(NamedTuple):
    """How a command ended."""

    status: int
    stderr: str

    @property
    def line(self) -> str:
        """Its complaint, which must be one line, come from `touchdown`, and mean failure."""
        lines = self.stderr.splitlines()
        assert self.status != 0
        assert len(lines) == 1, self.stderr
        assert lines[0].startswith("touchdown: ")
        return lines[0]


Command = Callable[..., Ended]


def records(path: Path) -> list[dict[str, str]]:
    """The rows of a CSV file."""
    with path.open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))
