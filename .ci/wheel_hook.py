"""What a wheel of this project needs beside its files.

An editable install, which is a wheel too, makes links from src/touchdown to the packages at the top of
the checkout. Python does not need them: `touchdown/__init__.py` looks at the top itself. They are for tools
that read the tree without running it (type checkers, editors), to which touchdown.rotor is
src/touchdown/rotor. Windows gets junctions, which need no rights; where neither can be made, only those
tools miss them.

A wheel for a platform gets machine code and FMUs: `.ci/build_wheel.py` says which, and for what, by two
variables of the environment.
"""

from __future__ import annotations

import contextlib
import os
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

SHIPPED, TAG = "TOUCHDOWN_SHIPPED", "TOUCHDOWN_WHEEL_TAG"
PACKAGES = ("modelkit", "rotor", "bearings", "fmus", "master")


class WheelHook(BuildHookInterface):
    """Runs before every build of a wheel."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Make the links that are missing, or take in what is to come along."""
        if version == "editable":
            _link(Path(self.root))
        elif SHIPPED in os.environ:
            build_data["force_include"][os.environ[SHIPPED]] = "touchdown/shipped"
            build_data["pure_python"] = False
            build_data["tag"] = os.environ[TAG]


def _link(top: Path) -> None:
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
