"""Links from src/touchdown to the packages at the top of a checkout, made by an editable install.

Python does not need them: `touchdown/__init__.py` looks at the top itself. They are for tools that read
the tree without running it (type checkers, editors), to which touchdown.rotor is src/touchdown/rotor.
Windows gets junctions, which need no rights; where neither can be made, only those tools miss them.
"""

from __future__ import annotations

import contextlib
import os
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

PACKAGES = ("modelkit", "rotor", "bearings", "fmus", "master")


class CheckoutLinks(BuildHookInterface):
    """Runs before every build of a wheel; an editable install is one."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Make the links that are missing."""
        if version != "editable":
            return
        top = Path(self.root)
        for name in PACKAGES:
            link = top / "src" / "touchdown" / name
            if not os.path.lexists(link):
                with contextlib.suppress(OSError):
                    _join(link, top / name)


def _join(link: Path, folder: Path) -> None:
    if os.name == "nt":
        import _winapi

        _winapi.CreateJunction(str(folder), str(link))  # type: ignore[attr-defined]
    else:
        link.symlink_to(os.path.relpath(folder, link.parent), target_is_directory=True)
